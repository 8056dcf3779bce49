#include "optics/models/ggx_tables.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "optics/models/microsurface_walk.h"
#include "optics/models/shared_tables.h"

namespace suite {

namespace {

constexpr size_t kPoints = 4096, kWalks = 1 << 16;

// Adds `weight` at cosine c to hats over the nodes: linear in c between them, as F is nearly.
void add_hat(double c, double weight, std::span<double> hats) {
  const double t = std::min(1.0, std::sqrt(c)) * (GgxTables::kAngles - 1);
  const size_t a = std::min(GgxTables::kAngles - 2, static_cast<size_t>(t));
  const double low = GgxTables::cosine(a), share = (c - low) / (GgxTables::cosine(a + 1) - low);
  hats[a] += weight * (1 - share);
  hats[a + 1] += weight * share;
}

// Mean over the azimuths of the first quadrant.
template <class F>
double around(const F& f, double mu, int azimuths) {
  double sum = 0;
  for (int k = 0; k < azimuths; ++k) sum += f(dir_from_angles(std::acos(mu), kPi / 2 * (k + 0.5) / azimuths));
  return sum / azimuths;
}

}  // namespace

std::shared_ptr<const GgxTables> GgxTables::of(Roughness roughness) {
  static SharedTables<Roughness, GgxTables> tables;
  return tables.get(roughness);
}

GgxTables::GgxTables(Roughness roughness) {
  tabulate(roughness);
  const int azimuths = roughness.x == roughness.y ? 1 : 64;
  const auto missed_at = [&](Dir out) { return missed(out); };
  lobe_ = std::make_shared<const PolarLobe>([&](double mu) { return around(missed_at, mu, azimuths); });
  // Even steps in the cube root of the cosine: on smooth surfaces only grazing directions miss anything.
  constexpr int steps = 4096;
  for (int s = 0; s < steps; ++s) {
    const double low = std::pow(static_cast<double>(s) / steps, 3), high = std::pow((s + 1.0) / steps, 3);
    missed_integral_ += kPi * (high * high - low * low) * around(missed_at, 0.5 * (low + high), azimuths);
  }
  walk(roughness);
}

void GgxTables::tabulate(Roughness roughness) {
  const Ggx facets{roughness.x, roughness.y};
  const std::vector<Vec2> points = baking_points(kPoints);
  single_ = DirectionalTable(facets.ax, facets.ay, kRows, kAngles, [&](Dir o, std::span<float> once) {
    std::vector<double> hats(kAngles);
    for (const Vec2 u : points) {
      const Dir h = facets.visible_normal(o, u);
      const double c = dot(o, h);
      const Dir in = h * (2 * c) - o;
      if (in.z > 0 && c > 0) add_hat(c, facets.shadowing(o, in) / facets.masking(o) / kPoints, hats);
    }
    std::transform(hats.begin(), hats.end(), once.begin(), [](double x) { return static_cast<float>(x); });
  });
  missed_ = DirectionalTable(facets.ax, facets.ay, kRows, 1, [&](Dir o, std::span<float> missed) {
    std::vector<float> once(kAngles);
    single_.at(o, once);
    double sum = 0;
    for (const float x : once) sum += x;
    missed[0] = static_cast<float>(std::max(0.0, 1 - sum));
  });
}

void GgxTables::walk(Roughness roughness) {
  const Ggx facets{roughness.x, roughness.y};
  const std::vector<Vec2> points = baking_points(kWalks);
  Pcg32 random(0x67677820);
  orders_.assign(kMostFacets - 1, 0);
  cosines_.assign(kAngles, 0);
  double walks = 0, cosines = 0;
  std::vector<double> met;
  for (const Vec2 u : points) {
    // Start where much is missed; a walk then stands for the others that left too soon.
    const Dir out = lobe_->sample(u);
    const double chance = missed(out);
    if (!(out.z > 0 && chance > 0)) continue;
    MicrosurfaceWalk light(facets, out);
    met.clear();
    while (met.size() < kMostFacets) {
      const auto h = light.next(random);
      if (!h) break;
      met.push_back(light.cosine(*h));
      light.reflect(*h);
    }
    if (met.size() < 2) continue;
    walks += 1 / chance;
    orders_[met.size() - 2] += 1 / chance;
    cosines += static_cast<double>(met.size()) / chance;
    for (const double c : met) add_hat(c, 1 / chance, cosines_);
  }
  SUITE_CHECK(walks > 0);
  for (double& x : orders_) x /= walks;
  for (double& x : cosines_) x /= cosines;
}

double GgxTables::repeated(std::span<const float> F) const {
  double mean = 0, sum = 0;
  for (size_t a = 0; a < kAngles; ++a) mean += cosines_[a] * F[a];
  double power = mean;
  for (const double share : orders_) sum += share * (power *= mean);
  return sum;
}

}  // namespace suite
