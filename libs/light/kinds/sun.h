// Far disks of uniform radiance, or collimated beams: the Sun, and the Moon (moon.h) as one.
#pragma once
#include <optional>
#include <vector>

#include "light/light_spec.h"

namespace suite {

// The Sun, or what follows its rules: a far disk that a date may place.
struct SunSpec : FarDisk {
  std::optional<SourceTime> time = {};  // direction still to be computed
  bool disk_by_time = false;            // half angle too, from the distance of the date
  bool at_1_au = false;                 // the irradiance holds at 1 AU and is to be scaled to the distance of the date
};
LightSpecPtr make_light(SunSpec spec);

// A far disk baked for a state.
class Sun final : public Light {
 public:
  Sun(const FarDisk& spec, const SpectralState& state);  // Error: half angle not in [0, pi/2], negative irradiance
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  std::optional<LightMet> met_outside(Dir direction, double time) const override;
  std::optional<Beam> beam() const override { return Beam{frame_.z, irradiance_.data()}; }
  std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;

  DirectionSample draw(Vec2 u) const;
  bool collimated() const { return drop_ == 0; }
  bool contains(Dir d) const;                  // false when collimated: nothing meets it by chance
  double density() const { return density_; }  // inside the disk
  // Radiance of the disk, or the irradiance when collimated.
  const float* spectrum() const { return spectrum_.data(); }
  // Irradiance on a plane facing the disk.
  const float* irradiance() const { return irradiance_.data(); }
  Dir direction() const { return frame_.z; }

 private:
  Frame frame_;
  double drop_;     // 1 - cos(half angle)
  double density_;  // 1 / solid angle
  std::vector<float> spectrum_, irradiance_;
};

}  // namespace suite
