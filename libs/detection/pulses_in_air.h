// Range ambiguity: light of earlier pulses that arrives after the next ones were emitted.
//
// A receiver knows of an arrival only the time since the last emission; arrivals beyond the interval of pulses come out
// folded by it (c / (2 PRF) of range), into a row that also holds what the later pulse itself brings.
#pragma once
#include <deque>

#include "detection/response.h"
#include "detection/waveform.h"

namespace suite {

// unfold: arrivals are told from their own pulse, as if the receiver knew it (multiple pulses in air resolved).
enum class PulsesInAir { refuse, fold, unfold };

class FoldedRows {
 public:
  FoldedRows(const ResponseHead& head, PulsesInAir how) : head_(head), how_(how) {}
  // next: s after the epoch, of the emission that follows; infinite for the last pulse. Rows of one pixel after the
  // other, pulses in their order. Error: pulses out of order, or under `refuse` light later than the next emission.
  std::vector<PhotonArrival> arrivals(const ResponseRow& row, double next);
  // s after the emission, where the receiver of the row stops listening: the next emission, or never.
  double listening(const ResponsePulse& pulse, double next) const;

 private:
  struct Late {
    double time;  // s after the epoch
    double photons, variance;
  };
  ResponseHead head_;
  PulsesInAir how_;
  std::vector<std::deque<Late>> late_;  // of each pixel
};

}  // namespace suite
