#include "motion/ut1.h"

#include <cmath>

namespace suite {

double dut1_at(Instant instant, Instant epoch, double dut1) {
  const JulianDate from = julian_ut1(epoch, 0), to = julian_ut1(instant, 0);
  const double of_calendar = 86400 * ((to.day - from.day) + (to.fraction - from.fraction));
  return dut1 + std::round((instant - epoch) - of_calendar);
}

}  // namespace suite
