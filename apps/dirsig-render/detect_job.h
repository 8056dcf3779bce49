// Detection that ends in files: of stored responses, and of responses while they are traced.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "detect_output.h"

namespace suite {

// A file of pulse shapes, as `pulse: {kind: file, ...}` names it.
PulseTable pulse_of_file(const Params& pulse);

// Takes responses in the order of their pulses.
class DetectJob : public ResponseSink {
 public:
  struct Place {
    std::string folder;    // of the files; is there when the first pulse comes
    std::string response;  // where responses are stored, for the log
    uint64_t pulses = 0;   // that will come
  };
  // text: has `output`, `las`, `csv`. Located Errors, before anything is written.
  DetectJob(const Params& text, DetectionSpec spec, const ResponseHead& head, Place place);
  // Detects a pulse of which nothing comes back: what is too much for a detector is refused before pulses are traced.
  // start: s after the emission, where range bin 1 begins.
  void rehearse(double start) const;
  void take(ResponseBlock&& block) override;
  void end_pulses();  // the last one is detected
  // Files are there from now on; writes detect.json and tells how many returns there are.
  void finish();

 private:
  struct Counts {
    uint64_t returns = 0, ideal = 0, signal = 0, silent = 0;  // silent: pulses without a return
  };
  void count(const DetectedPulse& pulse);
  Json log() const;
  DetectionSpec spec_;
  ResponseHead head_;
  Place place_;
  std::vector<std::unique_ptr<DetectOutput>> outputs_;
  std::vector<Counts> counts_;  // of each detector
  std::unique_ptr<DetectionRun> run_;
};

}  // namespace suite
