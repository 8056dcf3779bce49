// How paths of the balance of heat go on at a surface.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "heat/elements.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "optics/scatter_model.h"
#include "spectral/state.h"
#include "surface/surface_walk.h"
#include "trace/tracer.h"

namespace suite {

// Blocks of random numbers from here on choose points of elements (heat/elements.h).
inline constexpr uint32_t kPointBlock = 1u << 20;

// Reflections after which a path is ended and told.
inline constexpr uint32_t kMostReflections = 100000;

// Which times paths of an interval of rest look at: while all rests; without intervals any of the tracer's window, so
// that what comes and goes counts for its share. Nothing where nothing ever changes.
inline std::optional<TimeSpan> path_window(const Tracer& tracer, const Elements& elements, size_t interval) {
  return elements.rests().empty() ? tracer.window() : elements.rests()[interval].still;
}
inline double time_of_path(std::optional<TimeSpan> window, const SampleStream& numbers, uint32_t sample,
                           double at_rest) {
  constexpr uint32_t kPurpose = 1;
  return window ? window->begin + numbers.hashed(sample, kPurpose) * (window->end - window->begin) : at_rest;
}

// A direction towards a point of the sun's disk, of radius rad; x and y in units of it.
inline Dir on_disk(const Frame& sun, double x, double y, double radius) {
  return normalized(sun.z + radius * (sun.x * x + sun.y * y));
}

// A path of one bin of a state of which every bin is a knot, or whose shapes are all alike.
class OneBinWalk {
 public:
  explicit OneBinWalk(const SpectralState& state)
      : knots_(state.knots.size()), w_(state.size()), p_(state.knots.size()) {}

  struct Reflected {
    Dir direction;      // local
    double weight = 0;  // what the surface makes of the bin's throughput, its total included
  };
  // Nothing: the draw was in vain.
  std::optional<Reflected> reflect(const ScatterModel& model, Dir out, const std::array<double, 4>& u, size_t bin) {
    const size_t knot = knots_ == 1 ? 0 : bin;
    const auto drawn = draw_reflection(model, out, u, static_cast<int>(knot), w_, p_);
    if (!drawn) return std::nullopt;
    return Reflected{drawn->in, static_cast<double>(w_[bin]) / static_cast<double>(p_[knot])};
  }

 private:
  size_t knots_;
  std::vector<float> w_, p_;
};

}  // namespace suite
