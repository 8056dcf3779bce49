#include "light/kinds/moon.h"

#include <algorithm>
#include <cmath>

#include "light/kinds/body.h"
#include "light/kinds/phased_disk.h"
#include "light/kinds/rows.h"
#include "light/kinds/solar_spectrum.h"
#include "motion/moon_face.h"
#include "motion/ut1.h"

namespace suite {

namespace {

// Wavelength in nm; a0..a3; b1..b3; d1..d3 (table 4).
constexpr double kBands[32][11] = {
    {350.0, -2.67511, -1.78539, 0.50612, -0.25578, 0.03744, 0.00981, -0.00322, 0.34185, 0.01441, -0.01602},
    {355.1, -2.71924, -1.74298, 0.44523, -0.23315, 0.03492, 0.01142, -0.00383, 0.33875, 0.01612, -0.00996},
    {405.0, -2.35754, -1.72134, 0.40337, -0.21105, 0.03505, 0.01043, -0.00341, 0.35235, -0.03818, -0.00006},
    {412.3, -2.34185, -1.74337, 0.42156, -0.21512, 0.03141, 0.01364, -0.00472, 0.36591, -0.05902, 0.00080},
    {414.4, -2.43367, -1.72184, 0.43600, -0.22675, 0.03474, 0.01188, -0.00422, 0.35558, -0.03247, -0.00503},
    {441.6, -2.31964, -1.72114, 0.37286, -0.19304, 0.03736, 0.01545, -0.00559, 0.37935, -0.09562, 0.00970},
    {465.8, -2.35085, -1.66538, 0.41802, -0.22541, 0.04274, 0.01127, -0.00439, 0.33450, -0.02546, -0.00484},
    {475.0, -2.28999, -1.63180, 0.36193, -0.20381, 0.04007, 0.01216, -0.00437, 0.33024, -0.03131, 0.00222},
    {486.9, -2.23351, -1.68573, 0.37632, -0.19877, 0.03881, 0.01566, -0.00555, 0.36590, -0.08945, 0.00678},
    {544.0, -2.13864, -1.60613, 0.27886, -0.16426, 0.03833, 0.01189, -0.00390, 0.37190, -0.10629, 0.01428},
    {549.1, -2.10782, -1.66736, 0.41697, -0.22026, 0.03451, 0.01452, -0.00517, 0.36814, -0.09815, 0.00000},
    {553.8, -2.12504, -1.65970, 0.38409, -0.20655, 0.04052, 0.01009, -0.00388, 0.37206, -0.10745, 0.00347},
    {665.1, -1.88914, -1.58096, 0.30477, -0.17908, 0.04415, 0.00983, -0.00389, 0.37141, -0.13514, 0.01248},
    {693.1, -1.89410, -1.58509, 0.28080, -0.16427, 0.04429, 0.00914, -0.00351, 0.39109, -0.17048, 0.01754},
    {703.6, -1.92103, -1.60151, 0.36924, -0.20567, 0.04494, 0.00987, -0.00386, 0.37155, -0.13989, 0.00412},
    {745.3, -1.86896, -1.57522, 0.33712, -0.19415, 0.03967, 0.01318, -0.00464, 0.36888, -0.14828, 0.00958},
    {763.7, -1.85258, -1.47181, 0.14377, -0.11589, 0.04435, 0.02000, -0.00738, 0.39126, -0.16957, 0.03053},
    {774.8, -1.80271, -1.59357, 0.36351, -0.20326, 0.04710, 0.01196, -0.00476, 0.36908, -0.16182, 0.00830},
    {865.3, -1.74561, -1.58482, 0.35009, -0.19569, 0.04142, 0.01612, -0.00550, 0.39200, -0.18837, 0.00978},
    {872.6, -1.76779, -1.60345, 0.37974, -0.20625, 0.04645, 0.01170, -0.00424, 0.39354, -0.19360, 0.00568},
    {882.0, -1.73011, -1.61156, 0.36115, -0.19576, 0.04847, 0.01065, -0.00404, 0.40714, -0.21499, 0.01146},
    {928.4, -1.75981, -1.45395, 0.13780, -0.11254, 0.05000, 0.01476, -0.00513, 0.41900, -0.19963, 0.02940},
    {939.3, -1.76245, -1.49892, 0.07956, -0.07546, 0.05461, 0.01355, -0.00464, 0.47936, -0.29463, 0.04706},
    {942.1, -1.66473, -1.61875, 0.14630, -0.09216, 0.04533, 0.03010, -0.01166, 0.57275, -0.38204, 0.04902},
    {1059.5, -1.59323, -1.71358, 0.50599, -0.25178, 0.04906, 0.03178, -0.01138, 0.48160, -0.29486, 0.00116},
    {1243.2, -1.53594, -1.55214, 0.31479, -0.18178, 0.03965, 0.03009, -0.01123, 0.49040, -0.30970, 0.01237},
    {1538.7, -1.33802, -1.46208, 0.15784, -0.11712, 0.04674, 0.01471, -0.00656, 0.53831, -0.38432, 0.03473},
    {1633.6, -1.34567, -1.46057, 0.23813, -0.15494, 0.03883, 0.02280, -0.00877, 0.54393, -0.37182, 0.01845},
    {1981.5, -1.26203, -1.25138, -0.06569, -0.04005, 0.04157, 0.02036, -0.00772, 0.49099, -0.36092, 0.04707},
    {2126.3, -1.18946, -2.55069, 2.10026, -0.87285, 0.03819, -0.00685, -0.00200, 0.29239, -0.34784, -0.13444},
    {2250.9, -1.04232, -1.46809, 0.43817, -0.24632, 0.04893, 0.00617, -0.00259, 0.38154, -0.28937, -0.01110},
    {2383.6, -1.08403, -1.31032, 0.20323, -0.15863, 0.05955, -0.00940, 0.00083, 0.36134, -0.28408, 0.01010},
};
// Libration, per degree and degree-radian; the nonlinear phase terms, degrees (equation 11).
constexpr double kC[4] = {0.00034115, -0.0013425, 0.00095906, 0.00066229},
                 kP[4] = {4.06054, 12.8802, -30.5858, 16.7498};
constexpr double kSolidAngle = 6.4177e-5, kDistance = 384.4e6;  // of the Moon at its mean distance, sr and m

}  // namespace

Curve moon_reflectance(const MoonGeometry& g) {
  if (!(g.phase >= 0 && g.phase <= kPi) || !std::isfinite(g.sun_longitude) || !std::isfinite(g.observer_latitude) ||
      !std::isfinite(g.observer_longitude))
    throw Error(strf("a phase angle of %g rad is not between 0 and pi", g.phase));
  const double a = g.phase, degrees = a / kDegree, s = g.sun_longitude, latitude = g.observer_latitude / kDegree,
               longitude = g.observer_longitude / kDegree;
  std::vector<double> x, y;
  for (const auto& b : kBands) {
    const double log_reflectance = b[1] + a * (b[2] + a * (b[3] + a * b[4])) +
                                   s * (b[5] + s * s * (b[6] + s * s * b[7])) + kC[0] * latitude + kC[1] * longitude +
                                   kC[2] * s * latitude + kC[3] * s * longitude + b[8] * std::exp(-degrees / kP[0]) +
                                   b[9] * std::exp(-degrees / kP[1]) + b[10] * std::cos((degrees - kP[2]) / kP[3]);
    x.push_back(b[0] * 1e-3);
    y.push_back(degrees > 150 ? 0 : std::exp(log_reflectance));
  }
  return Curve(std::move(x), std::move(y), Outside::hold);
}

Curve moon_irradiance(const MoonGeometry& g, const Curve& sun) {
  if (!(g.sun_distance_au > 0) || !(g.observer_distance > 0)) throw Error("the Moon's distances must be positive");
  const Curve reflectance = moon_reflectance(g);
  const double far = kDistance / g.observer_distance,
               scale = kSolidAngle / kPi * far * far / (g.sun_distance_au * g.sun_distance_au);
  if (sun.is_constant()) return reflectance.scaled(scale * sun.value().front());
  std::vector<double> y;
  for (size_t i = 0; i < sun.wavelength_um().size(); ++i)
    y.push_back(scale * sun.value()[i] * reflectance.at(sun.wavelength_um()[i]));
  return Curve(sun.wavelength_um(), std::move(y), sun.outside());
}

Curve earthshine_irradiance(const MoonGeometry& g, const Curve& sun) {
  constexpr double kFullEarth = 8 / 1.3e5;
  const double phase = kPi - g.phase, share = (std::sin(phase) + (kPi - phase) * std::cos(phase)) / kPi;
  MoonGeometry full = g;
  full.phase = full.sun_longitude = 1.5 * kDegree;
  return moon_irradiance(full, sun).scaled(kFullEarth * share);
}

namespace {

Curve sum_of(const Curve& a, const Curve& b) {  // over the same wavelengths
  std::vector<double> y = a.value();
  for (size_t i = 0; i < y.size(); ++i) y[i] += b.value()[i];
  return a.is_constant() ? Curve::constant(y[0]) : Curve(a.wavelength_um(), std::move(y), a.outside());
}

// Empty where there is none.
std::string sentence_of(const LunarEclipse& eclipse) {
  if (eclipse.penumbral <= 0) return {};
  return strf(
      "moon: a lunar eclipse, which is left out: %.0f %% of the Moon's diameter stand in the Earth's umbra, "
      "where 1e-6 to 1e-4 of its light would be left, and %.0f %% in its penumbra",
      100 * std::clamp(eclipse.umbral, 0.0, 1.0), 100 * std::min(1.0, eclipse.penumbral));
}

class MoonLight final : public BodySpec {
 public:
  explicit MoonLight(MoonSpec spec) : BodySpec(spec.disk), spec_(std::move(spec)) {}
  std::string key() const override { return "moon"; }

