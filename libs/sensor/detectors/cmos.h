// Active-pixel detectors: every pixel has an amplifier of its own, every column a converter.
#pragma once
#include "base/params.h"
#include "sensor/detectors/array_detector.h"

namespace suite {

struct CmosKeys {
  // Electrons; the read noise of pixels is log-normal about its median, exp(deviation * Gauss); deviation 0: all alike.
  double read_median = 0, read_deviation = 0;
  double column_noise = 0, row_noise = 0;  // electrons, standard deviation, new in every read-out
  double column_offset = 0;                // the same of all read-outs
  // Random telegraph signal: a share of pixels has a trap that shifts the level by an amplitude, exponential over
  // pixels with this mean (electrons), while it is filled: this share of the time, at each of the two samples that are
  // subtracted.
  double trapped = 0, amplitude = 0, duty = 0.5;
};
// Keys read_noise_e: N | {median, mean}, column_noise_e, row_noise_e, column_offset_e, telegraph: {share, amplitude_e,
// duty}. read_noise: where there is none, electrons.
CmosKeys read_cmos(const Params& p, double read_noise);

// dn_and_electrons: counts of whole electrons beside those of the converter.
enum class CmosProducts : uint8_t { dn, dn_and_electrons };
std::shared_ptr<const ArrayDetector> make_cmos(const DetectorSpec& d, const CmosKeys& keys, CmosProducts products);

}  // namespace suite
