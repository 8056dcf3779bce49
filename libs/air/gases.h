// Absorption by gases over an interval of wavelengths, as a k-distribution: a few monochromatic points with weights.
//
// Assumes: within an interval each gas is perfectly correlated over height, gases overlap at random. A point stands for
// the same part of the interval at all levels, so products of transmittances along any path are right point by point.
// Based on: A. Lacis, V. Oinas, "A description of the correlated k distribution method", J. Geophys. Res. 96, 1991
// (random overlap). The parts are grouped here by their vertical depth and not sorted again at each level: two gases of
// which one lies low and the other high stay independent.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "air/continuum.h"
#include "air/gas_limits.h"
#include "air/profile.h"

namespace suite {

struct GasPoints {
  std::vector<double> weight;     // of the points; sum 1
  std::vector<float> absorption;  // [level][point], 1/m

  size_t count() const { return weight.size(); }
};

// Where the k-distributions come from. Const members may be called from many threads at once.
class GasProvider {
 public:
  virtual ~GasProvider() = default;
  // The range that it knows; beyond it nothing may be asked.
  virtual double low_um() const = 0;
  virtual double high_um() const = 0;
  // Source and stated error, a sentence.
  virtual std::string note() const = 0;
  // Ranges where it is less sure than the note says; none: nothing is known of it.
  virtual std::vector<GasLimit> limits() const { return {}; }

  // A part of the spectrum within which a distribution holds, cm-1. index: the provider's own.
  struct Band {
    double low_cm = 0, high_cm = 0;
    size_t index = 0;
  };
  // The bands that meet an interval, each as far as it lies in it, ascending and without gaps. 0 < low_cm < high_cm, in
  // range.
  virtual std::vector<Band> bands(double low_cm, double high_cm) const = 0;
  // What absorbs in a band, one entry for what is independent of the rest; 1 point for what is smooth.
  virtual std::vector<GasPoints> absorbers(const Band& band, std::span<const AirLevel> levels) const = 0;
};

struct GasReduction {
  int most = 4;          // points of an interval, 1 to 16
  double thin = 0.02;    // one point where the column over all levels takes less of the light
  double error = 0.002;  // fewer points where the transmittance of 1e-5 to 5 columns stays within
};
// The points of an interval at the levels (ascending, two at least), the most transparent first. A point's absorption
// is the one by which its part of the interval lets through as much as it does: over twice the column where that is
// transparent, over its own mean free path where it is opaque. Error: an interval that is none or that the provider
// does not know.
GasPoints gas_points(const GasProvider& provider, std::span<const AirLevel> levels, double low_um, double high_um,
                     const GasReduction& reduction = {});

// Vertical depth of each point over the levels; between them absorption runs exponentially (linearly to a zero).
std::vector<double> vertical_depths(const GasPoints& points, std::span<const AirLevel> levels);

// Spectra of LOWTRAN 7 with laws fitted line by line (band_fits.h), 0.2 um to 1 mm; lowtran.h has LOWTRAN itself. The
// second form takes another continuum of water. Error as check_continuum.
const GasProvider& builtin_gases();
inline std::shared_ptr<const GasProvider> shared_builtin_gases() { return {std::shared_ptr<void>(), &builtin_gases()}; }
std::unique_ptr<GasProvider> builtin_gases(WaterContinuum continuum);
// The builtin continuum of water in the form of MT_CKD, to go with lines: 0 to 20000 cm-1.
WaterContinuum builtin_continuum();

}  // namespace suite
