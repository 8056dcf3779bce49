// CPU seconds that the diffuse light of a state of spectral bins takes: diffuse_bench.
// 60 bins of 50 layers with 16 streams under a sun, with every azimuth order that counts; 1900 bins of 40 layers with 8
// streams that only emit. Molecules fall off with a height of 8 km, haze of asymmetry 0.7 with one of 1.2 km.
#include <cmath>
#include <cstdio>
#include <vector>

#include "air/discrete_ordinates.h"
#include "support/cpu_clock.h"

namespace {

using namespace suite;

struct Column {
  std::vector<DiffuseLayer> layers;
  std::vector<std::vector<double>> moments;
};

// rayleigh, haze, gas: depths of the whole column.
Column column(int count, double rayleigh, double haze, double gas) {
  Column c;
  c.layers.resize(count);
  c.moments.resize(count);
  for (int l = 0; l < count; ++l) {
    const double top = 60e3 * std::pow(1 - double(l) / count, 2), bottom = 60e3 * std::pow(1 - (l + 1.0) / count, 2);
    const auto part = [&](double height) { return std::exp(-bottom / height) - std::exp(-top / height); };
    const double r = rayleigh * part(8e3), h = haze * part(1.2e3), g = gas * part(4e3);
    for (int degree = 0; degree < 80; ++degree) {
      const double molecules = degree == 0 ? 1 : degree == 2 ? 0.1 : 0;
      c.moments[l].push_back((r * molecules + 0.95 * h * std::pow(0.7, degree)) / (r + 0.95 * h));
    }
    DiffuseLayer& layer = c.layers[l];
    layer.depth = r + h + g;
    layer.albedo = (r + 0.95 * h) / layer.depth;
    layer.moments = c.moments[l];
    layer.planck_top = 2 + 8 * std::exp(-top / 10e3);
    layer.planck_bottom = 2 + 8 * std::exp(-bottom / 10e3);
  }
  return c;
}

void run(const char* name, int bins, int count, int streams, double sun) {
  DiscreteOrdinates solver(streams);
  std::vector<Column> columns;
  for (int b = 0; b < bins; ++b) {
    const double wavelength = sun > 0 ? 0.4 + 2.0 * b / bins : 8 + 6.0 * b / bins;
    columns.push_back(column(count, 0.0088 * std::pow(wavelength, -4.1), 0.15 / wavelength, 0.01 * (1 + b % 8)));
  }
  double up = 0, orders = 0, tables = 0, other = 0;
  std::vector<double> mu, air, ground(16);
  for (int i = 0; i < 16; ++i) mu.push_back(-1 + (i + 0.5) / 8);
  const SourceAngles angles(streams, mu);
  const double start = test::cpu_seconds();
  for (const Column& c : columns) {
    DiffuseProblem problem;
    problem.layers = c.layers;
    problem.beam.irradiance = sun;
    problem.beam.cosine = 0.6;
    problem.ground_albedo = 0.2;
    problem.ground_emission = sun > 0 ? 0 : 8;
    solver.solve(problem);
    up += solver.fluxes({}).up;
    orders += solver.orders();
    const double solved = test::cpu_seconds();
    air.resize(mu.size() * solver.orders());
    for (int l = 0; l < count; ++l)
      for (const double fraction : {0.0, 0.5, 1.0}) solver.sources({l, fraction}, angles, air, ground);
    const double tabulated = test::cpu_seconds();
    tables += tabulated - solved;
    problem.beam.cosine = 0.5;
    solver.set_beam(problem.beam);
    other += test::cpu_seconds() - tabulated;
  }
  const double seconds = test::cpu_seconds() - start - tables - other;
  std::printf(
      "%-7s %4d bins, %d layers, %d streams, %.1f orders: %.3f s, %.2f us a layer and order; sources at 3 places\n"
      "        a layer in 16 directions: %.3f s; another sun: %.3f s (mean flux %.6f)\n",
      name, bins, count, streams, orders / bins, seconds, seconds / (orders * count) * 1e6, tables, other, up / bins);
}

}  // namespace

int main() {
  run("sun", 60, 50, 16, 1000);
  run("thermal", 1900, 40, 8, 0);
  run("sun", 60, 50, 32, 1000);
}
