// What detectors make of radiance: electrons and digital counts beside it.
#include <algorithm>
#include <array>
#include <cmath>

#include "sensor/kinds/platform.h"
#include "spectral/thermometer.h"

namespace suite {

namespace {

// Keeps the first `keep` bands of every [problem][...][band] array.
void keep_bands(CaptureResult& r, size_t keep) {
  auto cut = [&](std::vector<double>& v) {
    const size_t groups = v.size() / r.bands;
    for (size_t g = 0; g < groups; ++g)
      std::copy_n(v.begin() + static_cast<long>(g * r.bands), keep, v.begin() + static_cast<long>(g * keep));
    v.resize(groups * keep);
  };
  cut(r.radiance);
  cut(r.standard_error);
  for (size_t i = 0; i * r.bands * 6 < r.stokes_covariance.size(); ++i)
    std::copy_n(r.stokes_covariance.begin() + static_cast<long>(i * r.bands * 6), keep * 6,
                r.stokes_covariance.begin() + static_cast<long>(i * keep * 6));
  r.stokes_covariance.resize(r.stokes_covariance.size() / r.bands * keep);
  cut(r.error_correlation);  // its first rows are the ones to keep
  r.error_correlation.resize(keep * keep);
  r.bands = keep;
}

// Drops the truth of the photon bands, which are the computation's own affair.
void drop_truth_of(CaptureResult& r, const std::vector<Band>& bands, size_t keep) {
  std::vector<size_t> kept;
  for (size_t i = 0; i < r.truth_names.size(); ++i) {
    const bool theirs = std::any_of(bands.begin() + static_cast<long>(keep), bands.end(),
                                    [&](const Band& b) { return r.truth_names[i] == "reflectance " + b.name; });
    if (!theirs) kept.push_back(i);
  }
  if (kept.size() == r.truth_names.size()) return;
  std::vector<std::string> names;
  std::vector<double> values;
  for (const size_t i : kept) names.push_back(r.truth_names[i]);
  for (size_t p = 0; p < r.problems(); ++p)
    for (const size_t i : kept) values.push_back(r.truth[p * r.truth_names.size() + i]);
  r.truth_names = std::move(names);
  r.truth = std::move(values);
}

// Signal electrons on the axis for 1 W/(m2 sr um) in a photon band that counts one electron for each.
double electrons_per_radiance(const PlatformSpec& spec, const FocalArray& array) {
  const Lens& lens = spec.instruments[array.instrument].lens;
  return array.pitch.x * array.pitch.y * array.detector->fill_factor /
         g_number(lens.f_number(), lens.throughput, lens.obscuration) * array.readout.exposure();
}

}  // namespace

NoiseAtBackground noise_of(const PlatformSpec& spec, const Segment& segment, size_t band) {
  const FocalArray& array = spec.arrays[segment.array];
  const DetectorSpec& d = *array.detector;
  const BandThermometer thermometer(segment.bands[segment.radiance_bands + band]);
  const double L = thermometer.radiance(d.background),
               factor = electrons_per_radiance(spec, array) * segment.electrons[band];
  return noise_at_background(d, factor * L, factor / thermometer.read(L).slope, array.readout.exposure());
}

std::vector<BandNoise> detector_noise_of(const PlatformSpec& spec, const Segment& segment) {
  const FocalArray& array = spec.arrays[segment.array];
  const DetectorNoise noise =
      array.reader->noise(array.readout.exposure(), array.pitch.x * array.pitch.y * array.detector->fill_factor);
  double gain = 0;  // the more electrons, the smaller the noise is in radiance
  for (size_t i = 0; i < segment.chips; ++i) gain = std::max(gain, array.chips[segment.first_chip + i].gain);
  std::vector<BandNoise> of;
  for (const double electrons : segment.electrons) {
    const double k = electrons_per_radiance(spec, array) * gain * electrons;
    of.push_back(k > 0 ? BandNoise{noise.constant / (k * k), noise.linear / k} : BandNoise{});
  }
  return of;
}

std::string noise_text(const PlatformSpec& spec, const Segment& segment) {
  const auto& detector = spec.arrays[segment.array].detector;
  if (!detector || !(detector->background > 0)) return {};
  std::string out = strf("; NETD at %g K:", detector->background);
  for (size_t b = 0; b < segment.radiance_bands; ++b) {
    const NoiseAtBackground n = noise_of(spec, segment, b);
    out += strf(" %s %.4g K (%.4g K of it shot noise, read noise and quantisation)", segment.bands[b].name.c_str(),
                n.netd(), n.own / n.slope);
  }
  return out;
}

namespace {

// The same on a pixel, of `axis` on the axis: gain of its chip and fall-off.
double electrons_at(const PlatformSpec& spec, const FocalArray& array, const DetectorPlace& place, double axis) {
  const Lens& lens = spec.instruments[array.instrument].lens;
  const double cosine = lens.cos4 ? -lens.look(place.place).z : 1;
  return axis * place.chip->gain * cosine * cosine * cosine * cosine;
}

// Read-outs of the same task right before a capture, and the time from one to the next.
void set_before(const PlatformSpec& spec, const CaptureResult& result, ArrayLight& light) {
  const auto& captures = spec.tasks[result.task].captures;
  const auto& parts = spec.parts[result.task];
  const PlatformSpec::Part& own = parts[result.capture];
  const double begin = captures[result.capture].window.begin;
  for (size_t c = result.capture; c-- > 0;) {
    if (parts[c].array != own.array || parts[c].segment != own.segment) continue;
    if (light.before >= kMostBefore) break;
    if (light.before++ == 0) light.period = begin - captures[c].window.begin;
  }
}

// The light on an array but for its electrons.
ArrayLight light_of(const PlatformSpec& spec, const Segment& segment, const CaptureResult& result, uint64_t read_out) {
  const FocalArray& array = spec.arrays[segment.array];
  ArrayLight light;
  light.columns = result.columns, light.rows = result.rows;
  light.electrons.assign(result.problems(), 0);
  light.sites.resize(result.problems());
  light.exposure = array.readout.exposure();
  light.read_out = read_out;
  light.lines = array.readout.kind == Readout::Kind::line;
  light.pitch = array.pitch;
  if (array.reader->whole_frames()) set_before(spec, result, light);
  return light;
}

// Radiance behind the analysers of an array, in the bands that count photons; all of it where there are none.
class SeenRadiance {
 public:
  SeenRadiance(const PlatformSpec& spec, const Segment& segment, const CaptureResult& result)
      : result_(result), bands_(segment.radiance_bands) {
    const auto& analysers = spec.arrays[segment.array].analysers;
    if (!analysers) return;
    analysers_ = &*analysers;
    rows_ = analyser_rows(segment, *analysers);
    for (size_t c = 0; c < 3; ++c)
      channel_[c + 1] = channel_of(spec.channels, std::array{"stokes_q", "stokes_u", "stokes_v"}[c]);
  }
  double of(size_t problem, size_t band, const Exposed& from, uint64_t frame) const {
    if (!analysers_) return mean(problem, 0, band);
    const Stokes& row = rows_[band][analysers_->of(from.column, from.row, frame)];
    double sum = 0;
    for (size_t c = 0; c < 4; ++c)
      if (channel_[c] < result_.channels) sum += row[c] * mean(problem, channel_[c], band);
    return std::max(sum, 0.0);  // noise of paths, where next to nothing passes
  }

