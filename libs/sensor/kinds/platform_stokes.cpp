// Platforms that see polarisation: the frame of Stokes vectors, and analysers before detectors.
//
// Paths bring Stokes vectors, and analysers are applied to the means of a pixel: both are linear, so that it does not
// matter which comes first. Vectors arrive in a frame that stands still and are turned into that of the picture by the
// direction of the pixel's middle at the middle of its exposure; within a pixel and an exposure the turn is neglected.
#include <algorithm>
#include <array>
#include <cmath>

#include "sensor/kinds/platform.h"

namespace suite {

namespace {

bool in_picture(const PlatformSpec& spec) { return spec.polarimetry && spec.polarimetry->frame == StokesFrame::image; }

// Directions that the corners and the middle of an array look in, and what is up in its picture.
struct Views {
  std::vector<Dir> looks, ups;
};
void add_views(const PlatformSpec& spec, const FocalArray& array, double t, Views& views) {
  const Instrument& instrument = spec.instruments[array.instrument];
  const Pose pose = pose_at(spec, instrument, t);
  views.ups.push_back(normalized(pose.vector({0, 1, 0})));
  for (const uint32_t column : {0u, array.columns / 2, array.columns - 1})
    for (const uint32_t row : {0u, array.rows / 2, array.rows - 1})
      views.looks.push_back(
          normalized(pose.vector(instrument.lens.look(place_of(array, column, row, 0.5, 0.5).place))));
}
Views views_of(const PlatformSpec& spec) {
  constexpr size_t kMost = 256;  // moments of a task
  Views views;
  for (size_t t = 0; t < spec.tasks.size(); ++t) {
    const auto& captures = spec.tasks[t].captures;
    const size_t step = (captures.size() + kMost - 1) / kMost;
    for (size_t c = 0; c < captures.size(); c += step)
      for (const double time : {captures[c].window.begin, captures[c].window.end})
        add_views(spec, spec.arrays[spec.parts[t][c].array], time, views);
  }
  return views;
}

// The least sine of the angle between a direction and what is looked at.
double apart(const Views& views, Vec3 direction) {
  double least = 1;
  for (const Dir& look : views.looks) least = std::min(least, length(cross(look, direction)));
  return least;
}

}  // namespace

void read_stokes(const Params& params, PlatformSpec& spec) {
  if (const auto analyser = params.find("analyser"))
    throw analyser->error("an analyser stands before the detectors of an array", "give it to the array");
  spec.polarimetry = read_polarimetry(params, spec.channels);
}

void choose_frame(const Params& params, PlatformSpec& spec) {
  if (!in_picture(spec)) return;
  const Views views = views_of(spec);
  constexpr double kGood = 0.5, kLeast = 0.1;
  std::vector<Vec3> candidates(views.ups.begin(), views.ups.end());
  constexpr int kMore = 400;  // evenly over half a sphere (Fibonacci)
  for (int i = 0; i < kMore; ++i) {
    const double z = (i + 0.5) / kMore, turn = kPi * (3 - std::sqrt(5.0)) * i, s = std::sqrt(1 - z * z);
    candidates.push_back({s * std::cos(turn), s * std::sin(turn), z});
  }
  double best = 0;
  for (const Vec3& candidate : candidates) {
    const double found = apart(views, candidate);
    if (found <= best) continue;
    best = found, spec.polarimetry->up = candidate;
    if (best >= kGood) break;
  }
  if (best < kLeast)
    throw params.at("stokes_frame")
        .error("the instruments look in all directions, and no frame is apart from all of them",
               "a sensor for each instrument, or stokes_frame: meridian");
}

void read_array_analysers(const Params& p, const PlatformSpec& spec, FocalArray& array) {
  if (in_picture(spec) && array.time_bins > 1)
    throw p.at("time_bins")
        .error("parts of an exposure are not turned into the frame of the picture",
               "stokes_frame: meridian, or leave out time_bins");
  if (const auto analyser = p.find("analyser")) {
    if (!array.detector) throw analyser->error("there are no detectors behind it", "detector: {...} in the array");
    if (!in_picture(spec))
      throw analyser->error("analysers are given in the frame of the picture",
                            "stokes: linear and stokes_frame: image of the platform");
    array.analysers = read_analysers(*analyser);
    const bool circular = std::count(spec.channels.begin(), spec.channels.end(), "stokes_v") > 0;
    for (const char* component : {"stokes_q", "stokes_u"})
      if (!std::count(spec.channels.begin(), spec.channels.end(), component))
        throw analyser->error("analysers see Q and U", "stokes: linear, or [i, q, u, v]");
    for (const AnalyserTrain& train : array.analysers->trains)
      for (const double um : {0.43, 0.55, 1.3, 10.0})
        if (!circular && std::fabs(train.at(um)(0, 3)) > 1e-9)
          throw analyser->error("this analyser sees V", "stokes: [i, q, u, v] of the platform");
  }
  if (const auto mosaic = p.find("mosaic")) {
    if (!array.reader) throw mosaic->error("there are no counts", "detector: {gain_e_per_dn: N, ...} in the array");
    for (const Params& row : mosaic->items()) {
      array.mosaic.emplace_back();
      for (const Params& band : row.items()) array.mosaic.back().push_back(band.as_text());
      if (array.mosaic.back().empty() || array.mosaic.back().size() != array.mosaic[0].size())
        throw row.error("the rows of a mosaic have one length", "mosaic: [[red, green], [green, blue]]");
    }
  }
}

void check_mosaic(const Params& p, const FocalArray& array, std::span<const Band> bands) {
  for (const auto& row : array.mosaic)
    for (const std::string& name : row)
      if (std::none_of(bands.begin(), bands.end(), [&](const Band& b) { return b.name == name; }))
        throw p.at("mosaic").error("there is no band '" + name + "'", "names of `bands`");
}

void turn_upright(const PlatformSpec& spec, const std::function<Pose(double)>& pose, CaptureResult& result) {
  if (!in_picture(spec)) return;
  const size_t q = channel_of(spec.channels, "stokes_q"), u = channel_of(spec.channels, "stokes_u");
  if (q >= result.channels || u >= result.channels) return;
  const Capture& capture = spec.tasks[result.task].captures[result.capture];
  const FocalArray& array = spec.arrays[spec.segments[capture.state].array];
  const Lens& lens = spec.instruments[array.instrument].lens;
  const Vec3 first = spec.polarimetry->up;
  for (size_t i = 0; i < result.problems(); ++i) {
    const Exposed from = exposed(spec, capture, i);
    const Pose at = pose(capture.window.begin + from.delay + 0.5 * array.readout.exposure());
    const Dir k = -normalized(at.vector(lens.look(place_of(array, from.column, from.row, 0.5, 0.5).place)));
    const Vec3 e1 = normalized(first - k * dot(first, k)), up = at.vector({0, 1, 0}),
               upright = normalized(up - k * dot(up, k));
    const Mueller turn = frame_rotation({e1, cross(k, e1)}, upright);
    const double c = turn(1, 1), s = turn(1, 2);
    for (size_t b = 0; b < result.bands; ++b) {
      const auto index = [&](size_t channel) { return (i * result.channels + channel) * result.bands + b; };
      double &Q = result.radiance[index(q)], &U = result.radiance[index(u)];
      const double before = Q;
      Q = c * before + s * U, U = c * U - s * before;
      if (result.stokes_covariance.empty()) continue;
      double* const errors[] = {&result.standard_error[index(0)], &result.standard_error[index(q)],
                                &result.standard_error[index(u)]};
      double C[6];
      covariances(result, i, b, {*errors[0], *errors[1], *errors[2]}, C);
      *errors[1] = std::sqrt(std::max(0.0, c * c * C[3] + 2 * c * s * C[4] + s * s * C[5]));
      *errors[2] = std::sqrt(std::max(0.0, s * s * C[3] - 2 * c * s * C[4] + c * c * C[5]));
      double* const raw = &result.stokes_covariance[(i * result.bands + b) * 6];
      const double IQ = raw[1], QQ = raw[3], QU = raw[4], UU = raw[5];
      raw[1] = c * IQ + s * raw[2], raw[2] = c * raw[2] - s * IQ;
      raw[3] = c * c * QQ + 2 * c * s * QU + s * s * UU, raw[5] = s * s * QQ - 2 * c * s * QU + c * c * UU;
      raw[4] = (c * c - s * s) * QU + c * s * (UU - QQ);
    }
  }
}

std::vector<std::vector<Stokes>> analyser_rows(const Segment& segment, const Analysers& analysers) {
  std::vector<std::vector<Stokes>> rows;
  for (size_t b = 0; b < segment.radiance_bands; ++b) {
    rows.emplace_back();
    for (const AnalyserTrain& train : analysers.trains)
      rows.back().push_back(train.row(segment.bands[segment.radiance_bands + b]));
  }
  return rows;
}

Product mosaic_of(const PlatformSpec& spec, const Segment& segment, const CaptureResult& result, const Product& all) {
  const FocalArray& array = spec.arrays[segment.array];
  const Capture& capture = spec.tasks[result.task].captures[result.capture];
  Product product{"mosaic", all.unit, true, {"mosaic"}, {}};
  const size_t bands = segment.radiance_bands;
  for (size_t i = 0; i < result.problems(); ++i) {
    const Exposed at = exposed(spec, capture, i);
    const auto& row = array.mosaic[at.row % array.mosaic.size()];
    const std::string& name = row[at.column % row.size()];
    size_t b = 0;
    while (segment.bands[b].name != name) ++b;
    product.values.push_back(all.values[i * bands + b]);
  }
  return product;
}

}  // namespace suite
