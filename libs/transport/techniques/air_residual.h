// Residual estimator over the one-dimensional air field: paths that have ended go back to a
// place in the air that they have passed.
// Every flight of a path is remembered by chance, in proportion to what is scattered on it, times the throughput; one
// of them in the end (reservoir sampling: M. Chao, "A general purpose unequal probability sampling plan", 1982). When
// the path has ended it goes on from a place on that one, with what it had there, as if it had been scattered; its
// light is added to what it has. Where the weights sum to less than 1 it does so with that probability.
#pragma once
#include <algorithm>
#include <utility>

#include "transport/wave.h"

namespace suite {

template <class Wave>
class AirResidual {
 public:
  using Path = typename Wave::Path;
  void prepare(const Wave& wave) { passed_.resize(wave.paths.size()); }
  void start(uint32_t p) { passed_[p].sum = 0, passed_[p].again = false, passed_[p].times = 0; }
  void begin_flight(uint32_t p, const Path& path) { passed_[p].before = path; }
  // The flight of a path, of `length` m, before it has weakened it.
  void pass(Wave& wave, uint32_t p, double length);
  // Sends back those paths of the stage that do not go on: are not active.
  void go_back(Wave& wave, std::span<const uint32_t> stage, std::span<const uint32_t> active);
  bool any_returned() const { return !returned_.empty(); }
  std::span<const uint32_t> returned() const { return returned_; }
  void clear_returned() { returned_.clear(); }
  bool has_been_back(uint32_t p) const { return passed_[p].again; }
  // The record of a path; of one that has been back as it was when it first ended, with what was truncated since.
  PathRecord& record(uint32_t p, PathRecord& last) {
    if (!passed_[p].again) return last;
    passed_[p].record.truncated += std::exchange(last.truncated, 0);
    passed_[p].record.leaked += std::exchange(last.leaked, 0);
    return passed_[p].record;
  }

 private:
  struct Passed {
    Path before;                             // as it began the flight under way
    Path path;                               // and the one that is remembered,
    typename Wave::Throughputs::Kept there;  // with its throughput
    double sum = 0, weight = 0, length = 0;  // of all flights; of this one; m
    bool goes_on = false, again = false;     // scratch; it has been back
    uint32_t times = 0;                      // so often
    PathRecord record;                       // of the time before
  };
  bool go_back(Wave& wave, uint32_t p);
  std::vector<Passed> passed_;
  std::vector<uint32_t> returned_;  // to such places
};

// Where paths meet all light of the air by flying through it.
template <class Wave>
class NoAirResidual {
 public:
  void prepare(const Wave&) {}
  void start(uint32_t) {}
  void begin_flight(uint32_t, const typename Wave::Path&) {}
  void pass(const Wave&, uint32_t, double) {}
  void go_back(const Wave&, std::span<const uint32_t>, std::span<const uint32_t>) {}
  bool any_returned() const { return false; }
  std::span<const uint32_t> returned() const { return {}; }
  void clear_returned() {}
  bool has_been_back(uint32_t) const { return false; }
  PathRecord& record(uint32_t, PathRecord& last) { return last; }
};

template <class Wave>
void AirResidual<Wave>::pass(Wave& wave, uint32_t p, double length) {
  constexpr double kNothing = 1e-5;
  Passed& at = passed_[p];
  const Path& path = at.before;
  const auto chances = wave.space.chances(path, length);
  double weight = 0;  // whatever knot draws the path: it is no part of the densities that knots share
  for (size_t k = 0; k < wave.knots(); ++k) weight = std::max(weight, path.throughput[k] * chances[k]);
  if constexpr (Wave::Space::kMedia) weight *= path.share;
  if (!(weight > kNothing)) return;
  std::array<double, 4> u = dimensions::of_place(path.stream, path.sample, path.flights);
  if constexpr (Wave::Space::kMedia)
    if (!wave.space.reaches(p, path, length, u[1])) return;
  // What has chosen among these flights before does not choose again.
  if (at.times > 0) u[0] = dimensions::of_place_again(path.stream, path.sample, path.flights, at.times);
  at.sum += weight;
  if (u[0] * at.sum >= weight) return;
  at.path = path;
  at.weight = weight;
  at.length = length;
  wave.space.remember(p);
  wave.throughputs.keep(p, 1, at.there);
}

template <class Wave>
void AirResidual<Wave>::go_back(Wave& wave, std::span<const uint32_t> stage, std::span<const uint32_t> active) {
  for (const uint32_t p : active) passed_[p].goes_on = true;
  for (const uint32_t p : stage)
    if (!std::exchange(passed_[p].goes_on, false) && go_back(wave, p)) returned_.push_back(p);
  for (const uint32_t p : active) passed_[p].goes_on = false;
}

template <class Wave>
bool AirResidual<Wave>::go_back(Wave& wave, uint32_t p) {
  Passed& at = passed_[p];
  const double sum = std::exchange(at.sum, 0), chance = std::min(1.0, sum);
  if (!(sum > 0)) return false;
  const std::array<double, 4> u = dimensions::of_place(at.path.stream, at.path.sample, at.path.flights);
  if (u[2] >= chance) return false;
  if (!at.again) {
    at.record = wave.records[p];
    at.record.size = wave.paths[p].surfaces;
    at.record.scattered_first = at.record.scattered_first && at.path.scatterings > 0;  // not after that flight
    at.again = true;
    wave.records[p].truncated = wave.records[p].leaked = 0;
  }
  ++at.times;
  Path& path = wave.paths[p] = at.path;
  if (!wave.throughputs.has_room(p, 1)) wave.throughputs.make_room(p);
  const std::span<float> through = wave.throughputs.take(p);
  const auto density = wave.space.go_to(p, path, at.length, u[1], through);
  if (density) {
    const double own = (*density)[static_cast<size_t>(path.knot)];
    path.relative.take(wave.knots(), *density, own);
    const double shares = path.relative.mean(wave.P());
    const auto scale = static_cast<float>(sum / (at.weight * chance * own * shares));
    Wave::Throughputs::attenuate(at.there, scale, through);
    path.relative.divide(wave.knots(), shares);
    for (size_t k = 0; k < wave.knots(); ++k) path.throughput[k] *= double{scale} * through[wave.heroes.bins[k]];
    wave.throughputs.resume(p, at.there);
    ++path.scatterings;
    path.events |= by_medium;
  }
  wave.throughputs.give_back(p);
  return density.has_value();
}

}  // namespace suite
