// What heats and cools a surface, as functions of time. Ray tracing and weather files fill these; the solver only asks.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace suite {

// The load on one face of a slab at one moment.
struct SurfaceLoad {
  double sun_absorbed = 0;     // W/m2, shortwave already multiplied by the absorptance
  double sky_irradiance = 0;   // W/m2, longwave arriving; the emissivity of the face absorbs its share
  double air_temperature = 0;  // K; only used where the face has convection
  double wind = 0;             // m/s
};

// Right-continuous in time: at a jump it gives the value after it.
using Loads = std::function<SurfaceLoad(double t)>;
using TimeFunction = std::function<double(double t)>;

// A table of loads over ascending times (s), linear in between.
class LoadTable {
 public:
  enum class Outside { refuse, repeat };  // repeat: period = last time - first time; first and last load are one moment
  // Error: no rows, sizes that differ, times not strictly ascending, values that are not finite or negative (but sky
  // irradiance and wind may be 0); repeat with one row.
  LoadTable(std::vector<double> times, std::vector<SurfaceLoad> loads, Outside outside);
  // Error outside the table unless it repeats.
  SurfaceLoad at(double t) const;
  double begin() const { return times_.front(); }
  double end() const { return times_.back(); }
  // The table as a function; it shares the data.
  static Loads function(std::shared_ptr<const LoadTable> table);

 private:
  std::vector<double> times_;
  std::vector<SurfaceLoad> loads_;
  Outside outside_;
};

// Values over ascending times, linear in between; the same rules as LoadTable. For tabulated temperatures (K > 0 is the
// caller's to check).
class TimeTable {
 public:
  TimeTable(std::vector<double> times, std::vector<double> values, LoadTable::Outside outside);
  double at(double t) const;

 private:
  std::vector<double> times_, values_;
  LoadTable::Outside outside_;
};

}  // namespace suite
