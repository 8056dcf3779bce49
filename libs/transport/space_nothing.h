// What fills space: nothing, or air alone in closed form, but for clear matter that interfaces enclose. Two of the
// answers that the path kernel is made for; the third is media/space_field.h.
#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "light/environment.h"
#include "math/stokes_parts.h"
#include "transport/contribution.h"
#include "transport/known_way.h"
#include "transport/lane.h"
#include "transport/media/clear_matter.h"
#include "transport/options.h"
#include "transport/sight.h"

namespace suite {

// Where a flight of a path along its ray has ended.
enum class Arrival : uint8_t {
  met,        // where the ray ends: at a surface or outside the scene
  scattered,  // in a medium on the way
  onward,     // at a boundary that it goes straight through: it flies again
  ended       // it goes no further
};
struct Flight {
  Arrival arrival = Arrival::met;
  // What the way has done to the light of all that lies behind it; and whether it has done anything.
  Factor through;
  bool weakened = false;
  const float* emitted = nullptr;  // light from the way itself, per bin, as seen from its start; null = none
  // Where Space::kGoesBack: m; `emitted` is a difference to other light.
  double length = 0;
  bool difference = false;
};

// What a space needs to know to be made.
struct SpaceContext {
  const Surface& surface;
  const Optics& optics;
  const Environment& environment;
  const PipelineOptions& options;
  size_t width;
  std::span<const double> knot_probability;  // P_k
  LostLight* lost;                           // null where no light can be lost
  StokesParts parts = StokesParts::linear;   // of the air's light
};

class NothingSpace {
 public:
  static constexpr bool kScatters = false;  // paths are scattered between surfaces
  static constexpr bool kMedia = false;     // by media of the scene
  static constexpr bool kFills = false;     // flights do anything at all
  static constexpr bool kGoesBack = false;  // ended paths go back to places on their way (techniques/air_residual.h)
  static constexpr uint32_t kDense = 0;     // spectra that fly() needs
  using Sight = PlainSight;
  struct Around {};  // what surrounds a path
  explicit NothingSpace(const SpaceContext& c)
      : clear_(ClearMatter::of(c.surface, c.optics, c.width)), sight_(c.lost) {}

  // A wave of paths begins; and one of them does.
  void begin_wave() {}
  template <class L>
  void start(uint32_t p, const L& lane) {
    if (clear_) clear_->start(p, lane.origin, lane.time);
  }
  // Where the ray that looks for what a path meets next begins.
  template <class L>
  Vec3 ray_from(uint32_t, const L& lane) const {
    return lane.origin;
  }
  double index(uint32_t p) const { return clear_ ? clear_->index(p) : 1; }
  // Group index, by which light is late.
  double delay(uint32_t p) const { return clear_ ? clear_->delay(p) : 1; }
  // What path p sees a surface emit into empty space, made that of one in the matter that fills space there. Per bin.
  void emit_within(uint32_t p, std::span<float> emission) const {
    if (clear_) clear_->emit_within(p, emission);
  }
  // What fills space all the way to the outside, as a light that nodes can ask for (Atmosphere::sky); null = none.
  const Light* sky() const { return nullptr; }
  double sky_density(Dir) const { return 0; }
  const float* sky_radiance(const Ray&, std::span<float>, std::span<float>) const { return nullptr; }
  const float* sky_behind(const Ray&, std::span<float>, std::span<float>) const { return nullptr; }
  void cross(uint32_t p, const Hit& hit, uint32_t material, Dir in) {
    if (clear_) clear_->cross(p, hit, material, in);
  }
  void clear_sight() {}
  Sight& sight() { return sight_; }
  // What lies on the way of ray i of the last sight(), of SightRays, leaves of its light: false = all of it. reach: the
  // same of scattering alone at the knots, the share of continuations that would get as far.
  bool dims(const Ray&, double, size_t, std::span<float>, std::span<double>) { return false; }
  // m, group index times way, along ray i.
  double optical_way(uint32_t p, size_t, double distance) const { return delay(p) * distance; }
  // Along a way that interfaces bend (techniques/manifold.h): it leaves the event, or the surface at `hit` towards
  // `in`,
  void begin_way(uint32_t p, bool event, const Hit& hit, uint32_t material, Dir out, Dir in) {
    if (clear_) clear_->begin_way(p, !event && dot(in, hit.normal) * dot(out, hit.normal) < 0, hit, material, in);
  }
  // runs `length` m straight on, which multiplies `through`; the group index there. scratch: per bin.
  double follow_way(const Ray&, double, std::span<float>, std::span<float>) {
    return clear_ ? clear_->delay_on_way() : 1;
  }
  // and passes a surface.
  void cross_way(const Hit& hit, uint32_t material, Dir in) {
    if (clear_) clear_->cross_way(hit, material, in);
  }
  TraceStatistics take_statistics() { return clear_ ? clear_->take_statistics() : TraceStatistics{}; }

