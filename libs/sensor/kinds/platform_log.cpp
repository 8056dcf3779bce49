// Instruments that measure where the vehicle is: pose and time at a rate, as CSV in the columns of formats/motion, so
// that a log can be flown again.
#include <cmath>

#include "sensor/kinds/platform.h"

namespace suite {

Pose pose_at(const PlatformSpec& spec, const Instrument& instrument, double t) {
  Pose pose = spec.track->at(t);
  if (spec.jitter) pose = pose * spec.jitter->pose(t);
  for (const Attachment& a : instrument.chain) pose = a.at(t, pose, nullptr);
  return pose;
}

std::string pose_log(const PlatformSpec& spec, const Instrument& instrument, const SensorContext& context) {
  std::string text =
      "# pose of '" + instrument.name + "' on '" + spec.name + "' in scene ENU: x right, y forward, z up\n";
  const std::optional<SceneFrame> frame = context.frame ? context.frame() : std::nullopt;
  if (frame) {
    const Geodetic& o = frame->origin();
    text += strf("# origin of the scene: latitude %.9f, longitude %.9f deg, height %.4f m\n", o.latitude_deg,
                 o.longitude_deg, o.height_m);
  }
  if (context.utc && !context.utc(0).empty()) text += "# second 0 is " + context.utc(0) + "\n";
  text += "time_s,east_m,north_m,up_m,qw,qx,qy,qz\n";
  for (const Task& task : spec.tasks) {
    const double steps = std::floor((task.window.end - task.window.begin) * instrument.log_rate + 1e-6);
    for (double k = 0; k <= steps; ++k) {
      const double t = task.window.begin + k / instrument.log_rate;
      const Pose p = pose_at(spec, instrument, t);
      text += strf("%.9f,%.9g,%.9g,%.9g,%.12f,%.12f,%.12f,%.12f\n", t, p.translation.x, p.translation.y,
                   p.translation.z, p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z);
    }
  }
  return text;
}

}  // namespace suite
