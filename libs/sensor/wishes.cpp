#include <algorithm>

#include "motion/map_system.h"
#include "sensor/sensors.h"

namespace suite {

void read_units(const Params& params, ImageWishes& wishes) {
  const auto units = params.find("units");
  if (!units) return;
  wishes.quantity = static_cast<Quantity>(
      units->as_choice({"radiance", "toa_reflectance", "brightness_temperature", "remote_sensing_reflectance"}));
  wishes.where = units->where();
  if (wishes.quantity != Quantity::remote_sensing_reflectance) return;
  const auto [x, y, z] = params.at("irradiance_at_m").as_vec3();
  wishes.irradiance_at = {x, y, z};
}

// Keys of `geolocation: {...}`.
void read_map_wishes(const Params& p, ImageWishes& wishes) {
  bool degrees = false;
  if (const auto crs = p.find("crs")) {
    const std::string name = crs->as_text();
    wishes.epsg = name == "utm" ? 0 : name == "degrees" ? 4326 : epsg_of_name(name).value_or(-1);
    const auto system = wishes.epsg > 0 ? map_system_of_epsg(wishes.epsg) : std::nullopt;
    if (wishes.epsg && !(system && system->heights == MapSystem::Heights::unknown))
      throw crs->error("unknown reference system '" + name + "'",
                       "utm (WGS84, zone of the picture), degrees (EPSG:4326), EPSG:326zz or 327zz (UTM on WGS84), "
                       "EPSG:258zz (UTM on ETRS89), EPSG:4258 (ETRS89, degrees)");
    degrees = system && !system->zone;
  }
  if (p.has("pixel_m")) {
    wishes.pixel = p.number_in("pixel_m", 1e-6, 1e7, "m");
    if (degrees) throw p.at("pixel_m").error("pixels of a map in degrees have a size in degrees", "pixel_deg");
  }
  if (p.has("pixel_deg")) {
    wishes.pixel = p.number_in("pixel_deg", 1e-10, 10, "degrees");
    if (!degrees) throw p.at("pixel_deg").error("pixels of a projected map have a size in metres", "pixel_m");
  }
  if (const auto how = p.find("resampling"))
    wishes.resampling = static_cast<ImageWishes::Resampling>(how->as_choice({"area", "nearest"}));
}

ImageWishes read_wishes(const Params& params, std::vector<std::string>& truth) {
  ImageWishes wishes;
  read_units(params, wishes);
  const auto place = params.find("geolocation");
  if (!place) return wishes;
  if (place->kind() == Params::Kind::map) {
    wishes.geolocation = true;
    wishes.place_where = place->where();
    read_map_wishes(*place, wishes);
  } else {
    wishes.geolocation = place->as_bool();
  }
  if (wishes.geolocation && std::find(truth.begin(), truth.end(), "location") == truth.end())
    truth.push_back("location");
  return wishes;
}

}  // namespace suite
