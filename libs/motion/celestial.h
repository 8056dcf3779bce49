// The sphere of fixed stars over a place of the scene at an instant: directions of catalogues to scene ENU and back,
// and where a star is seen.
//
// Assumes: polar motion is neglected (below 0.5 arc second); parallax and radial motion of stars are zero. Agrees with
// astropy, which has polar motion, within 0.6 arc second from 1950 to 2100 (tests/unit/motion/celestial_test.cpp).
// Based on: IAU 2006/2000A precession and nutation, light deflection by the Sun, annual and diurnal aberration, and
// refraction A tan z + B tan^3 z, as ERFA has them (eraPmpx, eraAtciqz, eraAtioq, eraRefco; IERS Conventions 2010).
#pragma once
#include <memory>
#include <optional>

#include "math/vec.h"
#include "motion/scene_frame.h"
#include "motion/time.h"

namespace suite {

// A star as catalogues have it: ICRS (J2000), epoch 2000.0.
struct CatalogPlace {
  double right_ascension = 0, declination = 0;  // rad
  // rad a Julian year; of right ascension the change of the angle itself, without the cosine of the declination.
  double motion_right_ascension = 0, motion_declination = 0;
};

// Air at the observer, by which starlight is lifted.
struct SurfaceAir {
  double pressure = 101325;  // Pa
  double temperature = 283;  // K
  double humidity = 0;       // 0..1
  double wavelength_um = 0.55;
};

class CelestialSphere {
 public:
  // Seen from the origin of a frame. tt, ut1: of the instant. air: lifts the stars; none: there is none.
  CelestialSphere(const SceneFrame& frame, JulianDate tt, JulianDate ut1, const std::optional<SurfaceAir>& air = {});

  // Geometric turns between celestial axes (GCRS: x to the equinox of J2000, z to its pole) and scene ENU.
  Dir to_scene(Dir celestial) const { return axes_.to_world(celestial); }
  Dir to_celestial(Dir scene) const { return axes_.to_local(scene); }
  // The Earth's axis of the day, towards the north.
  Dir pole() const { return pole_; }
  // Axes of the ecliptic and mean equinox of date, in scene ENU: z to the ecliptic's pole.
  const Frame& ecliptic() const { return ecliptic_; }
  // Ecliptic longitude of the Sun (rad), geometric but for light time, and its distance, au.
  double sun_longitude() const { return sun_longitude_; }
  double sun_distance_au() const { return sun_distance_; }
  // The Sun and the observer from the centre of mass of the solar system, au, celestial axes.
  Vec3 sun_au() const { return sun_; }
  Vec3 observer_au() const;

  // The unit direction, in scene ENU, in which a star is seen: with proper motion, light deflection, aberration and,
  // with air, refraction (good above 10 degrees of height; what stands lower than 0.6 degrees below the horizon is not
  // lifted).
  Dir seen(const CatalogPlace& star) const;
  // The same without refraction.
  Dir without_air(const CatalogPlace& star) const;

 private:
  struct Observer;
  std::shared_ptr<const Observer> observer_;
  Frame axes_, ecliptic_;  // celestial and ecliptic axes in scene ENU
  Dir pole_{0, 0, 1};
  double sun_longitude_ = 0, sun_distance_ = 1;
  Vec3 sun_;
};

}  // namespace suite
