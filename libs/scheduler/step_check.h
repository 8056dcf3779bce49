// Whether the spectral step of a sensor is fine enough for what it looks at: averages over bins are multiplied instead
// of spectra, and halving the bins tells how much that matters.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "radiometry/sources/environment.h"
#include "sensor/sensor.h"

namespace suite {

struct CoarseStep {
  std::string band, under;  // "red edge", "the sun on asphalt"
  double change = 0;        // of the band's radiance when the bins are halved, relative
  double bin_um = 0;        // narrowest bin of the state
  int halvings = 0;         // after which the change would be within the limit; 0 = not within ten
};

inline constexpr double kStepLimit = 1e-3;

// The worst band of a sensor when halving the bins changes it by more than kStepLimit, for light of each source that
// is scattered by each material once (the sources alone too) and for what warm materials emit. sources: resolved.
std::optional<CoarseStep> coarse_step(const Scene& scene, const SourceSpecs& sources, const Sensor& sensor);

}  // namespace suite
