// What far disks have in common before they are baked: a direction by angles or by date, a size, an irradiance. Sun and
// Moon are such; others can be.
#pragma once
#include "base/params.h"
#include "light/earth.h"
#include "light/kinds/sun.h"
#include "light/light_spec.h"
#include "motion/ephemeris.h"

namespace suite {

// `direction` {zenith_deg, azimuth_deg} or {time_utc}, and the disk: half_angle_deg, collimated.
void read_disk(const Params& p, double usual_half_angle_deg, SunSpec& disk);

// Error at the date when it is none.
Instant instant_of(const SourceTime& time);
// "sun at 2026-..: 30.000 degrees above the horizon, MORE".
std::string sentence(const std::string& name, const SourceTime& time, double seconds, const SkyBody& body,
                     const std::string& more);

// A light that is one far disk.
class BodySpec : public LightSpec {
 public:
  std::shared_ptr<const Light> bake(const Tracer& tracer, const SpectralState& state) const override;
  const SourceTime* date() const override { return disk_.time ? &*disk_.time : nullptr; }
  const FarDisk* disk() const override { return &disk_; }
  bool shines(double low_um, double high_um) const override;
  void add_spectra(std::vector<LightSpectra>& to) const override;
  bool in_scene() const override { return false; }
  std::vector<std::string> hardly_met(double enough) const override;

 protected:
  explicit BodySpec(SunSpec disk) : disk_(std::move(disk)) {}
  const SunSpec disk_;
};

}  // namespace suite
