// What a round Earth makes of the diffuse light in its air: the difference from flat layers of the same depths.
//
// Method: light that arrives at every level from every side is summed up along straight ways, once through shells and
// once through flat layers, from the same sources (sunlight scattered once, the field of discrete ordinates, emission,
// the ground). The difference is scattered by the layers and reflected by the ground, and makes more of itself, until
// that is little. So the ground fills less than half of the directions of a place in the height, level ways leave the
// air, and errors of the quadrature cancel.
//
// Assumes: sources that are the same everywhere at a height, but for the azimuth, of which the mean counts: what grows
// towards the sun as much as it falls away from it cancels (not where the Earth's shadow runs through the air).
// Error: radiances along the limb within 1.0 % (5 to 60 km, suns of 53 and 84 degrees), out of the air within 1.6 %
// (suns to 88 degrees), of molecules and dust beside SASKTRAN2 (tests/physics/light/air_views_test.cpp).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "air/shells.h"

namespace suite {

// Directions in which light arrives at every level: Gauss's rule over what lies above, over what lies below and leaves
// the air again, and over the ground, denser towards the horizon.
class AirNodes {
 public:
  AirNodes(const Shells& shells, size_t ground);
  static constexpr size_t count() { return kUp + kLimb + kDown; }
  // Of levels from the ground's on; cosines are positive upwards, the weights of a level sum to 2.
  double cosine(size_t level, size_t node) const { return cosines_[level * count() + node]; }
  double weight(size_t level, size_t node) const { return weights_[level * count() + node]; }

 private:
  static constexpr size_t kUp = 14, kLimb = 8, kDown = 10;
  std::vector<double> cosines_, weights_;
};

// Straight ways from every level, in every direction of a quadrature, through layers; the same for all bins.
class AirWays {
 public:
  // Where a way enters or leaves a layer: a direction of the table of sources (cosine of the way with the vertical,
  // between at and at + 1), and how high in the layer (0 to 1).
  struct End {
    uint32_t at = 0;
    float share = 0, height = 0;
  };
  struct Step {
    uint32_t layer = 0;  // of the shells
    float length = 0;    // m
    End near, far;
  };
  struct Way {
    uint32_t first = 0, last = 0;  // steps
    bool ground = false;           // it ends there
  };
  // ground: level that ways end at. cosines: of the table, ascending from -1 to 1; kept as a copy.
  AirWays(const Shells& shells, size_t ground, AirNodes nodes, std::vector<double> cosines);

  size_t levels() const { return levels_; }  // from the ground's on
  const AirNodes& nodes() const { return nodes_; }
  const std::vector<double>& cosines() const { return cosines_; }
  const Way& way(size_t level, size_t node) const { return ways_[level * AirNodes::count() + node]; }
  size_t size() const { return steps_.size(); }
  std::span<const Step> steps(const Way& w) const { return {&steps_[w.first], w.last - w.first}; }

 private:
  End end(double cosine, double height) const;
  AirNodes nodes_;
  std::vector<double> cosines_;
  std::vector<Way> ways_;
  std::vector<Step> steps_;
  size_t levels_ = 0;
};

// Sources by layer from the ground's on, end (0 = the lower one) and cosine of the table: over depth, per sr.
struct AirSources {
  std::vector<float> values;
  size_t cosines = 0;
  double ground = 0;  // radiance of the ground
  AirSources(size_t layers, size_t count) : values(layers * 2 * count), cosines(count) {}
  float& at(size_t layer, int end, size_t cosine) { return values[index(layer, end) + cosine]; }
  const float* row(size_t layer, int end) const { return &values[index(layer, end)]; }

 private:
  size_t index(size_t layer, int end) const { return (layer * 2 + static_cast<size_t>(end)) * cosines; }
};

// A layer at one wavelength.
struct RoundLayer {
  double extinction = 0;            // 1/m
  double albedo = 0;                // of single scattering
  std::span<const double> moments;  // of its phase function, [0] = 1
};

struct RoundFluxes {
  double down = 0;    // on the ground
  double top_up = 0;  // out of the highest level
};

// One a thread: keeps its storage.
class RoundLight {
 public:
  // Ways through the shells and through flat layers of the same heights; kept as references.
  RoundLight(const AirWays& round, const AirWays& flat, size_t moments);
  // Legendre's polynomials of a cosine of the table, by degree.
  const double* legendre(size_t cosine) const { return &legendre_cosines_[cosine * moments_]; }
  // more: becomes what the sources gain, beyond those of flat layers; returned: what diffuse fluxes gain. layers from
  // the ground's on; sources: all of them, with sunlight scattered once and emission.
  RoundFluxes solve(std::span<const RoundLayer> layers, const AirSources& sources, double ground_albedo,
                    AirSources& more);

 private:
  struct Weights {
    float near, far;
  };
  void weigh(const AirWays& ways, std::span<const RoundLayer> layers);
  void arrive(const AirWays& ways, const AirSources& sources, double sign);
  void scatter(std::span<const RoundLayer> layers, AirSources& to);
  double flux(size_t level, bool down) const;

  const AirWays &round_, &flat_;
  size_t moments_;
  std::vector<double> legendre_nodes_, legendre_cosines_;  // [level][node] or [cosine], [moment]
  std::vector<Weights> weights_;                           // by step
  std::vector<float> grounds_;                             // by way: what is left of the ground's light
  std::vector<double> light_, base_;                       // [level][node]
};

}  // namespace suite
