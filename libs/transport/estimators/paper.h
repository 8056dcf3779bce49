// The paper's own estimator, for comparison: one explicit light a node out of sun, moon and all lamps, divided by its
// probability (the paper leaves that open: here all have the same, and no lamp is left out for being far); what is
// asked explicitly does not count when a continuation meets it; skies are met by continuations only; directions are
// drawn at the reference wavelength; no roulette, paths end at max_nodes; independent random numbers (Pipeline). Not
// for media. Its rule of stopping is StopRule::change.
//
// Based on: Goodenough & Brown, sections III-C-2 and IV-A as written.
#pragma once
#include <algorithm>
#include <span>

#include "transport/dimensions.h"
#include "transport/options.h"

namespace suite {

struct PaperEstimator {
  static std::array<double, kMaxKnots> knot_probabilities(size_t) { return {1}; }
  static int draw_knot(double, int) { return 0; }
  static double survival(double, uint64_t, int) { return 1; }
  static double by_chance(const LightNature& light, double) { return light.wide ? 1 : 0; }
  static double asked(double drawn, double, bool) { return drawn; }
  static bool parallel(const LightNature&) { return false; }

  template <class Kernel>
  static void sample_lights(Kernel& kernel, const PipelineOptions&) {
    size_t members = 0;
    for (const auto& light : kernel.lights())
      if (!light.nature.wide) members += light.light->members();
    if (members == 0) return;
    kernel.expect(kernel.nodes().size());
    const double probability = 1.0 / static_cast<double>(members);
    for (const auto& node : kernel.nodes()) {
      std::array<double, 4> u = kernel.numbers(node, dimensions::own_light(0));
      size_t chosen = std::min(members - 1, static_cast<size_t>(u[0] * static_cast<double>(members)));
      for (const auto& light : kernel.lights()) {
        if (light.nature.wide) continue;
        if (chosen >= light.light->members()) {
          chosen -= light.light->members();
          continue;
        }
        if (const auto sample =
                light.light->sample_member(chosen, probability, kernel.receiver(node), u, kernel.time(node)))
          kernel.connect(node, light, *sample, 1);
        break;
      }
    }
  }
};

}  // namespace suite
