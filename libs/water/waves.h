// Waves of a wind sea as a sum of many plane waves whose lengths and headings are drawn at random: the surface never
// repeats itself, in space or in time.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"

namespace suite {

// pierson_moskowitz  fully grown seas, gravity waves (W. Pierson & L. Moskowitz, J. Geophys. Res. 69, 1964)
// jonswap            growing with fetch (K. Hasselmann et al., Dtsch. Hydrogr. Z. A8(12), 1973; peakedness 3.3)
// elfouhaily         from swell to capillary waves (T. Elfouhaily et al., "A unified directional spectrum for long and
//                    short wind-driven waves", J. Geophys. Res. 102, 1997)
enum class WaveSpectrum { pierson_moskowitz, jonswap, elfouhaily };

struct SeaState {
  WaveSpectrum spectrum = WaveSpectrum::elfouhaily;
  double wind_m_s = 7;   // at 10 m, 0.5 to 40; 0 = flat water, whose spectrum is 0
  double fetch_m = 1e6;  // over which it blows, 100 to 1e7; pierson_moskowitz does not know it
  double toward = 0;     // rad, mathematical azimuth that the wind blows to
  double depth_m = 1e4;  // of the water, above 0: dispersion only, the spectrum is that of deep water
};
// Error, located at `where`: out of these ranges.
void check_sea_state(const SeaState& sea, const Where& where = {});

// Variance of the height per wave number k (rad/m, above 0) over all headings, m3. All spectra end at the shortest wind
// waves (kShortestWave); the two older ones fall as k^-3 until there.
double wave_spectrum(const SeaState& sea, double k);
inline constexpr double kShortestWave = 1500;  // rad/m
double peak_wave_number(const SeaState& sea);  // rad/m; 0 without wind
// rad/s: gravity and surface tension (km 370 rad/m, as Elfouhaily et al.), finite depth.
double wave_frequency(const SeaState& sea, double k);
// Integrals of the spectrum from low to high (rad/m): variance of height (m2), mean square slope of both directions.
double height_variance(const SeaState& sea, double low, double high);
double slope_variance(const SeaState& sea, double low, double high);

class Waves {
 public:
  // `count` waves from a fifth of the peak's wave number to `shortest` (rad/m), in classes even in the logarithm, one
  // of random length each; headings by the spectrum's spreading (elfouhaily: 1 + D cos(2 a), the waves with the wind;
  // else cos^2), phases at random. Same seed, same sea. shortest: above half of the peak's wave number. count >= 16.
  Waves(const SeaState& sea, double shortest, size_t count, uint64_t seed);
  double height(double x, double y, double time) const;  // m above the mean
  // The same at heights.size() places from (x, y) on, `step` apart along x, some four times as fast.
  void row(double x, double y, double step, double time, std::span<float> heights) const;
  double variance() const;  // of the height, m2, of this sum

 private:
  struct Wave {
    double kx, ky, frequency, phase, amplitude;
  };
  std::vector<Wave> waves_;
};

}  // namespace suite
