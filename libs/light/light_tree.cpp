#include "light/light_tree.h"

#include <immintrin.h>

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

constexpr uint32_t kWide = 8, kLamp = 1u << 31;
constexpr size_t kSteps = 32;

using Eight = float __attribute__((vector_size(32)));
using Eight32 = int32_t __attribute__((vector_size(32)));

Eight load(const float* p) { return _mm256_load_ps(p); }
Eight root(Eight x) { return _mm256_sqrt_ps(x); }
Eight larger(Eight a, Eight b) { return _mm256_max_ps(a, b); }
Eight smaller(Eight a, Eight b) { return _mm256_min_ps(a, b); }
Eight absolute(Eight x) { return larger(x, -x); }
float sum_of(Eight x) {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}
Eight sine(Eight cosine) { return root(larger(Eight{}, 1 - cosine * cosine)); }
// cos and sin of max(0, a - b).
Eight cos_difference(Eight sin_a, Eight cos_a, Eight sin_b, Eight cos_b) {
  return cos_a > cos_b ? Eight{} + 1 : cos_a * cos_b + sin_a * sin_b;
}
Eight sin_difference(Eight sin_a, Eight cos_a, Eight sin_b, Eight cos_b) {
  return cos_a > cos_b ? Eight{} : sin_a * cos_b - cos_a * sin_b;
}
Eight32 step_of(Eight cosine) {
  const Eight step = smaller(larger((cosine + 1) * 16, Eight{}), Eight{} + 31);
  return __builtin_convertvector(step, Eight32);
}

// In place of the most that a cluster can send, which takes wide flat clusters, whose sphere reaches high above them,
// for much brighter than they are, only this share of it counts: enough to keep every lamp drawable.
constexpr float kShareOfBound = 0.05f;
// By which bounds on cosines are widened: they are compared in single precision, and rounding must not hide a lamp.
constexpr float kSlack = 1e-3f;
// Inside the sphere around a branch nothing is known about the directions to its lamps: one that makes up such a share
// of its node there is opened, and judged by what is in it. So many nodes at most are open at a time: more of them
// cost more than they save (measured on streets of 60 and of 1000 lamps).
constexpr float kShareOpened = 0.4f;
constexpr int kMostOpened = 3;

}  // namespace

// A cut through the tree: nodes that were opened, each after the one above it, and what their branches are worth.
struct LightTree::Cut {
  alignas(32) float each[kMostOpened][kWide];
  uint32_t node[kMostOpened];
  double worth[kMostOpened];  // sums of each
  uint32_t size;
  double sum;
};

// Of the binary tree that the wide one is made of.
struct LightTree::Node {
  LightBounds bounds;
  bool leaf = false;
  uint32_t next = 0;  // second child (the first follows), or the light of a leaf
};

// Bounds of up to eight branches. Those that are not there have no power.
struct LightTree::Branches {
  alignas(32) float x[kWide] = {}, y[kWide] = {}, z[kWide] = {}, radius2[kWide] = {};  // spheres, from origin_
  alignas(32) float opens2[kWide] = {};  // radius2 of those that can be opened, else 0
  alignas(32) float axis_x[kWide] = {}, axis_y[kWide] = {}, axis_z[kWide] = {};
  alignas(32) float cos_cone[kWide] = {}, sin_cone[kWide] = {}, cos_spread[kWide] = {}, power[kWide] = {};
  alignas(32) int32_t both_sides[kWide] = {}, profile[kWide] = {};
  uint32_t child[kWide] = {};  // with kLamp set: a lamp, else an index into branches_
};

LightTree::LightTree(std::span<const LightBounds> lights, std::vector<LightProfile> profiles) : trail_(lights.size()) {
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Node> nodes;
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
  widen(nodes, 0, 0, 0);
}

LightTree::~LightTree() = default;

