// Time goes on: Sun, Moon and clear skies that follow from dates, for each capture where they are in the middle of its
// window.
//
// Moments stand on a grid of kMomentQuantum of absolute time, so that captures close to each other share what is baked,
// and so that a moment's lights do not depend on when a run begins or which part of it is run. A capture's lights are
// those of a moment at most 0.5 s away: the Sun and the Moon then stand at most 7.5 arc seconds off (0.8 % of the
// radius of their disks), and what the Sun sends to level ground is off by 3.6e-5 tan(zenith angle), less than
// kExposureLimit to 88 degrees from the zenith. Times that are whole seconds of UTC are on the grid.
//
// Assumes: a whole capture sees them there; long_exposure says when that is too coarse.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "light/environment.h"
#include "sensor/sensor.h"

namespace suite {

// The moment at which a capture's sources are resolved: the middle of its window, s.
double moment_of(const Capture& capture);

inline constexpr double kMomentQuantum = 1;  // s

// Sources resolved for one moment after the other. Keeps references to what it is made from.
class SourcesInTime {
 public:
  SourcesInTime(const SourceSpecs& written, const Scene& scene) : written_(written), scene_(scene) {}
  const SourceSpecs& written() const { return written_; }
  bool dated() const { return written_.dated(); }
  // The moment of the grid that is nearest to one; 0 where no source has a date.
  double on_grid(double moment) const;
  // Sources at a moment (s), exactly; they hold until the next call. Without dates they are the same at all moments.
  // Lights that nothing has to be computed for stay the same objects. Error: as resolve_sources.
  const SourceSpecs& at(double moment);

 private:
  const SourceSpecs& written_;
  SourceSpecs now_;
  const Scene& scene_;
  std::optional<double> moment_;
};

using Sensors = std::span<const std::unique_ptr<Sensor>>;

// Sources that stand for those of all moments: dated ones with the sun at the zenith, 60 and 85 degrees from it and the
// Moon full and at half, so that what is chosen from their spectra does not depend on when a run looks.
std::vector<SourceSpecs> sources_at_all_times(const SourceSpecs& written, const Scene& scene);

// The sources as the earliest capture sees them.
SourceSpecs first_sources(const SourceSpecs& written, const Scene& scene, Sensors sensors);

// Sentences about the sources: at the first and the last moment at which a capture sees them. Error, naming the
// capture: a clear sky while the sun is below the horizon.
std::vector<std::string> describe_sources(const SourceSpecs& written, const Scene& scene, Sensors sensors);

// The capture of a sensor during which a dated Sun or Moon (over the horizon) goes furthest from where it is taken.
struct LongExposure {
  std::string body, capture;     // "sun", name
  double seconds = 0;            // of the capture
  double moved = 0;              // rad, from the beginning to the end
  double radius = 0;             // rad, of the disk
  double irradiance_change = 0;  // of what it sends to level ground, air apart, at the reference wavelength, relative
};
inline constexpr double kExposureLimit = 1e-3;  // of the change of irradiance; the body may move by its radius
// Nothing when all captures are short enough.
std::optional<LongExposure> long_exposure(const SourceSpecs& written, const Scene& scene, const Sensor& sensor);

}  // namespace suite
