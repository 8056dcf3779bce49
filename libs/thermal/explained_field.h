// Temperatures whose causes are known.
#pragma once
#include <cmath>

#include "thermal/temperature.h"

namespace suite {

class ExplainedField : public TemperatureField {
 public:
  // Hours of a day (or of the span that was looked at) with the sun on a place, sunlight that it absorbs and infrared
  // that it receives at the time, W/m2. NaN where nobody knows.
  struct Cause {
    double sun_hours = NAN, absorbed_sun = NAN, longwave_received = NAN;
  };
  virtual Cause cause(const HeatedPlace& place, double time) const = 0;
};

}  // namespace suite
