// Sensors that see polarisation, for tests: single rays, all of I, Q, U, V.
#pragma once
#include "sensor/polarimetry.h"
#include "tests/support/media_kit.h"

namespace suite::test {

class StokesRays final : public RaySensor {
 public:
  StokesRays(std::vector<Ray> rays, uint32_t paths, Polarimetry how = {}, std::vector<Band> bands = one_band(),
             double step_um = 0.01)
      : RaySensor(std::move(rays), std::move(bands), paths, step_um), how_(std::move(how)) {}
  std::span<const std::string> channels() const override {
    static const std::vector<std::string> names{"radiance", "stokes_q", "stokes_u", "stokes_v", "depolarised"};
    return names;
  }
  const Polarimetry* polarimetry() const override { return &how_; }

 private:
  Polarimetry how_;
};

struct StokesSeen {
  Stokes S{}, error{};
  double depolarised = 0;
  double dolp() const { return std::hypot(S[1], S[2]) / S[0]; }
  double aolp_deg() const { return std::fmod(0.5 * std::atan2(S[2], S[1]) / kDegree + 180, 180.0); }
};
// Of the first band, ray by ray.
inline std::vector<StokesSeen> seen_of(const CaptureResult& r) {
  std::vector<StokesSeen> seen(r.problems());
  for (size_t i = 0; i < seen.size(); ++i) {
    for (size_t c = 0; c < 4; ++c) {
      seen[i].S[c] = r.radiance[(i * r.channels + c) * r.bands];
      seen[i].error[c] = r.standard_error[(i * r.channels + c) * r.bands];
    }
    seen[i].depolarised = r.radiance[(i * r.channels + 4) * r.bands];
  }
  return seen;
}
inline std::vector<StokesSeen> see_stokes(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                                          const std::vector<Ray>& rays, uint32_t paths, Polarimetry how = {},
                                          PipelineOptions options = {}) {
  const auto run = render(scene, sources, std::make_unique<StokesRays>(rays, paths, std::move(how)), options);
  return seen_of(run.result);
}

}  // namespace suite::test
