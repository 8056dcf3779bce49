#include <algorithm>

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

ImageWishes read_wishes(const Params& params, std::vector<std::string>& truth) {
  ImageWishes wishes;
  read_units(params, wishes);
  const auto place = params.find("geolocation");
  if (!place) return wishes;
  if (place->has("pixel_m")) {
    wishes.geolocation = true;
    wishes.pixel_m = place->number_in("pixel_m", 1e-6, 1e7, "m");
  } else {
    wishes.geolocation = place->as_bool();
  }
  if (wishes.geolocation && std::find(truth.begin(), truth.end(), "location") == truth.end())
    truth.push_back("location");
  return wishes;
}

}  // namespace suite
