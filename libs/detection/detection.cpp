#include "detection/detection.h"

#include <cmath>

#include "base/required.h"

namespace suite {

namespace {

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

// Whether most of the laser's light that comes back where a following gate searches is beside its window.
bool misses(const GateSpec& gate, const PulseLight& light) {
  if (gate.kind != GateSpec::Kind::follow) return false;
  double all = 0, heard = 0;
  for (const PixelLight& pixel : light.pixels)
    for (const PhotonArrival& a : pixel.arrivals) {
      if (a.time >= gate.start && a.time < gate.stop) all += a.photons;
      if (a.time >= light.window.start && a.time < light.window.stop) heard += a.photons;
    }
  return heard < 0.5 * all;
}

}  // namespace

PulseShape read_pulse(const Params& params, const PulseFile& file) {
  const std::vector<std::string> kinds{"impulse", "gaussian", "rectangular", "table", "file"};
  const Params p = params.at("pulse");
  switch (required(p, "kind", kinds).as_choice(kinds)) {
    case 0:
      return PulseShape::impulse();
    case 1:
      return PulseShape::gaussian(p.number_in("fwhm_ns", 1e-4, 1e6, "ns") * 1e-9);
    case 2:
      return PulseShape::rectangular(p.number_in("length_ns", 1e-4, 1e6, "ns") * 1e-9);
    case 3:
      return PulseShape::table(scaled(p.at("time_ns").as_numbers(), 1e-9), p.at("power").as_numbers(), p.where());
    default:
      break;
  }
  PulseTable t = file(p);
  return PulseShape::table(std::move(t.time), std::move(t.power), p.where());
}

DetectionSpec read_detection(const Params& params, const Params& laser, const PulseFile& file) {
  DetectionSpec s;
  s.seed = static_cast<uint64_t>(params.integer("seed", 0, 1LL << 53, 1));
  s.pulse = read_pulse(laser, file);
  s.gate = read_gate(params);
  if (const auto how = params.find("pulses_in_air"))
    s.in_air = std::array{PulsesInAir::refuse, PulsesInAir::fold,
                          PulsesInAir::unfold}[how->as_choice({"refuse", "fold", "unfold"})];
  for (const Params& d : params.at("detectors").items()) {
    s.detectors.push_back(make_lidar_detector(d, s.pulse));
    for (size_t k = 0; k + 1 < s.detectors.size(); ++k)
      if (s.detectors[k]->name() == s.detectors.back()->name())
        throw d.error("two detectors are called '" + s.detectors.back()->name() + "'", "a `name` of its own for each");
  }
  if (s.detectors.empty()) throw params.at("detectors").error("no detector", "detectors: [{kind: waveform, ...}]");
  return s;
}

DetectionRun::DetectionRun(const ResponseHead& head, const DetectionSpec& spec,
                           std::function<void(DetectedPulse&&)> deliver)
    : head_(head),
      spec_(spec),
      deliver_(std::move(deliver)),
      folded_(head, spec.in_air),
      gates_(spec.detectors.size(), Gate(spec.gate)),
      beside_(spec.detectors.size(), 0) {}

void DetectionRun::take(ResponseBlock&& block) {
  if (block.pulses.empty()) return;
  if (waiting_) detect(*waiting_, block.pulses.front().time);
  waiting_ = std::move(block);
}

void DetectionRun::finish() {
  if (waiting_) detect(*waiting_, std::numeric_limits<double>::infinity());
  waiting_.reset();
}

void DetectionRun::detect(const ResponseBlock& block, double next_emission) {
  for (size_t p = 0; p < block.pulses.size(); ++p)
    detect_pulse(block, p, p + 1 < block.pulses.size() ? block.pulses[p + 1].time : next_emission);
}

void DetectionRun::detect_pulse(const ResponseBlock& block, size_t pulse, double next) {
  PulseLight light;
  light.pulse = block.first_pulse + pulse, light.columns = head_.columns;
  const ResponsePulse& emitted = block.pulses[pulse];
  for (size_t x = 0; x < head_.pixel_count(); ++x) {
    const ResponseRow row(head_, block, pulse * head_.pixel_count() + x);
    light.pixels.push_back({folded_.arrivals(row, next), row.passive() / head_.bin});
  }
  const double listening = folded_.listening(emitted, next);
  Gate::Window whole{emitted.start, emitted.start + head_.bins * head_.bin};
  // Folded light arrives from the emission on.
  if (std::isfinite(listening)) whole = {0, listening};
  for (size_t d = 0; d < spec_.detectors.size(); ++d) {
    light.window = gates_[d].window(whole);
    light.window.stop = std::min(light.window.stop, listening);
    DetectedPulse detected{head_, block, pulse, d, std::vector<PixelRecord>(head_.pixel_count())};
    // A gate that opens behind the next emission hears nothing.
    if (light.window.stop > light.window.start) try {
        detected.records = spec_.detectors[d]->detect(light, hash_of(spec_.seed, d));
      } catch (const Error& e) {
        throw Error(e.where(),
                    strf("pulse %llu, detector '%s': ", static_cast<unsigned long long>(light.pulse),
                         spec_.detectors[d]->name().c_str()) +
                        e.message(),
                    e.hint());
      }
    std::vector<double> firsts;
    for (const PixelRecord& r : detected.records)
      if (!r.returns.empty()) firsts.push_back(r.returns.front().time);
    beside_[d] += misses(spec_.gate, light);
    gates_[d].learn(firsts);
    deliver_(std::move(detected));
  }
}

ReturnTruth truth_of(const ResponseHead& head, const ResponseRow& row, double time, double reach) {
  std::vector<double> sums(head.channels.size(), 0);
  for (size_t k = 0; k < row.size(); ++k) {
    if (row.bin(k) == 0 || std::fabs(arrival_of_bin(head, row.pulse(), row.bin(k)) - time) > reach) continue;
    for (size_t c = 0; c < sums.size(); ++c) sums[c] += row.value(k, c);
  }
  ReturnTruth t;
  t.photons = sums[kSingle] + sums[kMultiple];
  if (t.photons > 0) t.multiple = sums[kMultiple] / t.photons;
  for (size_t c = kMultiple + 1; c < sums.size(); ++c)
    if (head.channels[c].starts_with("tag:") && sums[c] > 0 &&
        (t.tag < 0 || sums[c] > sums[static_cast<size_t>(t.tag)]))
      t.tag = static_cast<int>(c);
  return t;
}

double adjusted_gps_time(const Instant& instant) {
  static const Instant begin = instant_from_utc({1980, 1, 6, 0, 0, 0});
  // Days and the billion are whole numbers: exact in a double.
  return (static_cast<double>(instant.day - begin.day) * 86400 - 1e9) + (instant.seconds - begin.seconds);
}

}  // namespace suite
