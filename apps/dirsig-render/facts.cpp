#include "facts.h"

#include <algorithm>
#include <cmath>

#include "scheduler/moments.h"

namespace suite {

Facts::Facts(const Simulation& sim, std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)), light_above_(sim.sensors) {
  if (sim.epoch) clock_ = Clock(*sim.epoch);
  if (const LightSpecPtr sun = sim.sources.sun()) sun_.lights = {sun};
  sun_.dut1 = sim.sources.dut1;
}

std::string Facts::utc(double seconds) const { return clock_ ? to_iso8601(clock_->utc(seconds), 6) : std::string(); }

std::optional<FarDisk> Facts::sun(double seconds) const {
  if (!sun_.any()) return std::nullopt;
  SourcesInTime sources(sun_, *scene_);
  return *sources.at(seconds).sun()->disk();
}

std::array<double, 2> azimuth_elevation_deg(Dir d) {
  const double azimuth = std::atan2(d.x, d.y) / kDegree;
  return {azimuth < 0 ? azimuth + 360 : azimuth, std::atan2(d.z, std::hypot(d.x, d.y)) / kDegree};
}

namespace {

// Remote-sensing reflectance is that of a part of the light.
void check_water(const Sensor& sensor, const ImageWishes& wishes) {
  const std::span<const std::string> channels = sensor.channels();
  if (std::find(channels.begin(), channels.end(), "water_leaving") == channels.end())
    throw Error(wishes.where, "units: remote_sensing_reflectance is that of the light that leaves water",
                "channels: [water_leaving]");
}

// A reference system is one of the Earth, and maps are resampled where they are written.
void check_map(const ImageWishes& wishes, const Simulation& sim, const Facts& facts) {
  if (wishes.epsg && !facts.on_earth())
    throw Error(wishes.place_where,
                "geolocation: a map in a reference system needs a scene with an origin on the Earth",
                "give the scene an `origin`, or leave out `crs`");
  if (wishes.resampling && !sim.output.geotiff)
    throw Error(wishes.place_where, "geolocation: `resampling` is that of maps, which are written as GeoTIFF",
                "output: {also: [geotiff]}");
}

}  // namespace

void check_wishes(const Simulation& sim, const Facts& facts) {
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    const std::unique_ptr<Sensor>& sensor = sim.sensors[s];
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures) {
        const ImageWishes wishes = sensor->wishes(c);
        if (wishes.geolocation && sim.periodic)
          throw Error(
              sim.sensor_where[s],
              "geolocation: a scene that repeats itself (`periodic`) has no places: all of them lie in its cell",
              "leave out one of the two");
        check_map(wishes, sim, facts);
        if (wishes.quantity == Quantity::remote_sensing_reflectance) check_water(*sensor, wishes);
        if (wishes.quantity != Quantity::toa_reflectance) continue;
        const std::optional<FarDisk> sun = facts.sun(moment_of(c));
        if (!sun)
          throw Error(wishes.where, "units: toa_reflectance compares with the sun's light, and there is no sun",
                      "give the simulation a `sun`, or leave the units at radiance");
        if (const double elevation = azimuth_elevation_deg(sun->direction)[1]; !(sun->direction.z > 0))
          throw Error(wishes.where,
                      strf("units: toa_reflectance needs the sun above the horizon; at %g s, when '%s' of sensor '%s' "
                           "is taken, it stands %.2f degrees below",
                           moment_of(c), c.name.c_str(), sensor->name().c_str(), -elevation),
                      "leave out the captures at night, or leave the units at radiance");
        for (const Band& b : sensor->bands(c.state))
          if (!(band_mean(b, sun->irradiance) > 0))
            throw Error(wishes.where, "units: toa_reflectance: the sun has no light in the band '" + b.name + "'",
                        "leave the units of this array at radiance");
      }
  }
}

}  // namespace suite
