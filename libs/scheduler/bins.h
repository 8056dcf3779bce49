// The bins of spectral states, chosen from what is looked at: so few that every band comes out within its spectral
// error of bins that are fine enough for all curves.
//
// Light is followed as averages over bins, and averages of curves are multiplied where the product of the curves is
// meant. Against that the bands of all products of what shines with what it is multiplied by (seen_spectra.h; one, two
// and three factors; the fourth and eighth power of some, as errors of what is scattered twice) are first found over
// ever finer cells until halving the cells changes none of them; then the fewest bins are looked for that give the
// same: one bin a stretch of bands where that will do, else some of the cells with weights (spectral/cubature.h), which
// are so narrow that averages multiply.
#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scheduler/seen_spectra.h"
#include "spectral/band_bias.h"

namespace suite {

struct BinReport {
  std::string sensor;
  size_t bands = 0, bins = 0;
  double wanted = 0;           // relative error of each band
  double reached = 0;          // by the bins that are used, what the cells cannot tell included
  double cell_um = 0;          // width of the finest cells
  std::string band, under;     // the farthest: "red edge", "the sun on reflectance of asphalt"
  bool chosen = true;          // false: the user wants even bins (spectral_error: 0), which were only looked at
  size_t g_points = 0;         // of even intervals under real air
  bool through_gases = false;  // judged along paths through real air
  // Bands under real air that are farther off than wanted, by wavelength.
  struct Missed {
    std::string band;
    double center_um, error;
    std::string under;
  };
  std::vector<Missed> missed = {};
  std::vector<BandBias> bias = {};  // of each band under real air; empty: not known
  bool met() const { return reached <= wanted; }
  // "'b28' (1.361 um) 0.4 %, 'b42' (1.831 um) 1.2 %"
  std::string missed_text() const;
  // "sensor 'camera': 4 bands in 7 bins, within 0.08 % of bins of 0.05 nm (farthest: band 'red', the sun)"
  std::string text() const;
};

// What reports, of each state in its turn, know of the bands' errors.
void add_biases(std::span<const BinReport> reports, BandBiases& to);

// Chooses bins for the sensors of a simulation in their turn. States of the same bands along the same paths through the
// air get the same bins, which are found once.
class BinChooser {
 public:
  // sources: resolved; several when they change with time. Both must live as long. heat: of surfaces that wait for the
  // balance of heat; they are taken to stay below kSimulatedBelow as long as it is not known.
  BinChooser(const Scene& scene, std::span<const SourceSpecs> sources, FoundHeat heat = {});
  ~BinChooser();
  // Gives every state of a sensor that asks for it bins for what it sees of the scene. One report a state. Error: a
  // source whose spectrum does not cover the bands.
  std::vector<BinReport> choose(Sensor& sensor);
  size_t found() const { return found_; }  // states whose bins were looked for

 private:
  struct Question;
  struct Answer;
  const Answer& answer(Sensor& sensor, size_t state, bool white_light);
  const Scene& scene_;
  std::span<const SourceSpecs> sources_;
  FoundHeat heat_;
  std::vector<std::pair<Question, Answer>> known_;  // the last ones
  size_t found_ = 0;
};

// The same for one sensor.
std::vector<BinReport> choose_bins(const Scene& scene, std::span<const SourceSpecs> sources, Sensor& sensor,
                                   FoundHeat heat = {});

}  // namespace suite
