// The detectors of a laser radar: one interface, one file a kind, one table.
#pragma once
#include <memory>
#include <string>

#include "base/params.h"
#include "base/registry.h"
#include "detection/gate.h"
#include "detection/returns.h"
#include "detection/variates.h"

namespace suite {

// What falls on a pixel after one pulse.
struct PixelLight {
  std::vector<PhotonArrival> arrivals;  // photons of the laser
  double passive = 0;                   // photons/s
};
struct PulseLight {
  uint64_t pulse = 0;  // number, of the random stream
  std::vector<PixelLight> pixels;
  uint32_t columns = 1;
  Gate::Window window{};
};

// What a detector makes of one pixel and pulse, and beside it what it would make without noise.
struct PixelRecord {
  std::vector<LidarReturn> returns, ideal_returns;
  SampleGrid grid;
  std::vector<double> samples;                      // in the detector's unit; empty: this kind keeps none
  std::vector<double> ideal_samples, ideal_errors;  // without noise, and its standard error by the paths
  // Where there is no light of the laser: expected sample, its standard deviation, and counts/s of detectors that
  // count.
  double level = 0, level_noise = 0, background_rate = 0;
};

// The samples of a gate for all pixels, `copies` of each. Error: more than kMostSamples together.
SampleGrid samples_for(const PulseLight& light, double step, size_t copies = 1);
// Error at p: more than 1000 steps within the width (both s) of what is to be resolved; s: 0 = no width.
void check_step(const Params& p, double step, double width);

class LidarDetector {
 public:
  virtual ~LidarDetector() = default;
  // One record a pixel. key: of the random stream, the same for all pulses. Error: a gate of too many samples or
  // counts.
  virtual std::vector<PixelRecord> detect(const PulseLight& light, uint64_t key) const = 0;
  virtual std::string sample_unit() const = 0;  // "counts"; empty: keeps no samples
  virtual bool counts_photons() const = 0;      // returns are single clicks
  const std::string& name() const { return name_; }
  void set_name(std::string name) { name_ = std::move(name); }

 private:
  std::string name_;
};

using LidarDetectorRow = RegistryRow<std::unique_ptr<LidarDetector>(const Params& params, const PulseShape& pulse)>;
const Registry<LidarDetectorRow>& lidar_detectors();
// Reads `kind` and `name`; located Error for anything wrong.
std::unique_ptr<LidarDetector> make_lidar_detector(const Params& params, const PulseShape& pulse);

LidarDetectorRow waveform_detector_row();
LidarDetectorRow linear_detector_row();
LidarDetectorRow geiger_detector_row();
LidarDetectorRow photon_counting_detector_row();

}  // namespace suite
