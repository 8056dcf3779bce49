// Memory of one thread for the light along a way through real air (stratified_air.cpp), per bin.
#pragma once
#include <vector>

#include "light/air_loops.h"

namespace suite {

struct AirScratch {
  using Row = std::vector<float>;
  // What is left of a beam somewhere.
  struct BeamAt {
    Row depth, light;    // exp(-depth)
    bool lit = false;    // not in the shadow of the Earth
    bool known = false;  // has been looked up
  };
  Row depth, keep, even, change;  // of the piece
  Row at_near, at_far;            // its source there
  air_loops::Weights weights(size_t i = 0) { return {&depth[i], &keep[i], &even[i], &change[i]}; }
  std::vector<BeamAt> near, far;         // per beam, at the ends of the piece
  BeamAt edge;                           // where the shadow of the Earth begins
  Row dark_T, lit_depth, lit_keep;       // up to the lit part of a piece, and of it
  Row scattered;                         // what a metre of a beam's way sends back if nothing dims it, W/(m3 sr um)
  std::vector<std::vector<Row>> phases;  // per beam and kind, 1/sr; empty: not yet known
  std::vector<double> cosines;           // per beam, of scattering

  void fit(size_t bins, size_t beams, size_t kinds) {
    if (depth.size() == bins && near.size() == beams && (phases.empty() || phases[0].size() == kinds)) return;
    *this = {};
    for (Row* row : {&depth, &keep, &even, &change, &at_near, &at_far, &scattered, &dark_T, &lit_depth, &lit_keep,
                     &edge.depth, &edge.light})
      row->resize(bins);
    near.assign(beams, {Row(bins), Row(bins)}), far = near;
    phases.assign(beams, std::vector<Row>(kinds));
    cosines.resize(beams);
  }
};

}  // namespace suite
