#include "detect_job.h"

#include <limits>

#include "base/files.h"
#include "base/run_app.h"
#include "formats/pulse/pulse.h"

namespace suite {

PulseTable pulse_of_file(const Params& p) { return read_pulse_file(p.at("file").as_path(), p.text("column", "")); }

DetectJob::DetectJob(const Params& text, DetectionSpec spec, const ResponseHead& head, Place place)
    : spec_(std::move(spec)), head_(head), place_(std::move(place)), counts_(spec_.detectors.size()) {
  outputs_ = read_outputs(text, {place_.folder, head_, spec_, place_.pulses});
  run_ = std::make_unique<DetectionRun>(head_, spec_, [this](DetectedPulse&& p) {
    count(p);
    for (const auto& output : outputs_) output->take(p);
  });
}

void DetectJob::rehearse(double start) const {
  const size_t pixels = head_.pixel_count();
  ResponseBlock dark;
  dark.pulses.resize(1);
  dark.pulses[0].start = start;
  dark.begin.assign(pixels + 1, 0);
  dark.bound.assign(pixels, std::numeric_limits<double>::quiet_NaN());
  dark.paths.assign(pixels, 0);
  DetectionRun run(head_, spec_, [](DetectedPulse&&) {});
  run.take(std::move(dark));
  run.finish();
}

void DetectJob::take(ResponseBlock&& block) { run_->take(std::move(block)); }

void DetectJob::end_pulses() { run_->finish(); }

void DetectJob::count(const DetectedPulse& p) {
  Counts& to = counts_[p.detector];
  bool any = false;
  for (const PixelRecord& r : p.records) {
    to.returns += r.returns.size(), to.ideal += r.ideal_returns.size();
    for (const LidarReturn& one : r.returns) to.signal += one.signal;
    any = any || !r.returns.empty();
  }
  to.silent += !any;
}

Json DetectJob::log() const {
  Json log = Json::object();
  log.set("arguments", command_line());
  log.set("response", place_.response);
  log.set("pulses", place_.pulses), log.set("pixels", head_.pixel_count()), log.set("seed", spec_.seed);
  Json detectors = Json::array();
  for (size_t d = 0; d < counts_.size(); ++d) {
    Json one = Json::object();
    one.set("name", spec_.detectors[d]->name());
    one.set("returns", counts_[d].returns), one.set("signal_returns", counts_[d].signal);
    one.set("ideal_returns", counts_[d].ideal), one.set("pulses_without_return", counts_[d].silent);
    one.set("pulses_beside_the_gate", run_->beside_gate(d));
    detectors.push(std::move(one));
  }
  log.set("detectors", std::move(detectors));
  return log;
}

void DetectJob::finish() {
  Json all = log();
  for (const auto& output : outputs_) output->finish(all);
  write_file(place_.folder + "/detect.json", all.text());
  for (size_t d = 0; d < counts_.size(); ++d) {
    note(strf("detector '%s': %llu returns of %llu pulses, %llu without any; %llu returns are not of the laser's light",
              spec_.detectors[d]->name().c_str(), static_cast<unsigned long long>(counts_[d].returns),
              static_cast<unsigned long long>(place_.pulses), static_cast<unsigned long long>(counts_[d].silent),
              static_cast<unsigned long long>(counts_[d].returns - counts_[d].signal)));
    if (const uint64_t beside = run_->beside_gate(d))
      note(strf(
          "detector '%s': of %llu pulses most light came back beside the window of `gate.follow` and is lost; after a "
          "pulse without a return the next one was searched for from start to stop",
          spec_.detectors[d]->name().c_str(), static_cast<unsigned long long>(beside)));
  }
}

}  // namespace suite
