#include "transport/media/space_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "optics/phase_function.h"
#include "transport/dimensions.h"

namespace suite {

namespace {
constexpr uint32_t kMostFlights = 1u << 24;  // boundaries passed included
}  // namespace

FieldSpace::FieldSpace(const SpaceContext& c)
    : surface_(c.surface),
      optics_(c.optics),
      air_(c.environment.atmosphere.get()),
      ambient_(c.surface.tracer().scene().ambient),
      field_(c.surface.tracer().scene(), c.optics.state(), c.surface.tracer().periodic()),
      bodies_(c.surface),
      flights_(field_, c.optics, c.knot_probability, air_),
      sight_(c.surface, bodies_, flights_, c.optics.media().size(), c.lost),
      plain_air_(air_ && !c.optics.air() && field_.placed().empty() && ambient_ == kNone),
      seen_(plain_air_ ? c.optics.state().size() : 0),
      stacks_(c.width),
      ways_(c.width),
      events_(2 * c.width + 2),
      phase_(c.optics.state().size()) {
  for (const BakedMedium& m : c.optics.media()) {
    const size_t reference = c.optics.state().knots[0];
    index_.push_back(std::sqrt(double{m.index_squared[reference]}));
    delay_.push_back(m.group_index);
    if (m.scatters()) m.phase->asymmetry(phase_);
    asymmetry_.push_back(m.scatters() ? double{phase_[reference]} : 0);
    one_phase_.push_back(m.scatters() && m.phase->spectrally_uniform());
  }
}

void FieldSpace::start(uint32_t p, const LivePath& live) {
  ways_[p] = {};
  stacks_[p].clear();
  if (bodies_.any()) stacks_[p] = bodies_.around(live.origin, live.time, statistics_);
}

Flight FieldSpace::fly(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, const Ray& ray, double length,
                       bool ends, std::span<float> through, std::span<float> emitted) {
  double gap = 0;
  length = begin_flight(p, live, record, hit, ray, length, gap);
  return fly_on(p, live, record, hit, length, gap, ends, through, emitted);
}

double FieldSpace::begin_flight(uint32_t p, const LivePath& live, PathRecord& record, Hit& hit, const Ray& ray,
                                double length, double& gap) {
  // This flight uses up the way on behind a boundary, whatever it comes to: the next one begins at the path's origin.
  gap = std::exchange(ways_[p].gap, 0);
  if (gap > 0) bodies_.settle(hit, ray, gap);
  if (!hit.hit() && !stacks_[p].empty()) leave_scene(p, live, record);
  return hit.hit() ? hit.distance : length;
}

Flight FieldSpace::fly_on(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length, double gap,
                          bool ends, std::span<float> through, std::span<float> emitted) {
  const std::array<double, 4> u = dimensions::of_flight(live.stream, live.sample, live.flights);
  const uint32_t medium = stacks_[p].medium(ambient_);
  const Branch branch = live.branch;
  if (plain_air_ && medium == kNone && branch != Branch::forced &&
      !(hit.hit() && bodies_.is_boundary(surface_.material(hit))))
    return fly_through_air(*air_, live.surfaces + live.scatterings > 0 ? nullptr : &seen_, live, length, ends, through,
                           emitted);
  const Flights::Result flown = flights_.fly(live, length, medium, is_airless(medium), {u[0], u[1]}, through, emitted);
  Flight flight{Arrival::met,
                {static_cast<float>(flown.scale), flown.dense ? through.data() : nullptr},
                flown.dense || flown.scale != 1,
                flown.emits ? emitted.data() : nullptr};
  live.branch = Branch::none;
  live.sided = live.sided && flown.scattered;
  if (flown.scattered) {
    live.length += flown.distance;
    live.arrival += delay_of(medium) * flown.distance;
    if (live.surfaces == (record.received ? 1u : 0u)) record.scattered_first = true;
    remember(p, live.origin + live.direction * flown.distance);
    flight.arrival = Arrival::scattered;
  } else if (branch == Branch::forced) {  // nothing scatters there
    record.end = PathEnd::absorbed;
    flight.arrival = Arrival::ended;
  } else {
    end_flight(p, live, record, hit, gap, flight);
  }
  return flight;
}

void FieldSpace::end_flight(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double gap, Flight& flight) {
  if (!hit.hit() || !bodies_.is_boundary(surface_.material(hit))) return;
  const uint32_t medium = stacks_[p].medium(ambient_);
  if (++live.flights >= kMostFlights) {
    record.end = PathEnd::max_nodes;
    record.truncated += live.throughput[0] * live.share * index_of(medium) * index_of(medium);
    flight.arrival = Arrival::ended;
    return;
  }
  const auto onward = bodies_.pass(stacks_[p], hit, {live.origin, live.direction, live.time, live.draw},
                                   hit.distance - gap, statistics_);
  if (!onward) return;
  live.length += hit.distance;
  live.arrival += delay_of(medium) * hit.distance;
  live.origin = hit.position;
  ways_[p] = {onward->start, onward->gap};
  flight.arrival = Arrival::onward;
}

double FieldSpace::scattering_depth(std::span<const double> depths, size_t knot) const {
  double tau = 0;
  for (size_t m = 0; m < depths.size(); ++m)
    tau += depths[m] * double{optics_.media()[m].scattering[optics_.state().knots[knot]]};
  return tau;
}

std::span<const double> FieldSpace::depths_of(const LivePath& live, double length, uint32_t medium) {
  depths_.assign(optics_.media().size(), 0);
  flights_.add_depths({live.origin, live.direction, live.time, live.draw}, length, medium, depths_);
  return depths_;
}

// Out of bodies that no surface ends there, which is told.
void FieldSpace::leave_scene(uint32_t p, const LivePath& live, PathRecord& record) {
  const uint32_t medium = stacks_[p].medium(ambient_);
  bodies_.leave_scene(stacks_[p]);
  if (stacks_[p].medium(ambient_) != medium && live.branch != Branch::forced)
    record.leaked += live.throughput[0] * live.share * index_of(medium) * index_of(medium);
}

void FieldSpace::remember(uint32_t event, Vec3 place) {
  ScatterPlace& e = events_[event];
  e.place = place;
  e.contents = flights_.contents();
  set_rates(e);
}

bool FieldSpace::fly_aside(uint32_t p, LivePath& live, const Hit& hit, double length, Vec2 u, Flight& flight,
                           std::span<float> through) {
  way_ = stacks_[p];
  if (!hit.hit()) bodies_.leave_scene(way_);
  const uint32_t medium = way_.medium(ambient_);
  // What shines on the way is met by the path's own flights.
  const Flights::Result flown = flights_.fly(live, length, medium, true, u, through, phase_);
  if (!flown.scattered) return false;
  flight.length = flown.distance;
  flight.through = {static_cast<float>(flown.scale), flown.dense ? through.data() : nullptr};
  if (air_ && !is_airless(medium)) {
    air_->transmittance(live.origin, live.direction, flown.distance, phase_);
    for (size_t i = 0; i < through.size(); ++i) through[i] = flown.dense ? through[i] * phase_[i] : phase_[i];
    flight.through.spectrum = through.data();
  }
  remember(side(p), live.origin + live.direction * flown.distance);
  return true;
}

void FieldSpace::emit_within(uint32_t p, std::span<float> emission) const {
  const uint32_t medium = stacks_[p].medium(ambient_);
  if (medium == kNone) return;
  const std::vector<float>& squared = optics_.media()[medium].index_squared;
  for (size_t i = 0; i < emission.size(); ++i) emission[i] *= squared[i];
}

void FieldSpace::stand(ScatterPlace& e, const MediumStack& stack) const {
  e.contents.clear();
  if (const uint32_t medium = stack.medium(ambient_); medium != kNone) e.contents.push_back({medium, 1, 0});
  set_rates(e);
}

double FieldSpace::albedo_around(uint32_t p, size_t knot) const {
  const BakedMedium& medium = optics_.media()[stacks_[p].medium(ambient_)];
  const size_t bin = optics_.state().knots[knot];
  const double scattering = double{medium.scattering[bin]}, all = scattering + double{medium.absorption[bin]};
  return all > 0 ? scattering / all : 0;
}

double FieldSpace::albedo(uint32_t p, size_t knot) const {
  const ScatterPlace& e = events_[p];
  const size_t bin = optics_.state().knots[knot];
  double all = e.rate[knot];
  for (const Constituent& c : e.contents) all += c.density * double{optics_.media()[c.medium].absorption[bin]};
  return all > 0 ? e.rate[knot] / all : 0;
}

double FieldSpace::asymmetry(uint32_t p) const {
  const ScatterPlace& e = events_[p];
  double sum = 0;
  for (const Constituent& c : e.contents)
    sum += c.density * double{optics_.media()[c.medium].scattering[optics_.state().knots[0]]} * asymmetry_[c.medium];
  return e.rate[0] > 0 ? sum / e.rate[0] : 0;
}

void FieldSpace::set_rates(ScatterPlace& e) const {
  const std::vector<size_t>& bins = optics_.state().knots;
  for (size_t k = 0; k < bins.size(); ++k) {
    e.rate[k] = 0;
    for (const Constituent& c : e.contents)
      e.rate[k] += c.density * double{optics_.media()[c.medium].scattering[bins[k]]};
  }
}

void FieldSpace::densities(uint32_t p, Dir out, Dir in, std::span<float> density) const {
  const double cosine = scattering_cosine(out, in);
  const ScatterPlace& e = events_[p];
  const std::vector<size_t>& bins = optics_.state().knots;
  if (e.contents.size() == 1 && optics_.media()[e.contents[0].medium].scatters()) {  // it alone is the mean
    optics_.media()[e.contents[0].medium].phase->pdf(cosine, density);
    for (size_t k = 0; k < density.size(); ++k)
      if (!(e.rate[k] > 0)) density[k] = 0;
    return;
  }
  double q[kMaxKnots] = {};
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    if (!m.scatters()) continue;
    float at_knots[kMaxKnots];
    m.phase->pdf(cosine, {at_knots, density.size()});
    for (size_t k = 0; k < density.size(); ++k) q[k] += c.density * double{m.scattering[bins[k]]} * at_knots[k];
  }
  for (size_t k = 0; k < density.size(); ++k) density[k] = e.rate[k] > 0 ? static_cast<float>(q[k] / e.rate[k]) : 0;
}

