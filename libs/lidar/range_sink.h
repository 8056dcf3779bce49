// Sums contributions of the path kernel to range bins: photons by their arrival, for states of one bin.
#pragma once
#include <vector>

#include "detection/range_bins.h"
#include "lidar/ends.h"
#include "transport/path_tracing.h"
#include "transport/stokes_throughputs.h"

namespace suite {

class RangeSink final : public Sink<SpectralThroughputs> {
 public:
  // Of a path that starts.
  struct Lane {
    RangeBins* rows = nullptr;  // its row, or those of all pixels where paths leave the laser
    int scramble = 0;
    double active = 0, passive = 0;  // photons of radiance 1 in them; 0: not asked for
    double arrival = 0;              // m, before the path begins
    uint32_t orders = 0;             // before it begins
    bool first_elsewhere = false;    // what matter scatters before any surface is brought by another path
    double once_at_surface = 1;      // times what surfaces scatter once
  };
  // end: the index of the lidar's light in the environment; receiver: null where paths leave it. orders: at most.
  // without_first: what matter scatters once comes from elsewhere (first_scattering.h).
  RangeSink(size_t width, uint16_t end, const ReceiverEnd* receiver, uint32_t orders, bool without_first)
      : lanes_(width), end_(end), receiver_(receiver), orders_(orders), without_first_(without_first) {}
  // Channels by what a path has met first, 0 = none: of the object, else of its material.
  struct Tags {
    std::vector<size_t> of_object, of_material;
    bool any() const { return !of_object.empty(); }
  };
  // Whose sink this is; asked for what paths have met.
  void serve(PathTracing& kernel) { kernel_ = &kernel; }
  void tell_apart(const Tags& tags) { tags_ = &tags; }  // kept
  void begin(uint32_t p, const Lane& lane) { lanes_[p] = lane; }
  uint64_t failures() const { return failures_; }
  // Analysers and the first of their channels; where paths carry polarisation.
  void analyse(std::span<const Analyser> analysers, size_t first_channel);
  // Light of a lane that has been found elsewhere: photons = lane.active times light. spectrum: of the end. seen: its
  // Stokes vector over its intensity, as the sensor sees it.
  void add_single(const Lane& lane, double arrival, double light, const float* spectrum, const Stokes& seen);

  void add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) override {
    for (const Contribution& c : stage) add(c, throughputs, {1, 0, 0, 0}, 0);
  }
  // unknown: share of the light whose polarisation is not known.
  void add(const Contribution& c, SpectralThroughputs& throughputs, const Stokes& seen, double unknown);
  uint16_t end() const { return end_; }
  // Photons of the laser, and those of them whose polarisation is not known.
  double photons() const { return photons_; }
  double unknown() const { return unknown_; }

 private:
  std::span<const RangeBins::Part> parts(const Stokes& seen);
  size_t tag(uint32_t p) const;
  std::vector<Lane> lanes_;
  uint16_t end_;
  const ReceiverEnd* receiver_;
  uint32_t orders_;
  bool without_first_;
  const Tags* tags_ = nullptr;  // null: there are no such channels
  PathTracing* kernel_ = nullptr;
  uint64_t failures_ = 0;
  std::span<const Analyser> analysers_;
  std::vector<RangeBins::Part> parts_;
  double photons_ = 0, unknown_ = 0;
};

// The same where paths carry polarisation.
class StokesRangeSink final : public Sink<StokesThroughputs> {
 public:
  // Keeps references. laser: null where nothing but passive light is asked for.
  StokesRangeSink(RangeSink& sums, const LaserEnd* laser) : sums_(sums), laser_(laser) {}
  void add(std::span<const Contribution> stage, StokesThroughputs& throughputs) override;

 private:
  RangeSink& sums_;
  const LaserEnd* laser_;
};

}  // namespace suite
