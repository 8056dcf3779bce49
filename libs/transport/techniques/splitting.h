// Path splitting: paths that go on in more than one way, one after the other.
//
// A branch is kept as the path that has just left its event: lane, throughput, bodies around it. When the path under
// way has ended, the last branch that was kept goes on in the same lane, and its light is added to the same sums: all
// branches of a path are one sample. Three events branch:
//   The first smooth interface of a path is passed and mirrors: what it mirrors is weak, but in dark bands all there
// is. A path that first enters a medium that scatters goes on from there n times with 1 / n of its light, so that what
// lies before, a flight through air and the light of a sky, is paid once. Each draws its knot anew: what has drawn the
// path so far, among the knots by P_k r_k, does not draw the rest; and numbers are those of sample n i + j of n times
// as many.
//   A surface in a medium that scatters light of the sun forwards (forward_guide.h) is left twice: as it comes (density
// p_k of directions at knot k), and guided (g_k), to be scattered on the next flight for certain. With t_k(s) the
// density of being scattered after s m and F_k the probability of it on the whole flight, both share
//   p_k t_k(s) + g_k t_k(s) / F_k
// for what is scattered; what is not comes by the first alone. Based on: multi-sample model of Veach & Guibas 1995.
#pragma once
#include <algorithm>
#include <utility>

#include "transport/techniques/end_guide.h"
#include "transport/techniques/forward_guide.h"
#include "transport/techniques/manifold.h"

namespace suite {

template <class Wave>
class Splitting {
 public:
  using Path = typename Wave::Path;
  static constexpr bool kSplits = true;
  // branches: whether any technique makes some.
  void prepare(const Wave& wave, bool branches) {
    if (branches) kept_.resize(wave.paths.size());
  }
  bool on() const { return !kept_.empty(); }
  void start(uint32_t p) {
    if (on()) kept_[p].surfaces = 0;
  }
  // Surfaces that the first branch of a path to end has met; of the last one to end, where there is one.
  uint32_t surfaces(uint32_t p, uint32_t last) const { return on() ? kept_[p].surfaces : last; }
  // Takes up the last branch kept of each path of the stage that has ended: is not active.
  void take_up_ended(Wave& wave, std::span<const uint32_t> stage, std::vector<uint32_t>& active);
  // Parts a path that has just passed its first surface, where it has entered a medium that scatters.
  void part(Wave& wave, uint32_t p);
  // Nodes of the stage from which a branch goes on and is kept; then the path stands at the node again. go_on(i, on)
  // takes a path on from node i; false: it has ended.
  // What the first smooth interface mirrors; and towards where the medium scatters light of the sun forwards.
  template <class GoOn>
  void branch_mirrored(Wave& wave, const Manifold<Wave>& manifold, size_t i, const GoOn& go_on);
  template <class GoOn>
  void branch_guided(Wave& wave, const ForwardGuide<Wave>& guide, size_t i, const GoOn& go_on);
  // Towards the end of a laser radar.
  template <class GoOn>
  void branch_to_end(Wave& wave, const EndGuide<Wave>& ends, size_t i, const GoOn& go_on);

 private:
  struct Kept {
    Path path;
    typename Wave::Space::Around around;
    LastAsked last;
    typename Wave::Throughputs::Kept throughput;
    uint32_t times;  // > 0: that many parts of a path are still to come
  };
  struct Branches {
    std::vector<Kept> of;  // the first `size` of them; the others are kept for later ones
    size_t size = 0;
    bool goes_on = false;   // scratch
    uint32_t surfaces = 0;  // that the first branch to end has met
  };
  // Of a path that enters a medium. Of the work to an error in the bay of sample_scenes four take 0.75 (coastal) to
  // 0.84 (green) of what two do, eight as much as four.
  static constexpr uint32_t kParts = 4;
  void keep(Wave& wave, uint32_t p, double share, uint32_t times);
  bool take_up(Wave& wave, uint32_t p);
  void draw_part(Wave& wave, uint32_t p, uint32_t j);
  template <class GoOn>
  void branch(Wave& wave, size_t i, const Continuation& on, const GoOn& go_on);

