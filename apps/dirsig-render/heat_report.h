// What is written of temperatures that were found: tables, a page of curves, what is told.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "formats/sim_text/sim_text.h"
#include "heat/day_sun.h"
#include "heat/heat_balance.h"
#include "heat/heat_optics.h"

namespace suite {

// All that temperatures were found with.
struct PreparedHeat {
  std::unique_ptr<const Tracer> tracer;
  HeatOptics optics;
  std::shared_ptr<Elements> elements;
  std::unique_ptr<HeatFaces> faces;
  HeatSpec spec;
  HeatCut cut;  // what the elements were made with
};

// Where temperatures are not found: reports what in the scene may heat its neighbours until a sensor sees them glow.
void report_hot_neighbours(const Scene& scene, const Simulation& sim);

// Elements, rays, errors, the balance: sentences.
std::vector<std::string> heat_sentences(const HeatResult& result, const PreparedHeat& prepared, double seconds);
// What the audit found, in a sentence; and every probe with both its walks, as CSV.
std::string audit_sentence(const HeatAudit& audit);
std::string audit_table(const HeatAudit& audit, const PreparedHeat& prepared, const Scene& scene);
// CSV: means over the faces of each material, by moment.
std::string heat_table(const HeatResult& result, const PreparedHeat& prepared, const Scene& scene,
                       const Simulation& sim);
// CSV: every flux of the elements that the probes are nearest to, by moment. Empty without probes.
std::string heat_probes(const HeatResult& result, const PreparedHeat& prepared, const WeatherLoads& weather,
                        const Scene& scene, const Simulation& sim);
// HTML: curves of every material, and of the probes, through the span.
std::string heat_page(const HeatResult& result, const PreparedHeat& prepared, const WeatherLoads& weather,
                      const Scene& scene, const Simulation& sim, const std::vector<std::string>& sentences);

}  // namespace suite
