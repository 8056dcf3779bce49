// The layers of a slab and the finite volumes they are cut into: what solvers of its heat conduction share.
#pragma once
#include <array>
#include <span>
#include <vector>

namespace suite {

struct SlabLayer {
  double thickness = 0;                   // m, > 0
  double density = 0;                     // kg/m3, > 0
  std::array<double, 5> specific_heat{};  // J/(kg K): coefficients of 1, T, T^2, T^3, T^4; positive for 20..1500 K
  std::array<double, 4> conductivity{};   // W/(m K): coefficients of 1, T, T^2, T^3; positive for 20..1500 K
  double heat_generation = 0;             // W/m3
  double contact_resistance = 0;          // m2 K/W to the next layer below, 0 = perfect contact
  int intervals = 0;                      // of the grid; 0 = chosen from the layer's diffusivity
};

// Nodes lie on the faces and on every layer contact; a resistive contact has two at one depth. Per node: depth (m),
// coefficients of the stored heat in T^1..T^5 (J/m2 K^-m) and heat generation (W/m2); per interval between nodes:
// coefficients of the conductance in T^0..T^3 (W/(m2 K) K^-m). One array a power.
struct SlabGrid {
  std::vector<double> depth, source;
  std::array<std::vector<double>, 5> heat;
  std::array<std::vector<double>, 4> conductance;
};

// Error: no layer; thickness, density, conductivity or specific heat not positive, negative resistance, too many
// intervals.
void check_slab_layers(std::span<const SlabLayer> layers);
// Whether specific heats and conductivities do not depend on temperature.
bool has_constant_properties(std::span<const SlabLayer> layers);
// Layers as checked. resolution: s, automatic grids resolve what diffuses within this time from the top face and, when
// `fast_below`, from the bottom face. Error: more than 100 000 nodes.
SlabGrid make_slab_grid(std::span<const SlabLayer> layers, double resolution, bool fast_below);

}  // namespace suite
