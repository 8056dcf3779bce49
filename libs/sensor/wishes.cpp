#include <algorithm>

#include "sensor/sensors.h"

namespace suite {

void read_units(const Params& params, ImageWishes& wishes) {
  const auto units = params.find("units");
  if (!units) return;
  wishes.quantity = static_cast<Quantity>(units->as_choice({"radiance", "toa_reflectance", "brightness_temperature"}));
  wishes.where = units->where();
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
