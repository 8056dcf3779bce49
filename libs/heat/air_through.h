// The air over the steps of a span, as faces feel it.
#pragma once
#include <vector>

#include "heat/surfaces.h"

namespace suite {

// A law of convection that does not ask the surface. Of dry faces its coefficient, and that times the air's
// temperature, averaged themselves, so that gusts act as they do and not as their mean; of all, film_of() at both ends
// of the steps and at the moments, which would be asked for every face. Empty of other laws.
struct FixedLaw {
  std::vector<StepLine> coefficient, times_air;       // by step
  std::vector<double> film_begin, film_end, film_at;  // W/(m2 K), by step, step, moment
};

class AirThrough {
 public:
  // Keeps a reference to the loads.
  explicit AirThrough(const SurfaceLoads& loads);

  struct Air {
    double kelvin, wind, gusts, vapour;
  };
  // At a fraction of a step, and at a moment: between the lines of the steps before and after it.
  Air at(size_t step, double fraction) const;
  Air around(size_t moment) const;
  // What acts on a face in it, without light.
  FaceWeather weather(const Air& air) const;
  FixedLaw law_of(const FaceTraits& face) const;
  double begins_at() const { return kelvin_.front().mean(); }  // K

 private:
  std::vector<StepLine> lines_of(const std::vector<double>& values) const;

  const SurfaceLoads& loads_;
  std::vector<StepLine> kelvin_, wind_, vapour_;  // by step
  std::vector<double> gusts_;                     // by step
};

}  // namespace suite
