// For which wavelengths a fitted quad-tree speaks, and what holds beyond.
//
// A channel stands for the wavelengths that are nearer to it than to any other: the outermost reach half of the spacing
// to their neighbours beyond themselves. A single channel reaches kAlone of its wavelength to either side.
#pragma once
#include "optics/model_spec.h"

namespace suite {

struct StoredRange {
  static constexpr double kAlone = 0.05;
  double low_um = 0, high_um = 0;
  Outside outside = Outside::error;
  // Inside, or another rule than `error` is declared.
  bool covers(double low, double high) const;
};

// Of a spec whose bundle is there; the rule is its text "outside" (error, hold, zero; without it error). Error for
// another word.
StoredRange stored_range(const ModelSpec& spec);
// "'satin.sqt' stands for 0.4 to 0.7 um" when a spec with a bundle is asked beyond what is stored and no rule says what
// holds there; empty otherwise.
std::string beyond_stored(const ModelSpec& spec, double low_um, double high_um);
// Error in that case. what: "model", "phase function".
void require_stored(const ModelSpec& spec, double low_um, double high_um, const char* what);

}  // namespace suite
