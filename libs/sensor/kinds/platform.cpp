// The default sensor: a vehicle with instruments, each a lens over arrays of detectors with their timing.
//
// Rays are drawn over the detector's area, moved by the point-spread function, spread over the integration time, and
// sent from where the instrument is at that time, so that blur, rolling-shutter skew and TDI come out by themselves.
// Based on: Goodenough & Brown, section III-B.
#include "sensor/kinds/platform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "sensor/kinds/rows.h"
#include "sensor/point_images.h"

namespace suite {

namespace {

class Platform final : public Sensor, public SeesPoints, public HasDegreeTarget {
 public:
  Platform(const Params& p, const SensorContext& context) : context_(context), spec_(read_platform(p, context)) {
    std::vector<std::vector<ImageKey>> keys;
    for (const auto& parts : spec_.parts) {
      keys.emplace_back();
      for (const PlatformSpec::Part& part : parts) {
        const FocalArray& a = spec_.arrays[part.array];
        // Only the first segment counts rows; the others stand beside it.
        const bool first = part.segment == a.segments[0];
        keys.back().push_back({first ? a.image : a.image + strf("/%zu", part.segment), a.scans()});
      }
    }
    rows_ = lay_out(spec_.tasks, keys);
    for (const Segment& s : spec_.segments)
      wide_ = wide_ || s.psf || spec_.instruments[spec_.arrays[s.array].instrument].lens.thin();
  }

  std::string name() const override { return spec_.name; }
  std::span<const SpectralState> states() const override { return spec_.states; }
  std::span<const Band> bands(size_t state) const override { return spec_.segments[state].bands; }
  void take_state(size_t state, SpectralState with_bins) override {
    Segment& s = spec_.segments[state];
    if (std::unique_ptr<PointSpread> psf = s.psf ? s.psf->with_bins(with_bins) : nullptr) s.psf = std::move(psf);
    spec_.states[state] = std::move(with_bins);
  }
  std::span<const Task> tasks() const override { return spec_.tasks; }
  std::span<const std::string> truth() const override { return spec_.truth; }
  std::span<const std::string> channels() const override { return spec_.channels; }
  const Polarimetry* polarimetry() const override { return spec_.polarimetry ? &*spec_.polarimetry : nullptr; }
  ImageWishes wishes(const Capture& capture) const override {
    return spec_.arrays[spec_.segments[capture.state].array].wishes;
  }
  double degree_target(const Capture& capture) const override {
    return spec_.segments[capture.state].degree_target.error;
  }
  int numbers() const override { return wide_ ? 8 : 4; }

  Convergence convergence(const Capture& capture, size_t problem) const override {
    const Segment& s = spec_.segments[capture.state];
    const FocalArray& array = spec_.arrays[s.array];
    return place_of(array, exposed(spec_, capture, problem).column, 0, 0.5, 0.5)
        .chip->convergence.value_or(capture.convergence);
  }

  void begin(const Capture& capture) override {
    const Segment& s = spec_.segments[capture.state];
    const Instrument& instrument = spec_.instruments[spec_.arrays[s.array].instrument];
    Prepared prepared;
    const TimeSpan span{capture.window.begin, capture.window.end};
    if (spec_.jitter) prepared.vehicle = std::make_unique<JitterWindow>(*spec_.jitter, span);
    for (const Attachment& a : instrument.chain)
      prepared.chain.push_back(a.jitter ? std::make_unique<JitterWindow>(*a.jitter, span) : nullptr);
    if (capture.window.begin == capture.window.end) prepared.still = pose(instrument, &prepared, capture.window.begin);
    prepared_[key_of(capture)] = std::move(prepared);
  }

  SensorRay ray(const RayRequest& request) const override {
    const Capture& capture = request.capture;
    const Segment& s = spec_.segments[capture.state];
    const FocalArray& array = spec_.arrays[s.array];
    const Instrument& instrument = spec_.instruments[array.instrument];
    const Readout& r = array.readout;
    const std::span<const double> u = request.u;

    // Find the detector and the moment.
    const Exposed from = exposed(spec_, capture, request.problem);
    double t = capture.window.begin + from.delay;
    const double stage = std::min(std::floor(u[2] * r.stages), r.stages - 1.0);
    if (r.stages > 1) t += stage * r.line_period;
    t += (u[2] * r.stages - stage) * r.integration;

    // Find the place in the focal plane whose light it collects.
    Vec2 place = place_of(array, from.column, from.row, u[0], u[1]).place;
    if (r.stages > 1) place.y += r.direction * (stage - 0.5 * (r.stages - 1)) * array.pitch.y;
    // (Radius and wavelength come from one block, so that weights are stratified together.)
    SensorRay out;
    if (s.psf) {
      const Vec2 offset = s.psf->sample(u[4], u[5], u[6]);
      place = {place.x - offset.x, place.y - offset.y};
      if (s.psf->spectral()) {
        s.psf->weights(offset, request.spectral);
        out.spectral = true;
      }
    }

    // Send the ray from the instrument's pose at that time.
    const Prepared* prepared = prepared_for(capture);
    const Pose at = prepared && prepared->still ? *prepared->still : pose(instrument, prepared, t);
    Dir direction = instrument.lens.look(place);
    Vec3 origin;
    if (instrument.lens.thin()) {
      const Vec2 pupil = instrument.lens.pupil(u[3], u[7]);
      origin = {pupil.x, pupil.y, 0};
      direction = direction * (instrument.lens.focus_distance / -direction.z) - origin;
    }
    out.ray = {at.point(origin), normalized(at.vector(direction)), t};
    out.points_apart = suite::sees_points(spec_, capture);
    return out;
  }

