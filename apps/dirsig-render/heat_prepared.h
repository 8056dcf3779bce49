// What a search for temperatures needs, made of a scene and a simulation.
#pragma once
#include <memory>
#include <optional>

#include "formats/heat_hdf/heat_hdf.h"
#include "heat_report.h"

namespace suite {

HeatWeather weather_of(const Simulation& simulation, const Scene& scene);
// cut: as a file says; none = as the simulation asks. rays: whether any are to come. Error: captures outside of the
// span; as its parts.
PreparedHeat prepare(const std::shared_ptr<const Scene>& scene, const Simulation& simulation, const JobOptions& job,
                     const std::optional<HeatCut>& cut = {}, bool rays = true);
double moments_of(const PreparedHeat& prepared);
// What finding temperatures takes at once: by face what paths found and the errors' blocks of it, beside that the most
// of what is done one after the other: the matrix from both ends as it is made, or that with two histories, loads and
// the nodes of the slabs. Beside the scene and its elements; ends that paths share, as parts of the sky, make it less:
// a street of 50000 elements took 190 MB of 247 MB.
double bytes_of(const PreparedHeat& prepared);
// Share of the faces that see what changes from one interval of rest to another, about.
double seeing_changes(const PreparedHeat& prepared);
// Refuses more than there is room for, before anything is traced.
void check_size(const PreparedHeat& prepared, const Simulation& simulation);

}  // namespace suite
