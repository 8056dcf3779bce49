// Waveforms of laser pulses in HDF5 with the names of GEDI's L1B product. See FORMAT.md.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "motion/scene_frame.h"

namespace suite {

struct WaveformShot {
  uint64_t shot = 0;  // number of the pulse
  uint32_t pixel = 0;
  double delta_time = 0;  // s, adjusted GPS time where there is an epoch, else simulation time
  std::span<const double> samples, ideal, ideal_error;  // counts
  double noise_mean = 0, noise_deviation = 0;           // counts, of samples without the laser's light
  double start = 0;                                     // s after the emission, middle of the first sample
  Geodetic first, last, instrument;                     // of the first and last sample, and of the receiver
};

class WaveformWriter {
 public:
  WaveformWriter(const std::string& path, const std::string& made_by);
  ~WaveformWriter();
  // number: of the beam, 0..15. sample: s. transmitted: power at samples as long, its maximum 1.
  void begin_beam(size_t number, const std::string& name, double sample, std::span<const double> transmitted);
  void add(size_t beam, const WaveformShot& shot);
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace suite
