// How a thing sits on its vehicle: nested attachments, each at rest or swinging, scanning, tabulated or following a
// target.
//
// A body's axes are x right, y forward, z up. Angles in rad; times in simulation seconds.
#pragma once
#include <memory>
#include <vector>

#include "base/params.h"
#include "sensor/sensors.h"

namespace suite {

// The motion of a mount relative to what carries it. Immutable; callable from many threads.
class Mount {
 public:
  virtual ~Mount() = default;
  // The rotation at time t. carrier: pose of what carries the mount at that time, its origin where the mount is (ENU).
  virtual Quat at(double t, const Pose& carrier) const = 0;
  // The times at which it knows where it is (all, unless a table ends).
  virtual TimeSpan covered() const;
};

// Key `mount`: {kind: static | whisk | line_scan | tabulated | look_at, ...}; null = static without a rotation.
std::unique_ptr<Mount> read_mount(const Params& params, const SensorContext& context);

// One link of the chain from a vehicle to an instrument.
struct Attachment {
  Pose fixed;                            // offset and rotation on the carrier
  std::shared_ptr<const Mount> mount;    // null = at rest
  std::shared_ptr<const Jitter> jitter;  // null = none
  Pose at(double t, const Pose& carrier, const JitterWindow* table) const;
};
// Keys offset_m, rotate_deg, mount, jitter. seed: mixed into the jitter's.
Attachment read_attachment(const Params& params, const SensorContext& context, uint64_t seed);

}  // namespace suite
