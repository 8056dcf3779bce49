// Stiff and extreme cases as rows of one table: a name, a reference, a bound, and a small function that measures the
// error. Adding a case is adding a row to one of the cases_*.cpp files.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "extreme/numerics.h"

namespace suite::extreme {

// How far a quantity can be driven before its error leaves the bound.
struct Sweep {
  std::string parameter, unit;  // empty = the case has nothing to drive
  double from = 0, to = 0;      // both > 0; the case's own setting is `from`
  double factor = 10;           // > 1: step of the sweep
};

struct Case {
  std::string group, name;
  std::string reference;  // what the error is against: closed form, long double, published table
  std::string unit;       // of error and bound; "1" = relative
  double bound = 0;       // the case holds when error <= bound; 0 = exactly
  // Error of the quantity when the sweep's parameter is x; NaN never holds.
  std::function<double(const Numerics&, double x)> error;
  Sweep sweep;
  std::string open;  // why the case cannot run yet; empty = it runs
};

struct Outcome {
  double error = 0;
  bool held = false;
  double seconds = 0;
};
Outcome measure(const Case& c, const Numerics& numerics);
// The last value of the sweep that is still inside the bound (0 = not even the first); reaches_end: nothing broke.
double limit_of(const Case& c, const Numerics& numerics, bool& reaches_end);

// All rows, group by group.
std::vector<Case> all_cases();
std::vector<Case> quantity_cases(), optics_cases(), scene_cases(), motion_cases(), thermal_cases(), media_cases(),
    air_cases(), water_cases(), heat_cases(), polarisation_cases(), lidar_cases(), night_cases();

}  // namespace suite::extreme
