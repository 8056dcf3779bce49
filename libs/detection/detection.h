// The stage of detection: responses in, records of all detectors out, pulse by pulse.
#pragma once
#include <functional>

#include "detection/detectors.h"
#include "detection/pulses_in_air.h"

namespace suite {

struct DetectionSpec {
  uint64_t seed = 1;
  PulseShape pulse;
  GateSpec gate;
  PulsesInAir in_air = PulsesInAir::refuse;
  std::vector<std::unique_ptr<LidarDetector>> detectors;
};
// pulse_file: times (s) and powers of a file, of the map {file: ..., column: ...}.
struct PulseTable {
  std::vector<double> time, power;
};
using PulseFile = std::function<PulseTable(const Params&)>;
// Key `pulse`: {kind: impulse | gaussian, fwhm_ns | rectangular, length_ns | table, time_ns, power | file, ...}.
PulseShape read_pulse(const Params& params, const PulseFile& file);
// Keys seed, gate, pulses_in_air, detectors, and of `laser` pulse. Located Errors.
DetectionSpec read_detection(const Params& params, const Params& laser, const PulseFile& file);

// One pulse of one detector.
struct DetectedPulse {
  const ResponseHead& head;
  const ResponseBlock& block;
  size_t in_block = 0;  // number of the pulse there
  size_t detector = 0;
  std::vector<PixelRecord> records;  // of each pixel
  const ResponsePulse& pulse() const { return block.pulses[in_block]; }
  uint64_t number() const { return block.first_pulse + in_block; }
  ResponseRow row(size_t pixel) const { return {head, block, in_block * head.pixel_count() + pixel}; }
};

// A sink of responses: a run of the transport may end in it, or a file be read into it.
class DetectionRun : public ResponseSink {
 public:
  // deliver: gets every pulse of every detector, in order.
  DetectionRun(const ResponseHead& head, const DetectionSpec& spec, std::function<void(DetectedPulse&&)> deliver);
  // Pulses are detected once the emission behind them is known. Error, naming pulse and detector.
  void take(ResponseBlock&& block) override;
  void finish();
  // Of a detector: pulses of which a following gate left out more than half of the light between `start` and `stop`.
  uint64_t beside_gate(size_t detector) const { return beside_[detector]; }

 private:
  void detect(const ResponseBlock& block, double next_emission);
  void detect_pulse(const ResponseBlock& block, size_t pulse, double next);
  ResponseHead head_;
  const DetectionSpec& spec_;
  std::function<void(DetectedPulse&&)> deliver_;
  FoldedRows folded_;
  std::vector<Gate> gates_;       // of each detector
  std::vector<uint64_t> beside_;  // likewise, pulses
  std::optional<ResponseBlock> waiting_;
};

// What the response says of a return: the part of multiple scattering and the strongest tag among the bins within
// `reach` (s) of its time.
struct ReturnTruth {
  double multiple = 0;  // share, 0..1
  int tag = -1;         // channel, -1 = none
  double photons = 0;   // of those bins
};
ReturnTruth truth_of(const ResponseHead& head, const ResponseRow& row, double time, double reach);

// s, adjusted standard GPS time: seconds since 1980-01-06 without leap seconds, less 1e9 (ASPRS LAS 1.4, global bit 0).
// To 6e-8 s, the step of the double there.
double adjusted_gps_time(const Instant& instant);

}  // namespace suite
