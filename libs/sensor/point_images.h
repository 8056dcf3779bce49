// Sensors that know where far points (stars) fall on their focal planes. Their rays say so (SensorRay::points_apart),
// and what paths find of such points straight ahead is left out.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

// What a pixel gathers of a far point: its radiance is the point's irradiance, of each bin, times these weights.
struct PointShare {
  size_t problem = 0;
  double weight = 0;                     // 1/sr, all bins
  std::span<const float> spectral = {};  // of each bin, besides; empty = 1
  double time = 0;                       // s, when
  Vec3 origin;                           // m, from where it is seen then
};

// A point as it was seen in a capture.
struct SeenPoint {
  std::string name;
  double v = 0, column = 0, row = 0;  // magnitude; centre of its light, in pixels from the picture's upper left corner
  std::vector<double> irradiance;  // W/(m2 um) at the sensor, of each band: through the air, and where nothing hides it
};

class SeesPoints {
 public:
  virtual ~SeesPoints() = default;
  // Whether it does so in a capture: its rays say the same.
  virtual bool sees_points(const Capture& capture) const = 0;
  // Hands over all shares of a point in a capture, between Sensor::begin and accept. direction_at: towards it at a
  // time from a place (m, scene ENU). brightness: of it over that of a star of V = 0, for which more effort is worth
  // while. share: is called in any order, from one thread.
  virtual void image_point(const Capture& capture, const std::function<Dir(double, Vec3)>& direction_at,
                           double brightness, const std::function<void(const PointShare&)>& share) const = 0;
  // m, of the optics, by which stars twinkle; 0: not known.
  virtual double aperture(const Capture&) const { return 0; }
  // The points of a capture, before its result is accepted.
  virtual void take_points(const Capture& capture, std::vector<SeenPoint> points) = 0;
};

// Moments at which a point that moves across a picture is put into it, so close that it goes a tenth of a pixel between
// two of them.
struct TrailSteps {
  // place_at: pixels, at a time; nothing where it is behind the sensor.
  TrailSteps(const TimeWindow& window, const std::function<std::optional<Vec2>(double)>& place_at);
  double time(int i) const { return window.begin + (i + 0.5) / count * (window.end - window.begin); }
  TimeWindow window;
  int count = 1;
};

// A table of points as CSV.
std::string points_table(std::span<const SeenPoint> points, std::span<const Band> bands);

}  // namespace suite
