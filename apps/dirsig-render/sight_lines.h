// Along which lines a picture looks: whether it can be laid onto a map, and the RPCs that stand for it.
#pragma once
#include <optional>
#include <vector>

#include "ground_places.h"
#include "motion/rpc.h"
#include "sensor/delivery.h"

namespace suite {

// The mean line of sight of a pixel over its area, its exposure and the blur of its optics.
struct SightLine {
  uint32_t column = 0, row = 0;
  Vec3 origin;    // m, scene ENU
  Dir direction;  // away from the sensor
};

// Those of a regular choice of pixels of a picture whose rows come in parts.
class SightLines {
 public:
  SightLines(uint32_t columns, uint32_t rows);
  // A part that begins at a row of the picture; its sensor is asked for rays.
  void add(const Delivery& part, uint32_t first_row);
  const std::vector<SightLine>& lines() const { return lines_; }

 private:
  uint32_t columns_, rows_;
  std::vector<SightLine> lines_;
};

// Whether the horizon is in view, or nearly: a line of sight misses the ground at the lowest of the places, or meets it
// at less than kLeastElevation.
inline constexpr double kLeastElevation = 3;  // degrees
bool horizon_in_view(const std::vector<SightLine>& lines, const GroundPlaces& places);

// Coefficients that follow the lines of sight over the heights of the places and some more. Nothing where they do not
// (fisheyes, horizons), or the scene is not on the Earth.
struct FittedRpc {
  Rpc rpc;
  double rms = 0, largest = 0;  // pixels: of the places of all pixels, against where the coefficients see them
};
std::optional<FittedRpc> rpc_of(const std::vector<SightLine>& lines, const GroundPlaces& places);

}  // namespace suite