 protected:
  std::unique_ptr<ClearMatter> clear_;  // null: none

 private:
  Sight sight_;
};

// A way through air alone, whose transmittance and radiance are known at once. first: for the sensor's own way, null
// when that is behind; ends: light from the end of the way is to come through it.
template <class L>
Flight fly_through_air(const Atmosphere& air, KnownWay* first, const L& lane, double length, bool ends,
                       std::span<float> through, std::span<float> emitted) {
  const bool sky = !first && length == std::numeric_limits<double>::infinity();
  // In a mirror neighbouring directions would be told apart.
  if (sky && !ends && lane.last_density > 0)
    return {Arrival::met, {}, false, air.sky_radiance(lane.origin, lane.direction, through, emitted)};
  if (sky)
    air.skylight(lane.origin, lane.direction, through, emitted);
  else if (first)
    first->path(air, lane.origin, lane.direction, length, through, emitted);
  else
    air.path(lane.origin, lane.direction, length, through, emitted);
  return {Arrival::met, {1, through.data()}, true, emitted.data()};
}

// Air without media.
class AirSpace : public NothingSpace {
 public:
  static constexpr bool kFills = true;
  static constexpr uint32_t kDense = 2;
  explicit AirSpace(const SpaceContext& c)
      : NothingSpace(c), air_(*c.environment.atmosphere), seen_(c.optics.state().size()), parts_(c.parts) {}

  void begin_wave() { seen_.forget(); }
  template <class L>
  Flight fly(uint32_t p, L& lane, PathRecord&, Hit&, const Ray&, double length, bool ends, std::span<float> through,
             std::span<float> emitted) {
    if (length < std::numeric_limits<double>::infinity() && clear_ && clear_->around(p)) return {};
    return fly_through_air(air_, lane.surfaces > 0 ? nullptr : &seen_, lane, length, ends, through, emitted);
  }
  static constexpr uint16_t kEmitter = kFromAir;
  const Light* sky() const { return air_.sky(); }
  double sky_density(Dir d) const { return air_.sky_density(d); }
  // What comes along a ray from outside (Atmosphere::sky_radiance).
  const float* sky_radiance(const Ray& ray, std::span<float> scratch, std::span<float> radiance) const {
    return air_.sky_radiance(ray.origin, ray.direction, scratch, radiance);
  }
  // Of an air that knows it.
  const PolarisedAir& polarised_air() const { return *air_.polarisation(parts_); }
  bool dims(const Ray& ray, double distance, size_t, std::span<float> transmission, std::span<double>) {
    air_.transmittance(ray.origin, ray.direction, distance, transmission);
    return true;
  }
  double follow_way(const Ray& ray, double length, std::span<float> through, std::span<float> scratch) {
    if (clear_ && clear_->on_way()) return clear_->delay_on_way();
    air_.transmittance(ray.origin, ray.direction, length, scratch);
    for (size_t i = 0; i < through.size(); ++i) through[i] *= scratch[i];
    return 1;
  }

 protected:
  const Atmosphere& air_;

 private:
  KnownWay seen_;  // of sensors' rays
  StokesParts parts_;
};

}  // namespace suite
