// Traces the pulses of a laser radar through a scene and leaves their impulse responses: photons on the focal plane by
// their arrival, for each pulse and pixel.
//
// Both ends of a path can be its beginning. Receiver first: paths leave the receiver, and every node asks the laser.
// Laser first: paths leave the laser, and every node asks the receiver. Both are the same kernel (libs/transport) over
// two delta lights (ends.h) and estimate the same light; what is narrower should begin (StartFrom::automatic).
// Passive light (sun, sky, lamps, what is warm) comes by paths that begin at the receiver and stands in bin 0.
//
// What matter scatters once has places of its own in every range bin (first_scattering.h). Leaves that fill space as
// matter (phase function `leaves`) let out what they let in where laser and receiver are together.
// Orders count scattering: smooth surfaces, which only turn light, are passed without one, so that a bed under flat
// water is seen by single scattering. Light that smooth surfaces alone bring back (corner cubes) is not found.
// Arrival is the optical path with the group index of the matter on it, where that is known, else its phase index; the
// air counts as vacuum, in arrivals and in ResponseHead::group_index alike.
// A polarised laser and analysers (LidarReceiver) have paths carry Mueller matrices, which begin at the receiver;
// smooth interfaces are then not looked through, and real air is refused. Assumes: reciprocal surfaces; an aperture and
// a laser that are points but for the beam's waist; the scene stands still from the emission to the reception of a
// pulse; passive light is even over the filter: it is known at the laser's line alone.
#pragma once
#include <functional>
#include <memory>

#include "base/progress.h"
#include "detection/response.h"
#include "lidar/instrument.h"
#include "light/environment.h"
#include "transport/options.h"

namespace suite {

// A laser has one place, and paths of a scene that repeats itself know theirs within the cell alone.
inline constexpr const char *kNoPeriodicLidar = "a scene that repeats itself is not traced for laser radars",
                            *kNoPeriodicLidarHint = "drop `periodic`, and place copies of the scene side by side";

// Threads are those of base/parallel.h; results do not depend on their number.
struct TraceOptions {
  uint64_t first = 0, count = UINT64_MAX;  // pulses of the train; what lies beyond its end is left out
  uint64_t seed = 1;
  uint32_t scrambles = 16;  // independent parts of a row's paths, 2..64, for standard errors; at most one a path
  // Of the kernel; nodes and scatterings follow from LidarInstrument::orders, the seed from above.
  PipelineOptions method = {};
  bool forced_scattering = true;  // in thin matter (first_scattering.h; off for comparisons)
  Progress* progress = nullptr;   // counts pulses; null = none
};

// What has been traced, for logs.
struct PulseReport {
  uint64_t pulses = 0, rows = 0, paths = 0;
  uint64_t dark = 0;      // numbers of the train at which no beam leaves; they are in no block
  uint64_t failures = 0;  // contributions that were no number
  double photons = 0;     // of all pulses and pixels, within the gate
  double outside = 0;     // and outside of it
  double met = 0;         // light of the laser that paths found, in sums of scrambles
  // Share of it whose polarisation is not known and counts as none (docs/theory/polarisation.md).
  double unknown_polarisation = 0;
  double truncated = 0;      // share of the light that was cut at the last order, at most
  bool laser_first = false;  // where paths began
  bool passive = false;      // there is light in bin 0
  bool smooth = false;       // smooth surfaces are there: light that meets nothing else (corner cubes) is left out
  bool hot_spot = false;     // leaves that fill space were passed once by light scattered once (first_scattering.h)
};

// What the blocks of an instrument belong to. scene: for its origin. Error: an instrument with a fault (fault_of).
ResponseHead response_head(const Scene& scene, const LidarInstrument& instrument, const TraceOptions& options = {});

// Traces pulses and hands their blocks to the sink in the order of the train; they are numbered (first_pulse) by those
// at which a beam leaves. Bits do not depend on which part of the train is traced in one go. A stop signal ends it
// between blocks by Stopped (base/interrupt.h); what was handed over stays. Error: an instrument with a fault
// (fault_of), a scene or sources that cannot be baked for the laser's wavelength, motions that do not cover the pulses.
PulseReport trace_pulses(const std::shared_ptr<const Scene>& scene, const SourceSpecs& passive,
                         const LidarInstrument& instrument, const TraceOptions& options, ResponseSink& sink);

}  // namespace suite
