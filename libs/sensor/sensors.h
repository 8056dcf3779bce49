// The table of sensor kinds: one row a kind, made from what the user wrote.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "motion/jitter.h"
#include "motion/track.h"
#include "sensor/delivery.h"
#include "sensor/sensor.h"

namespace suite {

// A picture of numbers: row-major, top row first, one channel.
struct GreyImage {
  uint32_t width = 0, height = 0;
  std::vector<float> values;
};

// What a sensor needs from the outside when it is made. Functions that are not set are refused where they are needed.
// A band of a file of spectral responses.
struct NamedResponse {
  std::string name;
  Curve curve;
};

struct SensorContext {
  std::function<Curve(const Params&)> curve;                           // from a number, a file name or {file: ..., ...}
  std::function<std::vector<NamedResponse>(const Params&)> responses;  // of all bands of a file, by its name
  std::function<void(const Delivery&)> deliver;                        // receives every finished capture
  std::function<TrackPtr(const Params&)> track;                        // a motion (formats/motion)
  std::function<Vec3(const Params&)> position;                         // position keys of a motion, scene ENU
  std::function<Jitter(const Params&, uint64_t)> jitter;               // with a seed to mix in
  std::function<double(const Params&)> time;                           // s, from a number or a UTC text
  std::function<GreyImage(const std::string&)> image;                  // a picture file
  std::function<std::optional<SceneFrame>()> frame;                    // where the scene is on the Earth, if it is
  std::function<std::string(double)> utc;  // UTC text of a simulation time; empty = no clock
};

using SensorRow = RegistryRow<std::unique_ptr<Sensor>(const Params& params, const SensorContext& context)>;

// The kinds that come with the suite and those added since the program started (a plug-in's), which is not to be done
// while sensors are being made.
Registry<SensorRow>& sensor_kinds();
// Reads `kind` and makes the sensor; located Error for anything wrong.
std::unique_ptr<Sensor> make_sensor(const Params& params, const SensorContext& context);

// Parts that several kinds share.
// Each a band, or several: {from_um, to_um, count, fwhm_um, shape}, {responses: FILE, names: [...]}. Located Errors.
std::vector<Band> read_bands(const Params& list, const SensorContext& context);
Convergence read_convergence(const Params& params);  // key `paths`: N, or {min, max, relative_error, absolute_floor}
// Key `paths: {bands: {NAME: relative error, ...}}`: a target for each band listed. Sets convergence.relative_error to
// the strictest of them and returns one a band, 0 for the others; nothing when the key is absent.
std::vector<double> read_band_targets(const Params& params, std::span<const Band> bands, Convergence& convergence);
// Key `spectral_error`: of each band, relative; 0 = the bins are even and stay as they are.
double read_spectral_error(const Params& params);
inline constexpr double kDefaultStep = 0.01;  // um
// Even bins of at most a step, to be replaced by what a spectral error asks for. step_um: 0 = not given.
SpectralState state_for(std::span<const Band> bands, double spectral_error, double step_um, double reference_um,
                        size_t knots);
// Keys spectral_error, spectral_step_um, reference_um, knots.
SpectralState read_state(const Params& params, std::span<const Band> bands);
// Key `truth`: a list of names of the truth table, or `all`; the default when absent. Names are checked by the
// renderer.
std::vector<std::string> read_truth(const Params& params);
// Key `channels`: a list of parts of the light, beside all of it. Names are checked by the renderer.
std::vector<std::string> read_channels(const Params& params);
// Keys `units: radiance | toa_reflectance | brightness_temperature | remote_sensing_reflectance` (with
// irradiance_at_m) and `geolocation: BOOL | {pixel_m | pixel_deg, crs, resampling}`, which adds `location` to the truth
// where it is missing. read_units: of a part of a sensor, which keeps the rest.
ImageWishes read_wishes(const Params& params, std::vector<std::string>& truth);
void read_units(const Params& params, ImageWishes& wishes);
// Keys time_s and integration_time_s of sensors with one capture.
TimeWindow read_window(const Params& params);

}  // namespace suite
