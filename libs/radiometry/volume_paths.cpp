#include "radiometry/volume_paths.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace suite {

namespace {
// Blocks of dimensions of the first flights of a path; later ones use hashed numbers.
constexpr uint32_t kFlightBlocks = 1024, kStratifiedFlights = 16;
constexpr uint32_t kFlightNumbers = 0, kScatterNumbers = 1, kSkyNumbers = 2, kMoonNumbers = 3, kLampNumbers = 4,
                   kBlocksPerFlight = 5;
constexpr uint32_t kHashedPurpose = 1u << 20;
constexpr uint32_t kMostFlights = 1u << 24;  // boundaries passed included
}  // namespace

VolumePaths::VolumePaths(const Surface& surface, const Optics& optics, const Environment& environment,
                         const PipelineOptions& options, std::span<const double> knot_probability, LostLight* lost)
    : surface_(surface),
      optics_(optics),
      environment_(environment),
      options_(options),
      ambient_(surface.tracer().scene().ambient),
      probability_(knot_probability.begin(), knot_probability.end()),
      field_(surface.tracer().scene(), optics.state(), surface.tracer().periodic()),
      bodies_(surface),
      flights_(field_, optics, knot_probability, environment.atmosphere.get()),
      light_(surface, bodies_, flights_, optics.media().size(), lost),
      spectrum_(optics.state().size()),
      transmission_(optics.state().size()),
      phase_(optics.state().size()) {}

void VolumePaths::start(LivePath& live, double time, TraceStatistics& statistics) {
  live.bodies.clear();
  if (bodies_.any()) live.bodies = bodies_.around(live.origin, time, statistics);
}

std::array<double, 4> VolumePaths::numbers(const LivePath& live, uint32_t block) const {
  if (live.flights < kStratifiedFlights)
    return live.stream.draw(live.sample, kFlightBlocks + kBlocksPerFlight * live.flights + block);
  std::array<double, 4> u;
  for (uint32_t d = 0; d < 4; ++d)
    u[d] = live.stream.hashed(live.sample, kHashedPurpose + 32 * live.flights + 4 * block + d);
  return u;
}

void VolumePaths::open(Wave& wave, uint32_t p) {
  const std::span<float> through = wave.through(p, wave.path(p).size), gathered = wave.gathered(p, wave.path(p).size);
  std::fill(through.begin(), through.end(), 1.0f);
  std::fill(gathered.begin(), gathered.end(), 0.0f);
  if (!wave.has_missed()) return;
  const std::span<float> missed = wave.missed_on_way(p, wave.path(p).size);
  std::fill(missed.begin(), missed.end(), 0.0f);
}

void VolumePaths::travel(Wave& wave, std::vector<LivePath>& live, RunStatistics& statistics) {
  statistics.trace.rays += std::exchange(crossing_.rays, 0);
  statistics.trace.cycles += std::exchange(crossing_.cycles, 0);
  pending_.resize(wave.active.size());
  ended_.assign(wave.active.size(), 0);
  start_.assign(wave.active.size(), {});
  for (size_t s = 0; s < wave.active.size(); ++s) {
    pending_[s] = s;
    open(wave, wave.active[s]);
  }
  while (!pending_.empty()) {
    // Fly each path to its next event: a scattering, a boundary to pass, a surface or the end of the scene.
    moving_.clear();
    event_count_ = 0;
    for (const size_t s : pending_) {
      bool moves = false;
      if (!step(wave, s, live[wave.active[s]], moves, statistics.trace))
        ended_[s] = 1;
      else if (moves)
        moving_.push_back(s);
    }
    // Give the scattered ones their light and a new direction.
    light_events(wave, live, statistics);
    for (size_t e = 0; e < event_count_; ++e) {
      LivePath& l = live[events_[e].path];
      if (scatter(wave, events_[e], l)) {
        moving_.push_back(events_[e].slot);
        start_[events_[e].slot] = {l.origin, 0};
      } else {
        ended_[events_[e].slot] = 1;
      }
    }
    statistics.nodes += event_count_;
    // See what those that go on will meet.
    rays_.clear();
    for (const size_t s : moving_) {
      LivePath& l = live[wave.active[s]];
      ++l.flights;
      const Ray& own = wave.path(wave.active[s]).ray;
      rays_.push_back({start_[s].from, l.direction, own.time, own.draw});
    }
    hits_.resize(rays_.size());
    surface_.tracer().nearest(rays_, hits_, false, statistics.trace);
    for (size_t i = 0; i < moving_.size(); ++i) {
      wave.hits[moving_[i]] = hits_[i];
      if (const double gap = start_[moving_[i]].gap; gap > 0) bodies_.settle(wave.hits[moving_[i]], rays_[i], gap);
    }
    std::swap(pending_, moving_);
  }
  size_t kept = 0;
  for (size_t s = 0; s < wave.active.size(); ++s) {
    ++live[wave.active[s]].flights;
    if (ended_[s]) continue;
    wave.active[kept] = wave.active[s];
    wave.hits[kept++] = wave.hits[s];
  }
  wave.active.resize(kept);
  wave.hits.resize(kept);
}

