// How surfaces turn photons that are to say where narrow lobes throw light (gloss_photons.h).
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "surface/optics.h"

namespace suite {

class GlossTurn {
 public:
  explicit GlossTurn(const SpectralState& state) : state_(state), spectrum_(state.size()) {}

  struct Turn {
    Dir in;              // in the shading frame: where to
    bool delta = false;  // by a mirror
    bool narrow = true;  // where the surface is brighter than kNarrow
    double weight = 0;   // of the flux at the reference bin, over the density of the draw
  };
  // A surface is narrow towards a direction in which it is this much brighter than if it scattered all light evenly.
  static constexpr double kNarrow = 1.5;

  // Of light that comes from `to`. Nothing where it ends, or passes a smooth interface, behind which others ask for it
  // (refracted/sight.h). u: four numbers in [0, 1).
  std::optional<Turn> draw(const ScatterModel& model, Dir to, const std::array<double, 4>& u);
  // Whether a material, as it is anywhere, may turn light narrowly: by some draws.
  bool is_glossy(const BakedMaterial& material);
  double at_reference(std::span<const float> spectrum) const { return double{spectrum[state_.knots[0]]}; }

 private:
  bool is_glossy(const ScatterModel& model);
  // By a Dirac lobe, whose weights stand in spectrum_.
  std::optional<Turn> mirrored(Dir to, const ScatterModel::Sample& drawn, float probability) const;
  double value(const ScatterModel& model, Dir out, Dir in);

  const SpectralState& state_;
  std::vector<float> spectrum_;
};

}  // namespace suite
