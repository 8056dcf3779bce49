// A simulation as a user writes it: YAML (or JSON) that names a prepared scene, sources, sensors and output. See FORMAT.md.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scheduler/scheduler.h"
#include "sensor/sensors.h"

namespace suite {

struct OutputSpec {
  enum class Type { float32, float64 } type = Type::float32;
  enum class Order { bsq, bil, bip } order = Order::bsq;
  std::vector<std::string> preview;  // names of three bands (red, green, blue) or one; empty = chosen by wavelength
};

// One of the prepared scenes that the simulation puts together; see libs/scene/combine.h.
struct SimulationScene {
  std::string path;
  std::optional<Affine3> placement;      // none: by its origin on the Earth
  std::shared_ptr<const Track> motion;   // null: at rest
};

struct Simulation {
  std::string path;
  std::vector<SimulationScene> scenes;
  std::string scene_path;                // of the first
  PipelineOptions pipeline;
  std::optional<Periodic> periodic;
  SourceSpecs sources;               // as written: dates, phases and clear skies are still to be resolved
  std::vector<std::unique_ptr<Sensor>> sensors;
  OutputSpec output;
};

// deliver: receives the finished captures of the sensors. Error located in the text for anything wrong, unread keys
// included.
Simulation read_simulation(const std::string& path, const std::function<void(const Sensor&, const CaptureResult&)>& deliver);

}  // namespace suite