Factor FieldSpace::evaluate(uint32_t p, double cosine, std::span<float> v) {
  const ScatterPlace& e = events_[p];
  const auto scatterers = std::count_if(e.contents.begin(), e.contents.end(),
                                        [&](const Constituent& c) { return optics_.media()[c.medium].scatters(); });
  if (scatterers != 1) std::fill(v.begin(), v.end(), 0.0f);
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    if (!m.scatters()) continue;
    const float density = static_cast<float>(c.density);
    if (one_phase_[c.medium]) {
      float value = 0;
      m.phase->eval(cosine, {&value, 1});
      if (scatterers == 1) return {density * value, m.scattering.data()};
      for (size_t i = 0; i < v.size(); ++i) v[i] += density * m.scattering[i] * value;
    } else {
      m.phase->eval(cosine, phase_);
      for (size_t i = 0; i < v.size(); ++i) {
        const float value = density * m.scattering[i] * phase_[i];
        v[i] = scatterers == 1 ? value : v[i] + value;
      }
    }
  }
  return {1, v.data()};
}

ScatterModel::Polarised FieldSpace::mueller(uint32_t p, Dir out, Dir in, std::span<Mueller> m) const {
  thread_local std::vector<PlaneBlocks> one, sum;
  thread_local std::vector<float> phase, whole;
  one.resize(m.size()), phase.resize(m.size());
  sum.assign(m.size(), PlaneBlocks{0, 0, 0, 0, 0, 0}), whole.assign(m.size(), 0.0f);
  const double cosine = scattering_cosine(out, in);
  const ScatterPlace& e = events_[p];
  double unknown = 0, all = 0;
  bool grey = e.contents.size() == 1;
  for (const Constituent& c : e.contents) {
    const BakedMedium& medium = optics_.media()[c.medium];
    if (!medium.scatters()) continue;
    const bool uniform = one_phase_[c.medium];
    medium.phase->eval(cosine, uniform ? std::span(phase).first(1) : std::span(phase));
    const auto of = medium.phase->polarised(cosine, one);
    grey = grey && of.grey;
    for (size_t i = 0; i < m.size(); ++i) {
      const float mine = static_cast<float>(c.density) * medium.scattering[i] * phase[uniform ? 0 : i];
      sum[i] = sum[i] + one[of.grey ? 0 : i] * double{mine};
      whole[i] += mine, all += mine, unknown += of.unknown * mine;
    }
    if (grey) sum[0] = one[0], whole[0] = 1;
  }
  const ScatteringPlane plane(out, in);
  for (size_t i = 0; i < (grey ? 1 : m.size()); ++i)
    m[i] = whole[i] > 0 ? plane.matrix(sum[i] * (1 / double{whole[i]})) : Mueller::depolariser();
  return {grey || m.size() == 1, all > 0 ? unknown / all : 0};
}

