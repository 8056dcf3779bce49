// Light that the air scatters a second time and more often, with its polarisation: what the scalar source
// (diffuse_source.h) lacks, as modes of I, Q, U and, where it is asked for, V in azimuth.
//
// I is a difference: the vector field less the scalar one, both by stokes_field.h, so that what they have in common
// (a round Earth, emission, forward peaks) stays that of the scalar source. Q and U are all there is. They come from
// what tells its matrices: molecules, and particles where their phase function does; the rest depolarises.
//
// Assumes: plane layers under beams that come as through a round Earth; that no light which the air emits is polarised
// by scattering.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "air/diffuse_setup.h"
#include "math/stokes_parts.h"

namespace suite {

class PolarisedSource {
 public:
  // Ways through the air by cosines with the vertical, ascending from -1 to 1; light travels against them.
  struct Shape {
    size_t layers = 0, bins = 0, beams = 0, orders = 0;
    std::vector<double> cosines;
    StokesParts kept = StokesParts::linear;
    size_t parts() const { return kept == StokesParts::all ? 4 : 3; }
  };
  // Error: the table takes more than 2 GB.
  explicit PolarisedSource(Shape shape);

  enum Part : size_t { i, q, u, v };
  // W/(m2 sr um), at the lower (0) or upper (1) end of a layer, over its extinction: the factor of cos(m phi), of U
  // and V that of sin(m phi), with phi from the beam's azimuth to that of the way. Per bin.
  std::span<float> at(size_t beam, size_t layer, size_t end, size_t cosine, size_t order, Part part) {
    return {&table_[index(beam, layer, end, cosine, order, part)], shape_.bins};
  }
  const float* at(size_t beam, size_t layer, size_t end, size_t cosine, size_t order, Part part) const {
    return &table_[index(beam, layer, end, cosine, order, part)];
  }
  // Between which cosines one lies: the first, and the share of the second.
  struct Place {
    size_t first = 0;
    float share = 0;
  };
  Place place(double cosine) const;
  const Shape& shape() const { return shape_; }

 private:
  size_t index(size_t beam, size_t layer, size_t end, size_t cosine, size_t order, Part part) const {
    const size_t row = ((beam * shape_.layers + layer) * 2 + end) * shape_.cosines.size() + cosine;
    return ((row * shape_.orders + order) * shape_.parts() + part) * shape_.bins;
  }
  Shape shape_;
  std::vector<float> table_;
};

// depths: of each beam, of level_depths(). Null where nothing polarises what it scatters.
std::shared_ptr<const PolarisedSource> solve_polarised_source(const AirSpec& spec, const AirColumn& column,
                                                              const SpectralState& state,
                                                              std::span<const AirBeam> beams,
                                                              std::span<const std::vector<double>> depths,
                                                              StokesParts parts = StokesParts::linear);

}  // namespace suite
