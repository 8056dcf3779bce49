#include "optics/models/fitted_facets.h"

#include <array>
#include <cmath>

#include "math/warps.h"
#include "optics/fresnel.h"
#include "optics/fresnel_mueller.h"
#include "optics/models/ground.h"

namespace suite {

namespace {

using Slopes = FacetRule::Slopes;

constexpr double kGauss[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kWeight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

}  // namespace

struct FittedFacets::Pair {
  double cos_beta = 0, facets = 0, sum = 0;  // facets: f without Fresnel; sum: of both cosines
  Pair(const FacetRule& r, Dir o, Dir i) {
    if (r.shadows == FacetRule::Shadows::obscuration) o = not_grazing(o), i = not_grazing(i);
    sum = o.z + i.z;
    const Vec3 h = o + i;
    const double size = length(h), cosine = h.z / size, tangent2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    cos_beta = std::clamp(dot(o, h) / size, 0.0, 1.0);
    const double s2 = r.sigma * r.sigma;
    const double p = r.slopes == Slopes::gaussian
                         ? r.bias * std::exp(-tangent2 / (2 * s2)) / (2 * kPi * s2 * cosine * cosine * cosine)
                         : r.bias / (cosine * (s2 + tangent2));
    double seen = 1;
    if (r.shadows == FacetRule::Shadows::cavity) {
      seen = std::min(1.0, 2 * cosine * std::min(o.z, i.z) / cos_beta);
    } else {
      const double lean = std::atan(std::sqrt(tangent2)) / r.omega;
      seen = (1 + lean * std::exp(-2 * std::acos(cos_beta) / r.tau)) / (1 + lean);
    }
    facets = p * seen / (4 * o.z * i.z * cosine);
  }
};

FittedFacets::FittedFacets(const FacetRule& rule, const ModelSpec& spec, const SpectralState& state)
    : rule_(rule),
      n_(state.sample(spec.curves.at("index"))),
      k_(state.sample(spec.curves.at("absorption"))),
      diffuse_(state.sample(spec.curves.at("diffuse"))),
      volume_(state.sample(spec.curves.at("volume"))),
      knots_(state.knots) {
  constexpr size_t kRows = 97;
  facets_ = DirectionalTable(rule.sigma, rule.sigma, kRows, state.size(), [&](Dir out, std::span<float> W) {
    integrate(out, W);
    for (size_t i = 0; i < W.size(); ++i)
      if (const double all = W[i] + body_total(out, i); all > 1.0001)
        throw Error(strf("model '%s': seen from %.1f deg the surface returns %.3f of the light at %g um",
                         spec.model.c_str(), polar_angle(out) / kDegree, all, state.bins[i].center_um()),
                    "more than it receives; lower bias, diffuse or volume");
  });
}

// Over half vectors: the tangent of their angle is sigma s / (1 - s), s in (0, 1); four Gauss points in each of 24
// parts of s, 64 azimuths of half the circle, the function being even.
void FittedFacets::integrate(Dir out, std::span<float> W) const {
  constexpr int kParts = 24, kAround = 64;
  std::array<Vec2, kAround> around;
  for (int a = 0; a < kAround; ++a) {
    const double phi = kPi * (a + 0.5) / kAround;
    around[static_cast<size_t>(a)] = {std::cos(phi), std::sin(phi)};
  }
  std::vector<double> sum(W.size());
  for (int part = 0; part < kParts; ++part)
    for (int g = 0; g < 4; ++g) {
      const double s = (part + kGauss[g]) / kParts, tangent = rule_.sigma * s / (1 - s),
                   cosine = 1 / std::sqrt(1 + tangent * tangent);
      const double solid = cosine * cosine * cosine * tangent * rule_.sigma / ((1 - s) * (1 - s)) * kWeight[g] /
                           kParts * (2 * kPi / kAround);
      for (const Vec2 turned : around) {
        const Dir h{tangent * cosine * turned.x, tangent * cosine * turned.y, cosine};
        const double cos_beta = dot(out, h);
        const Dir in = 2 * cos_beta * h - out;
        if (!(cos_beta > 0 && in.z > 0)) continue;
        const Pair pair(rule_, out, in);
        const double weight = pair.facets * in.z * 4 * cos_beta * solid;
        if (!(weight > 0)) continue;
        for (size_t i = 0; i < W.size(); ++i)
          sum[i] +=
              weight *
              (i && n_[i] == n_[i - 1] && k_[i] == k_[i - 1] ? 0 : fresnel_conductor(pair.cos_beta, n_[i], k_[i]));
      }
    }
  // Where the index stays the same, so does the sum.
  for (size_t i = 0; i < W.size(); ++i) {
    if (i && n_[i] == n_[i - 1] && k_[i] == k_[i - 1]) sum[i] = sum[i - 1];
    W[i] = static_cast<float>(sum[i]);
  }
}

double FittedFacets::body_total(Dir out, size_t i) const {
  const double c = rule_.shadows == FacetRule::Shadows::obscuration ? std::max(out.z, kGroundMinCosine) : out.z;
  // 2 pi times the integral of 2 m / (c + m) over m from 0 to 1, which the clamp of incidence changes below 85 deg.
  double volume = 1 - c * std::log1p(1 / c);
  if (rule_.shadows == FacetRule::Shadows::obscuration) {
    const double e = kGroundMinCosine;
    volume = (1 - e) - c * std::log((1 + c) / (e + c)) + 0.5 * e * e / (c + e);
  }
  return diffuse_[i] + 4 * kPi * volume_[i] * volume;
}

void FittedFacets::eval(Dir out, Dir in, std::span<float> w) const {
  if (!same_side(out, in)) return zero(w);
  const Pair pair(rule_, up(out), up(in));
  const double cosine = std::fabs(in.z);
  for (size_t i = 0; i < w.size(); ++i)
    w[i] = finite_float(cosine * (pair.facets * fresnel_conductor(pair.cos_beta, n_[i], k_[i]) + diffuse_[i] / kPi +
                                  2 * volume_[i] / pair.sum));
}

ScatterModel::Polarised FittedFacets::mueller(Dir out, Dir in, std::span<Mueller> m) const {
  if (!same_side(out, in)) return depolarised(m);
  const Pair pair(rule_, up(out), up(in));
  const ScatteringPlane plane(out, in);
  MuellerSum sum;
  for (size_t i = 0; i < m.size(); ++i) {
    const PlaneBlocks facets = fresnel_reflection(pair.cos_beta, {n_[i], k_[i]}) * pair.facets;
    m[i] = sum.over(plane.matrix(facets), diffuse_[i] / kPi + 2 * volume_[i] / pair.sum, 0);
  }
  return {m.size() == 1, 0};
}

void FittedFacets::total(Dir out, std::span<float> W) const {
  if (out.z == 0) return zero(W);
  facets_.at(up(out), W);
  for (size_t i = 0; i < W.size(); ++i) W[i] = static_cast<float>(std::min(1.0, W[i] + body_total(up(out), i)));
}

// Facets with long tails are never drawn alone: their density falls faster than they do.
double FittedFacets::facet_share(Dir out, const DirectionalTable::Place& place, size_t knot) const {
  const size_t i = knots_[knot];
  const double facets = facets_.at(place, i), rest = body_total(out, i);
  const bool alone = rule_.slopes == Slopes::gaussian && rule_.shadows == FacetRule::Shadows::cavity;
  if (alone && rest == 0) return 1;
  return facets + rest > 0 ? std::clamp(facets / (facets + rest), 0.1, alone ? 0.95 : 0.7) : 0.1;
}

// Draws follow f, which does not change beyond 85 deg where shadowing is obscuration.
Dir FittedFacets::seen_from(Dir out) const {
  return rule_.shadows == FacetRule::Shadows::obscuration ? not_grazing(up(out)) : up(out);
}

// Cauchy's slopes are drawn from a density that falls with the fourth power of the tangent.
double FittedFacets::slope_density(double tangent2, double cosine) const {
  const double s2 = rule_.sigma * rule_.sigma, c3 = cosine * cosine * cosine;
  if (rule_.slopes == Slopes::gaussian) return std::exp(-tangent2 / (2 * s2)) / (2 * kPi * s2 * c3);
  return s2 / (kPi * (s2 + tangent2) * (s2 + tangent2) * c3);
}

std::optional<ScatterModel::Sample> FittedFacets::sample(Dir out, Vec2 u, double lobe_u, int knot) const {
  if (out.z == 0) return std::nullopt;
  const Dir o = seen_from(out);
  const bool facet = lobe_u < facet_share(o, facets_.locate(o), static_cast<size_t>(knot));
  Dir in;
  if (facet) {
    const double t =
        rule_.sigma * std::sqrt(rule_.slopes == Slopes::gaussian ? -2 * std::log1p(-u.x) : u.x / (1 - u.x));
    const double cosine = 1 / std::sqrt(1 + t * t), turn = 2 * kPi * u.y;
    const Dir h{t * cosine * std::cos(turn), t * cosine * std::sin(turn), cosine};
    in = 2 * dot(o, h) * h - o;
  } else {
    in = cosine_hemisphere(u);
  }
  if (!(in.z > 0)) return std::nullopt;
  return Sample{out.z > 0 ? in : Dir{in.x, in.y, -in.z}, facet ? 1 : 0, false};
}

void FittedFacets::pdf(Dir out, Dir in, std::span<float> p) const {
  if (!same_side(out, in)) return zero(p);
  const Dir o = seen_from(out), i = up(in);
  const Vec3 h = o + i;
  const double size = length(h), cosine = h.z / size, tangent2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
  const double facet = slope_density(tangent2, cosine) / (4 * dot(o, h) / size), base = i.z / kPi;
  const DirectionalTable::Place place = facets_.locate(o);
  for (size_t k = 0; k < p.size(); ++k) {
    const double share = facet_share(o, place, k);
    p[k] = finite_float(share * facet + (1 - share) * base);
  }
}

}  // namespace suite
