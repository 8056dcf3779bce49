// The two ends of a lidar's paths as lights of the path kernel: whichever a path does not begin at is asked for at
// every node. Both are points that nothing meets by chance, stand where the pulse of the ray's time has them, and are
// found through smooth interfaces like lamps (LightNature::placed).
//   LaserEnd      scale = density of the beam, 1/sr, over the squared distance: irradiance of a unit energy
//   ReceiverEnd   scale = importance, m2, over the squared distance. Of a path that leaves the laser with a unit energy
//                 that is the energy on the focal plane, by reciprocity; which pixel's tells the spectrum (pixel_of)
// A polarised laser tells the Stokes vector of each sample by its spectrum (stokes_of) until it is told to forget them:
// of straight ways as well as of those that smooth interfaces bend, whose last part leads to the laser.
// Based on: E. Veach, "Robust Monte Carlo methods for light transport simulation", 1997, chapter 4 (importance).
#pragma once
#include <deque>
#include <type_traits>
#include <vector>

#include "lidar/field.h"
#include "lidar/laser_beam.h"
#include "lidar/pulse_at_work.h"
#include "light/light.h"
#include "math/mueller.h"

namespace suite {

class LidarEnd : public Light {
 public:
  std::optional<LightSample> sample_member(size_t, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;
  std::optional<LightPlace> draw_place(const LightReceiver& at, const std::array<double, 4>& u,
                                       double time) const override;

 protected:
  explicit LidarEnd(const PulsesAtWork& pulses);
  virtual Vec3 place(const PulseAtWork& pulse) const = 0;
  const PulsesAtWork& pulses_;
};

class LaserEnd final : public LidarEnd {
 public:
  // Keeps references. bins: of the state. stokes: of the laser, for one bin; nothing: not asked for. One thread asks.
  LaserEnd(const LaserBeam& beam, const PulsesAtWork& pulses, size_t bins, const std::optional<Stokes>& stokes = {});
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  // Of a sample of a laser that is asked for polarisation: over its intensity, in the meridian frame of its way from
  // the laser.
  static const Stokes& stokes_of(const float* spectrum) { return reinterpret_cast<const Given*>(spectrum)->stokes; }
  // No sample that was given so far will be asked for.
  void forget() { used_ = 0; }

 private:
  // A sample's spectrum, of the one bin that polarised lasers have, and what goes with it.
  struct Given {
    float one = 1;
    Stokes stokes{1, 0, 0, 0};
  };
  static_assert(std::is_standard_layout_v<Given>, "the spectrum's address is the sample's");
  Vec3 place(const PulseAtWork& pulse) const override { return pulse.laser.translation; }
  const LaserBeam& beam_;
  std::optional<Stokes> stokes_;
  std::vector<float> ones_;          // per bin
  mutable std::deque<Given> given_;  // the first `used_` are in use; places stay
  mutable size_t used_ = 0;
};

class ReceiverEnd final : public LidarEnd {
 public:
  ReceiverEnd(const ReceiverField& field, const PulsesAtWork& pulses, size_t bins);
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  size_t pixel_of(const float* spectrum) const { return static_cast<size_t>(spectrum - ones_.data()) / bins_; }

 private:
  Vec3 place(const PulseAtWork& pulse) const override { return pulse.receiver.translation; }
  const ReceiverField& field_;
  size_t bins_;
  std::vector<float> ones_;  // [pixel][bin]
};

}  // namespace suite