// One flight. False when the path ends in it; moves: it goes on behind a boundary. A scattered path is remembered.
bool VolumePaths::step(Wave& wave, size_t slot, LivePath& live, bool& moves, TraceStatistics& statistics) {
  const uint32_t p = wave.active[slot];
  Path& path = wave.path(p);
  Hit& hit = wave.hits[slot];
  if (!hit.hit()) bodies_.leave_scene(live.bodies);
  double length = hit.hit() ? hit.distance : std::numeric_limits<double>::infinity();
  if (!hit.hit() && environment_.earth)
    if (const auto met = environment_.earth->meet(live.origin, live.direction, length)) length = met->distance;
  const std::array<double, 4> u = numbers(live, kFlightNumbers);
  const Flights::Arrival arrival =
      flights_.fly(live, path.knot, length, live.bodies.medium(ambient_), path.ray.time, {u[0], u[1], u[3]},
                   wave.through(p, path.size), wave.gathered(p, path.size));
  if (arrival.scattered) {
    live.length += arrival.distance;
    if (path.size == path.first_met()) path.scattered_first = true;
    remember(wave, slot, live.origin + live.direction * arrival.distance);
    return true;
  }
  if (!hit.hit()) return true;
  const uint32_t material = surface_.material(hit);
  if (!bodies_.is_boundary(material)) return true;
  if (live.flights >= kMostFlights) {
    path.end = PathEnd::max_nodes;
    path.truncated = live.throughput[0] / live.shares;
    return false;
  }
  const auto onward = bodies_.pass(live.bodies, hit, {live.origin, live.direction, path.ray.time, path.ray.draw},
                                   hit.distance - start_[slot].gap, statistics);
  if (!onward) return true;
  live.length += hit.distance;
  live.origin = hit.position;
  start_[slot] = {onward->start, onward->gap};
  moves = true;
  return true;
}

void VolumePaths::remember(Wave& wave, size_t slot, Vec3 place) {
  if (event_count_ == events_.size()) events_.emplace_back();
  Scattering& e = events_[event_count_++];
  e.slot = slot;
  e.path = wave.active[slot];
  e.place = place;
  e.contents = flights_.contents();
  const std::vector<size_t>& bins = optics_.state().knots;
  for (size_t k = 0; k < bins.size(); ++k) {
    e.rate[k] = 0;
    for (const Constituent& c : e.contents)
      e.rate[k] += c.density * double{optics_.media()[c.medium].scattering[bins[k]]};
  }
}

// Density of directions at every knot.
void VolumePaths::densities(const Scattering& e, double cosine, std::span<double> q) const {
  const std::vector<size_t>& bins = optics_.state().knots;
  std::fill(q.begin(), q.end(), 0.0);
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    if (!m.scatters()) continue;
    float at_knots[kMaxKnots];
    m.phase->pdf(cosine, {at_knots, q.size()});
    for (size_t k = 0; k < q.size(); ++k) q[k] += c.density * double{m.scattering[bins[k]]} * at_knots[k];
  }
  for (size_t k = 0; k < q.size(); ++k) q[k] = e.rate[k] > 0 ? q[k] / e.rate[k] : 0;
}

// Sum over the contents of scattering coefficient times phase function, for every wavelength.
void VolumePaths::phase_spectrum(const Scattering& e, double cosine, std::span<float> v) {
  std::fill(v.begin(), v.end(), 0.0f);
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    if (!m.scatters()) continue;
    const float density = static_cast<float>(c.density);
    if (m.phase->spectrally_uniform()) {
      float value = 0;
      m.phase->eval(cosine, {&value, 1});
      for (size_t i = 0; i < v.size(); ++i) v[i] += density * m.scattering[i] * value;
    } else {
      m.phase->eval(cosine, phase_);
      for (size_t i = 0; i < v.size(); ++i) v[i] += density * m.scattering[i] * phase_[i];
    }
  }
}

