// What drives a simulation (paper, section III-B and III-C): a sensor lists its spectral states, tasks (time windows)
// and captures; a capture is a set of radiometric problems (pixels); the core asks it for rays and hands back results.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "spectral/state.h"

namespace suite {

struct TimeWindow {
  double begin = 0, end = 0;                // s, simulation time; begin == end is an instant
  bool operator==(const TimeWindow&) const = default;
};

// How many paths a problem may take (paper, section III-C: minimum, maximum, convergence at the reference wavelength).
struct Convergence {
  uint32_t min_paths = 64, max_paths = 64;
  double relative_error = 0;                // target for the relative standard error; 0 = none, max_paths is used
  double absolute_floor = 0;                // W/(m2 sr um): below it the error is judged absolutely
};

// One event of data collection: a frame, a line. Problems are laid out in rows and columns so that neighbours are known.
struct Capture {
  std::string name;
  TimeWindow window;
  uint32_t columns = 0, rows = 0;           // problems = columns * rows, row-major
  size_t state = 0;                         // index into Sensor::states()
  Convergence convergence;
  size_t problems() const { return size_t{columns} * rows; }
};

struct Task {
  std::string name;
  TimeWindow window;
  std::vector<Capture> captures;
};

// One sample ray of a problem.
struct SensorRay {
  Ray ray;                                  // ENU, unit direction, time inside the capture's window
  double weight = 1;                        // pupil weight; 0 = contributes nothing
};

// Results of one capture, all problems, row-major. Spectral quantities per bin of the state; means and standard errors.
struct CaptureResult {
  size_t task = 0, capture = 0;
  uint32_t columns = 0, rows = 0;
  size_t bands = 0;
  std::vector<double> radiance;             // [problem][band], W/(m2 sr um)
  std::vector<double> standard_error;       // [problem][band]
  std::vector<uint32_t> paths;              // [problem]
  std::vector<uint8_t> quality;             // [problem], bits of QualityFlag
  std::vector<std::string> truth_names;     // "material", "range_m", ...
  std::vector<double> truth;                // [problem][truth_names]; NaN = no data
  std::vector<double> error_correlation;    // [band][band]: bands share paths, so their errors do too
};
enum QualityFlag : uint8_t {
  quality_heavy_tail = 1,   // a few samples dominate: the interval may not cover
  quality_failures = 2,     // NaN or negative samples were rejected
  quality_truncated = 4,    // more than 1 % of the energy was cut at the maximum number of nodes
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual std::string name() const = 0;
  virtual std::span<const SpectralState> states() const = 0;
  virtual std::span<const Band> bands(size_t state) const = 0;
  virtual std::span<const Task> tasks() const = 0;
  // The ray of a sample: u are uniform numbers (pixel x, pixel y, time, pupil), stratified over the samples of the
  // problem. Called from many threads.
  virtual SensorRay ray(const Capture& capture, size_t problem, std::span<const double, 4> u) const = 0;
  // Called once per capture, from one thread, in the order in which captures run: the one that changes states least.
  virtual void accept(CaptureResult&& result) = 0;
};

}  // namespace suite
