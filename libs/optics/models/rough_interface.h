// What a rough interface of one roughness and one index does with light from every angle on both sides: tables that all
// states and wavelengths share.
//
// All shares are of radiance over squared index, for which the two sides make one closed furnace: what is reflected and
// what passes sum to 1. Light that meets one facet is given in closed form; what is missing to 1 has met more. Walks
// over the micro-surface tell how much of that is reflected.
//
// Transmission of light that meets one facet has the shadowing of Heitz et al. 2016, raised by the share `straight`
// towards the most that reciprocity allows: chains of refractions at facets, which go nearly straight on when the index
// is near 1, are thereby counted with the lobe that they resemble. At index 1 the whole light passes as it came.
// Based on: E. Heitz et al., "Multiple-scattering microfacet BSDFs with the Smith model", SIGGRAPH 2016.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "optics/microfacet.h"

namespace suite {

class RoughInterface {
 public:
  struct Kind {
    double roughness, index;  // index of the lower side over that of the upper one, > 1
    auto operator<=>(const Kind&) const = default;
  };
  static std::shared_ptr<const RoughInterface> of(Kind kind);
  explicit RoughInterface(Kind kind);

  // Indices at which tables that are interpolated stand, in order: node(n) <= index < node(n + 1).
  static double node(int n);
  static int node_below(double index);

  // Side 0 is the upper one, 1 the lower one; mu = |cosine|, in (0, 1].
  // Share reflected, however often it was scattered; the rest passes. index: near that of the table; angles are
  // compared by what they refract to, so that the critical angle stays sharp.
  double reflected(int side, double mu, double index) const;
  struct Again {
    double missed;   // share that meets more facets than the two lobes of one facet account for
    double through;  // of it, the share that passes (side 1: times the squared index)
  };
  Again again(int side, double mu) const;
  // Integrals over the hemisphere, times cosine. That of `through` is the same for both sides.
  double missed_integral(int side) const { return missed_integral_[static_cast<size_t>(side)]; }
  double through_integral() const { return through_integral_; }
  double straight() const { return straight_; }

  // Shadowing of transmission, in parts: walked + straight (most - walked).
  struct Shadowing {
    double walked, most;
    double at(double straight) const { return walked + straight * (most - walked); }
  };
  static Shadowing shadowing_across(const Ggx& facets, Dir a, Dir b) {
    return {facets.shadowing_across(a, b), std::min(facets.masking(a), facets.masking(b))};
  }

 private:
  struct Row {
    double reflected_once = 0, passed_walked = 0, passed_most = 0;  // light that meets one facet
    double again = 0, again_reflected = 0, refracted_only = 0;      // shares of the walks
  };
  using Rows = std::array<std::vector<Row>, 2>;
  Row make_row(int side, double mu, size_t number) const;
  void walk(int side, Dir out, uint64_t seed, Row& row) const;
  void close(const Rows& rows);
  template <class F>
  double integral(int side, const F& of_row) const;  // of what is linear between rows, times cosine
  double place(int side, double mu, double index) const;
  double cosine(int side, double place) const;

  Ggx facets_;
  double index_;
  std::array<std::vector<float>, 2> reflected_, missed_, through_;
  std::array<double, 2> missed_integral_{};
  double through_integral_ = 0, straight_ = 0;
};

}  // namespace suite
