// Reflection by a micro-surface of small mirrors (Ggx, GaussFacets), isotropic or anisotropic.
// Assumes: the same on both sides, nothing transmitted. What meets one facet is exact for Smith's surface. What meets
// more is a second lobe, missed(out) missed(in) / integral of missed, which closes the energy (at reflectance 1 the
// total is 1) and is reciprocal. For real metals `missed` is multiplied with the mean product of reflectances that
// light from a direction meets.
// Neglected: the second lobe's own shape, and that facets met one after the other depend on each other. Against exact
// walks up to 0.061 of the light leaves in wrong directions (aluminium, roughness 0.6 by 0.15; mostly below 0.02), and
// totals agree within 0.006 (tests/physics/optics/rough_energy_test.cpp prints both).
// Based on: B. Walter et al. 2007, equation 20; E. Heitz 2014 (height-correlated shadowing), 2018 (visible normals);
// C. Kulla & A. Conty, "Revisiting physically based shading at Imageworks", SIGGRAPH course, 2017 (second lobe); E.
// Heitz et al. 2016 (what it stands for: the walks of facet_tables.h).
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "optics/fresnel.h"
#include "optics/fresnel_mueller.h"
#include "optics/models/common.h"
#include "optics/models/facet_tables.h"

namespace suite {

// What the mirrors reflect at each bin: by index n + i k, or by Schlick's f0 where n is 0.
struct FacetColour {
  std::vector<float> f0, n, k;
  bool indexed() const { return *std::max_element(n.begin(), n.end()) > 0; }
  PlaneBlocks polarised(double c, size_t bin) const { return fresnel_reflection(c, {n[bin], k[bin]}); }
  double reflectance(double c, size_t bin) const {
    return n[bin] > 0 ? fresnel_conductor(c, n[bin], k[bin]) : fresnel_schlick(c, f0[bin]);
  }
  bool uniform() const {
    const auto constant = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v[0]; });
    };
    return constant(f0) && constant(n) && constant(k);
  }
};

// The verbs of ScatterModel.
template <class Facets>
class FacetMirror {
 public:
  FacetMirror(FacetColour colour, Facets facets)
      : colour_(std::move(colour)),
        bins_(colour_.f0.size()),
        facets_(facets),
        tables_(FacetTables<Facets>::of({facets.ax, facets.ay})),
        uniform_(colour_.uniform()),
        indexed_(colour_.indexed()) {
    tabulate();
  }