  LightSpecPtr resolved(const LightMoment& at) const override {
    return spec_.disk.time || spec_.by_phase ? make_light(suite::resolved(spec_, at)) : nullptr;
  }

  std::shared_ptr<const Light> bake(const Tracer& tracer, const SpectralState& state) const override {
    if (!spec_.phased || !spec_.to_sun) return BodySpec::bake(tracer, state);
    return std::make_shared<const PhasedDisk>(disk_, *spec_.to_sun, spec_.of_earth, state);
  }

  LightSpecPtr standing(double zenith) const override {
    if (!spec_.disk.time) return nullptr;
    MoonSpec still = spec_;
    still.phased = false;
    still.disk.time.reset();
    still.disk.direction = Dir{0, 0, 1};
    still.geometry.phase = still.geometry.sun_longitude = 1.5 * zenith;
    return make_light(std::move(still));
  }

 private:
  const MoonSpec spec_;
};

LightSpecPtr read_moon(const Params& p, const LightContext& context) {
  MoonSpec moon;
  read_disk(p, 0.25896, moon.disk);  // at 384 400 km
  if (const auto irradiance = p.find("irradiance")) {
    moon.disk.irradiance = context.positive(*irradiance, "irradiance", "W/(m2 um)");
    moon.by_phase = false;
  }
  const auto phase = p.find("phase_deg");
  if (phase && (!moon.by_phase || moon.disk.time))
    throw phase->error("a moon set by date, or with its own irradiance, has its phase already", "drop one of the two");
  if (moon.by_phase && !moon.disk.time) {
    if (!phase)
      throw p.error("the moon's light is not given", "give phase_deg, irradiance, or a direction by time_utc");
    moon.geometry.phase = phase->as_number_in(0, 180, "degrees") * kDegree;
    moon.geometry.sun_longitude = moon.geometry.phase;
  }
  if (const auto face = p.find("face")) {
    moon.phased = face->as_choice({"even", "phased"}) == 1;
    if (moon.phased && (!moon.disk.time || moon.disk.half_angle == 0))
      throw face->error("where the Sun stands as seen from the Moon is known by date alone, and a disk has a width",
                        "direction: {time_utc: ...}, not collimated");
  }
  if (const auto earthshine = p.find("earthshine")) {
    moon.earthshine = earthshine->as_bool();
    if (moon.earthshine && !moon.by_phase)
      throw earthshine->error("earthshine belongs to a moon whose light follows from its phase", "drop one of the two");
  }
  if (moon.by_phase)
    context.builtin(p, "the builtin spectrum of the sun, whose light the moon sends on,", "irradiance",
                    solar_irradiance());
  return make_light(std::move(moon));
}

}  // namespace

MoonSpec resolved(MoonSpec moon, const LightMoment& at) {
  MoonGeometry& g = moon.geometry;
  if (moon.disk.time) {
    const SourceTime& time = *moon.disk.time;
    const SceneFrame frame = frame_of(at.scene, time.where, "a moon set by date");
    const Instant epoch = instant_of(time), instant = epoch + at.seconds;
    const double dut1 = dut1_at(instant, epoch, at.dut1);
    const SkyBody body = moon_at(frame, {}, instant, dut1), sun = sun_at(frame, {}, instant, dut1);
    moon.disk.direction = body.direction;
    if (moon.disk.disk_by_time) moon.disk.half_angle = body.angular_radius;
    // Sun, Moon and observer in one triangle: phase and the Moon's distance from the Sun.
    const Vec3 to_sun = sun.direction * sun.distance - body.direction * body.distance;
    moon.to_sun = normalized(to_sun);
    g.phase = angle_between(normalized(to_sun), -body.direction);
    g.sun_distance_au = length(to_sun) / kAstronomicalUnit;
    g.observer_distance = body.distance;
    const JulianDate tt = julian_tt(instant);
    const MoonFace face =
        moon_face(CelestialSphere(frame, tt, julian_ut1(instant, dut1)), tt, body.direction, *moon.to_sun);
    g.sun_longitude = face.sun_longitude;
    g.observer_latitude = face.latitude, g.observer_longitude = face.longitude;
    at.said.push_back(sentence(
        "moon", time, at.seconds, body,
        strf("phase angle %.2f degrees, %.0f km, libration %.1f degrees in longitude and %.1f in "
             "latitude",
             g.phase / kDegree, body.distance * 1e-3, g.observer_longitude / kDegree, g.observer_latitude / kDegree)));
    if (const std::string eclipse = sentence_of(lunar_eclipse(instant)); !eclipse.empty()) at.said.push_back(eclipse);
    moon.disk.time.reset();
  }
  if (moon.by_phase) {
    moon.disk.irradiance = moon_irradiance(g, solar_irradiance());
    if (moon.earthshine) {
      const Curve earth = earthshine_irradiance(g, solar_irradiance());
      moon.disk.irradiance = sum_of(moon.disk.irradiance, earth);
      const double all = moon.disk.irradiance.mean(0.5, 0.6);
      moon.of_earth = all > 0 ? std::min(1.0, earth.mean(0.5, 0.6) / all) : 0;
    }
    moon.by_phase = false;
  }
  return moon;
}

LightSpecPtr make_light(MoonSpec spec) { return std::make_shared<const MoonLight>(std::move(spec)); }

LightRow moon_row() {
  return {{"moon", "a far disk with the ROLO irradiance of its phase (Kieffer & Stone 2005)", "W/(m2 um)", read_moon},
          false,
          "A sample of the Moon at every node, with a visibility ray.",
          "moon: {direction: {zenith_deg: 60, azimuth_deg: 250}, phase_deg: 30, half_angle_deg: 2}\n"};
}

}  // namespace suite
