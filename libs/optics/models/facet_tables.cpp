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

// The samples of the mean in order of u.x, and where the i-th of Sobol's sequence stands in that order. Neighbours then
// take the same branches of erf and the same count of Newton's steps; sums keep the order of the sequence, on which
// their last bits depend.
template <class Facets>
struct SortedSamples {
  std::vector<typename Facets::Sample> samples;
  std::vector<uint32_t> rank;
  SortedSamples() : rank(Facets::kBakingPoints) {
    const std::vector<Vec2> points = baking_points(Facets::kBakingPoints);
    std::vector<uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return points[a].x < points[b].x; });
    samples.reserve(order.size());
    for (const uint32_t i : order) {
      rank[i] = static_cast<uint32_t>(samples.size());
      samples.push_back(Facets::sample(points[i]));
    }
  }
};

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
  const SortedSamples<Facets> sorted;
  single_ = DirectionalTable(facets.ax, facets.ay, kRows, kAngles, [&](Dir o, std::span<float> once) {
    struct Met {
      double cosine, weight;  // cosine 0: not lit
    };
    thread_local std::vector<Met> met;
    thread_local std::vector<Dir> directions;  // of normals, then of the light
    met.resize(sorted.samples.size()), directions.resize(met.size());
    const typename Facets::View view(facets, o);
    const double lambda = facets.lambda(o), masking = 1 / (1 + lambda);
    view.normals(sorted.samples, directions);
    for (size_t k = 0; k < met.size(); ++k) {
      const Dir h = directions[k];
      met[k].cosine = dot(o, h);
      directions[k] = h * (2 * met[k].cosine) - o;
    }
    for (size_t k = 0; k < met.size(); ++k)
      if (directions[k].z > 0 && met[k].cosine > 0)
        met[k].weight = 1 / (1 + lambda + facets.lambda(directions[k])) / masking / Facets::kBakingPoints;
      else
        met[k].cosine = 0;
    std::vector<double> hats(kAngles);
    for (const uint32_t k : sorted.rank)
      if (met[k].cosine > 0) add_hat(met[k].cosine, met[k].weight, hats);
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
void FacetTables<Facets>::repeated(Dir out, std::span<const float> F, std::span<double> means) const {
  std::vector<float> shares(kOrders + kAngles);
  walks_.at(out, shares);
  for (double& sum : means) {
    double mean = 0;
    for (size_t a = 0; a < kAngles; ++a) mean += shares[kOrders + a] * F[a];
    double power = mean;
    sum = 0;
    for (size_t k = 0; k < kOrders; ++k) sum += shares[k] * (power *= mean);
    F = F.subspan(kAngles);
  }
}

template class FacetTables<Ggx>;
template class FacetTables<GaussFacets>;

}  // namespace suite