  bool sees_points(const Capture& capture) const override { return suite::sees_points(spec_, capture); }
  void image_point(const Capture& capture, const std::function<Dir(double, Vec3)>& direction_at, double brightness,
                   const std::function<void(const PointShare&)>& share) const override {
    const Instrument& instrument = spec_.instruments[spec_.arrays[spec_.segments[capture.state].array].instrument];
    const Prepared* prepared = prepared_for(capture);
    suite::image_point(
        spec_, capture,
        [&](double t) { return prepared && prepared->still ? *prepared->still : pose(instrument, prepared, t); },
        direction_at, brightness, share);
  }
  double aperture(const Capture& capture) const override {
    return spec_.instruments[spec_.arrays[spec_.segments[capture.state].array].instrument].lens.aperture;
  }
  void take_points(const Capture& capture, std::vector<SeenPoint> points) override {
    prepared_[key_of(capture)].points = std::move(points);
  }

  void accept(CaptureResult&& result) override {
    const PlatformSpec::Part part = spec_.parts[result.task][result.capture];
    const FocalArray& array = spec_.arrays[part.array];
    const Segment& segment = spec_.segments[part.segment];
    Piece piece;
    const Capture& capture = spec_.tasks[result.task].captures[result.capture];
    const Instrument& instrument = spec_.instruments[array.instrument];
    turn_upright(
        spec_, [&](double t) { return pose(instrument, prepared_for(capture), t); }, result);
    if (const auto prepared = prepared_.extract(key_of(capture))) piece.points = std::move(prepared.mapped().points);
    piece.products = detect(spec_, segment, result, part.event);
    piece.capture = result.capture;
    piece.result = std::move(result);
    auto& waiting = waiting_[{part.array, part.event}];
    waiting[part.segment] = std::move(piece);
    if (waiting.size() < array.segments.size()) return;
    deliver(part, waiting);
    waiting_.erase({part.array, part.event});
  }

  std::vector<TextFile> logs() const override {
    std::vector<TextFile> out;
    for (const Instrument& i : spec_.instruments)
      if (i.log_rate > 0) out.push_back({spec_.name + "_" + i.name + ".csv", pose_log(spec_, i, context_)});
    return out;
  }

 private:
  struct Piece {
    CaptureResult result;
    std::vector<Product> products;
    std::optional<std::vector<SeenPoint>> points;  // stars
    size_t capture = 0;                            // number in its task
  };
  // What belongs to a capture that is being rendered, by its state and window.
  struct Prepared {
    std::unique_ptr<JitterWindow> vehicle;
    std::vector<std::unique_ptr<JitterWindow>> chain;
    std::optional<Pose> still;
    std::optional<std::vector<SeenPoint>> points;  // where something that has some shines
  };
  using Key = std::array<double, 3>;
  static Key key_of(const Capture& c) { return {static_cast<double>(c.state), c.window.begin, c.window.end}; }
  const Prepared* prepared_for(const Capture& c) const {
    const auto found = prepared_.find(key_of(c));
    return found == prepared_.end() ? nullptr : &found->second;
  }

  Pose pose(const Instrument& instrument, const Prepared* prepared, double t) const {
    if (!prepared) return pose_at(spec_, instrument, t);
    Pose p = spec_.track->at(t);
    if (prepared->vehicle) p = p * prepared->vehicle->pose(t);
    for (size_t i = 0; i < instrument.chain.size(); ++i) p = instrument.chain[i].at(t, p, prepared->chain[i].get());
    return p;
  }

  // The bands of a segment without those that count photons.
  std::vector<Band> radiance_bands(size_t segment) const {
    const Segment& s = spec_.segments[segment];
    return {s.bands.begin(), s.bands.begin() + static_cast<long>(s.radiance_bands)};
  }

