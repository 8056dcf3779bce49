// Heights of the geoid (mean sea level, where maps count heights from) above the WGS84 ellipsoid.
#pragma once
#include <memory>
#include <string>

namespace suite {

// A grid of heights in a file of GeographicLib's (PGM: egm84-30, egm96-5, egm2008-1, ..., from
// https://geographiclib.sourceforge.io/C++/doc/geoid.html). May be called from many threads.
class Geoid {
 public:
  // Error when there is no such file (with where it is had from), or it is none of these grids.
  explicit Geoid(const std::string& path);
  // m above the ellipsoid, by a cubic through the grid's nodes around; latitude -90 to 90, longitude -180 to 360.
  double height_m(double latitude_deg, double longitude_deg) const;
  // What the file says of itself.
  const std::string& description() const { return description_; }

 private:
  struct Grid;
  std::shared_ptr<const Grid> grid_;
  std::string description_;
};

}  // namespace suite
