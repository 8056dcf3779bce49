// Radiance straight down over an even Lambert ground in real air, without paths: discrete ordinates of a flat column,
// bin by bin. Deterministic, so that bins of different kinds can be compared without noise.
#pragma once
#include <algorithm>
#include <cmath>

#include "air/column.h"
#include "air/discrete_ordinates.h"
#include "base/parallel.h"

namespace suite::test {

struct EvenGround {
  Curve reflectance;
  Curve sun;  // irradiance above the air, W/(m2 um)
  double sun_cosine = 0.8;
  double height = 3000;  // of the view over the ground, m; a level of the air, or above all of it
};

namespace even_air {

// Of some bins; out[i] belongs to bin i of the state.
inline void solve(const AirSpec& air, const SpectralState& state, const EvenGround& ground, double* out) {
  const AirColumn column = bake_column(air, state);
  const std::span<const double> heights = column.shells.heights();
  const size_t layers = column.layers() - column.ground, bins = state.size();
  std::vector<std::vector<float>> phase(column.kinds.size(), std::vector<float>(bins));
  for (size_t k = 0; k < phase.size(); ++k) column.kinds[k].phase->eval(-ground.sun_cosine, phase[k]);
  const std::vector<float> sun = state.sample(ground.sun), rho = state.sample(ground.reflectance);
  size_t view = 0;  // layer, from the top, at whose top the view is
  while (view + 1 < layers && heights[column.layers() - view] - heights[column.ground] > ground.height + 1) ++view;
  DiscreteOrdinates solver(8);
  std::vector<DiffuseLayer> problem_layers(layers);
  std::vector<std::vector<double>> moments(layers);
  std::vector<double> single(layers);
  for (size_t i = 0; i < bins; ++i) {
    for (size_t n = 0; n < layers; ++n) {
      const size_t l = column.layers() - 1 - n, at = l * bins + i;
      double scattered = 0;
      moments[n].assign(10, 0.0), single[n] = 0;
      for (size_t k = 0; k < column.kinds.size(); ++k) {
        const double s = double{column.kinds[k].scattering[at]};
        scattered += s, single[n] += s * double{phase[k][i]};
        const std::vector<double>& of = column.kinds[k].moments[i];
        for (size_t m = 0; m < std::min<size_t>(10, of.size()); ++m) moments[n][m] += s * of[m];
      }
      for (double& m : moments[n]) m /= std::max(scattered, 1e-300);
      single[n] /= std::max(scattered, 1e-300);
      moments[n][0] = 1;
      DiffuseLayer& layer = problem_layers[n];
      const double extinction = double{column.extinction[at]};
      layer.depth = extinction * (heights[l + 1] - heights[l]);
      layer.albedo = extinction > 0 ? std::min(1.0, scattered / extinction) : 0;
      layer.moments = moments[n];
      layer.planck_top = double{column.blackbody[(l + 1) * bins + i]};
      layer.planck_bottom = double{column.blackbody[l * bins + i]};
    }
    DiffuseProblem problem;
    problem.layers = problem_layers;
    problem.beam.irradiance = double{sun[i]};
    problem.beam.cosine = ground.sun_cosine;
    problem.ground_albedo = double{rho[i]};
    problem.ground_emission = (1 - double{rho[i]}) * double{column.blackbody[column.ground * bins + i]};
    problem.azimuth_tolerance = INFINITY;  // straight down there is but the mean over azimuth
    solver.solve(problem);
    out[i] = solver.radiance({static_cast<int>(view), 0}, 1, 0, single);
  }
}

}  // namespace even_air

// Radiance of every bin, W/(m2 sr um).
inline std::vector<double> even_radiance(const AirSpec& air, const SpectralState& state, const EvenGround& ground) {
  constexpr size_t kAtOnce = 256;
  std::vector<double> all(state.size());
  parallel_for(0, (state.size() + kAtOnce - 1) / kAtOnce, 1, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      SpectralState some = state;
      const size_t first = n * kAtOnce, last = std::min(state.size(), first + kAtOnce);
      some.bins.assign(state.bins.begin() + static_cast<long>(first), state.bins.begin() + static_cast<long>(last));
      some.shares.clear(), some.knots = {0};
      even_air::solve(air, some, ground, &all[first]);
    }
  });
  return all;
}

inline std::vector<double> bands_of(const SpectralState& state, std::span<const Band> bands,
                                    const std::vector<double>& radiance) {
  std::vector<double> out(bands.size());
  BandProjection(state, bands).apply(radiance, out);
  return out;
}

}  // namespace suite::test
