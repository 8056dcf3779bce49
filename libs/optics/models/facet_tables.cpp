#include "optics/models/facet_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "optics/models/gauss_facets.h"
#include "optics/models/microsurface_walk.h"
#include "optics/models/shared_tables.h"

namespace suite {

namespace {

constexpr size_t kWalks = 1024, kWalksOfAnisotropic = 128;

// Adds `weight` at cosine c to hats over the nodes: linear in c between them, as F is nearly.
void add_hat(double c, double weight, std::span<double> hats) {
  const double t = std::min(1.0, std::sqrt(c)) * (FacetGrid::kAngles - 1);
  const size_t a = std::min(FacetGrid::kAngles - 2, static_cast<size_t>(t));
  const double low = FacetGrid::cosine(a), share = (c - low) / (FacetGrid::cosine(a + 1) - low);
  hats[a] += weight * (1 - share);
  hats[a + 1] += weight * share;
}

// Shares of orders and of nodes among walks from `out` that meet more than one facet.
template <class Facets>
void walk(const Facets& facets, Dir out, size_t count, std::span<float> shares) {
  // Every direction has its own stream.
  Pcg32 random(hash_of(std::bit_cast<uint64_t>(out.x), std::bit_cast<uint64_t>(out.y)));
  std::vector<double> orders(FacetGrid::kOrders), cosines(FacetGrid::kAngles), met;
  for (size_t n = 0; n < count; ++n) {
    MicrosurfaceWalk light(facets, out);
    met.clear();
    while (met.size() < kMostFacets) {
      const auto h = light.next(random);
      if (!h) break;
      met.push_back(light.cosine(*h));
      light.reflect(*h);
    }
    if (met.size() < 2) continue;
    orders[std::min(met.size() - 2, orders.size() - 1)] += 1;
    for (const double c : met) add_hat(c, 1, cosines);
  }
  // Where hardly any light meets two facets it does not matter at which angles.
  double walks = std::accumulate(orders.begin(), orders.end(), 0.0);
  if (walks == 0) walks = orders[0] = 1, add_hat(out.z, 1, cosines);
  const double facets_met = std::accumulate(cosines.begin(), cosines.end(), 0.0);
  for (size_t k = 0; k < orders.size(); ++k) shares[k] = static_cast<float>(orders[k] / walks);
  for (size_t a = 0; a < cosines.size(); ++a) shares[orders.size() + a] = static_cast<float>(cosines[a] / facets_met);
}

}  // namespace

template <class Facets>
std::shared_ptr<const FacetTables<Facets>> FacetTables<Facets>::of(Roughness roughness) {
  static SharedTables<Roughness, FacetTables> tables;
  return tables.get(roughness);
}

template <class Facets>
FacetTables<Facets>::FacetTables(Roughness roughness) {
  const Facets facets{roughness.x, roughness.y};
  const bool isotropic = facets.ax == facets.ay;
  const auto samples = baking_samples<Facets>(Facets::kBakingPoints);
  single_ = DirectionalTable(facets.ax, facets.ay, kRows, kAngles, [&](Dir o, std::span<float> once) {
    std::vector<double> hats(kAngles);
    const typename Facets::View view(facets, o);
    const double lambda = facets.lambda(o), masking = 1 / (1 + lambda);
    for (const typename Facets::Sample& sample : samples) {
      const Dir h = view.normal(sample);
      const double c = dot(o, h);
      const Dir in = h * (2 * c) - o;
      if (in.z > 0 && c > 0) add_hat(c, 1 / (1 + lambda + facets.lambda(in)) / masking / Facets::kBakingPoints, hats);
    }
    std::copy(hats.begin(), hats.end(), once.begin());
  });
  missed_ = DirectionalTable(facets.ax, facets.ay, kRows, 1, [&](Dir o, std::span<float> missed) {
    std::vector<float> once(kAngles);
    single_.at(o, once);
    missed[0] = static_cast<float>(std::max(0.0, 1 - std::accumulate(once.begin(), once.end(), 0.0)));
  });
  walks_ = DirectionalTable(facets.ax, facets.ay, kRows, kOrders + kAngles, [&](Dir o, std::span<float> shares) {
    walk(facets, o, isotropic ? kWalks : kWalksOfAnisotropic, shares);
  });
  lobe_ = std::make_shared<const PolarLobe>([&](double mu) {
    const int azimuths = isotropic ? 1 : 64;
    double sum = 0;
    for (int k = 0; k < azimuths; ++k) sum += missed(dir_from_angles(std::acos(mu), kPi / 2 * (k + 0.5) / azimuths));
    return sum / azimuths;
  });
}

template <class Facets>
double FacetTables<Facets>::repeated(Dir out, std::span<const float> F) const {
  std::vector<float> shares(kOrders + kAngles);
  walks_.at(out, shares);
  double mean = 0, sum = 0;
  for (size_t a = 0; a < kAngles; ++a) mean += shares[kOrders + a] * F[a];
  double power = mean;
  for (size_t k = 0; k < kOrders; ++k) sum += shares[k] * (power *= mean);
  return sum;
}

template class FacetTables<Ggx>;
template class FacetTables<GaussFacets>;

}  // namespace suite