  void eval(Dir out, Dir in, std::span<float> w) const {
    if (!same_side(out, in)) return zero(w);
    const Dir o = up(out), i = up(in), h = normalized(o + i);
    const double shape = facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z), c = dot(o, h);
    thread_local std::vector<float> from, to;
    from.resize(w.size());
    to.resize(w.size());
    again_.at(o, from);
    again_.at(i, to);
    for (size_t b = 0; b < w.size(); ++b)
      w[b] = finite_float(colour_.reflectance(c, b) * shape +
                          std::max(0.0f, from[b]) * std::max(0.0f, to[b]) * again_scale_[b] * i.z);
  }
  // What meets one facet by Fresnel's amplitudes, the second lobe as a depolariser of which nothing is known; Schlick's
  // reflectance says nothing of polarisation.
  ScatterModel::Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const {
    m[0] = Mueller::depolariser();
    if (!indexed_ || !same_side(out, in)) return {};
    const Dir o = up(out), i = up(in), h = normalized(o + i);
    const double shape = facets_.density(h) * facets_.shadowing(o, i) / (4 * o.z), c = std::min(1.0, dot(o, h));
    thread_local std::vector<float> from, to;
    from.resize(m.size());
    to.resize(m.size());
    again_.at(o, from);
    again_.at(i, to);
    const ScatteringPlane plane(out, in);
    MuellerSum sum;
    for (size_t b = 0; b < (uniform_ ? 1 : m.size()); ++b) {
      const double again = std::max(0.0f, from[b]) * std::max(0.0f, to[b]) * again_scale_[b] * i.z;
      m[b] = sum.over(plane.matrix(colour_.polarised(c, b) * shape), 0, again);
    }
    return {uniform_, sum.unknown()};
  }
  void total(Dir out, std::span<float> W) const {
    if (out.z == 0) return zero(W);
    total_.at(up(out), W);
  }
  std::optional<ScatterModel::Sample> sample(Dir out, Vec2 u, double lobe_u, int) const {
    if (out.z == 0) return std::nullopt;
    const Dir o = up(out);
    const bool again = lobe_u < tables_->missed(o);
    const Dir h = again ? Dir{} : facets_.visible_normal(o, u);
    const Dir in = again ? tables_->lobe().sample(u) : normalized(h * (2 * dot(o, h)) - o);
    if (!(in.z > 0)) return std::nullopt;
    return ScatterModel::Sample{out.z > 0 ? in : Dir{in.x, in.y, -in.z}, again ? 1 : 0, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const {
    if (!same_side(out, in)) return zero(p);
    const Dir o = up(out), i = up(in), h = normalized(o + i);
    const double again = tables_->missed(o), once = facets_.masking(o) * facets_.density(h) / (4 * o.z);
    std::fill(p.begin(), p.end(), finite_float((1 - again) * once + again * tables_->lobe().pdf(i.z)));
  }
  bool isotropic() const { return facets_.ax == facets_.ay; }
  bool spectrally_uniform_shape() const { return uniform_; }

 private:
  // W(out): the distribution of cosines at the facets times F of every wavelength, and the second lobe.
  void tabulate() {
    constexpr size_t angles = FacetGrid::kAngles;
    std::vector<float> fresnel(bins_ * angles);
    for (size_t b = 0; b < bins_; ++b) {
      const std::span<float> row{fresnel.data() + b * angles, angles};
      for (size_t a = 0; a < angles; ++a) row[a] = static_cast<float>(colour_.reflectance(FacetGrid::cosine(a), b));
    }
    again_ = DirectionalTable(facets_.ax, facets_.ay, FacetGrid::kRows, bins_, [&](Dir o, std::span<float> A) {
      std::vector<double> repeated(A.size());
      tables_->repeated(o, fresnel, repeated);
      const double missed = tables_->missed(o);
      for (size_t b = 0; b < A.size(); ++b) A[b] = static_cast<float>(missed * repeated[b]);
    });
    scale_again();
    total_ = DirectionalTable(facets_.ax, facets_.ay, FacetGrid::kRows, bins_, [&](Dir o, std::span<float> W) {
      std::vector<float> once(angles);
      tables_->single(o, once);
      const DirectionalTable::Place place = again_.locate(o);
      for (size_t b = 0; b < W.size(); ++b) {
        double sum = again_.at(place, b);
        for (size_t a = 0; a < angles; ++a) sum += once[a] * fresnel[b * angles + a];
        W[b] = static_cast<float>(sum);
      }
    });
  }

  // Integrals of the second lobe's share over the hemisphere, in steps even in the cube root of the cosine: of smooth
  // surfaces only grazing directions miss anything.
  void scale_again() {
    constexpr int steps = 1024;
    const int azimuths = isotropic() ? 1 : 32;
    std::vector<float> share(bins_);
    again_scale_.assign(bins_, 0);
    for (int s = 0; s < steps * azimuths; ++s) {
      const double low = std::pow(static_cast<double>(s / azimuths) / steps, 3),
                   high = std::pow((s / azimuths + 1.0) / steps, 3), mu = 0.5 * (low + high);
      again_.at(dir_from_angles(std::acos(mu), kPi / 2 * (s % azimuths + 0.5) / azimuths), share);
      for (size_t b = 0; b < share.size(); ++b)
        again_scale_[b] += kPi * (high * high - low * low) / azimuths * std::max(0.0f, share[b]);
    }
    for (double& x : again_scale_) x = x > 0 ? 1 / x : 0;
  }

  FacetColour colour_;
  size_t bins_;
  std::vector<double> again_scale_;  // 1 / integral of again_ times cosine
  Facets facets_;
  std::shared_ptr<const FacetTables<Facets>> tables_;
  bool uniform_ = false, indexed_ = false;
  DirectionalTable total_, again_;  // again_: share of the second lobe
};

}  // namespace suite
