#include "light/light_tree.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

#include "light/light_tree_nodes.h"

namespace suite {

namespace {

using Eight = float __attribute__((vector_size(32)));
using Eight32 = int32_t __attribute__((vector_size(32)));

Eight load(const float* p) { return _mm256_load_ps(p); }
Eight32 load_whole(const int32_t* p) {
  return reinterpret_cast<Eight32>(_mm256_load_si256(reinterpret_cast<const __m256i*>(p)));
}
Eight root(Eight x) { return _mm256_sqrt_ps(x); }
Eight larger(Eight a, Eight b) { return _mm256_max_ps(a, b); }
Eight smaller(Eight a, Eight b) { return _mm256_min_ps(a, b); }
Eight absolute(Eight x) { return larger(x, -x); }
double sum_of(Eight x) {
  const __m256d four =
      _mm256_add_pd(_mm256_cvtps_pd(_mm256_castps256_ps128(x)), _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1)));
  const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
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
// m2, the least square of a distance.
constexpr float kLeast2 = 1e-20f;
// A branch that is near (kNear) and makes up such a share of what has been judged so far is opened, and judged by what
// is in it; so many nodes at most are open at a time. Measured on 220 to 5000 lamps: a cut of some eight nodes costs as
// much as it saves, and most of them are clusters of lamps, which are judged one by one.
constexpr float kShareOpened = 0.02f;
constexpr uint32_t kMostOpened = 24;

struct Sent {
  Eight middle, most;
};

// What lamps that look somewhere send to a place, over their power and the inverse square of the distance: one at the
// centre of each branch, and the most they can. x, y, z: directions to them; sin_b: of the angle that the radius of
// their sphere fills.
Sent sent(const LightBranches& b, const float* profiles, const float* peaks, Eight x, Eight y, Eight z, Eight sin_b) {
  const Eight cos_b = root(larger(Eight{}, 1 - sin_b * sin_b));
  Eight cos_w = -(load(b.axis_x) * x + load(b.axis_y) * y + load(b.axis_z) * z);
  const Eight32 both = load_whole(b.both_sides);
  cos_w = both ? absolute(cos_w) : cos_w;
  const Eight sin_w = sine(cos_w), cos_cone = load(b.cos_cone), sin_cone = load(b.sin_cone),
              cos_spread = load(b.cos_spread);
  const Eight cos_x = cos_difference(sin_w, cos_w, sin_cone, cos_cone),
              sin_x = sin_difference(sin_w, cos_w, sin_cone, cos_cone);
  const Eight cos_out = cos_difference(sin_x, cos_x, sin_b, cos_b);
  // Falls off with the cosine; where a lamp sends beyond a right angle it is only known to be positive.
  Eight most = larger(cos_out, Eight{} + 0.05f);
  Eight middle = cos_x <= cos_spread ? Eight{} : larger(cos_x, Eight{} + 0.05f);
  const Eight32 profile = load_whole(b.profile);
  const Eight32 profiled = profile >= 0;
  if (_mm256_movemask_epi8(reinterpret_cast<__m256i>(profiled)) != 0) {
    const Eight32 own = profiled ? profile : Eight32{};
    const Eight high = cos_difference(sin_w, cos_w, sin_b, cos_b);
    const Eight low = cos_w < -cos_b ? Eight{} - 1 : cos_w * cos_b - sin_w * sin_b;
    // Steps that the bounds only touch count too.
    const Eight32 range = (own * 32 + step_of(low - kSlack)) * 32 + step_of(high + kSlack);
    const Eight peak = _mm256_i32gather_ps(peaks, reinterpret_cast<__m256i>(range), 4);
    const Eight centre = _mm256_i32gather_ps(profiles, reinterpret_cast<__m256i>(own * 32 + step_of(cos_w)), 4);
    most = profiled ? peak : most;
    middle = profiled ? centre : middle;
  }
  const Eight32 dark = cos_out <= cos_spread;
  return {dark ? Eight{} : middle, dark ? Eight{} : most};
}

}  // namespace

// A cut through the tree: nodes that were opened, each after the one above it, and what their branches are worth.
struct LightTree::Cut {
  alignas(32) float each[kMostOpened][kWide];
  uint32_t node[kMostOpened];
  double worth[kMostOpened];  // sums of each
  uint32_t size;
  double sum;
};

