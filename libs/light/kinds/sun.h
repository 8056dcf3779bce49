// Far disks of uniform radiance, or collimated beams: the Sun, and the Moon (moon.h) as one.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "light/light.h"
#include "spectral/state.h"

namespace suite {

// A date from which direction, distance and size of a body follow (environment.h).
struct SourceTime {
  std::string utc;  // ISO 8601, as parse_iso8601 accepts it
  Where where;
};

// The Sun, or any far disk of uniform radiance.
struct SunSpec {
  Dir direction{0, 0, 1};               // towards the Sun, ENU
  double half_angle = 0.00465;          // rad; 0 = collimated
  Curve irradiance;                     // W/(m2 um) on a plane facing it
  std::optional<SourceTime> time = {};  // direction still to be computed
  bool disk_by_time = false;            // half angle too, from the distance of the date
  bool at_1_au = false;                 // the irradiance holds at 1 AU and is to be scaled to the distance of the date
};

// A far disk baked for a state.
class Sun final : public Light {
 public:
  Sun(const SunSpec& spec, const SpectralState& state);  // Error: half angle not in [0, pi/2], negative irradiance
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