  // Puts the columns of an array's segments side by side.
  void deliver(const PlatformSpec::Part& part, std::map<size_t, Piece>& pieces) {
    const FocalArray& array = spec_.arrays[part.array];
    Piece& first = pieces.at(array.segments[0]);
    const size_t task = first.result.task, capture = first.result.capture;
    const bool backwards = spec_.tasks[task].captures[capture].reversed & kColumnsReversed;
    std::vector<Band> bands = radiance_bands(array.segments[0]);
    std::vector<ColumnBands> columns;
    if (pieces.size() > 1) {
      for (const auto& [segment, piece] : pieces) columns.push_back({piece.result.columns, radiance_bands(segment)});
      if (backwards) std::reverse(columns.begin(), columns.end());
      std::vector<CaptureResult*> results;
      std::vector<std::vector<Product>*> products;
      for (auto& [segment, piece] : pieces) results.push_back(&piece.result), products.push_back(&piece.products);
      if (backwards) std::reverse(results.begin(), results.end()), std::reverse(products.begin(), products.end());
      join(results, products, first);
    }
    const Instrument& instrument = spec_.instruments[array.instrument];
    const Capture& c = spec_.tasks[task].captures[capture];
    Delivery d{
        *this, rows_[task][capture], std::move(first.result), std::move(bands), std::move(first.products), {}, {}, {}};
    d.columns = std::move(columns);
    if (spec_.polarimetry) add_polarisation(d);
    for (const auto& [segment, piece] : pieces)
      if (piece.points)
        d.texts.push_back({spec_.tasks[task].captures[piece.capture].name + "_stars.csv",
                           points_table(*piece.points, radiance_bands(segment))});
    const std::string who = strf("instrument '%s'", instrument.name.c_str());
    std::string spread;
    if (const auto& psf = spec_.segments[array.segments[0]].psf; psf && psf->cut() > 0)
      spread = strf("; point spread cut where %.2f %% of the light remain", 100 * psf->cut());
    spread += noise_text(spec_, spec_.segments[array.segments[0]]);
    if (spec_.polarimetry) spread += "; " + text_of(*spec_.polarimetry);
    d.description = who + strf(", %.9g to %.9g s", c.window.begin, c.window.end) + spread;
    if (array.scans()) {
      const std::vector<std::string>& lines = lines_of(part.array);
      d.lines_of_task = who + ", " + lines[task] + spread;
      for (const std::string& text : lines)
        d.lines_of_all += text.empty() ? "" : (d.lines_of_all.empty() ? who + ", " : "; ") + text;
      d.lines_of_all += spread;
    }
    context_.deliver(d);
  }

  // The times of all lines of an array, task by task, for the header of the file that holds them.
  const std::vector<std::string>& lines_of(size_t array) {
    std::vector<std::string>& texts = lines_[array];
    for (size_t t = texts.size(); t < spec_.tasks.size(); ++t) texts.push_back(lines_text(spec_, t, array, context_));
    return texts;
  }

  template <class T>
  static std::vector<T> beside(const std::vector<const std::vector<T>*>& parts, const std::vector<uint32_t>& columns,
                               uint32_t rows) {
    std::vector<T> all;
    for (uint32_t r = 0; r < rows; ++r)
      for (size_t i = 0; i < parts.size(); ++i) {
        const size_t width = parts[i]->size() / rows / columns[i] * columns[i];
        all.insert(all.end(), parts[i]->begin() + static_cast<long>(r * width),
                   parts[i]->begin() + static_cast<long>((r + 1) * width));
      }
    return all;
  }

  static void join(const std::vector<CaptureResult*>& results, const std::vector<std::vector<Product>*>& products,
                   Piece& into) {
    std::vector<uint32_t> columns;
    uint32_t all = 0;
    for (const CaptureResult* r : results) columns.push_back(r->columns), all += r->columns;
    const uint32_t rows = results[0]->rows;
    auto of = [&](auto member) {
      std::vector<const std::remove_reference_t<decltype(results[0]->*member)>*> parts;
      for (const CaptureResult* r : results) parts.push_back(&(r->*member));
      return beside(parts, columns, rows);
    };
    CaptureResult joined = into.result;
    joined.radiance = of(&CaptureResult::radiance);
    joined.standard_error = of(&CaptureResult::standard_error);
    joined.paths = of(&CaptureResult::paths);
    joined.quality = of(&CaptureResult::quality);
    joined.truth = of(&CaptureResult::truth);
    if (!joined.stokes_covariance.empty()) joined.stokes_covariance = of(&CaptureResult::stokes_covariance);
    joined.columns = all;
    for (size_t p = 0; p < into.products.size(); ++p) {
      std::vector<const std::vector<double>*> parts;
      for (const auto* list : products) parts.push_back(&(*list)[p].values);
      into.products[p].values = beside(parts, columns, rows);
    }
    into.result = std::move(joined);
  }

  SensorContext context_;
  PlatformSpec spec_;
  std::vector<std::vector<ImageRows>> rows_;
  std::map<size_t, std::vector<std::string>> lines_;  // by array: texts of the tasks
  bool wide_ = false;
  std::map<Key, Prepared> prepared_;
  std::map<std::pair<size_t, uint64_t>, std::map<size_t, Piece>>
      waiting_;  // events of which not all segments are there
};

}  // namespace

SensorRow platform_row() {
  return {"platform", "a vehicle with instruments: cameras, push-brooms, whiskbrooms, logs; motion, jitter, detectors",
          "", make_kind<Platform>};
}

}  // namespace suite