bool FieldSpace::scatter(uint32_t p, Dir out, int knot, Vec2 u, double who, Dir& in) const {
  const ScatterPlace& e = events_[p];
  const size_t own = optics_.state().knots[static_cast<size_t>(knot)];
  // Draw who scatters, then how.
  double choice = who * e.rate[knot];
  const BakedMedium* scatterer = nullptr;
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    const double rate = c.density * double{m.scattering[own]};
    if (!(rate > 0)) continue;
    scatterer = &m;
    if ((choice -= rate) < 0) break;
  }
  if (!scatterer) return false;
  in = scattered_direction(out, scatterer->phase->sample(u.x, knot), u.y);
  return true;
}

bool FieldSpace::sample(uint32_t p, const LivePath& live, Vec2 u, double who, std::span<float> dense,
                        Continuation& on) {
  if (!scatter(p, -live.direction, live.knot, u, who, on.in)) return false;
  densities(p, -live.direction, on.in, {on.density, optics_.state().knots.size()});
  on.dirac = false;
  on.weight = evaluate(p, scattering_cosine(-live.direction, on.in), dense);
  return true;
}

void FieldSpace::see_from_surface(uint32_t p, const Hit& hit, uint32_t material, Dir out, Dir in) {
  MediumStack& stack = sight_.add(stacks_[p]);
  if (dot(in, hit.normal) * dot(out, hit.normal) < 0) bodies_.transmit(stack, hit, material, in, statistics_);
}

bool FieldSpace::dims(const Ray& ray, double distance, size_t i, std::span<float> transmission,
                      std::span<double> reach) {
  const std::span<const double> depth = sight_.depths(i);
  const bool dim = flights_.transmittance(depth, transmission);
  if (dim)
    for (size_t k = 0; k < reach.size(); ++k) reach[k] = std::exp(-scattering_depth(depth, k));
  if (!air_ || (is_airless(sight_.start(i)) && !(sight_.passes(i) > 0))) return dim;
  if (!dim) std::fill(transmission.begin(), transmission.end(), 1.0f);
  air_->transmittance(ray.origin, ray.direction, distance, phase_);
  for (size_t k = 0; k < phase_.size(); ++k) transmission[k] *= phase_[k];
  return true;
}

TraceStatistics FieldSpace::take_statistics() {
  TraceStatistics all = sight_.take_statistics();
  all.rays += statistics_.rays, all.cycles += statistics_.cycles;
  statistics_ = {};
  return all;
}

}  // namespace suite
