#include "air_report.h"

#include <cmath>

#include "air/diffuse_field.h"
#include "scheduler/moments.h"
#include "scheduler/scene_albedo.h"

namespace suite {

namespace {

std::string profile_text(const AirSpec& air) {
  const AirProfile& p = air.profile;
  std::string text =
      strf("%s: %.1f kg/m2 of water, %.0f Dobson units of ozone; the scene's z = 0 at %.0f m, %s\n", p.name.c_str(),
           precipitable_water(p), dobson(p), air.height_of_scene(), air.round ? "round Earth" : "flat");
  text += "  height [m]  pressure [Pa]  temperature [K]  h2o [ppm]  o3 [ppm]\n";
  for (const AirLevel& l : air_levels(air))
    text += strf("  %10.0f  %13.5g  %15.1f  %9.4g  %8.4g\n", l.height, l.pressure, l.temperature,
                 1e6 * l.share(Gas::h2o), 1e6 * l.share(Gas::o3));
  return text;
}

// Vertical depth from the scene's z = 0 up, per bin: all, and what is scattered of it.
std::array<std::vector<double>, 2> depths_of(const AirColumn& column) {
  std::array<std::vector<double>, 2> depths;
  for (auto& d : depths) d.assign(column.bins, 0);
  column.shells.walk({0, 0, 0}, {0, 0, 1}, INFINITY, [&](const Shells::Piece& piece) {
    for (size_t i = 0; i < column.bins; ++i) {
      const size_t at = piece.layer * column.bins + i;
      depths[0][i] += piece.length * double{column.extinction[at]};
      for (const AirColumn::Kind& kind : column.kinds) depths[1][i] += piece.length * double{kind.scattering[at]};
    }
  });
  return depths;
}

// The field of a state under the beams of some sources.
DiffuseReport light_of(const AirSpec& air, const AirColumn& column, const SpectralState& state,
                       const SourceSpecs& sources) {
  std::vector<std::vector<float>> irradiance;
  std::vector<AirBeam> beams;
  std::vector<BeamTable> tables;
  for (const LightSpecPtr& light : sources.lights)
    if (light->disk()) irradiance.push_back(state.sample(light->disk()->irradiance));
  for (const LightSpecPtr& light : sources.lights)
    if (const FarDisk* disk = light->disk()) {
      beams.push_back({normalized(disk->direction), irradiance[beams.size()].data()});
      tables.push_back(bake_beam_table(air, column));
    }
  DiffuseReport report;
  solve_diffuse_field(air, column, state, beams, tables, &report);
  return report;
}

std::string state_text(const AirSpec& air, const SpectralState& state, std::span<const Band> bands,
                       const SourceSpecs& sources) {
  const AirColumn column = bake_column(air, state);
  const auto [whole, scattered] = depths_of(column);
  const DiffuseReport light = light_of(air, column, state, sources);
  const BandProjection projection(state, bands);
  const auto mean = [&](size_t band, const auto& value) {
    double sum = 0;
    for (size_t i = 0; i < state.size(); ++i) sum += projection.weight(band, i) * value(i);
    return sum;
  };
  std::string text =
      "  band                          zenith transmittance  scattering depth  direct  diffuse  up at the top, W/(m2 "
      "um)\n";
  for (size_t b = 0; b < bands.size(); ++b) {
    const auto of = [&](const std::vector<float>& row) {
      return row.empty() ? 0 : mean(b, [&](size_t i) { return double{row[i]}; });
    };
    text += strf("  %-18s %8.4g um  %20.4f  %16.4g  %6.4g  %7.4g  %13.4g\n", bands[b].name.c_str(), bands[b].center_um,
                 mean(b, [&](size_t i) { return std::exp(-whole[i]); }),
                 mean(b, [&](size_t i) { return scattered[i]; }), of(light.direct), of(light.down), of(light.top_up));
  }
  return text;
}

// Air over the ground that it asks for.
std::shared_ptr<const AirSpec> over_ground(const std::shared_ptr<const AirSpec>& air,
                                           const std::shared_ptr<const Scene>& scene, const SpectralState& state) {
  if (!asks_for_scene(air)) return air;
  const Tracer tracer(scene);
  return over_scene(air, tracer, Optics(*scene, state, used_materials(tracer), {.pending = true}), 0);
}

}  // namespace

std::string air_text(const Simulation& sim, const std::shared_ptr<const Scene>& scene) {
  SourcesInTime in_time(sim.sources, *scene);
  const SourceSpecs& sources = in_time.at(0);
  if (!sources.air)
    throw Error(Where{sim.path, 0, 0, {}, -1}, "the simulation has no real air to report",
                "give `atmosphere: {profile: us_standard}`");
  std::string text = profile_text(*sources.air);
  for (const auto& sensor : sim.sensors)
    for (size_t s = 0; s < sensor->states().size(); ++s)
      text += "sensor '" + sensor->name() + "', " + sensor->states()[s].text() + "\n" +
              state_text(*over_ground(sources.air, scene, sensor->states()[s]), sensor->states()[s], sensor->bands(s),
                         sources);
  return text;
}

void check_air_asked(const Simulation& sim, const Scene& scene, const Sensor& sensor) {
  const AirSpec* air = sim.sources.air.get();
  const bool traced = air && air->scattering == AirScattering::traced;
  const auto refuse = [&](const std::string& what, const char* hint) {
    throw Error(air ? air->where : Where{}, "sensor '" + sensor.name() + "' asks for " + what, hint);
  };
  constexpr const char* kByPaths =
      "traced air brings its light by paths, as any medium: ask for unscattered, adjacency, ...";
  for (const std::string& channel : sensor.channels()) {
    if (channel != "path_radiance") continue;
    if (traced) refuse(channel + ", which traced air has not got", kByPaths);
    if (air && uses_media(scene))
      refuse(channel + ", which is not known apart where media fill the scene: paths meet both on one way",
             "ask for unscattered, single_scattering, ..., which count the air's light with that of the media");
  }
  for (const std::string& truth : sensor.truth())
    if (truth.starts_with("air_") && (!air || traced))
      refuse("the truth " + truth + ", which needs real air",
             traced ? kByPaths : "give `atmosphere: {profile: us_standard}`");
}

}  // namespace suite
