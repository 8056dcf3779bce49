// Lamps that ride: on a platform, a placement of the scene, anything with a track. The lamp is baked in the frame of
// what carries it, and every question is asked in that frame at the time of the ray.
//
// Assumes: points and spots (lights that nothing meets by chance and that are not far): glowing geometry moves with its
// placement, and is met there. Scenes that repeat themselves have no riding lamps. Times that a track does not cover
// see it at its nearest end, as rays see geometry.
#pragma once
#include "light/light_spec.h"
#include "motion/track.h"

namespace suite {

class RidingLight final : public Light {
 public:
  // carried: in the frame of the track. Error when it is far, or can be met by chance.
  RidingLight(std::shared_ptr<const Light> carried, TrackPtr track);
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  size_t members() const override { return carried_->members(); }
  std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;

 private:
  Pose pose(double time) const;
  std::shared_ptr<const Light> carried_;
  TrackPtr track_;
  TimeSpan covered_;
};

// The same before it is baked: positions and directions of `carried` are those of the track's frame.
LightSpecPtr riding(LightSpecPtr carried, TrackPtr track);

}  // namespace suite
