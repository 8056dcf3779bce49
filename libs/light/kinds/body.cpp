#include "light/kinds/body.h"

#include <cmath>

#include "math/warps.h"
#include "motion/time.h"

namespace suite {

void read_disk(const Params& p, double usual_half_angle_deg, SunSpec& disk) {
  const auto d = p.find("direction");
  if (!d) throw p.error("the key 'direction' is missing", "give {zenith_deg, azimuth_deg} or {time_utc}");
  if (const auto time = d->find("time_utc")) {
    try {
      disk.time = SourceTime{time->as_text(), time->where()};
      instant_from_utc(parse_iso8601(disk.time->utc));
    } catch (const Error& e) {
      throw time->error(e.message(), e.hint());
    }
  } else {
    const double zenith = d->number_in("zenith_deg", 0, 180, "degrees") * kDegree;
    disk.direction = dir_from_angles(
        zenith, azimuth_from_compass_deg(d->number_in("azimuth_deg", -360, 360, "degrees clockwise from north")));
  }
  const bool collimated = p.boolean("collimated", false);
  const auto half = p.find("half_angle_deg");
  if (half && collimated) throw half->error("a collimated source has no half angle", "drop one of the two");
  disk.half_angle = collimated ? 0 : (half ? half->as_number_in(0, 90, "degrees") : usual_half_angle_deg) * kDegree;
  disk.disk_by_time = disk.time && !collimated && !half;
}

Instant instant_of(const SourceTime& time) {
  try {
    return instant_from_utc(parse_iso8601(time.utc));
  } catch (const Error& e) {
    throw Error(time.where, e.message(), e.hint());
  }
}

std::string sentence(const std::string& name, const SourceTime& time, double seconds, const SkyBody& body,
                     const std::string& more) {
  const std::string utc = seconds == 0 ? time.utc : to_iso8601(utc_from_instant(instant_of(time) + seconds));
  return strf("%s at %s: %.3f degrees %s the horizon, %s", name.c_str(), utc.c_str(),
              std::fabs(body.elevation) / kDegree, body.elevation < 0 ? "below" : "above", more.c_str());
}

std::shared_ptr<const Light> BodySpec::bake(const Tracer&, const SpectralState& state) const {
  SUITE_CHECK(!disk_.time);
  return std::make_shared<const Sun>(disk_, state);
}

bool BodySpec::shines(double low_um, double high_um) const { return shines_between(disk_.irradiance, low_um, high_um); }

void BodySpec::add_spectra(std::vector<LightSpectra>& to) const { add_curve("the " + key(), disk_.irradiance, to); }

std::vector<std::string> BodySpec::hardly_met(double enough) const {
  if (disk_.half_angle == 0) return {"the " + key() + " (collimated)"};
  // Solid angle over pi.
  const double chance = 2 * one_minus_cos(disk_.half_angle);
  if (chance >= enough) return {};
  return {strf("the %s (a disk that one path in %.2g meets by chance)", key().c_str(), 1 / chance)};
}

}  // namespace suite