  std::vector<Branches> kept_;  // [path]
  // Scratch: what a path was at its node.
  typename Wave::Space::Around around_;
  typename Wave::Throughputs::Kept throughput_before_;
};

// Where media do not scatter paths.
template <class Wave>
class NoSplitting {
 public:
  static constexpr bool kSplits = false;
  void prepare(const Wave&, bool) {}
  bool on() const { return false; }
  void start(uint32_t) {}
  uint32_t surfaces(uint32_t, uint32_t last) const { return last; }
  void take_up_ended(Wave&, std::span<const uint32_t>, std::vector<uint32_t>&) {}
  void part(Wave&, uint32_t) {}
};

// The path as it stands, with the share of its throughput.
template <class Wave>
void Splitting<Wave>::keep(Wave& wave, uint32_t p, double share, uint32_t times) {
  Branches& kept = kept_[p];
  if (kept.size == kept.of.size()) kept.of.emplace_back();
  Kept& to = kept.of[kept.size++];
  to.path = wave.paths[p];
  to.around = wave.space.around(p);
  if (!wave.last.empty()) to.last = wave.last[p];
  to.times = times;
  wave.throughputs.keep(p, static_cast<float>(share), to.throughput);
}

// Goes on with the last branch kept of a path that has ended; false when there is none.
template <class Wave>
bool Splitting<Wave>::take_up(Wave& wave, uint32_t p) {
  Branches& kept = kept_[p];
  if (kept.surfaces == 0) kept.surfaces = wave.paths[p].surfaces;
  if (kept.size == 0) return false;
  Kept& from = kept.of[kept.size - 1];
  wave.paths[p] = from.path;
  wave.space.put(p, from.around);
  if (!wave.last.empty()) wave.last[p] = from.last;
  wave.throughputs.resume(p, from.throughput);
  if (from.times > 0) draw_part(wave, p, --from.times);
  if (from.times == 0) --kept.size;
  return true;
}

// Part j of a path that goes on in parts, as kept before it was parted. What its directions and flights are drawn from
// is chosen anew: knot k with probability q_k, for which its light matters there, so that r_k = q_k / P_k.
template <class Wave>
void Splitting<Wave>::draw_part(Wave& wave, uint32_t p, uint32_t j) {
  // Where matter absorbs all light, hardly any comes back that has been scattered in it.
  constexpr double kLeast = 0.02;
  Path& path = wave.paths[p];
  double chosen[kMaxKnots], sum = 0;
  for (size_t k = 0; k < wave.knots(); ++k) {
    const double albedo = wave.space.albedo_around(p, k);
    sum += chosen[k] = path.relative.part(wave.P(), k) * std::max(kLeast, albedo * albedo);
  }
  double left = (j + path.stream.hashed(path.sample, dimensions::kKnot)) / kParts;
  bool drawn = false;
  for (size_t k = 0; k < wave.knots(); ++k) {
    chosen[k] /= sum;
    path.relative[k] = chosen[k] / wave.heroes.probability[k];
    if (drawn || !(chosen[k] > 0)) continue;
    path.knot = static_cast<int>(k);
    drawn = (left -= chosen[k]) < 0;
  }
  path.sample = path.sample * kParts + j;
}

template <class Wave>
void Splitting<Wave>::take_up_ended(Wave& wave, std::span<const uint32_t> stage, std::vector<uint32_t>& active) {
  for (const uint32_t p : active) kept_[p].goes_on = true;
  for (const uint32_t p : stage)
    if (!std::exchange(kept_[p].goes_on, false) && take_up(wave, p)) active.push_back(p);
  for (const uint32_t p : active) kept_[p].goes_on = false;
}

template <class Wave>
void Splitting<Wave>::part(Wave& wave, uint32_t p) {
  if (!wave.space.scatters_around(p)) return;
  wave.paths[p].share = 1.0 / kParts;
  keep(wave, p, wave.paths[p].share, kParts);
  take_up(wave, p);
}

template <class Wave>
template <class GoOn>
void Splitting<Wave>::branch(Wave& wave, size_t i, const Continuation& on, const GoOn& go_on) {
  constexpr uint64_t kPurpose = 0x6272616e6368;
  const uint32_t p = wave.nodes[i].path;
  const Path before = wave.paths[p];
  around_ = wave.space.around(p);
  wave.throughputs.keep(p, 1, throughput_before_);
  wave.paths[p].stream = SampleStream(hash_of(before.stream.key(), kPurpose), 0);
  if (go_on(i, on)) keep(wave, p, 1, 0);
  wave.paths[p] = before;
  wave.space.put(p, around_);
  wave.throughputs.resume(p, throughput_before_);
}

template <class Wave>
template <class GoOn>
void Splitting<Wave>::branch_mirrored(Wave& wave, const Manifold<Wave>& manifold, size_t i, const GoOn& go_on) {
  const uint32_t p = wave.nodes[i].path;
  const Dir out = -wave.paths[p].direction;
  const int knot = wave.paths[p].knot, mirror = manifold.interfaces().lobe(wave.surfaces.material(p), true);
  if (mirror == SmoothInterfaces::kNoLobe) return;
  const double mirrored = wave.surfaces.mirrors(p, out, mirror, knot);
  if (!(mirrored > 0 && mirrored < 1)) return;
  Continuation on;
  if (wave.surfaces.sample_way(p, out, mirror, true, knot, wave.dense(p), on)) branch(wave, i, on, go_on);
}

template <class Wave>
template <class GoOn>
void Splitting<Wave>::branch_guided(Wave& wave, const ForwardGuide<Wave>& guide, size_t i, const GoOn& go_on) {
  const PathNode& node = wave.nodes[i];
  const Path& path = wave.paths[node.path];
  const std::array<double, 4> u = dimensions::of_guided(path.stream, path.sample, path.surfaces - 1);
  Continuation on;
  if (!guide.draw(wave, node, {u[0], u[1]}, u[2], wave.dense(node.path), on)) return;
  guide.share(wave, node, ForwardGuide<Wave>::Way::guided, on);
  branch(wave, i, on, go_on);
}

template <class Wave>
template <class GoOn>
void Splitting<Wave>::branch_to_end(Wave& wave, const EndGuide<Wave>& ends, size_t i, const GoOn& go_on) {
  const PathNode& node = wave.nodes[i];
  Continuation on;
  if (ends.draw(wave, node, wave.dense(node.path), on)) branch(wave, i, on, go_on);
}

}  // namespace suite
