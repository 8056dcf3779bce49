// The impulse response of a scene to the pulses of a laser radar: photons by their optical arrival, for each pulse and
// pixel. Detectors read it as often as wanted; no path is traced again.
//
// Assumes: an impulse as transmitted pulse and receiver. A value of a range bin stands for an impulse in the middle of
// the bin; impulses between two middles are split (range_bins.h), so that sums and centroids are exact. Variances are
// of single bins: bins that share paths are correlated, which is not kept.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "detection/bin_interval.h"
#include "math/dualquat.h"
#include "motion/scene_frame.h"
#include "motion/time.h"

namespace suite {

// Where a return lies on its path: on the axis of the beam, or on the direction of its pixel.
enum class PlacesAlong { beam, pixel };

// The first channels; both together are all light. Others are parts of it, such as "tag:roof".
inline constexpr size_t kSingle = 0, kMultiple = 1;

struct ResponseHead {
  double bin = 1e-10;  // s, width of a range bin, 1e-13..1e-6
  uint32_t bins = 0;   // range bins of a pulse, 1..1e8; numbered from 1
  int scrambles = 0;   // of which the errors are, 2..64; 0: they are not known to be of scrambles
  std::vector<std::string> channels{"single", "multiple"};
  uint32_t columns = 1, rows = 1;       // of the focal plane
  std::vector<Dir> pixels{{0, 0, -1}};  // centres of the pixels in the receiver's frame, row by row
  PlacesAlong along = PlacesAlong::beam;
  double group_index = 1;          // mean of the air, by which arrivals become lengths, 1..2
  std::optional<Utc> epoch;        // second 0 of all times
  std::optional<Geodetic> origin;  // of the scene's ENU frame
  int epsg = 0;                    // of the scene's map, 0 = none
  size_t pixel_count() const { return pixels.size(); }
};

// Poses turn and move from the body's frame (x right, y ahead, z up, looks along -z) to scene ENU. A deflector is part
// of the pose: the beam leaves along -z of the emission.
struct ResponsePulse {
  double time = 0;           // s after the epoch, of the emission
  double wavelength_um = 1;  // of the line
  double energy = 0;         // J
  double start = 0;          // s after the emission, where range bin 1 begins
  Pose emission, reception;  // at their own times
};

// Consecutive pulses. Rows are pulse by pulse, pixel by pixel; an entry is a bin of a row that some path reached.
// Bin 0 is the passive light: photons within the width of one bin, the same at all arrivals.
struct ResponseBlock {
  uint64_t first_pulse = 0;
  std::vector<ResponsePulse> pulses;
  std::vector<uint64_t> begin{0};  // first entry of each row, and the end
  // Of each row: photons which a bin that no path reached stays below with 95 % confidence. NaN: nothing is known.
  std::vector<double> bound;
  std::vector<uint64_t> paths;          // of each row
  std::vector<uint32_t> bin;            // of each entry, ascending within a row
  std::vector<uint32_t> contributions;  // of each entry
  std::vector<double> value;            // photons on the focal plane, entries x channels, >= 0
  std::vector<double> variance;         // of value
  std::vector<float> skewness;          // of the scrambles of value (bin_interval.h); empty: not known

  size_t row_count() const { return begin.size() - 1; }
  size_t entries() const { return bin.size(); }
};

// What a bin of a row is known to hold.
struct BinKnown {
  bool reached = false;
  double value = 0, error = 0;  // photons of all light, and the standard error
  double bound = 0;             // photons, where it is not reached
  BinInterval interval;         // holds the mean with 95 % confidence; where it is not reached up to the bound
};

// One row of a block.
class ResponseRow {
 public:
  ResponseRow(const ResponseHead& head, const ResponseBlock& block, size_t row)
      : block_(&block),
        row_(row),
        channels_(head.channels.size()),
        pixels_(head.pixel_count()),
        scrambles_(head.scrambles) {}
  const ResponsePulse& pulse() const { return block_->pulses[row_ / pixels_]; }
  uint64_t pulse_number() const { return block_->first_pulse + row_ / pixels_; }
  size_t pixel() const { return row_ % pixels_; }
  size_t size() const { return block_->begin[row_ + 1] - block_->begin[row_]; }
  uint32_t bin(size_t k) const { return block_->bin[at(k)]; }
  uint32_t contributions(size_t k) const { return block_->contributions[at(k)]; }
  double value(size_t k, size_t channel) const { return block_->value[at(k) * channels_ + channel]; }
  double variance(size_t k, size_t channel) const { return block_->variance[at(k) * channels_ + channel]; }
  double photons(size_t k) const { return value(k, kSingle) + value(k, kMultiple); }
  // Single and multiple scattering are taken as independent.
  double photon_variance(size_t k) const { return variance(k, kSingle) + variance(k, kMultiple); }
  // What holds the mean of a channel, or of all light, with that confidence. Of as many degrees of freedom as scrambles
  // tell, and without skewness, where they are not known.
  BinInterval interval(size_t k, size_t channel, double confidence = 0.95) const;
  BinInterval photon_interval(size_t k, double confidence = 0.95) const;
  double bound() const { return block_->bound[row_]; }
  double passive() const { return size() && bin(0) == 0 ? photons(0) : 0; }  // photons within a bin's width
  BinKnown known(uint32_t bin) const;

 private:
  size_t at(size_t k) const { return block_->begin[row_] + k; }
  const ResponseBlock* block_;
  size_t row_, channels_, pixels_;
  int scrambles_;
};

// s after the emission, the middle of range bin `bin` (from 1).
inline double arrival_of_bin(const ResponseHead& head, const ResponsePulse& pulse, uint32_t bin) {
  return pulse.start + (static_cast<double>(bin) - 0.5) * head.bin;
}

// What is wrong, as the end of a sentence; empty when nothing is.
std::string fault_of(const ResponseHead& head);
std::string fault_of(const ResponseHead& head, const ResponseBlock& block);

// Takes blocks in the order of their pulses: what the transport writes to.
class ResponseSink {
 public:
  virtual ~ResponseSink() = default;
  virtual void take(ResponseBlock&& block) = 0;
};

// Scene ENU, m: where light that arrives `arrival` s after the emission was turned back, were it turned once. On the
// axis of the beam or of the pixel, from both poses (bistatic, moving): |P - E| + |P - R| = c t / n. Nothing when the
// path is shorter than the baseline.
std::optional<Vec3> place_of_return(const ResponseHead& head, const ResponsePulse& pulse, size_t pixel, double arrival);

}  // namespace suite
