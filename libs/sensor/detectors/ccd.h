// The detector of shot noise, dark current and Gaussian read noise.
#pragma once
#include "sensor/detectors/array_detector.h"

namespace suite {

// Reads read_noise_e, shot_noise, background_k and netd_k, after the pixels and the converter. bias: default, counts.
void read_charge_detector(const Params& p, double bias, DetectorSpec& d);
std::shared_ptr<const ArrayDetector> make_charge_detector(const DetectorSpec& d);

}  // namespace suite
