// Reflectances from display colours (sRGB, IEC 61966-2-1). A colour is three numbers and a spectrum is not: of the
// spectra that show the colour under daylight one of the smoothest is taken.
// Based on: I. Mallett, C. Yuksel, "Spectral Primary Decomposition for Rendering with sRGB Reflectance", EGSR 2019: a
// linear colour times three spectra that are nowhere negative and sum to 1. Those here are made anew, linear between
// 17 wavelengths: least sum of squared slopes, so that the three show sRGB's primaries under CIE D65 to the CIE 1931
// standard observer (CIE 018:2019 and ISO/CIE 11664-2:2022, sums over 1 nm).
#pragma once
#include <array>
#include <span>

#include "spectral/curve.h"

namespace suite {

using LinearRgb = std::array<double, 3>;  // of sRGB's primaries, linear; 0 to 1

// IEC 61966-2-1: a display value of 0 to 1 as a linear one, and back.
double linear_from_srgb(double display);
double srgb_from_linear(double linear);

inline constexpr size_t kUpliftedWaves = 17;
// Where an uplifted reflectance has values, um: 0.38 to 0.78. Between them it is linear.
std::span<const double, kUpliftedWaves> uplifted_wavelengths_um();
// The reflectance at those wavelengths: from the least to the largest of the three numbers, which are taken as 0 to 1.
// Colours come back within 0.4 of a level of 255, neutral ones flat.
std::array<double, kUpliftedWaves> uplifted_values(const LinearRgb& colour);
// The same as a curve. Beyond its ends, where a colour says nothing, the value of the end holds.
Curve uplifted(const LinearRgb& colour);

// How the descriptions of materials begin whose spectra are uplifted.
inline constexpr const char* kUplifted = "uplifted from a display colour";

}  // namespace suite