// Makes the branches of a node out of what is three levels below it; its index.
uint32_t LightTree::widen(const std::vector<Node>& nodes, uint32_t top, uint64_t trail, int depth) {
  std::vector<uint32_t> below{top};
  for (int level = 0; level < 3; ++level) {
    std::vector<uint32_t> deeper;
    for (const uint32_t n : below) {
      deeper.push_back(nodes[n].leaf ? n : n + 1);
      if (!nodes[n].leaf) deeper.push_back(nodes[n].next);
    }
    below = std::move(deeper);
  }
  const auto index = static_cast<uint32_t>(branches_.size());
  branches_.emplace_back();
  for (uint32_t k = 0; k < below.size(); ++k) {
    const Node& node = nodes[below[k]];
    const LightBounds& b = node.bounds;
    const uint64_t here = trail | uint64_t{k} << (3 * depth);
    if (node.leaf) trail_[node.next] = here;
    const uint32_t child = node.leaf ? node.next | kLamp : widen(nodes, below[k], here, depth + 1);
    Branches& to = branches_[index];
    const Vec3 c = b.box.center() - origin_, size = b.box.size();
    to.child[k] = child;
    to.x[k] = static_cast<float>(c.x), to.y[k] = static_cast<float>(c.y), to.z[k] = static_cast<float>(c.z);
    to.radius2[k] = static_cast<float>(0.25 * dot(size, size) * (1 + 1e-6));
    to.opens2[k] = node.leaf ? 0 : to.radius2[k];
    to.axis_x[k] = static_cast<float>(b.axis.x), to.axis_y[k] = static_cast<float>(b.axis.y),
    to.axis_z[k] = static_cast<float>(b.axis.z);
    to.cos_cone[k] = static_cast<float>(std::cos(b.cone)), to.sin_cone[k] = static_cast<float>(std::sin(b.cone));
    to.cos_spread[k] = b.spread >= kPi ? -2.0f : static_cast<float>(std::cos(b.spread)) - kSlack;
    to.power[k] = static_cast<float>(b.power);
    to.both_sides[k] = b.both_sides ? -1 : 0;
    to.profile[k] = b.profile;
  }
  return index;
}

