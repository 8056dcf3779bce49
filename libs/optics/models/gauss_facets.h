// A surface whose slopes are normally distributed, as waves of the sea are: the distribution of facets ("Beckmann's"),
// Smith's shadowing for it, and the sampling of the normals that are visible from a direction. The counterpart of Ggx
// in microfacet.h, to the same conventions.
// Based on: P. Beckmann & A. Spizzichino, "The scattering of electromagnetic waves from rough surfaces", 1963; B.
// Smith, "Geometrical shadowing of a random rough surface", IEEE Trans. AP 15, 1967; E. Heitz, "Understanding the
// masking-shadowing function", JCGT 3(2), 2014; E. Heitz & E. d'Eon, "Importance sampling microfacet-based BSDFs using
// the distribution of visible normals", EGSR 2014.
#pragma once
#include <cstdint>
#include <span>

#include "math/vec.h"

namespace suite {

struct GaussFacets {
  double ax = 0.1, ay = 0.1;                       // square root of twice the variance of the slopes along x and y, > 0
  static constexpr uint32_t kBakingPoints = 4096;  // visible normals that tables take the mean of

  double density(Dir h) const;  // of normals per projected solid angle, 1/sr
  double lambda(Dir d) const;
  double masking(Dir d) const { return 1 / (1 + lambda(d)); }
  double shadowing(Dir a, Dir b) const { return 1 / (1 + lambda(a) + lambda(b)); }
  // Of a sample u of the unit square: what does not depend on the view.
  struct Sample {
    double u = 0, across = 0;  // `across` in units of the roughness
  };
  static Sample sample(Vec2 u);
  class View;
  Dir visible_normal(Dir out, Vec2 u) const;  // out may point below the horizon too
};

// The visible normals of one view: what does not depend on the sample. Tables take thousands of one view, and the same
// samples for each.
class GaussFacets::View {
 public:
  View(GaussFacets facets, Dir out);
  Dir normal(Sample s) const;
  // The same of many samples, to the last bit, in some 0.6 of the time: step by step for all of them, so that the
  // processor works on several at once. Fastest where neighbours differ little. h.size() == s.size().
  void normals(std::span<const Sample> s, std::span<Dir> h) const;

 private:
  // A slope's search by Newton's steps: where it is, and the bracket.
  struct Search {
    double m, low, high;
  };
  Search start(double power) const;                                                 // power: u to the fit_
  Search next(const Search& search, double wanted, double fall, double erf) const;  // wanted: u total_
  double slope(double u) const;
  Dir normal(double slope, double across) const;
  GaussFacets facets_;
  double cosine_, sine_, cx_, cy_;  // of the view over slopes of unit roughness, and its azimuth
  double least_ = 0, edge_ = 0, erf_least_ = 0, total_ = 0, fit_ = 0;
};
inline Dir GaussFacets::visible_normal(Dir out, Vec2 u) const { return View(*this, out).normal(sample(u)); }

}  // namespace suite
