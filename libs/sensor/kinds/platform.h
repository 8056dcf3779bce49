// The parts of the default sensor: a vehicle that carries instruments. Internal to libs/sensor/kinds.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sensor/analyser.h"
#include "sensor/degree_target.h"
#include "sensor/detectors/detectors.h"
#include "sensor/lens.h"
#include "sensor/mount.h"
#include "sensor/polarimetry.h"
#include "sensor/psf.h"
#include "sensor/sensors.h"

namespace suite {

struct PointShare;

// When the detectors of an array integrate.
struct Readout {
  enum class Kind {
    global,   // all at once
    rolling,  // row by row, `row_time` apart
    line,     // one row of detectors; the rows of the image are moments, `line_period` apart (push-broom)
    whisk     // one column of detectors swept across: columns of the image are moments `sample_period` apart, scans
              // `line_period` apart
  } kind = Kind::global;
  double integration = 0;     // s, of one detector (of one stage with time delay and integration)
  double row_time = 0;        // s
  double line_period = 0;     // s
  double sample_period = 0;   // s
  uint32_t samples = 0;       // of a whisk scan
  uint32_t per_capture = 64;  // lines or scans that make one capture
  uint32_t stages = 1;        // time delay and integration: line only
  int direction = 1;          // +1: the charge moves down the picture, as the image does in forward flight
  double exposure() const { return integration * stages; }
};

struct Chip {
  uint32_t columns = 0, rows = 0;
  Vec2 offset;                             // m in the focal plane, right and down, of its centre
  double gain = 1;                         // relative response
  std::optional<Convergence> convergence;  // instead of the array's
  uint32_t first_column = 0;               // in the array's image
};

struct FocalArray {
  std::string image;
  Vec2 pitch;  // m
  bool flip_columns = false, flip_rows = false;
  std::vector<Chip> chips;
  uint32_t columns = 0, rows = 0;  // of detectors, over all chips
  Readout readout;
  uint32_t time_bins = 1;  // parts of the exposure, each with a picture of its own
  std::optional<DetectorSpec> detector;
  std::shared_ptr<const ArrayDetector> reader;   // null without counts
  std::optional<Analysers> analysers;            // before its detectors
  std::vector<std::vector<std::string>> mosaic;  // [row][column]: the band that a detector counts; empty = all bands
  ImageWishes wishes;
  size_t instrument = 0;
  std::vector<size_t> segments;
  bool scans() const { return readout.kind == Readout::Kind::line || readout.kind == Readout::Kind::whisk; }
  uint32_t image_columns() const { return readout.kind == Readout::Kind::whisk ? readout.samples : columns; }
};

// Chips of an array that share their bands; the unit that is captured. Its number is the number of its spectral state.
struct Segment {
  size_t array = 0, first_chip = 0, chips = 0;
  uint32_t first_column = 0, columns = 0;  // of the array's image
  std::vector<Band> bands;                 // as listed, then those that count photons when there is a detector
  size_t radiance_bands = 0;
  Convergence convergence;                // of its chips without one of their own
  std::vector<double> band_targets;       // of the radiance bands; empty = the reference decides
  DegreeTarget degree_target;             // of the degree of polarisation
  std::vector<BandNoise> detector_noise;  // of all bands; empty = the error is judged beside radiance
  std::vector<double> electrons;          // per W/(m2 um) s m2 of irradiance, of each band
  std::unique_ptr<const PointSpread> psf;
};

struct Instrument {
  std::string name;
  Lens lens;
  std::vector<Attachment> chain;            // from the vehicle outwards
  Params text;                              // where it was written
  std::vector<double> triggers;             // s, of frames, when they do not follow a clock
  double clock_rate = 0, clock_offset = 0;  // Hz, s; rate 0 = one frame a task
  double trigger_distance = 0;              // m along the track; 0 = none
  double log_rate = 0;                      // Hz; > 0: a log of pose and time instead of images
};

// What the text of a platform says.
struct PlatformSpec {
  std::string name;
  TrackPtr track;
  std::shared_ptr<const Jitter> jitter;  // null = none
  std::vector<Instrument> instruments;
  std::vector<FocalArray> arrays;
  std::vector<Segment> segments;
  std::vector<SpectralState> states;  // of the segments
  std::vector<Task> tasks;            // with captures
  struct Part {                       // what a capture is
    size_t array = 0, segment = 0;
    uint64_t event = 0;  // number of the frame or block; the segments of one event share it
  };
  std::vector<std::vector<Part>> parts;  // [task][capture]
  std::vector<std::string> truth, channels;
  ImageWishes wishes;  // of arrays that do not say
  std::optional<Polarimetry> polarimetry;
};

// platform_read.cpp. Error, located, for anything wrong, motion that does not cover the tasks included.
PlatformSpec read_platform(const Params& params, const SensorContext& context);
// platform_tasks.cpp: fills tasks and parts.
void plan_captures(PlatformSpec& spec, const Params& params, const SensorContext& context);

// The place in the focal plane (m) of a point of a detector, at shares u, v of its width and height, and its chip.
struct DetectorPlace {
  Vec2 place;
  const Chip* chip = nullptr;
};
DetectorPlace place_of(const FocalArray& array, uint32_t column, uint32_t row, double u, double v);

// platform_strips.cpp: which way up the pictures of push-brooms and whiskbrooms are. Lines follow in time downwards,
// and columns, and the detectors of a whisk scan, are put in the order in which the picture is not mirrored.
constexpr uint8_t kColumnsReversed = 1, kRowsReversed = 2;  // Capture::reversed
void turn_strips(PlatformSpec& spec);
// What a pixel of a capture is: a detector (column over all chips of the array, row) and when it begins to integrate, s
// after the capture began.
struct Exposed {
  uint32_t column = 0, row = 0;
  double delay = 0;
};
Exposed exposed(const PlatformSpec& spec, const Capture& capture, size_t problem);
// For headers: when each line of a task's picture is taken, and where on the compass the picture's axes point.
std::string lines_text(const PlatformSpec& spec, size_t task, size_t array, const SensorContext& context);

// platform_stokes.cpp. Before the arrays: keys stokes and stokes_frame. After the captures are planned: the frame in
// which paths bring Stokes vectors, `up` of `image` being one direction for all instruments and times, along which none
// of them looks. Error, located: instruments that look everywhere.
void read_stokes(const Params& params, PlatformSpec& spec);
void choose_frame(const Params& params, PlatformSpec& spec);
// Keys analyser and mosaic of an array whose bands are known.
void read_array_analysers(const Params& p, const PlatformSpec& spec, FocalArray& array);
void check_mosaic(const Params& p, const FocalArray& array, std::span<const Band> bands);
// Turns Q and U of every pixel, with errors and covariances, into the frame of the picture as it lies while the pixel's
// middle is exposed.
void turn_upright(const PlatformSpec& spec, const std::function<Pose(double)>& pose, CaptureResult& result);
// The share of I, Q, U and V that each train passes on to a segment's photons, [band][train].
std::vector<std::vector<Stokes>> analyser_rows(const Segment& segment, const Analysers& analysers);
// The detectors' band by the mosaic, of a product of all bands.
Product mosaic_of(const PlatformSpec& spec, const Segment& segment, const CaptureResult& result, const Product& all);

// platform_products.cpp: electrons and counts of a result whose bands are a segment's; strips the photon bands.
// read_out: tells this event from all others.
std::vector<Product> detect(const PlatformSpec& spec, const Segment& segment, CaptureResult& result, uint64_t read_out);
// Noise of a band's detectors on the axis, of a chip of gain 1. Error: a NETD that cannot be.
NoiseAtBackground noise_of(const PlatformSpec& spec, const Segment& segment, size_t band);
// Noise of one reading on the axis, in radiance, of the bands of a segment's photons; 0 of those that nothing counts.
// Of several chips that of the highest gain, which is the smallest.
std::vector<BandNoise> detector_noise_of(const PlatformSpec& spec, const Segment& segment);
// For headers: NETD of every band; empty where there is no background.
std::string noise_text(const PlatformSpec& spec, const Segment& segment);
// platform_points.cpp: far points (point_images.h) on framing cameras that are focused at infinity. pose: of the
// instrument at a time, in scene ENU.
bool sees_points(const PlatformSpec& spec, const Capture& capture);
void image_point(const PlatformSpec& spec, const Capture& capture, const std::function<Pose(double)>& pose,
                 const std::function<Dir(double, Vec3)>& direction_at, double brightness,
                 const std::function<void(const PointShare&)>& share);
// platform_log.cpp: pose and time of an instrument over the tasks, as CSV.
std::string pose_log(const PlatformSpec& spec, const Instrument& instrument, const SensorContext& context);
// The pose of the instrument at a time, without tables.
Pose pose_at(const PlatformSpec& spec, const Instrument& instrument, double t);

}  // namespace suite
