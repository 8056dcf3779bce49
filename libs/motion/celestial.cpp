#include "motion/celestial.h"

#include <erfa.h>
#include <erfam.h>

#include <cmath>

namespace suite {

namespace {

// Direction in the axes of the place.
Dir seen_by(const eraASTROM& at, const CatalogPlace& star) {
  eraASTROM mine = at;  // ERFA takes it as not constant
  double right_ascension, declination, azimuth, zenith, hour, seen_declination, seen_right_ascension;
  eraAtciq(star.right_ascension, star.declination, star.motion_right_ascension, star.motion_declination, 0, 0, &mine,
           &right_ascension, &declination);
  eraAtioq(right_ascension, declination, &mine, &azimuth, &zenith, &hour, &seen_declination, &seen_right_ascension);
  return {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
}

}  // namespace

struct CelestialSphere::Observer {
  eraASTROM bare, lifted;
};

CelestialSphere::CelestialSphere(const SceneFrame& frame, JulianDate tt, JulianDate ut1,
                                 const std::optional<SurfaceAir>& air) {
  double to_earth[3][3], to_ecliptic[3][3];
  eraC2t06a(tt.day, tt.fraction, ut1.day, ut1.fraction, 0, 0, to_earth);
  const auto column = [&](int j) { return frame.enu_direction({to_earth[0][j], to_earth[1][j], to_earth[2][j]}); };
  axes_ = {column(0), column(1), column(2)};
  pole_ = normalized(frame.enu_direction({0, 0, 1}));
  eraEcm06(tt.day, tt.fraction, to_ecliptic);
  const auto row = [&](int i) { return axes_.to_world({to_ecliptic[i][0], to_ecliptic[i][1], to_ecliptic[i][2]}); };
  ecliptic_ = {row(0), row(1), row(2)};
  double heliocentric[2][3], barycentric[2][3], x, y, locator, a = 0, b = 0;
  eraEpv00(tt.day, tt.fraction, heliocentric, barycentric);
  const Vec3 sun{-heliocentric[0][0], -heliocentric[0][1], -heliocentric[0][2]};
  const Vec3 on_ecliptic = ecliptic_.to_local(axes_.to_world(sun));
  sun_longitude_ = std::atan2(on_ecliptic.y, on_ecliptic.x);
  sun_distance_ = length(sun);
  sun_ = sun + Vec3{barycentric[0][0], barycentric[0][1], barycentric[0][2]};

  eraXys06a(tt.day, tt.fraction, &x, &y, &locator);
  if (air) eraRefco(air->pressure * 1e-2, air->temperature - 273.15, air->humidity, air->wavelength_um, &a, &b);
  const Geodetic& site = frame.origin();
  const auto observer = std::make_shared<Observer>();
  for (eraASTROM* at : {&observer->bare, &observer->lifted}) {
    const bool lifts = at == &observer->lifted;
    eraApco(tt.day, tt.fraction, barycentric, heliocentric[0], x, y, locator, eraEra00(ut1.day, ut1.fraction),
            site.longitude_deg * kDegree, site.latitude_deg * kDegree, site.height_m, 0, 0,
            eraSp00(tt.day, tt.fraction), lifts ? a : 0, lifts ? b : 0, at);
  }
  observer_ = observer;
}

Vec3 CelestialSphere::observer_au() const {
  const auto& eb = observer_->bare.eb;
  return {eb[0], eb[1], eb[2]};
}

Dir CelestialSphere::without_air(const CatalogPlace& star) const { return seen_by(observer_->bare, star); }

Dir CelestialSphere::seen(const CatalogPlace& star) const {
  static const double kLowest = std::sin(-0.6 * kDegree);
  const Dir bare = without_air(star);
  return bare.z < kLowest ? bare : seen_by(observer_->lifted, star);
}

}  // namespace suite
