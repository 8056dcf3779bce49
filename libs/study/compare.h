// One run against a reference: how far off, in which direction, and whether the reported errors cover it.
//
// Based on: Student's interval with the degrees of freedom of the scrambles, combined with the reference's own after
// F. Satterthwaite, "An approximate distribution of estimates of variance components", Biometrics Bulletin 2(6), 1946.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sensor/delivery.h"

namespace suite {

// What a run or a reference says about every problem of every capture, one series a band of a sensor.
struct StudyImage {
  struct Series {
    std::string name;  // "uas: red"
    std::vector<double> radiance,
        standard_error;  // W/(m2 sr um), one value a problem; standard_error may be empty: exact
  };
  std::vector<Series> series;
  std::vector<uint8_t> flagged;  // one value a problem of the first series' sensor order; empty = none
  std::vector<uint32_t> paths;   // paths of each problem; empty = unknown
  double degrees = 3;            // of freedom of the standard errors
};

// Appends a finished capture as series "sensor: band" (radiance channel). Captures of one sensor that have the same
// bands go on in the same series. Bins of time are series of their own; cells of directions are values of one series,
// as pixels are.
void append(StudyImage& image, const Delivery& delivery);

struct Comparison {
  std::string series;
  double relative_rmse = 0;         // root mean square difference by the mean of the reference
  double bias = 0;                  // mean signed difference by the mean of the reference
  double bias_error = 0;            // its standard error from the scatter over problems, both images included
  double reference_bias_error = 0;  // the part of it that the reference brings, which repetitions share
  double coverage = 0;              // share of the counted problems whose 95 % interval contains the reference
  size_t counted = 0;               // problems with a standard error and no flag
  size_t zero_variance = 0;         // problems whose standard error is 0
  size_t flagged = 0;
  size_t exceeding = 0;  // problems whose error is beyond what a missing flag promises (sensor/quality.h), and beyond
                         // twice the reference's own standard error on top of it
  size_t found = 0;      // of these, flagged
};
// Error when the images differ in series or sizes, or when the reference is 0 on the mean.
std::vector<Comparison> compare(const StudyImage& run, const StudyImage& reference);

}  // namespace suite
