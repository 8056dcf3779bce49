// What the core is primed with for a capture (paper, section III-C): a tracer, a kit, and the pipeline over them.
// Captures that share them all share the pipeline with its working memory.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "scheduler/kits.h"

namespace suite {

// Of what a user chooses, what suits a sensor: photons are sent for every state, and where things move that is for
// every line of a scanner; eight for each problem of its largest capture.
inline PipelineOptions suited(const Sensor& sensor, PipelineOptions options) {
  constexpr size_t kEach = 8;
  size_t most = 1;
  for (const Task& task : sensor.tasks())
    for (const Capture& capture : task.captures) most = std::max(most, capture.problems());
  options.gloss_photons = static_cast<uint32_t>(std::min<size_t>(options.gloss_photons, kEach * most));
  return options;
}

// Error: a capture that asks for many suns at once, where the sun's light is spread by media or air.
inline void check_many_suns(const Sensor& sensor, const Capture& capture, const Kit& kit) {
  if (capture.bin_by == Capture::BinBy::sun && (!kit.optics->media().empty() || kit.environment->atmosphere))
    throw Error("sensor '" + sensor.name() + "' asks for many suns at once, which do not shine through media or air");
}

// Error: a sensor that measures from the plane of a sun which does not shine.
inline void check_polarimetry(const Sensor& sensor, const Environment& environment) {
  const Polarimetry* const how = sensor.polarimetry();
  if (how && how->frame == StokesFrame::scattering_plane && environment.sun == kNoLight)
    throw Error("sensor '" + sensor.name() + "': there is no sun, so no scattering plane",
                "stokes_frame: meridian or image");
}

inline void check_capture(const Sensor& sensor, const Capture& capture, const Kit& kit) {
  check_many_suns(sensor, capture, kit);
  check_polarimetry(sensor, *kit.environment);
}

struct Primed {
  Primed(std::shared_ptr<const Tracer> t, Kit k, const Sensor& sensor, size_t sensor_state,
         const PipelineOptions& options)
      : tracer(std::move(t)),
        kit(std::move(k)),
        surface(*tracer, *kit.optics),
        truth(sensor.truth(),
              {*tracer, state(), sensor_state, sensor.bands(sensor_state), projection(), *kit.environment}),
        channels(sensor.channels()),
        pipeline(surface, *kit.optics, *kit.environment, state(), projection(), kit.bands->reference, truth, channels,
                 suited(sensor, options)) {}
  Primed(const Primed&) = delete;

  const SpectralState& state() const { return kit.optics->state(); }
  const BandProjection& projection() const { return kit.bands->projection; }
  // Whether it is what these would make. (Bands belong to one sensor and one of its states.)
  bool made_of(const Tracer& t, const Kit& k) const {
    return tracer.get() == &t && kit.optics == k.optics && kit.environment == k.environment && kit.bands == k.bands;
  }

  const std::shared_ptr<const Tracer> tracer;
  const Kit kit;
  const Surface surface;
  const TruthPlan truth;
  const ChannelPlan channels;
  const Pipeline pipeline;
};

}  // namespace suite
