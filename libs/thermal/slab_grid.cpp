// The finite volumes of layers: checks, interval lengths, coefficients of heat and conductance.
#include "thermal/slab_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace suite {

namespace {

constexpr size_t kMostNodes = 100000;
constexpr double kColdest = 20, kHottestSlab = 1500;  // K, where the property polynomials must stay positive

template <size_t N>
double polynomial(const std::array<double, N>& c, double x) {
  double v = 0;
  for (size_t i = N; i-- > 0;) v = v * x + c[i];
  return v;
}

template <size_t N>
void check_positive(const std::array<double, N>& c, const char* what, const std::string& layer) {
  for (int i = 0; i <= 64; ++i) {
    const double T = kColdest * std::pow(kHottestSlab / kColdest, i / 64.0), v = polynomial(c, T);
    if (!(v > 0 && std::isfinite(v)))
      throw Error(layer + strf(": the %s is %g at %g K", what, v, T),
                  strf("it must be positive from %g to %g K", kColdest, kHottestSlab));
  }
}

void check_layer(const SlabLayer& l, size_t number) {
  const std::string name = strf("layer %zu of a slab", number);
  if (!(l.thickness > 0 && l.thickness <= 1e6))
    throw Error(name + strf(": thickness %g m", l.thickness), "more than 0, at most 1e6 m");
  if (!(l.density > 0 && l.density <= 1e5))
    throw Error(name + strf(": density %g kg/m3", l.density), "more than 0, at most 1e5 kg/m3");
  check_positive(l.specific_heat, "specific heat", name);
  check_positive(l.conductivity, "conductivity", name);
  if (!std::isfinite(l.heat_generation)) throw Error(name + ": heat generation is not finite");
  if (!(l.contact_resistance >= 0 && std::isfinite(l.contact_resistance)))
    throw Error(name + strf(": contact resistance %g m2 K/W", l.contact_resistance), "0 or more");
  if (l.intervals < 0 || l.intervals > 50000)
    throw Error(name + strf(": %d intervals", l.intervals), "0 (automatic) to 50000");
}

// Interval lengths of a layer, from the top down. `above` and `below`: distances of its top and bottom from the faces
// that change fast (infinite when there is none).
std::vector<double> intervals_of(const SlabLayer& l, double above, double below, double resolution) {
  if (l.intervals > 0) return std::vector<double>(static_cast<size_t>(l.intervals), l.thickness / l.intervals);
  const double diffusivity = polynomial(l.conductivity, 300.0) / (l.density * polynomial(l.specific_heat, 300.0));
  // A step of flux on a thick solid comes within 5e-4 of its rise at half the resolution and after.
  const double finest = 0.15 * std::sqrt(diffusivity * resolution);
  constexpr double kGrowth = 0.075;  // per length of distance from the face
  std::vector<double> lengths;
  double z = 0;
  while (z < l.thickness && lengths.size() <= kMostNodes) {
    const double distance = std::fmin(above + z, below + l.thickness - z);
    lengths.push_back(std::fmin(finest + kGrowth * distance, l.thickness / 3));
    z += lengths.back();
  }
  for (double& h : lengths) h *= l.thickness / z;
  return lengths;
}

}  // namespace

void check_slab_layers(std::span<const SlabLayer> layers) {
  if (layers.empty()) throw Error("a slab without a layer", "give at least one");
  for (size_t i = 0; i < layers.size(); ++i) check_layer(layers[i], i + 1);
}

bool has_constant_properties(std::span<const SlabLayer> layers) {
  const auto not_zero = [](double c) { return c != 0; };
  return std::none_of(layers.begin(), layers.end(), [&](const SlabLayer& l) {
    return std::any_of(l.specific_heat.begin() + 1, l.specific_heat.end(), not_zero) ||
           std::any_of(l.conductivity.begin() + 1, l.conductivity.end(), not_zero);
  });
}

SlabGrid make_slab_grid(std::span<const SlabLayer> layers, double resolution, bool fast_below) {
  SlabGrid grid;
  double total = 0;
  for (const SlabLayer& l : layers) total += l.thickness;
  auto add_node = [&grid](double z) {
    grid.depth.push_back(z);
    for (auto& c : grid.heat) c.push_back(0);
    grid.source.push_back(0);
  };
  add_node(0);
  double z = 0;
  for (size_t k = 0; k < layers.size(); ++k) {
    const SlabLayer& l = layers[k];
    const double below = fast_below ? total - z - l.thickness : INFINITY;
    for (const double h : intervals_of(l, z, below, resolution)) {
      // Half of the interval's heat and source go to the node at each end.
      add_node(grid.depth.back() + h);
      for (const size_t node : {grid.depth.size() - 2, grid.depth.size() - 1}) {
        for (size_t m = 0; m < 5; ++m)
          grid.heat[m][node] += l.density * h / 2 * l.specific_heat[m] / static_cast<double>(m + 1);
        grid.source[node] += l.heat_generation * h / 2;
      }
      for (size_t m = 0; m < 4; ++m) grid.conductance[m].push_back(l.conductivity[m] / h);
      if (grid.depth.size() > kMostNodes)
        throw Error(strf("a slab needs more than %zu nodes", kMostNodes),
                    "give a coarser resolution or the number of intervals");
    }
    z += l.thickness;
    grid.depth.back() = z;
    if (l.contact_resistance > 0 && k + 1 < layers.size()) {
      add_node(z);  // the other side of the contact
      for (size_t m = 0; m < 4; ++m) grid.conductance[m].push_back(m == 0 ? 1 / l.contact_resistance : 0);
    }
  }
  return grid;
}

}  // namespace suite
