#include "radiometry/sources/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

constexpr double kShareOfBound = 0.05;

// cos of max(0, a - b).
double cos_difference(double sin_a, double cos_a, double sin_b, double cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
double sin_difference(double sin_a, double cos_a, double sin_b, double cos_b) {
  return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}
double sine(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

}  // namespace

LightTree::LightTree(std::span<const LightBounds> lights, std::vector<LightProfile> profiles)
    : profiles_(std::move(profiles)), trail_(lights.size()) {
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * lights.size());
  build(lights, order, 0, 0);
}

uint32_t LightTree::build(std::span<const LightBounds> lights, std::span<uint32_t> order, uint64_t trail, int depth) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  LightBounds all;
  Box3 centres;
  for (const uint32_t i : order) all = united(all, lights[i]), centres.grow(lights[i].box.center());
  Node node;
  node.center = all.box.center();
  node.radius2 = 0.25 * dot(all.box.size(), all.box.size());
  node.axis = all.axis;
  node.cos_cone = std::cos(all.cone), node.sin_cone = std::sin(all.cone);
  node.cos_spread = all.spread >= kPi ? -2 : std::cos(all.spread);
  node.power = all.power;
  node.both_sides = all.both_sides;
  node.profile = all.profile;
  if (order.size() == 1) {
    node.leaf = true;
    node.next = order[0];
    trail_[order[0]] = trail;
    nodes_[index] = node;
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
  for (int axis = 0; axis < 3 && depth < 40; ++axis) {
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
  build(lights, order.first(middle), trail, depth + 1);
  node.next = build(lights, order.subspan(middle), trail | (uint64_t{1} << depth), depth + 1);
  nodes_[index] = node;
  return index;
}

// What the lamps under a node send to a place, up to a common factor (section 4.3): what one at its centre would send,
// and a share of the most they can, which alone keeps every lamp drawable but takes wide flat clusters, whose sphere
// reaches high above them, for much brighter than they are.
double LightTree::importance(const Node& node, const LightReceiver& at) const {
  const Vec3 to = node.center - at.position;
  const double d2 = dot(to, to);
  // Inside the sphere around the node nothing is known about directions.
  if (d2 <= node.radius2 || d2 == 0) return 2 * node.power / std::max(node.radius2, 1e-300);
  const Dir towards = to / std::sqrt(d2);
  const double sin_b2 = node.radius2 / d2, cos_b = std::sqrt(1 - sin_b2), sin_b = std::sqrt(sin_b2);
  double cos_w = -dot(node.axis, towards);
  if (node.both_sides) cos_w = std::fabs(cos_w);
  const double sin_w = sine(cos_w);
  const double cos_x = cos_difference(sin_w, cos_w, node.sin_cone, node.cos_cone),
               sin_x = sin_difference(sin_w, cos_w, node.sin_cone, node.cos_cone);
  const double cos_out = cos_difference(sin_x, cos_x, sin_b, cos_b);
  if (cos_out <= node.cos_spread) return 0;
  // Twice: the most that any lamp of the node can send, and what one at its centre would.
  double most, middle;
  if (node.profile >= 0) {
    const double high = cos_difference(sin_w, cos_w, sin_b, cos_b),
                 low = cos_w < -cos_b ? -1 : cos_w * cos_b - sin_w * sin_b;
    const auto step = [](double cosine) { return std::clamp(static_cast<int>((cosine + 1) * 16), 0, 31); };
    const LightProfile& profile = profiles_[static_cast<size_t>(node.profile)];
    // Steps that the bounds only touch count too: rounding must not hide a lamp.
    most = *std::max_element(profile.begin() + step(low - 1e-9), profile.begin() + step(high + 1e-9) + 1);
    middle = profile[static_cast<size_t>(step(cos_w))];
  } else {
    // Falls off with the cosine; where a lamp sends beyond a right angle it is only known to be positive.
    most = std::max(cos_out, 0.05);
    middle = cos_x <= node.cos_spread ? 0 : std::max(cos_x, 0.05);
  }
  if (const double norm = dot(at.normal, at.normal); norm > 0) {
    double cos_i = dot(at.normal, towards);
    if (at.two_sided) cos_i = std::fabs(cos_i);
    most *= std::max(0.0, cos_difference(sine(cos_i), cos_i, sin_b, cos_b));
    middle *= std::max(0.0, cos_i);
  }
  return node.power / d2 * (middle + kShareOfBound * most);
}

std::optional<LightTree::Choice> LightTree::sample(const LightReceiver& at, double u) const {
  uint32_t i = 0;
  double probability = 1;
  if (nodes_[0].leaf && !(importance(nodes_[0], at) > 0)) return std::nullopt;
  while (!nodes_[i].leaf) {
    const uint32_t first = i + 1, second = nodes_[i].next;
    const double a = importance(nodes_[first], at), b = importance(nodes_[second], at);
    if (!(a + b > 0)) return std::nullopt;
    const double p = a / (a + b);
    if (u < p) {
      i = first;
      u = u / p;
      probability *= p;
    } else {
      i = second;
      u = (u - p) / (1 - p);
      probability *= 1 - p;
    }
    u = std::min(u, 1 - 0x1p-53);
  }
  return Choice{nodes_[i].next, probability};
}

double LightTree::probability(const LightReceiver& at, uint32_t light) const {
  uint32_t i = 0;
  uint64_t trail = trail_[light];
  double probability = 1;
  if (nodes_[0].leaf) return importance(nodes_[0], at) > 0 ? 1 : 0;
  for (; !nodes_[i].leaf; trail >>= 1) {
    const uint32_t first = i + 1, second = nodes_[i].next;
    const double a = importance(nodes_[first], at), b = importance(nodes_[second], at);
    if (!(a + b > 0)) return 0;
    probability *= trail & 1 ? 1 - a / (a + b) : a / (a + b);
    i = trail & 1 ? second : first;
  }
  return probability;
}

}  // namespace suite
