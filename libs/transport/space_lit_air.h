// Air without media whose light knows the scene: shadows in it, and what single places of the scene send into it.
//
// Segments bring what they bring over an even ground (AirSpace). Beside that, a path that has ended goes back to one
// place in the air on its way (techniques/air_residual.h), is scattered there, and brings the difference that the scene
// makes (light/air_vertices.h): what it meets from there counts less what the even ground or the sky would have sent,
// beams count where they are missing.
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

#include "transport/air_places.h"

namespace suite {

class LitAirSpace : public AirSpace {
 public:
  static constexpr bool kScatters = true, kGoesBack = true;
  explicit LitAirSpace(const SpaceContext& c) : AirSpace(c), places_(c), knots_(c.optics.state().knots) {}

  template <class L>
  void start(uint32_t p, const L& lane) {
    AirSpace::start(p, lane);
    places_.start(p);
  }
  template <class L>
  Flight fly(uint32_t p, L& lane, PathRecord& record, Hit& hit, const Ray& ray, double length, bool ends,
             std::span<float> through, std::span<float> emitted) {
    Flight flight{Arrival::met, {1, through.data()}, true, emitted.data()};
    const bool left = places_.leave(p);
    if (!left) {
      flight = AirSpace::fly(p, lane, record, hit, ray, length, ends, through, emitted);
    } else if (length == std::numeric_limits<double>::infinity() && ends && places_.lit_from_outside()) {
      air_.transmittance(lane.origin, lane.direction, length, through);  // to a light that the field does not know
      flight.emitted = nullptr;
    } else if (length == std::numeric_limits<double>::infinity()) {  // the even ground or the sky, as everywhere
      record.end = PathEnd::escaped;
      record.escape = lane.direction;
      flight = {Arrival::ended, {}, false, nullptr};
    } else {
      places_.beyond(lane.origin, lane.direction, length, through, emitted);
    }
    // Clear matter holds none of the air.
    flight.length = flight.weakened || length == std::numeric_limits<double>::infinity() ? length : 0;
    flight.difference = left;
    if (flight.weakened)
      for (size_t k = 0; k < std::min<size_t>(L::kKnots, knots_.size()); ++k) lane.throughput[k] *= through[knots_[k]];
    return flight;
  }

  // The probabilities that light of each knot is scattered on a flight of a path from where it is, not exactly.
  template <class L>
  AirVertices::PerKnot chances(const L& lane, double length) const {
    return places_.chances(lane.origin, lane.direction, length);
  }
  // What a path that may go back there must remember of a flight, which it has just flown.
  void remember(uint32_t p) {
    if (clear_) clear_->remember(p);
  }
  // Puts path p to a place on the flight that it remembers, drawn for its knot; returns the densities of all knots.
  // through: what lies on the way there leaves of light. Nothing where nothing scatters. u: in [0, 1).
  template <class L>
  std::optional<AirVertices::PerKnot> go_to(uint32_t p, L& lane, double length, double u, std::span<float> through) {
    const auto place = places_.go_to(p, lane.origin, lane.direction, length, u, lane.knot, through);
    if (!place) return std::nullopt;
    if (clear_) clear_->resume(p);
    lane.length += place->distance;
    lane.arrival += place->distance;
    return place->density;
  }
  // Whether path p stands at such a place: beams shine there in the even field already.
  bool in_air(uint32_t p) const { return places_.here(p); }
  // What ray i, of the last sight(), lacks there of a beam: transmission of the air times the share that is missing.
  // False = nothing.
  bool lacks(const Ray& ray, double distance, size_t, bool blocked, std::span<float> transmission) const {
    if (blocked) air_.transmittance(ray.origin, ray.direction, distance, transmission);
    return blocked;
  }

  // Scattering there.
  Vec3 place(uint32_t p) const { return places_.place(p); }
  void densities(uint32_t p, Dir out, Dir in, std::span<float> density) const {
    places_.densities(p, out, in, density);
  }
  Factor evaluate(uint32_t p, double cosine, std::span<float> v) const { return places_.evaluate(p, cosine, v); }
  template <class L>
  bool sample(uint32_t p, const L& lane, Vec2 u, double who, std::span<float> dense, Continuation& on) const {
    return places_.sample(p, -lane.direction, lane.knot, u, who, dense, on);
  }
  void see_from_event(uint32_t) {}
  void see_from_surface(uint32_t, const Hit&, uint32_t, Dir, Dir) {}

 private:
  AirPlaces places_;
  std::vector<size_t> knots_;
};

}  // namespace suite
