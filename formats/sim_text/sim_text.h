// A simulation as a user writes it: YAML (or JSON) that names a prepared scene, sources, sensors and output. See
// FORMAT.md.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/params.h"
#include "heat/heat_balance.h"
#include "lidar/instrument.h"
#include "scheduler/scheduler.h"
#include "sensor/sensors.h"

namespace suite {

// How radiance becomes a picture for people.
struct PreviewSpec {
  std::vector<std::string> bands;  // names of three (red, green, blue) or one; empty = chosen by wavelength
  enum class Show { natural, radiance, kelvin } show = Show::natural;  // natural: kelvin for one band beyond 3 um
  double low_percent = 1, high_percent = 99;   // of all values: black and white, unless there is a range
  std::optional<std::array<double, 2>> range;  // W/(m2 sr um) or K
  double gamma = 0;                            // 0 = that of sRGB; radiance only
  bool bar = true;                             // beside pictures of one band
};

struct OutputSpec {
  enum class Type { float32, float64, uint16 } type = Type::float32;
  double scale = 1;  // uint16: what one count stands for, in the units
  enum class Order { bsq, bil, bip } order = Order::bsq;
  // How images are cut into files: as each image suggests (lines of a task in one file, frames each in their own), or
  // so.
  enum class Files { natural, capture, task, simulation } files = Files::natural;
  enum class Units { w_m2, w_cm2, photons } units = Units::w_m2;  // per sr and um; photons per s
  bool geotiff = false, exr = false;                              // beside ENVI
  PreviewSpec preview;
  std::map<std::string, PreviewSpec> previews;  // of sensors that have their own
  const PreviewSpec& preview_of(const std::string& sensor) const {
    const auto own = previews.find(sensor);
    return own == previews.end() ? preview : own->second;
  }
};

// One of the prepared scenes that the simulation puts together; see libs/scene/combine.h.
struct SimulationScene {
  std::string path;
  std::optional<Affine3> placement;     // none: by its origin on the Earth
  std::shared_ptr<const Track> motion;  // null: at rest
  TimeSpan life = kAlways;              // s: of the whole scene
};

// Temperatures that are to be found from weather.
struct HeatRequest {
  std::shared_ptr<const Weather> weather;
  HeatSpec spec;                                     // its span is still to be chosen unless `span` is given
  std::optional<TimeSpan> span;                      // s
  std::vector<std::pair<std::string, Vec3>> probes;  // m, scene ENU
  bool keep_operator = false;                        // what paths find, for other weather and to go on from
  double save_every = 20;                            // s
  bool final_gather = false;                         // temperatures at points, as sharp as shadows are
  double leave_out = 0;  // K, what elements that are left out may do to what is seen; 0 = none
  Where where;
};

// A laser radar among the sensors.
struct SimulationLidar {
  LidarInstrument instrument;
  Where where;  // in the text
};

struct Simulation {
  std::string path;
  std::vector<std::string> settings;  // applied to the text
  std::vector<std::string> files;     // that the text names, the scenes' included
  std::vector<SimulationScene> scenes;
  std::string scene_path;  // of the first
  PipelineOptions pipeline;
  std::optional<Periodic> periodic;
  Where periodic_where;
  SourceSpecs sources;       // as written: dates, phases and clear skies are still to be resolved
  std::optional<Utc> epoch;  // of second 0: key `epoch`, or the sun's or the moon's date
  double dut1 = 0;           // s, UT1 - UTC at second 0
  bool dut1_given = false;   // by the text
  std::vector<std::unique_ptr<Sensor>> sensors;
  std::vector<Where> sensor_where;  // of each, in the text
  std::vector<SimulationLidar> lidars;
  // Set where there are laser radars: the text, of which what detection reads (LidarInstrument::detection) has not been
  // read. Who reads it asks for reject_unread().
  std::optional<Params> unread;
  OutputSpec output;
  std::optional<HeatRequest> heat;
};

// What reading needs from the application.
struct SimulationCallbacks {
  std::function<void(const Delivery&)> deliver;  // receives the finished captures of the sensors
  // Origin on the Earth of a prepared scene; asked only when a motion needs to know.
  std::function<GeodeticOrigin(const std::string& path, const std::vector<SimulationScene>& scenes)> origin;
};
// settings: "PATH=VALUE", values in place of the text's (base/params.h). Error located in the text or setting for
// anything wrong, unread keys included.
Simulation read_simulation(const std::string& path, const SimulationCallbacks& callbacks,
                           std::vector<std::string> settings = {});

// The same of a text that a program made of other files (Params::parse_made), the settings applied; path: the file that
// all started from. `files` gets what the text names, the others are the caller's to add.
Simulation read_simulation_tree(const Params& root, const std::string& path, const SimulationCallbacks& callbacks,
                                std::vector<std::string> settings);

}  // namespace suite
