// Twinkling: how much a star's light differs from its mean as telescopes on the ground see it.
//
// Assumes: apertures larger than the cells of turbulence (some 5 cm; smaller ones see less than this says) and
// exposures of at least 10 ms, as which shorter ones count; all wavelengths alike. Known to a factor of 2 from night to
// night. Based on: A. T. Young, "Photometric error analysis VI: confirmation of Reiger's theory of scintillation",
// Astron. J. 72, 1967.
#pragma once
#include <cstdint>

namespace suite {

// Standard deviation over the mean: 0.09 D^(-2/3) X^1.75 exp(-h / 8000 m) / sqrt(2 t), D in cm, t in s.
double scintillation_index(double aperture_m, double air_mass, double height_m, double exposure_s);

// A factor of mean 1 and that standard deviation, log-normal. key: the same gives the same.
double scintillation(double index, uint64_t key);

}  // namespace suite
