// What is known of the error that the bins of a spectral state make in a band.
#pragma once

namespace suite {

// A bound: `relative` times the band's radiance or `floor`, whichever is larger.
struct BandBias {
  double relative = 0;
  double floor = 0;    // W/(m2 sr um)
  bool within = true;  // what is wanted
  double of(double radiance) const { return relative * (radiance > floor ? radiance : floor); }
};

}  // namespace suite
