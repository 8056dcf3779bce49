// What drives a simulation (paper, section III-B and III-C): a sensor lists its spectral states, tasks (time windows)
// and captures; a capture is a set of radiometric problems (pixels); the core asks it for rays and hands back results.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/mueller.h"
#include "math/vec.h"
#include "spectral/state.h"

namespace suite {

struct RunFacts;  // run_facts.h

struct TimeWindow {
  double begin = 0, end = 0;  // s, simulation time; begin == end is an instant
  bool operator==(const TimeWindow&) const = default;
};

// How many paths a problem may take (paper, section III-C: minimum, maximum, convergence at the reference wavelength).
struct Convergence {
  uint32_t min_paths = 64, max_paths = 64;
  double relative_error = 0;  // target for the relative standard error; 0 = none, max_paths is used
  double absolute_floor = 0;  // W/(m2 sr um): below it the error is judged absolutely
};

// Noise of a detector beside which the Monte Carlo error of a band is judged: its variance is constant + linear *
// radiance.
struct BandNoise {
  double constant = 0;  // (W/(m2 sr um))^2
  double linear = 0;    // W/(m2 sr um)
};

// One event of data collection: a frame, some lines. Problems are laid out in rows and columns.
struct Capture {
  std::string name;                // unique within the sensor
  TimeWindow window;               // all rays have their times inside it
  uint32_t columns = 0, rows = 0;  // problems = columns * rows, row-major
  size_t state = 0;                // index into Sensor::states()
  Convergence convergence;
  // Target for the relative standard error of each band, 0 = its error does not matter. Empty: the target is
  // convergence.relative_error at the reference wavelength. convergence.relative_error is the least of those that
  // matter.
  std::vector<double> band_targets;
  // Of each band; convergence.relative_error is then the target for its standard error over the root of that variance.
  // Both 0: the band does not matter. Empty: not judged so.
  std::vector<BandNoise> detector_noise;
  bool own_convergence = false;  // Sensor::convergence says for each problem what it may take
  bool neighbours = true;        // problems beside each other look at things beside each other
  // A problem's radiance may be split into bins, each with a mean of its own. time: the window is cut into equal parts,
  // and each bin is the radiance during its part. escape: bins are cells of the upper hemisphere, `escape_rings` rings
  // of equal solid angle from the horizon to the zenith times bins / escape_rings equal azimuths, the first about east;
  // each is the part of the radiance that came in from there along paths that left the scene (the bins add up to the
  // radiance from above).
  // sun: bin i is the radiance under a collimated sun of unit spectral irradiance towards suns[i] and nothing else; all
  // bins share their paths (only for scenes without media, air and period-breaking sources; see
  // transport/sinks/radiance.h).
  enum class BinBy : uint8_t { none, time, escape, sun } bin_by = BinBy::none;
  uint32_t bins = 1, escape_rings = 0;
  std::vector<Dir> suns;
  uint8_t reversed = 0;  // for the sensor's own use: which of the picture's axes run against its detectors
  size_t problems() const { return size_t{columns} * rows; }
  // Where a problem lies.
  struct Place {
    uint32_t column, row;
  };
  Place place_of(size_t problem) const {
    // Every ray asks for it, and numbers of 32 bits are divided in a third of the time.
    if (const auto n = static_cast<uint32_t>(problem); n == problem) return {n % columns, n / columns};
    return {static_cast<uint32_t>(problem % columns), static_cast<uint32_t>(problem / columns)};
  }
};

struct Task {
  std::string name;
  TimeWindow window;
  std::vector<Capture> captures;
};

// What the core asks a ray for.
struct RayRequest {
  const Capture& capture;
  size_t problem = 0;
  // Sensor::numbers() uniform numbers in [0, 1), stratified over the samples of the problem: use the first for what
  // matters most (pixel x, pixel y, time, ...).
  std::span<const double> u;
  // One place per bin of the state, for a sensor that weighs wavelengths differently; see SensorRay::spectral.
  std::span<float> spectral;
};

// One sample ray of a problem.
struct SensorRay {
  Ray ray;            // ENU, unit direction, time inside the capture's window
  double weight = 1;  // pupil weight, same for all wavelengths; 0 = contributes nothing
  // True when RayRequest::spectral was filled: the ray was drawn with a density that is not right for every wavelength,
  // and each bin's radiance is multiplied by (wanted density at that wavelength) / (density that it was drawn with).
  // These weights are independent of the path that follows, so they multiply its own balance-heuristic weights; a
  // sensor keeps them bounded by drawing from the mixture over the wavelengths of the state.
  bool spectral = false;
  // Rays that collect light over many directions instead of looking into one. plane: at ray.origin, facing
  // ray.direction; the sample is irradiance / pi. sphere: flux through a small sphere / (4 pi). The core chooses where
  // to look and asks Sun, Moon, sky and lamps as it does at surfaces; the receiver counts as a node of the path.
  enum class Receiver : uint8_t { none, plane, sphere } receiver = Receiver::none;
  // Far points (stars) straight ahead are put on the focal plane by other means (point_images.h).
  bool points_apart = false;
};

// The frame that a sensor tells Stokes vectors in (libs/math/CONVENTIONS.md).
enum class StokesFrame : uint8_t {
  meridian,          // +Q in the plane of the vertical and the ray
  image,             // +Q up in the picture
  scattering_plane,  // +Q in the plane of the sun and the ray
};
// How a sensor sees polarisation. Its channels then name Q, U, V as it wants them.
struct Polarimetry {
  StokesFrame frame = StokesFrame::meridian;
  Vec3 up = {};  // of `image`: what is up in the picture, along no ray
  Vec3 axis =
      {};  // of pictures that are no perspective or map: their middle, from which `up` is taken along great circles
  // What stands before the detector, as a matrix in that frame; the radiance is the intensity behind it.
  std::optional<Mueller> analyser;
};

// Results of one capture, all problems, row-major. Spectral quantities per band; means and standard errors.
struct CaptureResult {
  size_t task = 0, capture = 0;
  uint32_t columns = 0, rows = 0;
  size_t bands = 0;
  size_t channels = 1, bins = 1;
  std::vector<double> radiance;          // [problem][channel][bin][band], W/(m2 sr um)
  std::vector<double> standard_error;    // [problem][channel][bin][band]
  double error_degrees = 3;              // of freedom of the standard errors, for Student's quantile
  std::vector<uint32_t> paths;           // [problem]
  std::vector<uint8_t> quality;          // [problem], bits of QualityFlag
  std::vector<std::string> truth_names;  // "material", "range [m]", ...
  std::vector<double> truth;             // [problem][truth_names]; NaN = no data
  std::vector<double>
      error_correlation;  // [band][band] of the first channel: bands share paths, so their errors do too
  // Of sensors that tell Q and U: covariances of the errors of their means, II, IQ, IU, QQ, QU, UU; else empty.
  std::vector<double> stokes_covariance;  // [problem][band][6]
  size_t problems() const { return size_t{columns} * rows; }
  size_t values_per_problem() const { return channels * bins * bands; }
};
// What each means, in words: quality.h.
enum QualityFlag : uint8_t {
  quality_heavy_tail = 1,  // rare events: the true error may be far beyond the reported one
  quality_failures = 2,    // NaN or negative samples were rejected
  // Both only where it is more than a tenth of the standard error, too (scheduler/shortfall.h).
  quality_truncated = 4,   // more than 1 % of the energy was cut at the maximum number of nodes
  quality_unresolved = 8,  // light behind smooth refracting surfaces was not found, and would change more than 0.1 %
  quality_clipped = 16,    // of detectors: counts beyond an end of the converter, or charge beyond the full well
  quality_no_information =
      32,  // value or error is unknown: no sample counted, or one group of them alone brought light
};

// What the numbers of an image are, and what goes with it. Paths, errors, targets and products know radiance only: it
// is turned into the quantity when it is delivered.
enum class Quantity { radiance, toa_reflectance, brightness_temperature, remote_sensing_reflectance };
struct ImageWishes {
  Quantity quantity = Quantity::radiance;
  Where where = {};          // where the user asked for it, for messages
  bool geolocation = false;  // the place of every pixel and a table that maps it, beside the image; needs the truth
                             // `location`
  double pixel = 0;          // of the grid of table and maps, m, or degrees of a geographic system; 0 = from the data
  int epsg = 0;              // of that grid; 0 = the UTM zone of the picture's middle
  Where place_where = {};    // of the keys of `geolocation`
  enum class Resampling : uint8_t { area, nearest };
  std::optional<Resampling> resampling;  // of maps (GeoTIFF); by area unless asked for
  Vec3 irradiance_at = {};  // m, ENU: where light from above is taken that remote-sensing reflectance is over
};

// A text that a sensor writes: a log, a table of results.
struct TextFile {
  std::string name;  // file name without folder
  std::string text;
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual std::string name() const = 0;
  virtual std::span<const SpectralState> states() const = 0;
  virtual std::span<const Band> bands(size_t state) const = 0;
  // Takes a state with other bins in the place of one whose `choice` asks for them (scheduler/bins.h): the same window
  // and reference wavelength. Called before any capture begins, from one thread.
  virtual void take_state(size_t state, SpectralState with_bins);
  virtual std::span<const Task> tasks() const = 0;
  // Uniform numbers that one ray takes, 1..8. The first four form one stratified block, the others a second.
  virtual int numbers() const { return 4; }
  // The channels of its results, each a part of the light that has means and errors of its own: names of rows of the
  // table in transport/channels.h; the first is radiance, which is all of it.
  virtual std::span<const std::string> channels() const;
  // The truth to collect for each problem: names of rows of the table in transport/truth.
  virtual std::span<const std::string> truth() const;
  // What the user wants of the images of a capture.
  virtual ImageWishes wishes(const Capture&) const { return {}; }
  // What a problem of a capture with own_convergence may take, instead of what the capture says for all. Asked before
  // the job starts, from one thread; at least one path.
  virtual Convergence convergence(const Capture& capture, size_t) const { return capture.convergence; }
  // Called before a run's first capture, from one thread, when its bins are chosen.
  virtual void start(const RunFacts&) {}
  // Called once per capture before it is rendered, from one thread; several captures may be rendered at the same time.
  // Single rays may be asked for before.
  virtual void begin(const Capture&) {}
  // The ray of a sample. Called from many threads; does not throw.
  virtual SensorRay ray(const RayRequest& request) const = 0;
  // Called once per capture, from one thread, in any order of captures. The job is over when all have been accepted.
  virtual void accept(CaptureResult&& result) = 0;
  // Texts that do not depend on rendering (logs of pose and time), asked for when the job is over.
  virtual std::vector<TextFile> logs() const { return {}; }
  // Null: the sensor does not see polarisation, and paths carry none.
  virtual const Polarimetry* polarimetry() const { return nullptr; }
};

// What is collected unless a sensor or its user says otherwise.
std::span<const std::string> default_truth();
std::span<const std::string> default_channels();  // radiance

}  // namespace suite
