// Temperatures at points, as sharp as shadows are: what the renderer may ask in place of those of whole elements.
//
// Method: a point's own day in the sun (shadow rays at every moment, edges to a second, a point of the sun's disk of
// its own) takes the place of that of its element; what it absorbs beyond the element's makes it warmer or colder as
// its slab answers (point_response.h). Sunlight that comes by way of other surfaces or the sky, and infrared, are those
// of the element.
// Told of elements with layers and a closed back on which direct sun differs from place to place, and that stand in one
// place all the time; of others nothing.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "base/diagnostics.h"
#include "heat/heat_balance.h"
#include "heat/point_response.h"

namespace suite {

class SunlightWave;

class PointHeat {
 public:
  // K: elements whose places differ by less (root mean square, HeatErrors::size) are not looked at.
  static constexpr double kLeast = 0.02;
  // Keeps references. result: with `straight` (straight_sunlight), of a span that repeats. Error: others.
  PointHeat(const HeatScene& scene, const WeatherLoads& weather, const HeatResult& result);
  ~PointHeat();
  // Whether a place on an element at a time (s) is told apart from it.
  bool tells(uint32_t element, double time) const;
  // K, by how much it is warmer; nothing where that does not settle, or the place is none. From any thread; what one
  // asks twice running is found once.
  std::optional<double> above(uint32_t element, const HeatedPlace& place, double time) const;
  // Places asked so far, and the seconds of all threads that took.
  uint64_t asked() const { return asked_; }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }
  // Places among them whose temperature did not settle: they have their element's.
  uint64_t unsettled() const { return unsettled_; }
  // Places on what stands elsewhere at other times: they have their element's, too.
  uint64_t displaced() const { return displaced_; }
  // What was counted so far and matters.
  std::vector<Diagnostic> diagnostics() const;

 private:
  std::optional<double> found(uint32_t element, const HeatedPlace& place, double time) const;
  std::unique_ptr<SunlightWave> take_wave() const;
  const uint64_t number_;  // among all that there were
  const HeatScene scene_;
  const WeatherLoads& weather_;
  const HeatResult& result_;
  PathOptions paths_;
  std::vector<FaceWeather> air_;                                        // by moment
  std::map<uint32_t, std::unique_ptr<const PointResponse>> responses_;  // by material
  mutable Sunlight unused_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<SunlightWave>> waves_;  // that no thread works with
  mutable std::atomic<uint64_t> asked_ = 0, nanoseconds_ = 0, unsettled_ = 0, displaced_ = 0;
};

// W/m2 that fronts absorb straight from the sun, [face][moment], of those that points can be told apart on; from the
// same points as the balance.
std::vector<float> straight_sunlight(const HeatScene& scene, const WeatherLoads& weather, const HeatResult& result,
                                     const HeatSpec& spec);

}  // namespace suite
