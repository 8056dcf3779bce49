// A simulation as a user writes it: YAML (or JSON) that names a prepared scene, sources, sensors and output. See FORMAT.md.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/time.h"
#include "scheduler/scheduler.h"
#include "sensor/sensors.h"

namespace suite {

// A Sun whose direction follows from date and place.
struct SunByTime {
  Utc utc;
  Where where;
  bool disk_from_distance = true;    // half angle from the Earth-Sun distance of the date
};

struct OutputSpec {
  enum class Type { float32, float64, uint16 } type = Type::float32;
  double scale = 1;                  // uint16: what one count stands for, in the units
  enum class Order { bsq, bil, bip } order = Order::bsq;
  // How images are cut into files: as each image suggests (lines of a task in one file, frames each in their own), or so.
  enum class Files { natural, capture, task, simulation } files = Files::natural;
  enum class Units { w_m2, w_cm2, photons } units = Units::w_m2;  // per sr and um; photons per s
  bool geotiff = false, exr = false; // beside ENVI
  std::vector<std::string> preview;  // names of three bands (red, green, blue) or one; empty = chosen by wavelength
};

struct Simulation {
  std::string path;
  std::string scene_path;
  PipelineOptions pipeline;
  std::optional<Periodic> periodic;
  SourceSpecs sources;
  std::optional<SunByTime> sun_by_time;   // sources.sun is there, its direction still to be computed
  std::optional<Utc> epoch;               // of second 0: key `epoch`, or the sun's date
  double dut1 = 0;                        // s, UT1 - UTC
  std::vector<std::unique_ptr<Sensor>> sensors;
  OutputSpec output;
};

// What reading needs from the application.
struct SimulationCallbacks {
  std::function<void(const Delivery&)> deliver;  // receives the finished captures of the sensors
  // Origin on the Earth of a prepared scene; asked only when a motion needs to know.
  std::function<GeodeticOrigin(const std::string& scene_path)> origin;
};
// Error located in the text for anything wrong, unread keys included.
Simulation read_simulation(const std::string& path, const SimulationCallbacks& callbacks);

}  // namespace suite
