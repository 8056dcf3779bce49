// Intervals of range bins that hold the true mean with a given confidence, from the scrambles of a bin.
//
// A bin's scrambles are few and of further orders of scattering heavily skewed: an interval of so many standard errors
// to either side then misses the mean on its long side (10 to 15 % of the time in place of 2.5). Hall's cubic
// transformation takes the skewness out of Student's statistic; where there is none it is Student's interval.
// Based on: P. Hall, "On the removal of skewness by transformation", J. Royal Statistical Society B 54, 1992, equation
// for g_3; G. Zou, A. Donner, "Construction of confidence limits about effect measures: a general approach", Statistics
// in Medicine 27, 2008 (sums of independent parts).
#pragma once
#include <span>

namespace suite {

struct BinInterval {
  double low = 0, high = 0;
};

// mean, error: of the scrambles; skewness: third central moment of the scrambles over the 3/2 power of their variance,
// both unbiased. scrambles: >= 2. confidence: in (0, 1). Photons are not below 0, and neither is `low`.
BinInterval bin_interval(double mean, double error, double skewness, int scrambles, double confidence);

// What of two independent parts is known of their sum.
struct BinPart {
  double mean;
  BinInterval interval;
};
BinInterval interval_of_sum(const BinPart& a, const BinPart& b);

// Skewness of values as bin_interval() takes it; 0 of fewer than three, and where all are alike.
double skewness_of(std::span<const double> values);

}  // namespace suite
