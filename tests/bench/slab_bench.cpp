// Slab steps per second, at the number of nodes given: constant properties (one elimination a stage), properties that
// depend on temperature (Newton's method), and adaptive days.
#include <benchmark/benchmark.h>

#include <cmath>

#include "math/vec.h"
#include "thermal/slab.h"

namespace suite {
namespace {

SlabSpec ground(int nodes, bool depends_on_temperature) {
  SlabLayer l;
  l.thickness = 0.5;
  l.density = 1800;
  l.specific_heat = {850};
  l.conductivity = {0.9};
  if (depends_on_temperature) {
    l.specific_heat[1] = 0.5;
    l.conductivity[3] = 1e-9;
  }
  l.intervals = nodes - 1;
  SlabSpec spec;
  spec.layers = {l};
  spec.top.kind = SlabFace::Kind::surface;
  spec.top.convection_still = 10;
  spec.top.loads = [](double t) {
    return SurfaceLoad{600 * std::fmax(0.0, -std::cos(2 * kPi * t / 86400)), 330, 290, 0};
  };
  spec.bottom.value = [](double) { return 0.0; };
  return spec;
}

void fixed_steps(benchmark::State& state, bool depends_on_temperature) {
  Slab slab(ground(static_cast<int>(state.range(0)), depends_on_temperature), {});
  slab.start(0, 290);
  for (auto _ : state) benchmark::DoNotOptimize(slab.step(60));
  state.counters["slab_steps/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
void constant_properties(benchmark::State& state) { fixed_steps(state, false); }
void properties_of_temperature(benchmark::State& state) { fixed_steps(state, true); }

void adaptive_day(benchmark::State& state) {
  Slab slab(ground(static_cast<int>(state.range(0)), false), {});
  slab.start(0, 290);
  double t = 0;
  for (auto _ : state) slab.advance(t += 86400);
  state.counters["slab_steps/s"] = benchmark::Counter(
      static_cast<double>(slab.counters().steps + slab.counters().rejected), benchmark::Counter::kIsRate);
  state.counters["steps/day"] = static_cast<double>(slab.counters().steps) / static_cast<double>(state.iterations());
}

BENCHMARK(constant_properties)->Arg(20)->Arg(100);
BENCHMARK(properties_of_temperature)->Arg(20)->Arg(100);
BENCHMARK(adaptive_day)->Arg(20);

}  // namespace
}  // namespace suite

BENCHMARK_MAIN();