// Asks the explicit sources at all scattering events of this round.
void VolumePaths::light_events(Wave& wave, std::vector<LivePath>& live, RunStatistics& statistics) {
  if (!options_.explicit_sources || event_count_ == 0) return;
  lights_.clear();
  light_.clear();
  rays_.clear();
  wave.distance.clear();
  for (size_t e = 0; e < event_count_; ++e) ask_sources(wave, e, live[events_[e].path]);
  wave.blocked.resize(rays_.size());
  light_.look(rays_, wave.distance, wave.blocked, statistics.trace);
  for (size_t i = 0; i < rays_.size(); ++i) {
    const bool buried =
        environment_.earth && environment_.earth->meet(rays_[i].origin, rays_[i].direction, wave.distance[i]);
    if (!buried && (!wave.blocked[i] || light_.passes(i) > 0))
      add_light(wave, live[events_[lights_[i].event].path], lights_[i], rays_[i].direction, i, !wave.blocked[i]);
  }
}

// One sample each of sun, moon, sky and lamps.
void VolumePaths::ask_sources(Wave& wave, size_t e, const LivePath& live) {
  const Ray& own = wave.path(events_[e].path).ray;
  const auto ask = [&](Dir direction, double density, double radiance, const float* spectrum, double distance,
                       bool disk = false, bool sky = false) {
    if (!(radiance > 0)) return;
    lights_.push_back({e, density, radiance, spectrum, disk, sky});
    rays_.push_back({events_[e].place, direction, own.time, own.draw});
    wave.distance.push_back(distance);
    light_.add(live.bodies);
  };
  const double far = std::numeric_limits<double>::infinity();
  if (environment_.sun_disk) {
    const std::array<double, 4> u = numbers(live, kScatterNumbers);
    const DirectionSample drawn = environment_.sun_disk->draw({u[2], u[3]});
    ask(drawn.direction, drawn.density, 1, environment_.sun_disk->spectrum(), far, true);
  }
  if (environment_.moon_disk) {
    const std::array<double, 4> u = numbers(live, kMoonNumbers);
    const DirectionSample drawn = environment_.moon_disk->draw({u[0], u[1]});
    ask(drawn.direction, drawn.density, 1, environment_.moon_disk->spectrum(), far, true);
  }
  if (environment_.sky && environment_.sky->tabulated()) {
    const std::array<double, 4> u = numbers(live, kSkyNumbers);
    const DirectionSample drawn = environment_.sky->draw({u[0], u[1]});
    const float* spectrum = environment_.sky->spectrum();
    ask(drawn.direction, drawn.density, spectrum ? environment_.sky->relative(drawn.direction) : 1, spectrum, far,
        false, true);
  }
  if (environment_.lamps) {
    const std::array<double, 4> u = numbers(live, kLampNumbers);
    const auto lamp = environment_.lamps->sample({events_[e].place, {}, true}, u, own.time);
    if (lamp) {
      // The ray ends just in front of the lamp, not on it.
      const Vec3 way = lamp->end - events_[e].place;
      if (const double distance = length(way); distance > 0)
        ask(way / distance, lamp->density, lamp->scale, lamp->spectrum, distance);
    }
  }
}

void VolumePaths::add_light(Wave& wave, const LivePath& live, const Light& light, Dir direction, size_t ray,
                            bool arrives) {
  const Scattering& e = events_[light.event];
  const size_t knots = probability_.size();
  const double cosine = scattering_cosine(-live.direction, direction);
  phase_spectrum(e, cosine, spectrum_);
  double reach[kMaxKnots];
  std::fill_n(reach, knots, 1.0);
  const bool dim = dims(ray, transmission_, {reach, knots});
  double denominator = live.shares, chance = 0;
  if (light.density > 0) {
    double q[kMaxKnots];
    densities(e, cosine, {q, knots});
    double by_chance = 0;
    for (size_t k = 0; k < knots; ++k) by_chance += probability_[k] * live.relative[k] * q[k] * reach[k];
    const double drawn = live.shares * light.density;
    chance = by_chance / drawn;
    denominator = arrives ? shared_density(drawn, by_chance, light.disk) : drawn;
  }
  Path& path = wave.path(e.path);
  if (!arrives) {
    if (light.sky || chance > LostLight::kOftenMet) return;
    path.missed_chance = std::min(path.missed_chance, chance);
  }
  const std::span<float> beta = wave.through(e.path, path.size),
                         sum = arrives ? wave.gathered(e.path, path.size) : wave.missed_on_way(e.path, path.size);
  const float scale = static_cast<float>((arrives ? 1 : light_.passes(ray)) * light.radiance / denominator);
  if (dim)
    for (size_t i = 0; i < beta.size(); ++i) spectrum_[i] *= transmission_[i];
  if (environment_.atmosphere) {
    environment_.atmosphere->transmittance(e.place, direction, wave.distance[ray], phase_);
    for (size_t i = 0; i < beta.size(); ++i) spectrum_[i] *= phase_[i];
  }
  const float* source = light.spectrum;
  if (!source) {  // the sky's, whose shape changes with wavelength
    std::fill(phase_.begin(), phase_.end(), 0.0f);
    environment_.sky->add(direction, 1, phase_);
    source = phase_.data();
  }
  for (size_t i = 0; i < beta.size(); ++i) sum[i] += scale * beta[i] * spectrum_[i] * source[i];
}

