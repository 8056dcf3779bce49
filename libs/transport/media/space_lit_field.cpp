#include "transport/media/space_lit_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}  // namespace

LitFieldSpace::LitFieldSpace(const SpaceContext& c)
    : FieldSpace(c),
      places_(c),
      flights_of_(c.width),
      even_(c.optics.state().size()),
      scratch_(c.optics.state().size()) {}

void LitFieldSpace::start(uint32_t p, const LivePath& live) {
  FieldSpace::start(p, live);
  places_.start(p);
  flights_of_[p].brings = Brings::all;
}

void LitFieldSpace::put(uint32_t p, const Around& around) {
  FieldSpace::put(p, around);
  places_.start(p);
  flights_of_[p].brings = Brings::all;
}

Flight LitFieldSpace::fly(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, const Ray& ray, double length,
                          bool ends, std::span<float> through, std::span<float> emitted) {
  OfPath& own = flights_of_[p];
  if (places_.leave(p)) own.brings = Brings::difference;
  double gap = 0;
  length = begin_flight(p, live, record, hit, ray, length, gap);
  own.around = around(p);
  const uint32_t medium = medium_around(p);
  const bool forced = live.branch == Branch::forced, beams_elsewhere = own.brings != Brings::all;
  const double before = live.length;
  Flight flight;
  if (!beams_elsewhere)
    flight = fly_on(p, live, record, hit, length, gap, ends, through, emitted);
  else if (own.brings == Brings::difference && is_clear(live, length, medium))
    flight = fly_clear(p, live, record, hit, length, gap, ends, through, emitted);
  else
    flight = fly_difference(p, live, record, hit, length, gap, ends, through, emitted);
  own.reach = flight.arrival == Arrival::scattered ? live.length - before : kInfinity;
  if (flight.arrival != Arrival::onward) own.brings = Brings::all;
  flight.difference = beams_elsewhere;
  // Branches drawn towards a light share what they come to with others, which bring the air on the way.
  flight.length = forced || is_airless(medium) ? 0 : length;
  return flight;
}

bool LitFieldSpace::is_clear(const LivePath& live, double length, uint32_t medium) {
  if (medium != kNone) return false;
  if (!field_.has_grids()) return true;
  const std::span<const double> depths = depths_of(live, length, medium);
  return std::all_of(depths.begin(), depths.end(), [](double d) { return d == 0; });
}

// Where nothing but air is on the way.
Flight LitFieldSpace::fly_clear(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length, double gap,
                                bool ends, std::span<float> through, std::span<float> emitted) {
  Flight flight{Arrival::met, {1, through.data()}, true, nullptr};
  if (length == kInfinity) {
    if (ends && places_.lit_from_outside()) {  // a light that the field does not know
      air_->transmittance(live.origin, live.direction, length, through);
    } else {  // the even ground or the sky, as everywhere
      record.end = PathEnd::escaped;
      record.escape = live.direction;
      return {Arrival::ended, {}, false, nullptr};
    }
  } else if (hit.hit() && bodies_.is_boundary(surface_.material(hit))) {
    air_->transmittance(live.origin, live.direction, length, through);
    end_flight(p, live, record, hit, gap, flight);
    if (flight.arrival == Arrival::met) {  // a surface lies there, too
      places_.beyond(live.origin, live.direction, length, through, emitted);
      flight.emitted = emitted.data();
    }
  } else {
    places_.beyond(live.origin, live.direction, length, through, emitted);
    flight.emitted = emitted.data();
  }
  const std::vector<size_t>& bins = optics_.state().knots;
  for (size_t k = 0; k < bins.size(); ++k) live.throughput[k] *= through[bins[k]];
  return flight;
}

// Where media are, or were before a boundary.
Flight LitFieldSpace::fly_difference(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length,
                                     double gap, bool ends, std::span<float> through, std::span<float> emitted) {
  OfPath& own = flights_of_[p];
  const Vec3 from = live.origin;
  const Dir d = live.direction;
  // Past the scene's edge there is the even ground.
  const double ground = length == kInfinity ? places_.to_ground(from, d) : kInfinity;
  Flight flight = fly_on(p, live, record, hit, std::min(length, ground), gap, ends, through, emitted);
  if (!flight.emitted) std::fill(emitted.begin(), emitted.end(), 0.0f);
  if (flight.emitted && flight.emitted != emitted.data())  // of a table of the sky
    std::copy_n(flight.emitted, emitted.size(), emitted.data());
  if (ground < kInfinity && flight.arrival == Arrival::met) {
    places_.even(from + d * ground, d, scratch_, even_);
    for (size_t i = 0; i < even_.size(); ++i)
      emitted[i] += even_[i] * flight.through.scale * (flight.through.spectrum ? flight.through.spectrum[i] : 1.0f);
    record.end = PathEnd::escaped;
    record.escape = d;
    flight.arrival = Arrival::ended;
  }
  if (own.brings == Brings::difference) {
    places_.even(from, d, scratch_, even_);
    for (size_t i = 0; i < even_.size(); ++i) emitted[i] -= even_[i];
    own.brings = Brings::rest;
  }
  flight.emitted = emitted.data();
  return flight;
}

bool LitFieldSpace::reaches(uint32_t p, const LivePath& live, double length, double u) const {
  const double reach = flights_of_[p].reach;
  return reach == kInfinity || places_.distance_to(live.origin, live.direction, length, u, live.knot) <= reach;
}

std::optional<AirVertices::PerKnot> LitFieldSpace::go_to(uint32_t p, LivePath& live, double length, double u,
                                                         std::span<float> through) {
  FieldSpace::put(p, flights_of_[p].remembered);
  flights_of_[p].brings = Brings::all;
  auto place = places_.go_to(p, live.origin, live.direction, length, u, live.knot, through);
  if (!place) return std::nullopt;
  const uint32_t medium = medium_around(p);
  const std::span<const double> depths = depths_of(live, place->distance, medium);
  if (flights_.transmittance(depths, scratch_)) {
    for (size_t i = 0; i < through.size(); ++i) through[i] *= scratch_[i];
    for (size_t k = 0; k < optics_.state().knots.size(); ++k)
      place->density[k] *= std::exp(-scattering_depth(depths, k));
  }
  live.length += place->distance;
  live.arrival += delay_of(medium) * place->distance;
  live.branch = Branch::none, live.sided = false;
  return place->density;
}

bool LitFieldSpace::lacks(const Ray& ray, double distance, size_t i, bool blocked, std::span<float> transmission) {
  if (blocked) return air_->transmittance(ray.origin, ray.direction, distance, transmission), true;
  if (!flights_.transmittance(sight_.depths(i), scratch_)) return false;
  air_->transmittance(ray.origin, ray.direction, distance, transmission);
  for (size_t b = 0; b < transmission.size(); ++b) transmission[b] *= 1 - scratch_[b];
  return true;
}

void LitFieldSpace::densities(uint32_t event, Dir out, Dir in, std::span<float> density) const {
  in_air(event) ? places_.densities(event, out, in, density) : FieldSpace::densities(event, out, in, density);
}

Factor LitFieldSpace::evaluate(uint32_t event, double cosine, std::span<float> v) {
  return in_air(event) ? places_.evaluate(event, cosine, v) : FieldSpace::evaluate(event, cosine, v);
}

bool LitFieldSpace::sample(uint32_t p, const LivePath& live, Vec2 u, double who, std::span<float> dense,
                           Continuation& on) {
  return in_air(p) ? places_.sample(p, -live.direction, live.knot, u, who, dense, on)
                   : FieldSpace::sample(p, live, u, who, dense, on);
}

}  // namespace suite
