// The standard estimator: every kind of light at every node, shared with the continuations (multiple importance
// sampling, shares.h), directions drawn at several wavelengths, Russian roulette.
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "transport/node.h"
#include "transport/options.h"
#include "transport/shares.h"

namespace suite {

struct StandardEstimator {
  // P_k: the reference keeps at least half of the paths.
  static std::array<double, kMaxKnots> knot_probabilities(size_t knots) {
    std::array<double, kMaxKnots> P{};
    for (size_t k = 0; k < knots; ++k) P[k] = knots == 1 ? 1.0 : k == 0 ? 0.5 : 0.5 / static_cast<double>(knots - 1);
    return P;
  }
  static int draw_knot(double u, int knots) {
    return u < 0.5 ? 0 : 1 + std::min(knots - 2, static_cast<int>((u - 0.5) * 2 * (knots - 1)));
  }
  static double survival(double brightness, uint64_t events, int after) {
    return suite::survival(brightness, events, after);
  }
  // What a light counts that continuations met by chance; other: the density of asking for it over theirs.
  static double by_chance(const LightNature& light, double other) { return 1 / shared_density(1, other, light.disk); }
  // What a sample that was asked for is divided by.
  static double asked(double drawn, double by_chance, bool disk) { return shared_density(drawn, by_chance, disk); }
  // Lights whose rays run alongside each other.
  static bool parallel(const LightNature& light) { return light.far && !light.wide; }

  template <class Kernel>
  static void sample_lights(Kernel& kernel, const PipelineOptions& options) {
    bool parallel = true;
    for (const auto& light : kernel.lights()) {
      if (parallel && !StandardEstimator::parallel(light.nature)) kernel.set_parallel(), parallel = false;
      kernel.expect(kernel.nodes().size() * static_cast<size_t>(light.nature.draws));
      for (const auto& node : kernel.nodes()) {
        const double asks = kernel.asks(node, light);
        if (!(asks > 0)) continue;
        if (light.only)
          kernel.connect(node, light, *light.only, 1, asks);
        else
          sample_one(kernel, node, light, options, asks);
      }
    }
    if (parallel) kernel.set_parallel();
  }

 private:
  template <class Kernel>
  static void sample_one(Kernel& kernel, const PathNode& node, const SampledLight& light,
                         const PipelineOptions& options, double asks) {
    std::array<double, 4> u = kernel.numbers(node, light.use);
    if (light.first_number == 2) u = {u[2], u[3], 0, 0};
    const LightReceiver at = light.nature.far ? LightReceiver{} : kernel.receiver(node);
    const int draws = kernel.is_first(node) && !node.event ? std::min(options.lamp_draws, light.nature.draws) : 1;
    kernel.set_draws(node, light, draws);
    // Strata of the choice; the other numbers are the first one's, turned round.
    const auto turned = [](double x, int k) {
      const double y = x + k * (1.0 / LightNature::kMostDraws);
      return y >= 1 ? y - 1 : y;
    };
    if (draws == 1) {
      if (const auto sample = light.light->sample(at, u, kernel.time(node)))
        kernel.connect(node, light, *sample, 1, asks);
      return;
    }
    std::array<std::array<double, 4>, LightNature::kMostDraws> v;
    std::array<std::optional<LightSample>, LightNature::kMostDraws> drawn;
    const auto count = static_cast<size_t>(draws);
    for (int k = 0; k < draws; ++k)
      v[static_cast<size_t>(k)] = {(k + u[0]) / draws, turned(u[1], k), turned(u[2], k), turned(u[3], k)};
    light.light->sample_all(at, std::span(v).first(count), kernel.time(node), std::span(drawn).first(count));
    for (const auto& sample : std::span(drawn).first(count))
      if (sample) kernel.connect(node, light, *sample, draws);
  }
};

}  // namespace suite
