// What real air makes of light along slanted paths through it, for choosing bins and for judging them: sunlight down to
// the ground and up again, sunlight that the air scatters once, what other lights send, and what ground and air emit,
// each through the gases.
//
// Paths run through flat layers; a low sun's or a level path's air mass ends at 10. Heights and slants are those of the
// sensor's own rays and suns and some to both sides; those that bins are judged by (held out) are others than those
// that they are chosen by, but for the sensor's own.
#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "scheduler/seen_spectra.h"

namespace suite {

enum class PathSet { training, held_out };

class AirPaths {
 public:
  // sources: resolved, with real air; several when they change with time.
  AirPaths(std::span<const SourceSpecs> sources, const Sensor& sensor, size_t state);
  ~AirPaths();
  AirPaths(AirPaths&&) noexcept;
  // Lights and glows; what makes them is shared and lives as long.
  std::vector<SeenSpectra> spectra(PathSet set) const;
  // What of the sensor enters: heights, then air masses of views. Equal ones have equal paths under the same sources.
  std::vector<double> key() const;
  // Vertical depth of gases over the ground, per bin.
  std::vector<float> gas_depth(const SpectralState& state) const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace suite
