// Temperatures that the weather makes: found before anything is rendered, or read from a file.
#pragma once
#include <memory>
#include <string>

#include "cluster/ranks.h"
#include "formats/sim_text/sim_text.h"
#include "heat/heat_balance.h"
#include "options.h"

namespace suite {

// Whether a sensor would see what weather does to temperatures, or asks for them.
bool sees_heat(const Simulation& simulation, const RenderOptions& options);

// Wavelengths that the balance looks at, um, beside those of the sensors.
std::vector<std::array<double, 2>> heat_windows_um();

// What the renderer is told of surfaces that wait for the balance. Writes FOLDER/heat.h5 and FOLDER/heat.csv where it
// was found here and a folder is given, and tells notes, balance and errors. Error: a scene with such surfaces and a
// simulation without `heat`; captures outside of the span; as its parts.
// ranks: null of a process alone; else the first one finds (or reads) temperatures, and the others are told.
Heating heating_of(const std::shared_ptr<const Scene>& scene, const Simulation& simulation, const JobOptions& job,
                   const RenderOptions& options, const std::string& folder, Ranks* ranks);

// Tells what the temperatures at points took (`final_gather`).
void report_points(const Heating& heating);

// --dry-run: elements, rays, memory; empty where no temperatures are to be found. Error: as heating_of().
std::string heat_forecast(const std::shared_ptr<const Scene>& scene, const Simulation& simulation,
                          const JobOptions& job, const RenderOptions& options);

}  // namespace suite
