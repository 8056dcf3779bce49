// Systems of maps beside those of map_system.h: any projected or geographic EPSG code, through PROJ, which is loaded
// when one is asked for.
#pragma once
#include <memory>
#include <string>

#include "motion/map_system.h"

namespace suite {

class MapProjection {
 public:
  // Error: PROJ is not there (the message names its package), or it does not know the code.
  explicit MapProjection(int epsg);

  bool geographic() const;                  // its coordinates are longitude and latitude
  const std::string& name() const;          // "NAD83 / UTM zone 10N"
  MapSystem::Heights heights() const;       // of compound and three-dimensional codes
  const std::string& heights_name() const;  // what they count from, "NAVD88 height"; empty: nothing is said
  // x: easting or longitude, y: northing or latitude, in the system's units; on WGS84, with the same height. From many
  // threads. Error: PROJ knows no such place.
  Geodetic place(double x, double y, double height_m) const;
  // How the last place was found: PROJ's name of the transformation and its accuracy, a half sentence.
  std::string description() const;

 private:
  struct Opened;
  std::shared_ptr<Opened> opened_;
};

}  // namespace suite
