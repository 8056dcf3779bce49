// Channels: parts of the light of a path that results keep beside all of it. One table, one row a channel; a sensor
// names the rows it wants (Sensor::channels). All channels of a result ride on the same paths.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "math/stokes_parts.h"
#include "transport/contribution.h"

namespace suite {

// make: the share of a contribution that the channel takes, a function of the contribution alone; 0 = nothing.
struct ChannelRow : RegistryRow<float(const Contribution&)> {
  // Shares may be negative, and so may what a path brings: a sample that is not finite is rejected, but none for its
  // sign.
  bool is_signed = false;
  bool of_water = false;  // looks at Contribution::water
  // 1 to 3: Q, U or V of all light rather than a part of the intensity.
  int component = 0;
  bool of_stokes = false;  // needs paths that carry polarisation
};
// The first is `radiance`, all light.
const Registry<ChannelRow>& channel_rows();

// The channels of a sensor: the first is radiance. Rows must outlive it.
class ChannelPlan {
 public:
  // Error: an unknown name.
  explicit ChannelPlan(std::span<const std::string> names);
  explicit ChannelPlan(std::vector<const ChannelRow*> rows);
  size_t size() const { return rows_.size(); }
  // Of a channel beside radiance, 1 .. size() - 1.
  float share(size_t channel, const Contribution& c) const { return rows_[channel]->make(c); }
  bool is_signed(size_t channel) const { return rows_[channel]->is_signed; }
  int component(size_t channel) const { return rows_[channel]->component; }
  bool of_water() const { return of_water_; }    // one of them is
  bool of_stokes() const { return of_stokes_; }  // one of them is
  StokesParts parts() const;                     // of all light that they tell
  bool operator==(const ChannelPlan&) const = default;

 private:
  std::vector<const ChannelRow*> rows_;
  bool of_water_ = false, of_stokes_ = false;
};

}  // namespace suite