// What the lamps of each branch send to a place, up to a common factor (section 4.3): what one at its centre would
// send, and a share of the most they can. Single precision: it decides about probabilities only, and those are used as
// they come out.
double LightTree::importance(const LightBranches& b, const Asker& at, double before, float* each,
                             uint32_t& opened) const {
  const Eight to_x = load(b.x) - at.x, to_y = load(b.y) - at.y, to_z = load(b.z) - at.z;
  const Eight d2 = larger(to_x * to_x + to_y * to_y + to_z * to_z, Eight{} + kLeast2), inverse = 1 / root(d2);
  const Eight radius = load(b.radius), sin_b = smaller((radius + at.rounding) * inverse, Eight{} + 1);
  Sent lamp{Eight{} + 1, Eight{} + 1};
  if (!b.even) lamp = sent(b, profiles_.data(), peaks_.data(), to_x * inverse, to_y * inverse, to_z * inverse, sin_b);
  if (at.looks) {
    Eight cos_i = (at.normal_x * to_x + at.normal_y * to_y + at.normal_z * to_z) * inverse;
    if (at.two_sided) cos_i = absolute(cos_i);
    // Positive where any of the sphere is above the horizon, rounding included.
    lamp.most *= smaller(larger(Eight{}, cos_i + sin_b + kSlack), Eight{} + 1);
    if (b.points) {
      lamp.middle *= larger(Eight{}, cos_i);
    } else {
      // The cosines over the sphere are taken as spread evenly around that of its centre; below the horizon they are 0.
      const Eight above = larger(Eight{}, cos_i + sin_b);
      lamp.middle *= cos_i >= sin_b ? cos_i : above * above / larger(4 * sin_b, Eight{} + 1e-30f);
    }
  }
  Eight value = load(b.power) * (inverse * inverse) * (lamp.middle + kShareOfBound * lamp.most);
  opened = 0;
  if (b.points) {
    _mm256_store_ps(each, value);
    return sum_of(value);
  }
  value = d2 <= radius * radius ? load(b.inside) : value;
  _mm256_store_ps(each, value);
  const double worth = sum_of(value);
  const Eight32 coarse = (d2 < load(b.opens)) & (value > kShareOpened * static_cast<float>(before + worth));
  opened = static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(coarse)));
  return worth;
}

LightTree::Asker LightTree::asker(const LightReceiver& at) const {
  const Vec3 from = at.position - origin_;
  // Half a last place of each coordinate of both ends, over three axes, and a little more.
  constexpr double kRounding = 2 * 0x1p-24;
  return {static_cast<float>(kRounding * (length(from) + extent_)),
          static_cast<float>(from.x),
          static_cast<float>(from.y),
          static_cast<float>(from.z),
          static_cast<float>(at.normal.x),
          static_cast<float>(at.normal.y),
          static_cast<float>(at.normal.z),
          dot(at.normal, at.normal) > 0,
          at.two_sided};
}

void LightTree::cut(uint32_t from, const Asker& at, Cut& made) const {
  made.node[0] = from;
  made.size = 1;
  made.sum = 0;
  for (uint32_t i = 0; i < made.size; ++i) {
    const LightBranches& b = branches_[made.node[i]];
    float* const each = made.each[i];
    uint32_t opened = 0;
    made.worth[i] = importance(b, at, made.sum, each, opened);
    if (opened != 0) {
      for (; opened != 0 && made.size < kMostOpened; opened &= opened - 1) {
        const int k = __builtin_ctz(opened);
        made.node[made.size++] = b.child[k];
        each[k] = 0;
      }
      made.worth[i] = sum_of(load(each));
    }
    made.sum += made.worth[i];
  }
}

// The branch of a cut in which u falls, and u within it.
LightTree::Choice LightTree::choose(const Cut& c, double& u) const {
  // The last that counts where rounding leaves none.
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
  const auto chosen = static_cast<double>(each[branch]);
  u = std::clamp((rest - before) / chosen, 0.0, 1 - 0x1p-53);
  return {branches_[c.node[node]].child[branch], chosen / c.sum};
}

void LightTree::sample(const LightReceiver& at, std::span<const double> u,
                       std::span<std::optional<Choice>> drawn) const {
  Cut first, deeper;
  const Asker from = asker(at);
  cut(0, from, first);
  for (size_t i = 0; i < u.size(); ++i) {
    drawn[i].reset();
    const Cut* c = &first;
    double rest = u[i], probability = 1;
    while (c->sum > 0) {
      const Choice chosen = choose(*c, rest);
      probability *= chosen.probability;
      if (chosen.light & kLamp) {
        drawn[i] = {chosen.light & ~kLamp, probability};
        break;
      }
      cut(chosen.light, from, deeper);
      c = &deeper;
    }
  }
}

std::optional<LightTree::Choice> LightTree::sample(const LightReceiver& at, double u) const {
  std::optional<Choice> drawn;
  sample(at, {&u, 1}, {&drawn, 1});
  return drawn;
}

double LightTree::probability(const LightReceiver& at, uint32_t light) const {
  // The way down to the lamp: a branch of a node each.
  uint32_t way[kDeepest], length = 0;
  for (uint32_t place = place_[light]; place != kNoNode; place = branches_[place / kWide].parent) way[length++] = place;
  const Asker from = asker(at);
  double probability = 1;
  Cut c;
  while (length > 0) {
    cut(way[length - 1] / kWide, from, c);
    if (!(c.sum > 0)) return 0;
    // Down to where the cut ends on the way.
    for (uint32_t i = 0;;) {
      const uint32_t place = way[--length];
      const uint32_t* const opened =
          length == 0 ? c.node + c.size : std::find(c.node + i + 1, c.node + c.size, way[length - 1] / kWide);
      if (opened == c.node + c.size) {
        probability *= static_cast<double>(c.each[i][place % kWide]) / c.sum;
        break;
      }
      i = static_cast<uint32_t>(opened - c.node);
    }
    if (!(probability > 0)) return 0;
  }
  return probability;
}

}  // namespace suite
