// What a surface of small mirrors (Ggx, GaussFacets) does besides reflecting once: tables that depend on the roughness
// only and are shared by all states and wavelengths.
//
// Totals of single scattering are kept as distributions of the cosine at the facet, so that any Fresnel reflectance can
// be applied afterwards. What is missing to 1 at reflectance 1 has been scattered again: `missed`. How often, and at
// which cosines, is found by walks over the micro-surface.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "optics/models/directional_table.h"
#include "optics/models/polar_lobe.h"

namespace suite {

// What tables of all kinds of facets have in common.
struct FacetGrid {
  static constexpr size_t kRows = 129, kAngles = 96, kOrders = 24;
  // Cosine of node a of kAngles: even in its square root, because Fresnel reflectance bends near grazing.
  static double cosine(size_t a) {
    const double t = static_cast<double>(a) / (kAngles - 1);
    return t * t;
  }
  struct Roughness {
    double x, y;
    auto operator<=>(const Roughness&) const = default;
  };
};

template <class Facets>
class FacetTables : public FacetGrid {
 public:
  static std::shared_ptr<const FacetTables> of(Roughness roughness);
  explicit FacetTables(Roughness roughness);

  // Single scattering: the total is the sum over a of once[a] F(cosine(a)). once.size() == kAngles, out.z > 0.
  void single(Dir out, std::span<float> once) const { single_.at(out, once); }
  // Share of what arrives from (or leaves to) `out` that meets more than one facet, out.z > 0, at reflectance 1.
  double missed(Dir out) const { return std::max(0.0f, missed_.at(out, 0)); }
  // Means over the light from `out` that meets more than one facet of the product of reflectances that it meets, for
  // several rows of F at the nodes, [row][kAngles]; out.z > 0. Facets are taken for independent of each other.
  void repeated(Dir out, std::span<const float> F, std::span<double> means) const;
  const PolarLobe& lobe() const { return *lobe_; }  // follows `missed`

 private:
  DirectionalTable single_, missed_;
  // kOrders shares of the light that meets 2, 3, ... (the last: and more) facets, then kAngles shares of the nodes
  // among the facets that it meets.
  DirectionalTable walks_;
  std::shared_ptr<const PolarLobe> lobe_;
};

}  // namespace suite
