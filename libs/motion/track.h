// A track: where something is and how it is turned, at any time it covers. Poses map the moving body's own axes to the
// scene's ENU frame; a platform's axes are x right, y forward, z up.
//
// Based on: L. Kavan et al., "Dual quaternions for rigid transformation blending", 2006 (screw interpolation).
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/dualquat.h"
#include "motion/scene_frame.h"
#include "motion/sgp4.h"
#include "motion/time.h"

namespace suite {

struct TrackRecord;

// Immutable; all members may be called from many threads.
class Track {
 public:
  virtual ~Track() = default;
  // Body to scene ENU at simulation time t (s). Error outside covered().
  virtual Pose at(double t) const = 0;
  // Velocity of the body's origin, scene ENU, m/s. Unless a track knows it in closed form: fourth-order central
  // differences over +-2 ms (relative error (w h)^4/30 at angular rate w), one-sided at the ends of the covered time.
  virtual Vec3 velocity(double t) const;
  virtual TimeSpan covered() const;  // all times by default
  // Whether what it carries is not there outside covered(); else nobody may ask for such times.
  virtual bool absent_outside() const { return false; }
  // Times inside the span where the motion has a kink (keyframes), ascending; none by default.
  virtual std::vector<double> kinks(TimeSpan span) const;
  // As plain data (track_record.h). Error for a kind that cannot be stored.
  virtual TrackRecord record() const;

