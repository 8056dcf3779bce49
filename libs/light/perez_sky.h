// How the light of a sky is spread over it, by how clear and bright it is.
// Based on: R. Perez, R. Seals & J. Michalsky, "All-weather model for sky luminance distribution", Solar Energy 50,
// 1993.
#pragma once

namespace suite {

class PerezSky {
 public:
  // zenith: of the sun, rad, below pi / 2. direct: W/m2 of the beam on a plane facing it; diffuse: W/m2 of the sky on a
  // level plane, above 0; extraterrestrial: W/m2 of the beam above the air; air_mass: relative. Clearness and
  // brightness are equations 2 and 3.
  PerezSky(double zenith, double direct, double diffuse, double extraterrestrial, double air_mass);
  // Relative radiance (equation 1), 0 or more: of a direction by the cosine of its zenith angle and its angle to the
  // sun, rad.
  double at(double cos_zenith, double to_sun) const;

 private:
  double k_[5];
};

}  // namespace suite
