// Bins chosen through the gases of real air: few fine cells and g-points of them, with weights of their own for each
// band, so that light along slanted paths through the air comes out as over all cells (spectral/cubature.h).
//
// Candidates are the g-points of cells of 0.5 nm or 1 cm-1, narrower where a band is narrow. They are fitted to paths
// of training and judged on others (air_paths.h); bands that miss there are fitted closer and judged again. What is
// left is each band's bias. Based on: J.-L. Moncet et al., J. Atmos. Sci. 65, 2008 (optimal spectral sampling); J.
// Gasteiger et al., J. Quant. Spectrosc. Radiat. Transfer 148, 2014 (representative wavelengths; 5 to 20 a band for 1
// %).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "scheduler/air_paths.h"
#include "scheduler/products.h"

namespace suite {

// Cells that are fine enough for the builtin gases and the sun within bands: not yet split into g-points.
SpectralState air_cells(std::span<const Band> bands);

class AirChoice {
 public:
  // seen: of the scene, without the air. state: which bins are wanted for.
  AirChoice(const AirSpec& air, const AirPaths& paths, const std::vector<SeenSpectra>& seen, const SpectralState& state,
            std::span<const Band> bands, bool white_light);

  // Chosen bins, their reference and knots transparent. tolerance: relative error of each band on held-out paths.
  SpectralState choose(double tolerance) const;

  struct Worst {
    double error = 0;
    std::string under;   // which product
    double of_dark = 0;  // W/(m2 sr um), the largest error of lights that are too dark for bins to be chosen for them
  };
  // Of each band, on held-out paths, by the bins of a state.
  std::vector<Worst> judge(const SpectralState& state) const;
  // A hundredth of the brightest light of each band without gases, W/(m2 sr um): no error is relative to less.
  const std::vector<double>& floors() const { return floors_; }
  const SpectralState& cells() const { return intervals_; }

 private:
  SpectralState state_of(const ChosenCells& chosen) const;
  const AirPaths& paths_;
  const SpectralState wanted_;
  std::span<const Band> bands_;
  SpectralState intervals_, fine_;
  ProductRecipe training_, held_out_;
  SpectralProducts products_;                 // of training, over the fine cells
  std::vector<BandCells> cells_;              // of each band
  std::vector<std::vector<BandMean>> means_;  // [band][product] of held-out paths
  std::vector<double> floors_;
};

// Gives a state whose bins are set its knots: near those of place_knots, the bins that gases absorb least.
void place_transparent_knots(SpectralState& state, size_t knot_count, std::span<const float> gas_depth);

// What a state's bins count in each band by its response, or by its shares.
std::vector<BandCells> cells_of(const SpectralState& state, std::span<const Band> bands);

}  // namespace suite
