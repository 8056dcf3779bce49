// A far disk that is a sphere in sunlight: the Moon with its phase, as what resolves half a degree sees it.
//
// Assumes: a sphere that is dark beyond its terminator but for a share of its light that comes evenly (earthshine), and
// scatters by Lommel and Seeliger's law, mu0 / (mu0 + mu), without maria or relief; the mean over the disk is that of
// the even disk, so irradiance does not change. Based on: H. Seeliger, "Zur Photometrie des Saturnringes", Astron.
// Nachr. 109, 1884; B. Hapke, "Theory of reflectance and emittance spectroscopy", 2012, section 8.
#pragma once
#include "light/kinds/sun.h"

namespace suite {

class PhasedDisk final : public Light {
 public:
  // to_sun: from the sphere, scene ENU, unit. even: 0..1, of the irradiance. Error: as Sun; a collimated disk.
  PhasedDisk(const FarDisk& disk, Dir to_sun, double even, const SpectralState& state);
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  std::optional<LightMet> met_outside(Dir direction, double time) const override;
  std::optional<Beam> beam() const override { return disk_.beam(); }
  std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;
  // Radiance in a direction over its mean over the disk; 0 beside it.
  double shade(Dir direction) const;

 private:
  double lit(double x, double y) const;  // before it is scaled; of the disk of radius 1
  Sun disk_;
  Frame frame_;  // z towards it
  double sine_;  // of the half angle
  Dir to_sun_;   // in the frame
  double even_, scale_ = 1;
};

}  // namespace suite
