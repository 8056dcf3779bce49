#include "detection/gate.h"

#include <algorithm>

#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kMetre = 2 / kSpeedOfLight;  // s of arrival a metre of range
constexpr double kFarthest = 1e11;            // m

// NAME_m as a range or NAME_ns as an arrival, s.
double read_moment(const Params& p, const std::string& name) {
  const bool metres = p.has(name + "_m"), nanoseconds = p.has(name + "_ns");
  if (metres == nanoseconds)
    throw p.error("gate: one of " + name + "_m and " + name + "_ns is needed", name + "_m: 900");
  return metres ? p.number_in(name + "_m", 0, kFarthest, "m") * kMetre
                : p.number_in(name + "_ns", 0, 1e12, "ns") * 1e-9;
}

}  // namespace

GateSpec read_gate(const Params& params) {
  const auto p = params.find("gate");
  if (!p) return {};
  if (p->kind() == Params::Kind::scalar) {
    p->as_choice({"all"});
    return {};
  }
  GateSpec g;
  g.kind = GateSpec::Kind::fixed;
  g.start = read_moment(*p, "start"), g.stop = read_moment(*p, "stop");
  if (!(g.stop > g.start)) throw p->error("the gate ends before it begins", "stop after start");
  const auto follow = p->find("follow");
  if (!follow) return g;
  g.kind = GateSpec::Kind::follow;
  g.ahead = follow->number_in("ahead_m", 0, kFarthest, "m") * kMetre;
  g.behind = follow->number_in("behind_m", 0, kFarthest, "m") * kMetre;
  if (!(g.ahead + g.behind > 0)) throw follow->error("a gate of no length", "ahead_m: 50, behind_m: 20");
  g.memory = static_cast<size_t>(follow->integer("pulses", 1, 10000, 1));
  return g;
}

Gate::Window Gate::window(Window whole) const {
  if (spec_.kind == GateSpec::Kind::all) return whole;
  if (spec_.kind == GateSpec::Kind::fixed || seen_.empty()) return {spec_.start, spec_.stop};
  std::vector<double> all(seen_.begin(), seen_.end());
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  const double middle = all[all.size() / 2];
  return {std::max(0.0, middle - spec_.ahead), middle + spec_.behind};
}

void Gate::learn(std::span<const double> first_returns) {
  if (spec_.kind != GateSpec::Kind::follow) return;
  // The ground has left the window, as at the end of a line that is scanned one way: search again.
  if (first_returns.empty()) return seen_.clear();
  std::vector<double> all(first_returns.begin(), first_returns.end());
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  seen_.push_back(all[all.size() / 2]);
  if (seen_.size() > spec_.memory) seen_.pop_front();
}

}  // namespace suite
