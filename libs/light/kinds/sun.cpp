#include "light/kinds/sun.h"

#include "light/kinds/body.h"
#include "light/kinds/rows.h"
#include "light/kinds/solar_spectrum.h"
#include "math/warps.h"
#include "motion/moon_face.h"
#include "motion/ut1.h"

namespace suite {

namespace {

class SunLight final : public BodySpec {
 public:
  explicit SunLight(SunSpec spec) : BodySpec(std::move(spec)) {}
  std::string key() const override { return "sun"; }
  bool is_sun() const override { return true; }

  LightSpecPtr resolved(const LightMoment& at) const override {
    if (!disk_.time) return nullptr;
    const SourceTime& time = *disk_.time;
    const Instant epoch = instant_of(time), instant = epoch + at.seconds;
    const SceneFrame frame = frame_of(at.scene, time.where, "a sun set by date");
    const double dut1 = dut1_at(instant, epoch, at.dut1);
    const SkyBody body = sun_at(frame, {}, instant, dut1);
    SunSpec now = disk_;
    now.time.reset();
    now.direction = body.direction;
    if (now.disk_by_time) now.half_angle = body.angular_radius;
    const double au = body.distance / kAstronomicalUnit;
    if (now.at_1_au) now.irradiance = now.irradiance.scaled(1 / (au * au));
    at.said.push_back(sentence(key(), time, at.seconds, body, strf("%.5f AU", au)));
    constexpr double kNew = 177 * kDegree;  // of the Moon's phase, when it may stand before the Sun
    if (moon_phase_angle(instant) > kNew)
      if (const double covered = solar_eclipse(frame, {}, instant, dut1); covered > 0)
        at.said.push_back(strf("sun: a solar eclipse, which is left out: the Moon covers %.0f %% of the Sun's diameter",
                               100 * std::min(1.0, covered)));
    return make_light(std::move(now));
  }

  LightSpecPtr standing(double zenith) const override {
    if (!disk_.time) return nullptr;
    SunSpec still{FarDisk(disk_), std::nullopt, disk_.disk_by_time, disk_.at_1_au};
    still.direction = dir_from_angles(zenith, 0);
    return make_light(std::move(still));
  }
};

LightSpecPtr read_sun(const Params& p, const LightContext& context) {
  SunSpec sun;
  const auto irradiance = p.find("irradiance");
  if (!irradiance || (irradiance->kind() == Params::Kind::scalar && irradiance->as_text() == "tsis")) {
    sun.irradiance =
        context.builtin(irradiance.value_or(p), "the builtin spectrum of the sun", "irradiance", solar_irradiance());
    sun.at_1_au = true;
  } else {
    sun.irradiance = context.positive(*irradiance, "irradiance", "W/(m2 um)");
  }
  read_disk(p, 0.26655, sun);  // at 1 AU: asin(6.957e8 m / 1.495978707e11 m)
  return make_light(std::move(sun));
}

}  // namespace

LightSpecPtr make_light(SunSpec spec) { return std::make_shared<const SunLight>(std::move(spec)); }

LightRow sun_row() {
  return {{"sun", "a far disk, or collimated; TSIS-1 spectrum unless one is given", "W/(m2 um)", read_sun},
          false,
          "A sample of the Sun at every node, with a visibility ray.",
          "sun: {direction: {zenith_deg: 40, azimuth_deg: 130}, half_angle_deg: 3}\n"};
}

Sun::Sun(const FarDisk& spec, const SpectralState& state)
    : frame_(Frame::around(normalized(spec.direction))),
      spectrum_(state.sample(spec.irradiance)),
      irradiance_(spectrum_) {
  if (!(spec.half_angle >= 0 && spec.half_angle <= kPi / 2))
    throw Error(strf("the half angle %g rad of a disk is not between 0 and pi/2", spec.half_angle));
  if (spec.irradiance.min() < 0) throw Error("the irradiance of the sun or moon is negative");
  drop_ = one_minus_cos(spec.half_angle);
  density_ = drop_ > 0 ? 1 / (2 * kPi * drop_) : 0;
  // Radiance = irradiance / projected solid angle of the disk, pi sin^2.
  const double s = std::sin(spec.half_angle);
  if (drop_ > 0)
    for (float& v : spectrum_) v = static_cast<float>(v / (kPi * s * s));
  nature_.far = true;
  nature_.delta = collimated();
  nature_.disk = !collimated();
}

std::optional<LightSample> Sun::sample(const LightReceiver& at, const std::array<double, 4>& u, double time) const {
  return sample_member(0, 1, at, {0, u[0], u[1], 0}, time);
}

std::optional<LightSample> Sun::sample_member(size_t, double probability, const LightReceiver&,
                                              const std::array<double, 4>& u, double) const {
  const DirectionSample drawn = draw({u[1], u[2]});
  LightSample s;
  s.direction = drawn.direction;
  s.density = drawn.density * probability;
  s.scale = collimated() ? 1 / probability : 1;
  s.spectrum = spectrum();
  return s;
}

std::optional<LightMet> Sun::met_outside(Dir direction, double) const {
  if (!contains(direction)) return std::nullopt;
  return LightMet{1, spectrum(), density_};
}

DirectionSample Sun::draw(Vec2 u) const {
  if (drop_ == 0) return {frame_.z, 0};
  return {frame_.to_world(uniform_cone(u, drop_)), density_};
}

bool Sun::contains(Dir d) const {
  // 1 - cos of the angle as half the squared chord: no cancellation for a disk of milliradians.
  const Vec3 chord = d - frame_.z;
  return drop_ > 0 && 0.5 * dot(chord, chord) < drop_;
}

}  // namespace suite
