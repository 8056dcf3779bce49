// How a light tree is made: a binary tree by the surface-area orientation heuristic, and the wide one out of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "light/light_tree_nodes.h"

namespace suite {

namespace {

// Bounds of two sets of lamps (Conty Estevez & Kulla 2018, algorithm 1 for the cones).
LightBounds united(const LightBounds& a, const LightBounds& b) {
  if (a.power == 0) return b;
  if (b.power == 0) return a;
  LightBounds r = a;
  r.box.grow(b.box);
  r.power = a.power + b.power;
  r.both_sides = a.both_sides || b.both_sides;
  r.spread = std::max(a.spread, b.spread);
  if (a.profile != b.profile || length(a.axis - b.axis) > 1e-9) r.profile = -1;
  const LightBounds &wide = a.cone >= b.cone ? a : b, &narrow = a.cone >= b.cone ? b : a;
  const double between = angle_between(wide.axis, narrow.axis);
  r.axis = wide.axis;
  r.cone = wide.cone;
  if (std::min(between + narrow.cone, kPi) <= wide.cone) return r;
  r.cone = 0.5 * (wide.cone + between + narrow.cone);
  const Vec3 pole = cross(wide.axis, narrow.axis);
  if (r.cone >= kPi || !(length(pole) > 1e-12)) {
    r.cone = kPi;
    return r;
  }
  r.axis = normalized(rotation(normalized(pole), r.cone - wide.cone).vector(wide.axis));
  return r;
}

// Cost of a set: power x area x solid angle of its cone weighted with the spread (section 4.4, equation 1).
double cost(const LightBounds& b, double longest, double extent) {
  const double o = b.cone, w = std::min(o + b.spread, kPi);
  const double solid = 2 * kPi * (1 - std::cos(o)) +
                       kPi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
  const Vec3 s = b.box.size();
  // A floor keeps flat and single-point sets comparable.
  const double e = 1e-6 * longest, area = (s.x + e) * (s.y + e) + (s.y + e) * (s.z + e) + (s.z + e) * (s.x + e);
  return b.power * solid * area * (longest / std::max(extent, 1e-3 * longest));
}

// Sends the same everywhere.
bool even(const LightBounds& b, std::span<const LightProfile> profiles) {
  if (b.profile < 0 || b.cone + b.spread < kPi) return false;
  const LightProfile& p = profiles[static_cast<size_t>(b.profile)];
  return std::all_of(p.begin(), p.end(), [](float v) { return v == 1; });
}

}  // namespace

LightTree::LightTree(std::span<const LightBounds> given, std::vector<LightProfile> profiles) : place_(given.size()) {
  std::vector<LightBounds> lights(given.begin(), given.end());
  // Powers relative to the largest, so that single precision holds what they are worth.
  double most = 0;
  for (const LightBounds& b : lights) most = std::max(most, b.power);
  for (LightBounds& b : lights) {
    b.power /= most;
    if (even(b, profiles)) b.axis = {0, 0, 1};  // no matter which, but those of a cluster alike
  }
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<LightNode> nodes;
  nodes.reserve(2 * lights.size());
  build(lights, order, 0, nodes);
  for (const LightProfile& p : profiles)
    for (size_t first = 0; first < kSteps; ++first) {
      profiles_.push_back(p[first]);
      peaks_.resize(peaks_.size() + first, 0.0f);
      for (size_t last = first; last < kSteps; ++last)
        peaks_.push_back(
            *std::max_element(p.begin() + static_cast<long>(first), p.begin() + static_cast<long>(last) + 1));
    }
  if (profiles.empty()) profiles_.assign(kSteps, 0.0f), peaks_.assign(kSteps * kSteps, 0.0f);
  origin_ = nodes[0].bounds.box.center();
  extent_ = 0.5 * length(nodes[0].bounds.box.size());
  widen(nodes, profiles, 0, kNoNode);
}

LightTree::~LightTree() = default;

// The nodes that become the branches of one node: those with the most lamps are split first; few enough lamps stay
// together, down to which a cluster is judged by all of its lamps in one go.
std::vector<uint32_t> LightTree::branches_of(const std::vector<LightNode>& nodes, uint32_t top) {
  std::vector<uint32_t> below{top};
  const uint32_t together = nodes[top].lamps <= kWide ? 1 : kWide;
  while (below.size() < kWide) {
    const auto largest = std::max_element(below.begin(), below.end(),
                                          [&](uint32_t a, uint32_t b) { return nodes[a].lamps < nodes[b].lamps; });
    if (nodes[*largest].lamps <= together) break;
    const uint32_t split = *largest;
    *largest = split + 1;
    below.insert(largest + 1, nodes[split].next);
  }
  return below;
}

// Makes a node of the wide tree out of what is below `top`; its index.
uint32_t LightTree::widen(const std::vector<LightNode>& nodes, std::span<const LightProfile> profiles, uint32_t top,
                          uint32_t parent) {
  const std::vector<uint32_t> below = branches_of(nodes, top);
  const auto index = static_cast<uint32_t>(branches_.size());
  branches_.emplace_back();
  branches_[index].parent = parent;
  for (uint32_t k = 0; k < below.size(); ++k) {
    const LightNode& node = nodes[below[k]];
    const uint32_t here = kWide * index + k;
    const bool lamp = node.lamps == 1;
    if (lamp) place_[node.next] = here;
    const uint32_t child = lamp ? node.next | kLamp : widen(nodes, profiles, below[k], here);
    set(branches_[index], k, node.bounds, even(node.bounds, profiles));
    branches_[index].child[k] = child;
    if (lamp) branches_[index].opens[k] = 0;
  }
  return index;
}

void LightTree::set(LightBranches& to, uint32_t k, const LightBounds& b, bool evenly) const {
  const Vec3 c = b.box.center() - origin_, size = b.box.size();
  const double radius = 0.5 * length(size) * (1 + 1e-6);
  to.x[k] = static_cast<float>(c.x), to.y[k] = static_cast<float>(c.y), to.z[k] = static_cast<float>(c.z);
  to.radius[k] = static_cast<float>(radius);
  to.power[k] = static_cast<float>(b.power);
  if (radius > 0) to.inside[k] = static_cast<float>(2 * b.power / (radius * radius));
  to.opens[k] = static_cast<float>(kNear * kNear * radius * radius);
  to.axis_x[k] = static_cast<float>(b.axis.x), to.axis_y[k] = static_cast<float>(b.axis.y),
  to.axis_z[k] = static_cast<float>(b.axis.z);
  to.cos_cone[k] = static_cast<float>(std::cos(b.cone)), to.sin_cone[k] = static_cast<float>(std::sin(b.cone));
  to.cos_spread[k] = b.spread >= kPi ? -2.0f : static_cast<float>(std::cos(b.spread)) - kSlack;
  to.both_sides[k] = b.both_sides ? -1 : 0;
  to.profile[k] = b.profile;
  to.even = to.even && evenly;
  to.points = to.points && radius == 0;
  if (!evenly) return;
  // Beside others: what falls off with the cosine outside of a cone that is the whole sphere.
  to.cos_cone[k] = -1, to.sin_cone[k] = 0;
  to.profile[k] = -1;
}

uint32_t LightTree::build(std::span<const LightBounds> lights, std::span<uint32_t> order, int depth,
                          std::vector<LightNode>& nodes) const {
  const auto index = static_cast<uint32_t>(nodes.size());
  nodes.emplace_back();
  LightBounds all;
  Box3 centres;
  for (const uint32_t i : order) all = united(all, lights[i]), centres.grow(lights[i].box.center());
  nodes[index].bounds = all;
  nodes[index].lamps = static_cast<uint32_t>(order.size());
  if (order.size() == 1) {
    nodes[index].next = order[0];
    return index;
  }
  // Split where the costs of the two sides add up to least, over twelve buckets along each axis.
  constexpr int buckets = 12;
  const Vec3 low = centres.low, size = centres.size();
  const double longest = std::max({all.box.size().x, all.box.size().y, all.box.size().z});
  auto bucket_of = [&](uint32_t i, int axis) {
    return std::min(buckets - 1, static_cast<int>(buckets * (lights[i].box.center()[axis] - low[axis]) / size[axis]));
  };
  double best = INFINITY;
  int best_axis = -1, best_split = 0;
  for (int axis = 0; axis < 3 && depth < kCostly; ++axis) {
    if (!(size[axis] > 0)) continue;
    std::array<LightBounds, buckets> in{};
    for (const uint32_t i : order) {
      LightBounds& b = in[static_cast<size_t>(bucket_of(i, axis))];
      b = united(b, lights[i]);
    }
    std::array<LightBounds, buckets> right{};
    right[buckets - 1] = in[buckets - 1];
    for (int b = buckets - 2; b >= 0; --b)
      right[static_cast<size_t>(b)] = united(in[static_cast<size_t>(b)], right[static_cast<size_t>(b) + 1]);
    LightBounds left;
    for (int b = 0; b + 1 < buckets; ++b) {
      left = united(left, in[static_cast<size_t>(b)]);
      const LightBounds& other = right[static_cast<size_t>(b) + 1];
      if (left.power == 0 || other.power == 0) continue;
      const double c = cost(left, longest, all.box.size()[axis]) + cost(other, longest, all.box.size()[axis]);
      if (c < best) best = c, best_axis = axis, best_split = b;
    }
  }
  size_t middle = order.size() / 2;  // lamps at one place, or a tree that grew too deep
  if (best_axis >= 0) {
    const auto cut = std::stable_partition(order.begin(), order.end(),
                                           [&](uint32_t i) { return bucket_of(i, best_axis) <= best_split; });
    middle = static_cast<size_t>(cut - order.begin());
  }
  build(lights, order.first(middle), depth + 1, nodes);
  const uint32_t second = build(lights, order.subspan(middle), depth + 1, nodes);
  nodes[index].next = second;
  return index;
}

}  // namespace suite