uint32_t LightTree::build(std::span<const LightBounds> lights, std::span<uint32_t> order, int depth,
                          std::vector<Node>& nodes) const {
  const auto index = static_cast<uint32_t>(nodes.size());
  nodes.emplace_back();
  LightBounds all;
  Box3 centres;
  for (const uint32_t i : order) all = united(all, lights[i]), centres.grow(lights[i].box.center());
  nodes[index].bounds = all;
  if (order.size() == 1) {
    nodes[index].leaf = true;
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
  for (int axis = 0; axis < 3 && depth < 32; ++axis) {
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

// What the lamps of each branch send to a place, up to a common factor (section 4.3): what one at its centre would
// send, and a share of the most they can. Single precision: it decides about probabilities only, and those are used as
// they come out.
float LightTree::importance(const Branches& b, const LightReceiver& at, float* each, int room, int& opened) const {
  const Vec3 from = at.position - origin_;
  const Eight to_x = load(b.x) - static_cast<float>(from.x), to_y = load(b.y) - static_cast<float>(from.y),
              to_z = load(b.z) - static_cast<float>(from.z);
  const Eight d2 = larger(to_x * to_x + to_y * to_y + to_z * to_z, Eight{} + 1e-30f), inverse = 1 / root(d2);
  const Eight x = to_x * inverse, y = to_y * inverse, z = to_z * inverse;
  const Eight radius2 = load(b.radius2), power = load(b.power);
  const Eight inverse2 = inverse * inverse;
  const Eight sin_b2 = smaller(radius2 * inverse2, Eight{} + 1), sin_b = root(sin_b2), cos_b = root(1 - sin_b2);
  Eight cos_w = -(load(b.axis_x) * x + load(b.axis_y) * y + load(b.axis_z) * z);
  const auto both = reinterpret_cast<Eight32>(_mm256_load_si256(reinterpret_cast<const __m256i*>(b.both_sides)));
  cos_w = both ? absolute(cos_w) : cos_w;
  const Eight sin_w = sine(cos_w), cos_cone = load(b.cos_cone), sin_cone = load(b.sin_cone),
              cos_spread = load(b.cos_spread);
  const Eight cos_x = cos_difference(sin_w, cos_w, sin_cone, cos_cone),
              sin_x = sin_difference(sin_w, cos_w, sin_cone, cos_cone);
  const Eight cos_out = cos_difference(sin_x, cos_x, sin_b, cos_b);
  // Falls off with the cosine; where a lamp sends beyond a right angle it is only known to be positive.
  Eight most = larger(cos_out, Eight{} + 0.05f);
  Eight middle = cos_x <= cos_spread ? Eight{} : larger(cos_x, Eight{} + 0.05f);
  const auto profile = reinterpret_cast<Eight32>(_mm256_load_si256(reinterpret_cast<const __m256i*>(b.profile)));
  const Eight32 profiled = profile >= 0;
  if (_mm256_movemask_epi8(reinterpret_cast<__m256i>(profiled)) != 0) {
    const Eight32 own = profiled ? profile : Eight32{};
    const Eight high = cos_difference(sin_w, cos_w, sin_b, cos_b);
    const Eight low = cos_w < -cos_b ? Eight{} - 1 : cos_w * cos_b - sin_w * sin_b;
    // Steps that the bounds only touch count too.
    const Eight32 range = (own * 32 + step_of(low - kSlack)) * 32 + step_of(high + kSlack);
    const Eight peak = _mm256_i32gather_ps(peaks_.data(), reinterpret_cast<__m256i>(range), 4);
    const Eight centre = _mm256_i32gather_ps(profiles_.data(), reinterpret_cast<__m256i>(own * 32 + step_of(cos_w)), 4);
    most = profiled ? peak : most;
    middle = profiled ? centre : middle;
  }
  if (dot(at.normal, at.normal) > 0) {
    Eight cos_i =
        static_cast<float>(at.normal.x) * x + static_cast<float>(at.normal.y) * y + static_cast<float>(at.normal.z) * z;
    if (at.two_sided) cos_i = absolute(cos_i);
    most *= larger(Eight{}, cos_difference(sine(cos_i), cos_i, sin_b, cos_b) + kSlack);
    middle *= larger(Eight{}, cos_i);
  }
  Eight value = cos_out <= cos_spread ? Eight{} : power * inverse2 * (middle + kShareOfBound * most);
  // Inside the sphere around a branch.
  value = d2 <= radius2 ? 2 * power / larger(radius2, Eight{} + 1e-30f) : value;
  value = power > 0 ? value : Eight{};
  float worth = sum_of(value);
  const Eight32 coarse = (d2 < load(b.opens2)) & (value > kShareOpened * worth);
  opened = _mm256_movemask_ps(reinterpret_cast<__m256>(coarse));
  if (opened != 0 && __builtin_popcount(static_cast<unsigned>(opened)) <= room) {
    value = coarse ? Eight{} : value;
    worth = sum_of(value);
  } else {
    opened = 0;
  }
  _mm256_store_ps(each, value);
  return worth;
}

void LightTree::cut(uint32_t from, const LightReceiver& at, Cut& made) const {
  made.node[0] = from;
  made.size = 1;
  made.sum = 0;
  for (uint32_t i = 0; i < made.size; ++i) {
    const Branches& b = branches_[made.node[i]];
    int opened = 0;
    made.worth[i] =
        static_cast<double>(importance(b, at, made.each[i], kMostOpened - static_cast<int>(made.size), opened));
    made.sum += made.worth[i];
    for (; opened; opened &= opened - 1) made.node[made.size++] = b.child[__builtin_ctz(static_cast<unsigned>(opened))];
  }
}

std::optional<LightTree::Choice> LightTree::sample(const LightReceiver& at, double u) const {
  double probability = 1;
  Cut c;
  for (uint32_t from = 0;;) {
    cut(from, at, c);
    if (!(c.sum > 0)) return std::nullopt;
    // The node and its branch in which u falls; the last that counts where rounding leaves none.
    double rest = u * c.sum;
    uint32_t node = 0, branch = 0;
    for (uint32_t i = 0; i < c.size; ++i) {
      if (!(c.worth[i] > 0)) continue;
      node = i;
      if (rest < c.worth[i]) break;
      rest -= c.worth[i];
    }
    const float* const each = c.each[node];
    double before = 0, passed = 0;
    for (uint32_t k = 0; k < kWide && passed <= rest; ++k) {
      if (!(each[k] > 0)) continue;
      branch = k;
      before = passed;
      passed += static_cast<double>(each[k]);
    }
    probability *= static_cast<double>(each[branch]) / c.sum;
    from = branches_[c.node[node]].child[branch];
    if (from & kLamp) return Choice{from & ~kLamp, probability};
    u = std::clamp((rest - before) / static_cast<double>(each[branch]), 0.0, 1 - 0x1p-53);
  }
}

double LightTree::probability(const LightReceiver& at, uint32_t light) const {
  double probability = 1;
  uint64_t trail = trail_[light];
  Cut c;
  for (uint32_t from = 0;;) {
    cut(from, at, c);
    if (!(c.sum > 0)) return 0;
    // Down to where the cut ends on the way to the lamp.
    for (uint32_t i = 0;; trail >>= 3) {
      const auto k = static_cast<uint32_t>(trail & 7);
      const uint32_t child = branches_[c.node[i]].child[k];
      const uint32_t* const opened = std::find(c.node + i + 1, c.node + c.size, child);
      if (opened != c.node + c.size) {
        i = static_cast<uint32_t>(opened - c.node);
        continue;
      }
      probability *= static_cast<double>(c.each[i][k]) / c.sum;
      if (child & kLamp) return probability;
      from = child;
      trail >>= 3;
      break;
    }
    if (!(probability > 0)) return 0;
  }
}

}  // namespace suite
