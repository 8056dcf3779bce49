// The GGX distribution of micro-facet normals with Smith's height-correlated shadowing, and the sampling of the normals
// that are visible from a direction.
//
// All directions on the upper side (z > 0) where nothing else is said, unit length. Based on: B. Walter et al.,
// "Microfacet models for refraction through rough surfaces", EGSR 2007; E. Heitz, "Understanding the masking-shadowing
// function", JCGT 3(2), 2014 (equations 72, 86, 99); E. Heitz, "Sampling the GGX distribution of visible normals", JCGT
// 7(4), 2018; E. Heitz, J. Hanika, E. d'Eon, C. Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith
// model", SIGGRAPH 2016.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "math/sampling.h"
#include "math/vec.h"

namespace suite {

// Euler's B(1 + a, 1 + b) for a, b >= 0, to 2e-8 relative while both are below 1e5
// (Stirling's series at arguments of at least 5).
inline double beta_above_one(double a, double b) {
  const auto log_gamma = [](double x) {  // of 1 + x
    const double z = x + 5, y = 1 / z, y2 = y * y;
    return (z - 0.5) * std::log(z) - z + y * (1.0 / 12 - y2 * (1.0 / 360 - y2 / 1260)) -
           std::log((x + 1) * (x + 2) * ((x + 3) * (x + 4)));
  };
  constexpr double half_log_two_pi = 0.91893853320467274178;
  return std::exp(log_gamma(a) + log_gamma(b) - log_gamma(a + b + 1) + half_log_two_pi);
}

struct Ggx {
  double ax = 0.1, ay = 0.1;                       // roughness along x and y, > 0
  static constexpr uint32_t kBakingPoints = 4096;  // visible normals that tables take the mean of

  // Density of normals per projected solid angle, 1/sr.
  double density(Dir h) const {
    const double x = h.x / ax, y = h.y / ay, t = x * x + y * y + h.z * h.z;
    return 1 / (kPi * ax * ay * t * t);
  }
  double lambda(Dir d) const {
    const double z2 = d.z * d.z, a2 = ax * ax * d.x * d.x + ay * ay * d.y * d.y;
    // (sqrt(1 + a2 / z2) - 1) / 2 without cancellation at small slopes.
    return 0.5 * a2 / (z2 + std::fabs(d.z) * std::sqrt(z2 + a2));
  }
  double masking(Dir d) const { return 1 / (1 + lambda(d)); }                       // G1
  double shadowing(Dir a, Dir b) const { return 1 / (1 + lambda(a) + lambda(b)); }  // G2, same side
  // The chance that a point which a sees from above is seen from below by b (given as up(b)), times masking(a): heights
  // that are easily seen from one side are hardly seen from the other (Heitz et al. 2016: G2 of transmission).
  double shadowing_across(Dir a, Dir b) const { return beta_above_one(lambda(a), lambda(b)); }
  // Density per steradian of visible_normal(out, .).
  double visible_density(Dir out, Dir h) const {
    const double c = dot(out, h);
    return c > 0 ? masking(out) * c * density(h) / out.z : 0;
  }
  // Of a sample u of the unit square: its place on the disk, which does not depend on the view.
  struct Sample {
    double x = 0, radius = 0, sine = 0;  // of its azimuth
  };
  static Sample sample(Vec2 u) {
    const double r = std::sqrt(u.x), phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r, std::sin(phi)};
  }
  class View;
  // out may point below the horizon too: the normals that a ray climbing out of a valley meets.
  Dir visible_normal(Dir out, Vec2 u) const;
};

// The visible normals of one view: what does not depend on the sample. Tables take thousands of one view, and the same
// samples for each.
class Ggx::View {
 public:
  // Stretches to the hemisphere of unit roughness.
  View(Ggx facets, Dir out) : facets_(facets), v_(normalized({facets.ax * out.x, facets.ay * out.y, out.z})) {
    const double s2 = v_.x * v_.x + v_.y * v_.y;
    t1_ = s2 > 0 ? Vec3{-v_.y, v_.x, 0} / std::sqrt(s2) : Vec3{1, 0, 0};
    t2_ = cross(v_, t1_);
  }
  // Samples the visible half disk, projects back.
  Dir normal(Sample sample) const {
    const double s = 0.5 * (1 + v_.z);
    const double p1 = sample.x, p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * sample.radius * sample.sine;
    const Vec3 n = t1_ * p1 + t2_ * p2 + v_ * std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2));
    return normalized({facets_.ax * n.x, facets_.ay * n.y, std::max(0.0, n.z)});
  }
  void normals(std::span<const Sample> samples, std::span<Dir> h) const {
    for (size_t i = 0; i < samples.size(); ++i) h[i] = normal(samples[i]);
  }

 private:
  Ggx facets_;
  Vec3 v_, t1_, t2_;
};
inline Dir Ggx::visible_normal(Dir out, Vec2 u) const { return View(*this, out).normal(sample(u)); }

// Points of the unit square for averages over visible normals when a model is baked (the first points of Sobol's
// sequence; count a power of two up to 2^16).
inline std::vector<Vec2> baking_points(uint32_t count) {
  std::vector<Vec2> points(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto x = sobol4(i);
    points[i] = {unit_double(x[0]) + 0.5 / count, unit_double(x[1]) + 0.5 / count};
  }
  return points;
}
// The same as samples of Facets (Ggx, GaussFacets), for their View::normal.
template <class Facets>
std::vector<typename Facets::Sample> baking_samples(uint32_t count) {
  std::vector<typename Facets::Sample> samples;
  samples.reserve(count);
  for (const Vec2 u : baking_points(count)) samples.push_back(Facets::sample(u));
  return samples;
}

}  // namespace suite
