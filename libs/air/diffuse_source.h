// Light that the air scatters a second time and more often, as a source along any way through it: what a layer sends
// out into a direction, over what the layer takes out of light there.
//
// Assumes: an even ground; that the source changes linearly with height within a layer, and between the directions of
// the table; that under another height of the sun, as far from the scene, it is brighter or darker in all directions
// alike.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

class DiffuseSource {
 public:
  // Directions: cosines with the vertical, ascending from -1 to 1, and azimuths from that of the only beam on (0 to
  // pi), or around where there are several; one where nothing depends on it.
  struct Axes {
    std::vector<double> cosines;
    size_t azimuths = 1;
    std::optional<double> symmetric;  // azimuth of the beam, rad
  };
  DiffuseSource(size_t layers, size_t bins, Axes axes);

  // Where a direction lies between those of the table.
  struct Corners {
    size_t at[4];
    float weight[4];
  };
  Corners corners(double cosine, double azimuth) const;
  // W/(m2 sr um), at the lower (0) or upper (1) end of a layer; per bin.
  std::span<float> at(size_t layer, int end, size_t direction) {
    return {&table_[((layer * 2 + static_cast<size_t>(end)) * directions() + direction) * bins_], bins_};
  }
  const float* at(size_t layer, int end, size_t direction) const {
    return &table_[((layer * 2 + static_cast<size_t>(end)) * directions() + direction) * bins_];
  }
  size_t directions() const { return axes_.cosines.size() * axes_.azimuths; }
  const Axes& axes() const { return axes_; }
  size_t direction(size_t cosine, size_t azimuth) const { return cosine * axes_.azimuths + azimuth; }
  // The same under other heights of the only beam: what the source is to be multiplied with, over that at the origin.
  struct Suns {
    std::vector<double> zenith;  // rad, ascending; empty: it does not matter
    double at_origin = 0;        // cosine
    std::vector<float> factor;   // [sun][layer][bin]
  };
  void set_suns(std::vector<double> zenith, double at_origin);
  bool low_sun() const { return !suns_.zenith.empty(); }
  std::span<float> factor(size_t sun, size_t layer) { return {&suns_.factor[(sun * layers_ + layer) * bins_], bins_}; }
  const Suns& suns() const { return suns_; }
  // Multiplies sources of a layer for a place where the beam stands at this cosine; per bin.
  void relight(size_t layer, double cosine, float* near, float* far) const;

  // Of an azimuth of the table, rad.
  double azimuth(size_t index) const;

 private:
  Axes axes_;
  size_t layers_, bins_;
  std::vector<float> table_;
  Suns suns_;
};

}  // namespace suite
