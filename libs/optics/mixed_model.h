// Several scattering models side by side within one spot: what a mixture map, or a reflectance cube, makes of a point.
// w, W and the densities are sums over the parts, so one path sees the whole mixture and no part is drawn by lot for
// good: parts of equal shape cost no variance.
//
// A part's share may differ from wavelength to wavelength. Drawing takes part p at knot k with a probability
// proportional to its share there, of which a tenth goes by the mean over the state: a part that counts only elsewhere
// is still drawn. Based on: Goodenough & Brown, section III-A-3 (mixture maps); mixtures of densities after Veach &
// Guibas, "Optimally combining sampling techniques", SIGGRAPH 1995.
#pragma once
#include <vector>

#include "optics/scatter_model.h"

namespace suite {

class MixedModel final : public ScatterModel {
 public:
  // Forgets all parts. knots: bins of the state's knots; must outlive the model.
  void reset(std::span<const size_t> knots);
  // Adds a part. model must outlive this; share >= 0, of all wavelengths; spectrum: a further factor >= 0 per bin (one
  // value for each bin, must outlive this), empty = 1. The shares of all parts sum to 1 (less: the rest is black).
  void add(const ScatterModel& model, float share, std::span<const float> spectrum = {});
  // Adds the parts first <= i < end of another mixture, each times a further factor >= 0 per bin; the shares need not
  // sum to 1 then. The other's models and spectra and `factor` must outlive this. Bug: `other` is this.
  void add(const MixedModel& other, size_t first, size_t end, std::span<const float> factor);
  size_t parts() const { return parts_.size(); }

  void eval(Dir out, Dir in, std::span<float> w) const override;
  void total(Dir out, std::span<float> W) const override;
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override;
  void pdf(Dir out, Dir in, std::span<float> p) const override;
  void delta_weight(Dir out, int lobe, int knot, std::span<float> weight) const override;
  void delta_probability(Dir out, int lobe, int knot, std::span<float> probability) const override;
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override;
  Polarised delta_mueller(Dir out, int lobe, int knot, std::span<Mueller> m) const override;
  bool has_delta() const override;
  bool opaque() const override;
  bool isotropic() const override;

 private:
  struct Part {
    const ScatterModel* model;
    float share;
    const float* spectrum;    // null = 1
    float chance[kMaxKnots];  // not normalised
  };
  double chance(const Part& part, size_t knot) const {
    return chance_sum_[knot] > 0 ? part.chance[knot] / chance_sum_[knot] : 0;
  }
  std::vector<Part> parts_;
  std::vector<std::vector<float>> products_;  // spectra times factors
  std::span<const size_t> knots_;
  double chance_sum_[kMaxKnots] = {};
};

}  // namespace suite