 protected:
  void check_time(double t) const;  // Error outside covered()
};
using TrackPtr = std::shared_ptr<const Track>;

// The orientation of a platform from the horizontal direction of its nose (mathematical azimuth, rad), its nose's rise
// above the horizon (pitch) and the lowering of its right side (roll).
Quat platform_rotation(double azimuth, double pitch, double roll);

// ---- Frames in which tracks are written --------------------------------------------------------------------------

// Rotations from the axes of a frame at a place to scene ENU: east, north, up of the place; grid east, grid north, up.
Quat geodetic_axes(const SceneFrame& frame, const Geodetic& place);
Quat utm_axes(const SceneFrame& frame, const UtmPoint& point);

// The pose that scene ENU gives a body at an ECEF point, turned by `rotation` relative to the ECEF axes.
Pose pose_from_ecef(const SceneFrame& frame, Vec3 ecef, const Quat& rotation);
// At a geodetic place, turned relative to east, north and up of that place.
Pose pose_from_geodetic(const SceneFrame& frame, const Geodetic& place, const Quat& rotation);
// At a UTM point, turned relative to grid east, grid north and up of that place.
Pose pose_from_utm(const SceneFrame& frame, const UtmPoint& point, const Quat& rotation);

// ---- Tracks -------------------------------------------------------------------------------------------------------

TrackPtr static_track(const Pose& pose);

// Keyframes in scene ENU, joined by screw motions. Error: fewer than one key, times not strictly ascending, anything
// not finite. One key is a body at rest for that instant only.
struct PoseKey {
  double time = 0;  // s
  Pose pose;
};
TrackPtr keyframe_track(std::vector<PoseKey> keys);

// Places by Lagrange's polynomial of a degree (1 to 15; less with fewer keys) through the keys around a time,
// orientation as that of keyframes. covered: within the times of the keys. With velocities, by Hermite's polynomial
// of that degree or the odd one below (3 at least): each key then counts twice.
struct InterpolatedMotion {
  std::vector<PoseKey> keys;
  size_t degree = 1;
  TimeSpan covered;
  std::vector<Vec3> velocities = {};  // m/s in scene ENU, one per key; or none
};
TrackPtr interpolated_track(InterpolatedMotion motion);

// Constant speed (m/s, >= 0) along a heading (mathematical azimuth, rad) with a climb angle (rad, -pi/2..pi/2), at
// `start` (scene ENU) at time t0; pitched by the climb. With `curved`, the path follows the Earth: a geodesic from the
// start, whose height above the ellipsoid changes by the climb only; the heading is counted from the east there.
struct StraightMotion {
  Vec3 start;
  double azimuth = 0, climb = 0, speed = 0, t0 = 0;
  const SceneFrame* curved = nullptr;  // copied
};
TrackPtr straight_track(const StraightMotion& motion);

// A level circle (radius > 0) about a centre; speed > 0 m/s; nose along the motion, rolled by `bank` into the turn
// (rad). At t0 the body is in direction `azimuth` (mathematical, rad) from the centre.
struct CircleMotion {
  Vec3 center;
  double radius = 1, speed = 1, azimuth = 0, bank = 0, t0 = 0;
  bool clockwise = false;  // seen from above
};
TrackPtr circle_track(const CircleMotion& motion);

// A body turning at a constant rate (rad/s, right-handed) about an axis through a point of the body's own frame; `base`
// is its pose at t0 in the parent's frame.
struct SpinMotion {
  Pose base;
  Dir axis{0, 0, 1};
  Vec3 through;
  double rate = 0, t0 = 0;
};
TrackPtr spin_track(const SpinMotion& motion);

// inner, given in the moving frame of outer: a camera on a gimbal on an aircraft.
TrackPtr composed_track(TrackPtr outer, TrackPtr inner);

// The same motion, `seconds` later: at t where `track` is at t - seconds. Cannot be stored.
TrackPtr delayed_track(TrackPtr track, double seconds);

// The same motion, of something that is not there outside the times that it covers.
TrackPtr ending_track(TrackPtr track);

// A satellite: position from SGP4, in the scene's frame; clock and dut1 (s) tie simulation time to UTC. Orientation:
// z away from the Earth's ellipsoid, y along the velocity over the rotating Earth as nearly as that allows.
// Error at times where the theory refuses the elements.
TrackPtr orbit_track(std::shared_ptr<const Sgp4> orbit, const SceneFrame& frame, const Clock& clock, double dut1);

// Keeps the place of a track and replaces its orientation. The body's -z axis (where a camera looks) is pointed ...
enum class Pointing {
  look_at,   // ... at a target, y as nearly up as it can be (towards `up` when looking straight down)
  nadir,     // ... down the ellipsoid's normal (straight down without a frame), y along the horizontal velocity
  velocity,  // y (forward) is along the velocity, z as nearly up as it can be
};
struct PointingRule {
  Pointing kind = Pointing::look_at;
  TrackPtr target;                    // look_at: the target's origin is looked at
  const SceneFrame* frame = nullptr;  // where up is; copied. Null: +z of the scene everywhere
};
// Error at construction: look_at without a target. Error at a time when the direction does not exist: the target is in
// the body's own place, or the body is at rest while velocity is asked for. For nadir at rest y is north.
TrackPtr pointed_track(TrackPtr place, const PointingRule& rule);

// ---- Motion as the ray tracer interpolates it ---------------------------------------------------------------------

// The ray tracer moves geometry linearly between equidistant keys. The smallest number of keys (>= 2, or 1 for an
// instant or a motion below the bound) found to keep every point within `radius` (m, >= 0) of the body's origin closer
// than `bound` (m, > 0) to its true place, all through the window. Error: a bound that is not positive, a track that
// does not cover the window, or more than 1e6 keys.
size_t time_steps_for(const Track& track, TimeSpan window, double radius, double bound);
// The keys themselves.
std::vector<Affine3> time_keys(const Track& track, TimeSpan window, size_t steps);

// The same for anything that has a place at a time, such as a chain of tracks. kinks: times inside the window where the
// motion has a kink.
using MovingFrame = std::function<Affine3(double t)>;
size_t time_steps_for(const MovingFrame& frame, std::span<const double> kinks, TimeSpan window, double radius,
                      double bound);
std::vector<Affine3> time_keys(const MovingFrame& frame, TimeSpan window, size_t steps);

}  // namespace suite
