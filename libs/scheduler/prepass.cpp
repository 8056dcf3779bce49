#include "scheduler/prepass.h"

#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

void check_elements(const std::string& name, std::span<const Prepass::Element> elements) {
  for (size_t i = 0; i < elements.size(); ++i) {
    const auto& [p, n] = elements[i];
    if (!std::isfinite(p.x + p.y + p.z) || !(std::fabs(length(n) - 1) < 1e-6))
      throw Error(strf("pre-pass '%s': element %zu stands at (%g, %g, %g) m with a normal of length %g", name.c_str(),
                       i, p.x, p.y, p.z, length(n)),
                  "a finite place and a unit normal");
  }
}

}  // namespace

Prepass::Prepass(std::string name, std::vector<Element> elements, std::vector<Spectrum> spectra,
                 std::span<const TimeWindow> windows, const Convergence& goal)
    : name_(std::move(name)), elements_(std::move(elements)) {
  if (elements_.empty() || elements_.size() > UINT32_MAX || spectra.empty() || windows.empty())
    throw Error(strf("pre-pass '%s' has %zu elements, %zu spectra and %zu windows", name_.c_str(), elements_.size(),
                     spectra.size(), windows.size()),
                "at least one of each, and at most 2^32 - 1 elements");
  check_elements(name_, elements_);
  for (Spectrum& s : spectra) {
    if (s.state.choice.error > 0)
      throw Error("pre-pass '" + name_ + "': the bins of a state are still to be chosen", "give them");
    states_.push_back(std::move(s.state)), bands_.push_back(std::move(s.bands));
  }
  for (const TimeWindow& w : windows) {
    if (!(w.begin <= w.end))
      throw Error(strf("pre-pass '%s': a window from %g to %g s", name_.c_str(), w.begin, w.end));
    Task task{strf("%g to %g s", w.begin, w.end), w, {}};
    for (size_t s = 0; s < states_.size(); ++s) {
      Capture c;
      c.name = strf("window %zu, spectrum %zu", tasks_.size(), s);
      c.window = w;
      // One column: a store keeps rows of blocks, so that little is lost when a run breaks off.
      c.columns = 1, c.rows = static_cast<uint32_t>(elements_.size());
      c.state = s;
      c.convergence = goal;
      c.neighbours = false;
      task.captures.push_back(std::move(c));
    }
    tasks_.push_back(std::move(task));
  }
  results_.resize(tasks_.size() * states_.size());
}

SensorRay Prepass::ray(const RayRequest& r) const {
  const auto& [position, normal] = elements_[r.problem];
  const TimeWindow& w = r.capture.window;
  SensorRay out{{position, normal, w.begin + r.u[0] * (w.end - w.begin)}, kPi};
  out.receiver = SensorRay::Receiver::plane;
  return out;
}

void Prepass::accept(CaptureResult&& result) {
  const size_t at = result.task * states_.size() + result.capture;
  results_[at] = std::move(result);
}

const CaptureResult& Prepass::result(size_t window, size_t spectrum) const {
  SUITE_CHECK(window < tasks_.size() && spectrum < states_.size());
  return results_[window * states_.size() + spectrum];
}

std::span<const double> Prepass::irradiance(size_t window, size_t spectrum) const {
  return result(window, spectrum).radiance;
}

std::span<const double> Prepass::standard_error(size_t window, size_t spectrum) const {
  return result(window, spectrum).standard_error;
}

std::vector<std::array<double, 2>> windows_um(std::span<const std::unique_ptr<Sensor>> sensors,
                                              std::span<const std::unique_ptr<Sensor>> prepasses) {
  std::vector<std::array<double, 2>> windows;
  for (const auto& all : {sensors, prepasses})
    for (const auto& sensor : all)
      for (const SpectralState& s : sensor->states()) windows.push_back({s.low_um, s.high_um});
  return windows;
}

}  // namespace suite
