// When a lamp is how bright.
#pragma once
#include <vector>

#include "motion/timetable.h"

namespace suite {

// By what a lamp's light is multiplied: the row of the table that holds; 1 before the first one.
struct LampSchedule {
  Timetable when;
  std::vector<double> scale;  // per row, >= 0; 0 = off
};

}  // namespace suite
