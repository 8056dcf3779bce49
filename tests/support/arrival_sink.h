// A sink that keeps when light arrives: histograms of the optical path from the light to the sensor, one an order of
// scattering. For states of one bin.
#pragma once
#include <vector>

#include "math/stats.h"
#include "tests/support/radiometry_kit.h"
#include "transport/serve.h"

namespace suite::test {

class ArrivalSink final : public Sink<SpectralThroughputs> {
 public:
  // orders: kept apart, later ones count as the last. step: m a bin.
  ArrivalSink(size_t orders, size_t bins, double step) : bins_(bins), step_(step), light_(orders * (bins + 1)) {}
  void add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) override {
    for (const Contribution& c : stage) {
      if (!c.arrived()) continue;
      const size_t order = std::min<size_t>(c.order, light_.size() / (bins_ + 1) - 1);
      const double at = std::clamp(std::floor(c.arrival / step_), 0.0, static_cast<double>(bins_));
      double L = double{throughputs.throughput(c.path)[0]} * c.factor.scale * c.scale;
      if (c.factor.spectrum) L *= c.factor.spectrum[0];
      if (c.radiance) L *= c.radiance[0];
      light_[order * (bins_ + 1) + static_cast<size_t>(at)] += L;
    }
  }
  // Sum of the radiance that arrived in a bin; that of index `bins` has what came later.
  double light(size_t order, size_t bin) const { return light_[order * (bins_ + 1) + bin]; }
  void clear() { std::fill(light_.begin(), light_.end(), 0.0); }

 private:
  size_t bins_;
  double step_;
  std::vector<double> light_;
};

// Histograms of the light along one ray: mean radiance a path of each order and bin over independent batches.
struct Arrivals {
  Arrivals(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const Ray& ray, size_t orders,
           size_t bins, double step, uint32_t batches, uint32_t paths)
      : values(orders, std::vector<RunningStats>(bins + 1)) {
    const Tracer tracer(scene);
    const SpectralState state = make_state(one_band(), 0.01, 0, 1);
    const Optics optics(*scene, state);
    const Environment environment = bake_environment(sources, tracer, false, optics.state());
    const Surface surface(tracer, optics);
    const PipelineOptions options;
    const KernelContext context{surface, optics, environment, options};
    constexpr uint32_t width = 32;
    SpectralThroughputs throughputs(width, optics.state().size(), 1);
    ArrivalSink sink(orders, bins, step);
    const auto kernel = make_kernel(choose_kernel(context), context, width, throughputs, sink);
    const FlushDenormals flush;
    for (uint32_t batch = 0; batch < batches; ++batch) {
      const SampleStream stream(7, 0, 0, batch);
      TraceStatistics statistics;
      for (uint32_t begin = 0; begin < paths; begin += width) {
        for (uint32_t p = 0; p < width; ++p) {
          throughputs.begin(p, 1, nullptr);
          kernel->start(p, {ray, 1}, stream, begin + p);
        }
        complete(*kernel, tracer, statistics);
      }
      double all = 0;
      for (size_t order = 0; order < orders; ++order)
        for (size_t i = 0; i <= bins; ++i) {
          const double L = sink.light(order, i) / paths;
          values[order][i].add(L);
          all += L;
        }
      total.add(all);
      sink.clear();
    }
  }
  std::vector<std::vector<RunningStats>> values;  // [order][bin]
  RunningStats total;
};

}  // namespace suite::test
