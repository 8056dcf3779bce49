// Definitions of kernel.h: residual estimator over the one-dimensional air field: paths that have ended go back to a
// place in the air that they have passed.
// Every flight of a path is remembered by chance, in proportion to what is scattered on it, times the throughput; one
// of them in the end (reservoir sampling: M. Chao, "A general purpose unequal probability sampling plan", 1982). When
// the path has ended it goes on from a place on that one, with what it had there, as if it had been scattered; its
// light is added to what it has. Where the weights sum to less than 1 it does so with that probability.
#pragma once
#include <algorithm>
#include <utility>

#include "transport/kernel.h"

namespace suite {

// The flight of a slot, before it has weakened its path.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::pass(size_t slot) {
  constexpr double kNothing = 1e-5;
  const uint32_t p = active_[slot];
  Passed& at = passed_[p];
  const Path& path = at.before;
  const auto chances = space_.chances(path, flights_[slot].length);
  double weight = 0;  // whatever knot draws the path: it is no part of the densities that knots share
  for (size_t k = 0; k < knots(); ++k) weight = std::max(weight, path.throughput[k] * chances[k]);
  if (!(weight > kNothing)) return;
  at.sum += weight;
  if (dimensions::of_place(path.stream, path.sample, path.flights)[0] * at.sum >= weight) return;
  at.path = path;
  at.weight = weight;
  at.length = flights_[slot].length;
  space_.remember(p);
  const std::span<const float> T = throughputs_.throughput(p);
  std::copy(T.begin(), T.end(), &throughput_there_[p * bins_]);
}

// Paths of the stage that do not go on.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::go_back(std::span<const uint32_t> stage) {
  for (const uint32_t p : active_) passed_[p].goes_on = true;
  for (const uint32_t p : stage)
    if (!std::exchange(passed_[p].goes_on, false) && go_back(p)) returned_.push_back(p);
  for (const uint32_t p : active_) passed_[p].goes_on = false;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::go_back(uint32_t p) {
  Passed& at = passed_[p];
  const double sum = std::exchange(at.sum, 0), chance = std::min(1.0, sum);
  if (!(sum > 0)) return false;
  const std::array<double, 4> u = dimensions::of_place(at.path.stream, at.path.sample, at.path.flights);
  if (u[2] >= chance) return false;
  if (!at.again) {
    at.record = records_[p];
    at.record.size = paths_[p].surfaces;
    at.again = true;
    records_[p].truncated = 0;
  }
  Path& path = paths_[p] = at.path;
  if (!throughputs_.has_room(p, 1)) throughputs_.make_room(p);
  const std::span<float> through = throughputs_.take(p), there{&throughput_there_[p * bins_], bins_};
  const auto density = space_.go_to(p, path, at.length, u[1], through);
  if (density) {
    const double own = (*density)[static_cast<size_t>(path.knot)];
    path.relative.take(knots(), *density, own);
    const double shares = path.relative.mean(P());
    const auto scale = static_cast<float>(sum / (at.weight * chance * own * shares));
    for (size_t i = 0; i < bins_; ++i) there[i] *= scale * through[i];
    path.relative.divide(knots(), shares);
    for (size_t k = 0; k < knots(); ++k) path.throughput[k] *= double{scale} * through[knot_bins_[k]];
    throughputs_.resume(p, there);
    ++path.scatterings;
    path.events |= by_medium;
  }
  throughputs_.give_back(p);
  return density.has_value();
}

}  // namespace suite
