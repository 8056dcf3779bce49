// Spectra of lamps as sums of Gaussian lines and bands, made here so that their colours are those of the kinds: the
// LEDs lie on Planck's locus at their temperature (CIE 1931, within 2 %), high-pressure sodium near 1900 K, metal
// halide and coated mercury lamps between 3500 and 3900 K. For illumination and camera signals; not for spectroscopy.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace suite {

// sodium, metal_halide, mercury, led_2700, led_3000, led_4000, led_5000.
std::vector<std::string> lamp_names();
// W/um of a lamp that sends 1 W in all, 0.35 to 0.85 um, zero outside. Bug: no such name.
Curve lamp_spectrum(const std::string& name);

}  // namespace suite
