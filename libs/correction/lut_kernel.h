// Adjacency kernels of a table for atmospheric correction, as bands see them: air_kernel.h over its states and heights,
// weighted by response and sunlight as `transm_up_dif` is.
#pragma once
#include <vector>

#include "correction/air_kernel.h"
#include "correction/lut.h"

namespace suite {

// Of one state and height, views straight down.
struct LutKernel {
  // [radius][band]: share of the light from around that comes from nearer than a radius, and its standard error.
  std::vector<std::vector<double>> within, within_error;
  std::vector<double> total, total_error;  // [band]: diffuse transmittance up, by the photons
  std::vector<double> around;              // [band]: share of all light of an even ground that comes from around
};

// [height], in the table's order. Errors: as air_kernel.
std::vector<LutKernel> lut_kernel(const AirSpec& air, const LutTable& table, size_t state, const LutFineness& fineness,
                                  const KernelSpec& spec);

}  // namespace suite