// Draws the direction in which a scattered path goes on; false when it ends.
bool VolumePaths::scatter(Wave& wave, const Scattering& e, LivePath& live) {
  Path& path = wave.path(e.path);
  const size_t knot = static_cast<size_t>(path.knot), knots = probability_.size();
  const std::vector<size_t>& bins = optics_.state().knots;
  const std::array<double, 4> u = numbers(live, kScatterNumbers);
  const Dir out = -live.direction;
  ++live.scatterings;
  path.end = PathEnd::absorbed;

  // Draw who scatters, then how.
  double choice = numbers(live, kFlightNumbers)[2] * e.rate[knot];
  const BakedMedium* scatterer = nullptr;
  for (const Constituent& c : e.contents) {
    const BakedMedium& m = optics_.media()[c.medium];
    const double rate = c.density * double{m.scattering[bins[knot]]};
    if (!(rate > 0)) continue;
    scatterer = &m;
    if ((choice -= rate) < 0) break;
  }
  if (!scatterer) return false;
  const double cosine = scatterer->phase->sample(u[0], path.knot);
  double q[kMaxKnots];
  densities(e, cosine, {q, knots});
  const double own = q[knot];
  if (!(own > 0)) return false;

  // Weigh by what all of them do.
  const std::span<float> beta = wave.through(e.path, path.size);
  phase_spectrum(e, cosine, spectrum_);
  for (size_t i = 0; i < beta.size(); ++i) beta[i] = static_cast<float>(beta[i] * (spectrum_[i] / own));
  live.shares_before = live.shares;
  live.shares = 0;
  double brightest = 0;
  for (size_t k = 0; k < knots; ++k) {
    live.relative[k] *= q[k] / own;
    live.shares += probability_[k] * live.relative[k];
    live.throughput[k] *= spectrum_[bins[k]] / own;
    brightest = std::max(brightest, live.throughput[k]);
  }
  live.last_density = own;
  live.direction = scattered_direction(out, cosine, u[1]);
  live.origin = live.place = e.place;
  live.length_at_place = live.length;
  live.scattered = true;
  brightest /= live.shares;
  if (!(brightest > 0) && knots == 1 && optics_.state().size() == 1) return false;

  if (path.size + static_cast<int>(std::min(live.scatterings, 1000u)) > options_.roulette_after) {
    const double survival = std::clamp(brightest, 0.05, 1.0);
    if (numbers(live, kSkyNumbers)[3] >= survival) {
      path.end = PathEnd::roulette;
      return false;
    }
    for (size_t k = 0; k < knots; ++k) live.throughput[k] /= survival;
    for (float& b : beta) b = static_cast<float>(b / survival);
  }
  if (live.scatterings >= options_.max_scatterings) {
    path.end = PathEnd::max_nodes;
    path.truncated = live.throughput[0] / live.shares;
    return false;
  }
  return true;
}

void VolumePaths::look(Wave& wave, const std::vector<LivePath>& live, RunStatistics& statistics) {
  light_.clear();
  for (size_t i = 0; i < wave.rays.size(); ++i) {
    const uint32_t p = wave.owner[i];
    const Node& node = wave.node(p, wave.path(p).size - 1);
    MediumStack& stack = light_.add(live[p].bodies);
    const double to_light = dot(wave.rays[i].direction, node.hit.normal), to_viewer = dot(node.out, node.hit.normal);
    if (to_light * to_viewer < 0)
      bodies_.transmit(stack, node.hit, node.at.material, wave.rays[i].direction, statistics.trace);
  }
  light_.look(wave.rays, wave.distance, wave.blocked, statistics.trace);
}

bool VolumePaths::dims(size_t ray, std::span<float> transmission, std::span<double> knots) const {
  const std::span<const double> depth = light_.depths(ray);
  if (!flights_.transmittance(depth, transmission)) return false;
  for (size_t k = 0; k < knots.size(); ++k) {
    double tau = 0;
    for (size_t m = 0; m < depth.size(); ++m)
      tau += depth[m] * double{optics_.media()[m].scattering[optics_.state().knots[k]]};
    knots[k] = std::exp(-tau);
  }
  return true;
}

}  // namespace suite