 private:
  // Over the parts of the exposure.
  double mean(size_t problem, size_t channel, size_t band) const {
    double sum = 0;
    for (size_t t = 0; t < result_.bins; ++t)
      sum +=
          result_
              .radiance[((problem * result_.channels + channel) * result_.bins + t) * result_.bands + bands_ + band] /
          static_cast<double>(result_.bins);
    return sum;
  }
  const CaptureResult& result_;
  size_t bands_;
  const Analysers* analysers_ = nullptr;
  std::vector<std::vector<Stokes>> rows_;
  std::array<size_t, 4> channel_{};
};

void add_kelvin(const std::vector<BandThermometer>& thermometers, const DetectorSpec& d, double exposure,
                std::span<const double> per_radiance, std::vector<Product>& products) {
  const std::vector<double>& dn = products.back().values;
  const size_t bands = thermometers.size();
  Product kelvin{"apparent_temperature", "K", false, products.back().bands, std::vector<double>(dn.size())};
  for (size_t k = 0; k < dn.size(); ++k)
    kelvin.values[k] = thermometers[k % bands].read(d.signal_of(dn[k], exposure) / per_radiance[k]).kelvin;
  products.push_back(std::move(kelvin));
}

}  // namespace

std::vector<Product> detect(const PlatformSpec& spec, const Segment& segment, CaptureResult& result,
                            uint64_t read_out) {
  const FocalArray& array = spec.arrays[segment.array];
  if (!array.detector) return {};
  const DetectorSpec& d = *array.detector;
  const size_t bands = segment.radiance_bands, n = result.problems();
  const double axis = electrons_per_radiance(spec, array), exposure = array.readout.exposure();
  std::vector<Product> out;
  out.push_back({"electrons", "electrons", false, {}, std::vector<double>(n * bands)});
  for (size_t b = 0; b < bands; ++b) out[0].bands.push_back(segment.bands[b].name);
  Product dn{"dn", "DN", true, out[0].bands, {}}, counts{"counts", "counts", true, out[0].bands, {}};
  std::vector<BandThermometer> thermometers;
  std::vector<double> per_radiance(n * bands);
  const Capture& capture = spec.tasks[result.task].captures[result.capture];
  const SeenRadiance seen(spec, segment, result);
  ArrayLight light;
  if (array.reader) light = light_of(spec, segment, result, read_out);
  for (size_t b = 0; b < bands; ++b) {
    for (size_t i = 0; i < n; ++i) {
      const Exposed from = exposed(spec, capture, i);
      const DetectorPlace place = place_of(array, from.column, from.row, 0.5, 0.5);
      // The photon bands follow the listed ones; every band has detectors of its own.
      const double radiance = seen.of(i, b, from, read_out);
      const double factor = electrons_at(spec, array, place, axis);
      per_radiance[i * bands + b] = factor * segment.electrons[b];
      const double signal = radiance * (factor * segment.electrons[b]);
      out[0].values[i * bands + b] = signal;
      if (!array.reader) continue;
      light.electrons[i] = signal;
      light.sites[i] = {
          hash_of(segment.array, b, uint64_t{from.row} * 0x100000000ull + from.column), from.column,
          static_cast<uint32_t>(place.chip - array.chips.data()),
          std::find(d.bad.begin(), d.bad.end(), std::array<uint32_t, 2>{from.column, from.row}) != d.bad.end()};
    }
    if (!array.reader) continue;
    light.array = hash_of(segment.array, b);
    light.more = d.background > 0 ? noise_of(spec, segment, b).more : 0;
    const ArrayReading reading = array.reader->read(light);
    const auto spread = [&](const std::vector<double>& of, std::vector<double>& into) {
      if (into.empty()) into.resize(of.empty() ? 0 : n * bands);
      for (size_t i = 0; i < of.size(); ++i) into[i * bands + b] = of[i];
    };
    spread(reading.dn, dn.values), spread(reading.counts, counts.values);
    for (size_t i = 0; i < n; ++i)
      if (reading.clipped[i]) result.quality[i] |= quality_clipped;
    if (d.background > 0) thermometers.emplace_back(segment.bands[bands + b]);
  }
  if (!array.mosaic.empty() && !dn.values.empty()) out.push_back(mosaic_of(spec, segment, result, dn));
  drop_truth_of(result, segment.bands, bands);
  keep_bands(result, bands);
  if (!dn.values.empty()) out.push_back(std::move(dn));
  if (!thermometers.empty()) add_kelvin(thermometers, d, exposure, per_radiance, out);
  if (!counts.values.empty()) out.push_back(std::move(counts));
  return out;
}

}  // namespace suite
