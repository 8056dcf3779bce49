// Steps of elements per second: slabs in lockstep beside the single slab, at the number of nodes given; and a whole
// periodic day. One core.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/parallel.h"
#include "heat/slab_batch.h"
#include "heat/surfaces.h"
#include "math/vec.h"
#include "spectral/planck.h"
#include "support/slab_kit.h"

namespace suite {
namespace {

constexpr size_t kElements = 1024;

SlabLayer ground(benchmark::State& state) {
  return test::uniform(0.5, 1800, 850, 0.9, static_cast<int>(state.range(0)) - 1);
}
double sun(double t) { return 600 * std::fmax(0.0, -std::cos(2 * kPi * t / 86400)); }

void count(benchmark::State& state, double steps) {
  state.counters["element_steps/s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
}

// Elements differ by their share of the sun.
BatchLoads loads() {
  return [](double begin, double end, const SlabBatch& batch, FaceLines& top, FaceLines&) {
    const double a = sun(begin), b = sun(end);
    for (size_t e = 0; e < batch.elements(); ++e) {
      const double share = static_cast<double>(e) / static_cast<double>(batch.elements());
      top.constant[e] = {share * a + 0.95 * 330 + 10 * 290, share * b + 0.95 * 330 + 10 * 290};
      top.linear[e] = {10, 10};
      top.quartic[e] = 0.95 * kStefanBoltzmann;
    }
  };
}

void batch_steps(benchmark::State& state) {
  SlabBatch batch({ground(state)}, kElements);
  batch.start(0, 290);
  const BatchLoads day = loads();
  for (auto _ : state) batch.step(600, day);
  count(state, static_cast<double>(state.iterations()) * kElements);
}

// Properties that depend on temperature.
void warm_batch_steps(benchmark::State& state) {
  SlabLayer layer = ground(state);
  layer.specific_heat[1] = 0.5;
  layer.conductivity[3] = 1e-9;
  SlabBatch batch({layer}, kElements);
  batch.start(0, 290);
  const BatchLoads day = loads();
  for (auto _ : state) batch.step(600, day);
  count(state, static_cast<double>(state.iterations()) * kElements);
}

void single_steps(benchmark::State& state) {
  SlabSpec spec;
  spec.layers = {ground(state)};
  spec.top = test::surface(
      0.95,
      [](double t) {
        return SurfaceLoad{sun(t), 330, 290, 0};
      },
      10);
  spec.bottom = test::flux(0);
  Slab slab(spec, {});
  slab.start(0, 290);
  for (auto _ : state) benchmark::DoNotOptimize(slab.step(600));
  count(state, static_cast<double>(state.iterations()));
}

// Periodic days of 144 steps to 0.01 K, the sweeps counted as steps.
void periodic_day(benchmark::State& state) {
  const std::vector<double> steps(144, 600.0);
  double sweeps = 0;
  for (auto _ : state) {
    SlabBatch batch({ground(state)}, kElements);
    batch.start(0, 290);
    sweeps += find_periodic(batch, 0, steps, loads(), {0.01, 60}).sweeps;
  }
  count(state, sweeps * 144 * kElements);
  state.counters["sweeps"] = sweeps / static_cast<double>(state.iterations());
  state.counters["elements/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kElements, benchmark::Counter::kIsRate);
}

// A periodic day coupled by random exchange, half of it with the sky: walls under TARP with 64 shares each, one core.
void coupled_day(benchmark::State& state) {
  const auto count = static_cast<size_t>(state.range(0));
  ExchangeMatrix exchange(count, 1);
  SurfaceGroup walls;
  walls.layers = {test::uniform(0.3, 1800, 850, 0.9)};
  walls.front.convection = make_convection({"tarp", {}, ""});
  SurfaceLoads loads;
  loads.steps.assign(144, 600);
  uint32_t random = 1;
  std::vector<float> absorbed;
  for (uint32_t e = 0; e < count; ++e) {
    std::vector<ExchangeMatrix::Entry> row{{static_cast<uint32_t>(count), 0.5}};
    for (int k = 0; k < 64; ++k) {
      random = random * 1664525u + 1013904223u;
      row.push_back({(random >> 8) % static_cast<uint32_t>(count), 0.5 / 64});
    }
    exchange.add_row(row);
    walls.front_rows.push_back(e);
    for (int k = 0; k <= 144; ++k)
      absorbed.push_back(static_cast<float>(sun(600.0 * k) * static_cast<double>(e) / static_cast<double>(count)));
  }
  loads.absorbed = CompactRows(absorbed, 145);
  loads.air = {{0, 86400}, {285, 285}, {2, 2}, {0, 0}, true};
  loads.outside.assign(145, 320);
  set_threads(1);
  int sweeps = 0;
  for (auto _ : state) {
    CoupledSurfaces surfaces({walls}, exchange);
    surfaces.start(285);
    SurfaceOptions options;
    options.past.tolerance = options.coupling.tolerance = 0.01;
    sweeps = surfaces.solve(loads, options).coupling.sweeps;
  }
  state.counters["sweeps"] = sweeps;
  state.counters["elements/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(count), benchmark::Counter::kIsRate);
}

BENCHMARK(batch_steps)->Arg(12)->Arg(24)->Arg(48);
BENCHMARK(warm_batch_steps)->Arg(24);
BENCHMARK(single_steps)->Arg(12)->Arg(24)->Arg(48);
BENCHMARK(periodic_day)->Arg(24)->Unit(benchmark::kMillisecond);
BENCHMARK(coupled_day)->Arg(4096)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace suite

BENCHMARK_MAIN();
