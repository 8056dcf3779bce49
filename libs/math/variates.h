// Random variates that detectors are made of, from a generator.
#pragma once
#include "math/sampling.h"

namespace suite {

// Standard normal variate (Box and Muller 1958).
double normal(Pcg32& random);

// Poisson variate with the given mean; 0 unless it is positive. By inversion up to 30, by transformed rejection above.
// Based on: W. Hoermann, "The transformed rejection method for generating Poisson random variables", Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS).
double poisson(double mean, Pcg32& random);

// Gamma variate of the given shape (> 0) and mean shape * scale. Based on: G. Marsaglia, W. W. Tsang, "A simple method
// for generating gamma variables", ACM TOMS 26, 2000; shapes below 1 by their section 6.
double gamma_variate(double shape, double scale, Pcg32& random);
// Exponential variate.
double exponential_variate(double mean, Pcg32& random);

// Successes in so many trials of probability p, 0..1. Based on: D. A. Relles, "A simple algorithm for generating
// binomial random variables when N is large", JASA 67, 1972 (a beta variate says where the median trial lies).
uint32_t binomial(uint32_t trials, double p, Pcg32& random);

}  // namespace suite
