// What is written of detected pulses: one class a kind of file.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/json.h"
#include "detection/detection.h"

namespace suite {

class DetectOutput {
 public:
  virtual ~DetectOutput() = default;
  virtual void take(const DetectedPulse& pulse) = 0;
  virtual void finish(Json& log) = 0;  // the files are there from now on; adds what they hold
};

struct DetectContext {
  std::string folder;
  const ResponseHead& head;
  const DetectionSpec& spec;
  uint64_t pulses = 0;
};

// Keys output and las, csv of the detectors' text. Located Errors; also for files that need a place on the Earth.
std::vector<std::unique_ptr<DetectOutput>> read_outputs(const Params& params, const DetectContext& context);

std::unique_ptr<DetectOutput> las_output(const Params& params, const DetectContext& context);
std::unique_ptr<DetectOutput> waveform_output(const DetectContext& context);
std::unique_ptr<DetectOutput> photon_output(const DetectContext& context);
std::unique_ptr<DetectOutput> dirsig_bin_output(const DetectContext& context);
std::unique_ptr<DetectOutput> csv_output(const Params& params, const DetectContext& context);

// Scene ENU to a map: UTM of the response's code, or of the zone of its origin; the scene's own metres without an
// origin.
class DetectMap {
 public:
  // epsg: 0 = the response's. Error: a code that is not UTM on WGS84 or ETRS89.
  DetectMap(const ResponseHead& head, int epsg, const Where& where);
  Vec3 place(Vec3 enu) const;
  const std::string& wkt() const { return wkt_; }

 private:
  std::optional<SceneFrame> frame_;
  UtmZone zone_;
  std::string wkt_;
};

// s: adjusted GPS time of an emission, or simulation time where the response has no epoch.
double time_of_pulse(const ResponseHead& head, double time);

}  // namespace suite
