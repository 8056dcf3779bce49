// Refraction in a round, still atmosphere: how the Sun is raised, and how much air lies on a bent ray.
//
// Assumes spherical layers: n r sin(theta) is constant along a ray. Density is exponential in height between the given
// heights and ends with the last; refractivity n - 1 is proportional to it. Integrals run over q = n r cos(theta),
// along which path (ds = dq / (n + r n')) and bending (-n'/n tan(theta) dr) are regular at every angle, the horizon and
// tangent points included; to some 1e-9 of their values. Only these numbers are bent: lines of sight and beams
// through Shells are straight.
// Based on: L. H. Auer, E. M. Standish, "Astronomical refraction: computational method for all zenith angles",
// Astron. J. 119, 2000; P. E. Ciddor, "Refractive index of air: new equations for the visible and near infrared", Appl.
// Opt. 35, 1996, equations 1 and 2.
#pragma once
#include <optional>
#include <vector>

namespace suite {

// n - 1 of dry air with 450 ppm of CO2 at a pressure (Pa) and temperature (K), as of an ideal gas. Measured from 0.23
// to 1.69 um; goes on smoothly from 0.2 um to all longer wavelengths.
double refractivity(double wavelength_um, double pressure, double temperature);

class Refraction {
 public:
  // radius: of the sphere of height zero, m. Density (any unit) at ascending heights, m, positive;
  // refractivity_per_density times density is n - 1; 0 = straight. Error: wrong sizes or order, a density not positive,
  // or air that thins out so fast that it would lead light around the Earth.
  Refraction(double radius, std::vector<double> heights, std::vector<double> density, double refractivity_per_density);

  struct Ray {
    double air_mass = 0;       // density along the ray over the density straight above its start
    double bending = 0;        // rad; true zenith angle = apparent zenith angle + bending
    double lowest_height = 0;  // m
  };
  // What reaches a height (from the first to below the last) from an apparent zenith angle, rad, 0 to pi: from the
  // outside, or nothing when the ray meets the sphere of the first height. Error: a height outside the profile.
  std::optional<Ray> ray(double height, double apparent_zenith) const;
  // The apparent zenith angle of what stands at a true one (seen from far outside), rad; nothing when the Earth hides
  // it.
  std::optional<double> apparent_zenith(double height, double true_zenith) const;
  // Least apparent zenith angle at which the Earth is seen, rad.
  double horizon(double height) const;

 private:
  struct Sums {
    double density = 0, bending = 0;  // over the path: density m, rad
  };
  // At a height of layer l.
  struct Index {
    double density, n, slope;  // n and dn/dr
  };
  Index at(size_t layer, double height) const;
  size_t layer_of(double height) const;
  // (n r)^2 at a height less that at another, without cancellation; the layers are theirs.
  double rise(size_t layer, double height, size_t from_layer, double from) const;
  // Along a ray with this n r sin(theta), from q at a height (in a layer) up to the outside, or up to q = until.
  Sums along(double constant, size_t layer, double height, double q, double until) const;
  // The height above `low` at which (n r)^2 is larger by `gain` than there; within the layer.
  double height_of(size_t layer, double low, double gain) const;

  double radius_;
  std::vector<double> heights_, density_, decay_;  // decay: 1/m, of each layer
  double per_density_;
};

}  // namespace suite
