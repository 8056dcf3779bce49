// Definitions of kernel.h: path splitting: paths that go on in more than one way, one after the other.
//
// A branch is kept as the path that has just left its event: lane, throughput, bodies around it. When the path under
// way has ended, the last branch that was kept goes on in the same lane, and its light is added to the same sums: all
// branches of a path are one sample. Three events branch:
//   The first smooth interface of a path is passed and mirrors: what it mirrors is weak, but in dark bands all there
// is. A path that first enters a medium that scatters goes on from there n times with 1 / n of its light, so that what
// lies before, a flight through air and the light of a sky, is paid once. Each draws its knot anew: what has drawn the
// path so far, among the knots by P_k r_k, does not draw the rest; and numbers are those of sample n i + j of n times
// as many.
//   A surface in a medium that scatters light of the sun forwards (kernel_guide.h) is left twice: as it comes (density
// p_k of directions at knot k), and guided (g_k), to be scattered on the next flight for certain. With t_k(s) the
// density of being scattered after s m and F_k the probability of it on the whole flight, both share
//   p_k t_k(s) + g_k t_k(s) / F_k
// for what is scattered; what is not comes by the first alone. Based on: multi-sample model of Veach & Guibas 1995.
#pragma once
#include <algorithm>
#include <utility>

#include "transport/kernel.h"

namespace suite {

// The path as it stands, with the share of its throughput.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::keep(uint32_t p, double share, uint32_t times) {
  if constexpr (kGuides) {
    Branches& kept = branches_[p];
    if (kept.size == kept.of.size()) kept.of.emplace_back();
    Kept& to = kept.of[kept.size++];
    to.path = paths_[p];
    to.around = space_.around(p);
    if (!last_.empty()) to.last = last_[p];
    to.times = times;
    const std::span<const float> T = throughputs_.throughput(p);
    to.throughput.resize(bins_);
    for (size_t i = 0; i < bins_; ++i) to.throughput[i] = static_cast<float>(share) * T[i];
  }
}

// Goes on with the last branch kept of a path that has ended; false when there is none.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::take_up(uint32_t p) {
  if constexpr (kGuides) {
    Branches& kept = branches_[p];
    if (kept.surfaces == 0) kept.surfaces = paths_[p].surfaces;
    if (kept.size == 0) return false;
    Kept& from = kept.of[kept.size - 1];
    paths_[p] = from.path;
    space_.put(p, from.around);
    if (!last_.empty()) last_[p] = from.last;
    throughputs_.resume(p, from.throughput);
    if (from.times > 0) draw_part(p, --from.times);
    if (from.times == 0) --kept.size;
    return true;
  }
  return false;
}

// Part j of a path that goes on in parts, as kept before it was parted. What its directions and flights are drawn from
// is chosen anew: knot k with probability q_k, for which its light matters there, so that r_k = q_k / P_k.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::draw_part(uint32_t p, uint32_t j) {
  if constexpr (kGuides) {
    // Where matter absorbs all light, hardly any comes back that has been scattered in it.
    constexpr double kLeast = 0.02;
    Path& path = paths_[p];
    double chosen[kMaxKnots], sum = 0;
    for (size_t k = 0; k < knots(); ++k) {
      const double albedo = space_.albedo_around(p, k);
      sum += chosen[k] = path.relative.part(P(), k) * std::max(kLeast, albedo * albedo);
    }
    double left = (j + path.stream.hashed(path.sample, dimensions::kKnot)) / kParts;
    bool drawn = false;
    for (size_t k = 0; k < knots(); ++k) {
      chosen[k] /= sum;
      path.relative[k] = chosen[k] / probability_[k];
      if (drawn || !(chosen[k] > 0)) continue;
      path.knot = static_cast<int>(k);
      drawn = (left -= chosen[k]) < 0;
    }
    path.sample = path.sample * kParts + j;
  }
}

// The lane's next path: the last branch kept of each that has ended.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::take_up_ended() {
  for (const uint32_t p : active_) branches_[p].goes_on = true;
  for (const uint32_t p : in_stage_)
    if (!std::exchange(branches_[p].goes_on, false) && take_up(p)) active_.push_back(p);
  for (const uint32_t p : active_) branches_[p].goes_on = false;
}

// Behind the first surface that a path has passed.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::part(uint32_t p) {
  if constexpr (kGuides) {
    if (!space_.scatters_around(p)) return;
    paths_[p].share = 1.0 / kParts;
    keep(p, paths_[p].share, kParts);
    take_up(p);
  }
}

// The path goes on from node i and is kept there; then it stands at the node again.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::keep_branch(size_t i, const Continuation& on) {
  if constexpr (kGuides) {
    constexpr uint64_t kPurpose = 0x6272616e6368;
    const uint32_t p = nodes_[i].path;
    const Path before = paths_[p];
    around_ = space_.around(p);
    const std::span<const float> T = throughputs_.throughput(p);
    throughput_before_.assign(T.begin(), T.end());
    paths_[p].stream = SampleStream(hash_of(before.stream.key(), kPurpose), 0);
    if (go_on(i, on)) keep(p, 1, 0);
    paths_[p] = before;
    space_.put(p, around_);
    throughputs_.resume(p, throughput_before_);
  }
}

// What the first smooth interface mirrors.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::branch_mirrored(size_t i) {
  if constexpr (kGuides && Surfaces::kDense > 0) {
    const uint32_t p = nodes_[i].path;
    const Dir out = -paths_[p].direction;
    const int knot = paths_[p].knot, mirror = refracted_->interfaces().lobe(surfaces_.material(p), true);
    if (mirror == SmoothInterfaces::kNoLobe) return;
    const double mirrored = surfaces_.mirrors(p, out, mirror, knot);
    if (!(mirrored > 0 && mirrored < 1)) return;
    Continuation on;
    if (surfaces_.sample_way(p, out, mirror, true, knot, dense(p), on)) keep_branch(i, on);
  }
}

// Towards where the medium scatters light of the sun forwards.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::branch_guided(size_t i) {
  if constexpr (kGuides) {
    const NodeAt& node = nodes_[i];
    const Path& path = paths_[node.path];
    const std::array<double, 4> u = dimensions::of_guided(path.stream, path.sample, path.surfaces - 1);
    Continuation on;
    if (!draw_guided(node, {u[0], u[1]}, u[2], dense(node.path), on)) return;
    share_with_guide(node, true, on);
    keep_branch(i, on);
  }
}

}  // namespace suite
