// How particles in natural waters scatter: densities over the scattering angle with forward peaks far narrower than a
// degree, as tables that sample exactly.
#pragma once
#include "optics/phases/cosine_table.h"

namespace suite {

// The analytic function of a crowd of spheres whose sizes follow a power law, in its form with the limit on sizes left
// out: normalised, infinite at 0 (cos_scatter below 1); the table is finite below 1e-6 rad, with the right integral.
// index: of refraction over that of water, above 1; slope: of the size distribution (number per size), 3 to 5, both
// exclusive. Based on: G. Fournier & M. Jonasz, "Computer-based underwater imaging analysis", Proc. SPIE 3761, 1999,
// equations 3-5; C. Mobley, L. Sundman, E. Boss, "Phase function effects on oceanic light fields", Appl. Opt. 41, 2002,
// eq. 7.
double fournier_forand(double index, double slope, double cos_scatter);
CosineTable fournier_forand_table(double index, double slope);
// Share that it scatters by more than 90 degrees, in closed form (Mobley et al. 2002, equation 8).
double fournier_forand_backscatter(double index, double slope);

struct SeaParticles {
  double index, slope;
};
// The pair on the line index = 1.01 + 0.1542 (slope - 3) that scatters this share backwards (Mobley et al. 2002,
// equation 9). backscatter: kLeastBackscatter to kMostBackscatter.
inline constexpr double kLeastBackscatter = 1e-3, kMostBackscatter = 0.15;
SeaParticles sea_particles(double backscatter);

// The mean of three of T. Petzold's measurements in San Diego harbour, less water ("average particle"): a power law
// below 0.1 degrees.
// Based on: C. Mobley, "Light and Water", 1994, table 3.10 (T. Petzold, "Volume scattering functions for selected ocean
// waters", SIO Ref. 72-78, 1972); C. Mobley et al., Appl. Opt. 32, 1993, table 2.
CosineTable petzold_table();
CosineTable hg_table(double g);

}  // namespace suite
