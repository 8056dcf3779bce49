// Equiangular sampling: scattering vertices near lamps, on flights through even media.
//
// The light that a small lamp scatters into a ray is brightest where the ray passes it, as 1 / d2. Free flights put
// their vertices elsewhere, and the few that come close are most of the noise of a lamp in fog. So a flight that begins
// in matter which scatters and is the same everywhere also puts a vertex on its way at a distance t with the density
//   e(t) = tried sum q_m e_m(t),   e_m: equiangular about lamp m (equiangular_law.h), q_m ~ angle over its distance,
// samples points of lamps there, and ends. Flights that pass lamps by are tried by chance (roulette). What the path
// itself finds of such samples at its next scattering is shared with it (multi-sample balance heuristic), by weights
// that depend on the flight's beginning and t alone:
//   free flight   a / (a + e),   equiangular   e / (a + e),   a(t) = sum P_k r_k s_k exp(-s_k t),
// s_k the scattering coefficient at hero wavelength k where the flight begins. Where the flight leaves that matter, a
// is no density of it any more, and the weights still sum to 1. Chance never meets a point, so nothing else has a part
// of this light; lamps with a surface are left to their own samples. Based on: C. Kulla & M. Fajardo, "Importance
// sampling techniques for path tracing in participating media", EGSR 2012; E. Veach & L. Guibas, "Optimally combining
// sampling techniques for Monte Carlo rendering", 1995.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "transport/equiangular_law.h"
#include "transport/techniques/suffix_throughput.h"

namespace suite {

template <class Wave>
class Equiangular {
 public:
  using Path = typename Wave::Path;
  void prepare(const Wave& wave);
  // Puts vertices on the flights that begin, whose hits are known, and sends shadow rays from them; false when there
  // are none.
  bool begin(Wave& wave, std::span<const uint32_t> active);
  void answer(Wave& wave);
  uint64_t take_nodes() { return std::exchange(nodes_, 0); }
  // The share of a light sample at a scattering that is left to it; place: of the lamp.
  double beside(const Wave& wave, const PathNode& node, uint16_t light, bool point) const {
    if (lamps_.empty() || !node.event || !point || !flights_[node.path].shares || !has(light)) return 1;
    if (wave.in_air(node)) return 1;
    const Flying& flight = flights_[node.path];
    const double t = length(wave.space.place(node.path) - flight.from), own = free_density(wave, flight, t);
    return own / (own + density(flight, t));
  }

 private:
  static constexpr double kCarries = 4, kLeast = 0.05, kNear = 0.25;
  struct Lamp {
    const SampledLight* light;
    size_t member;
  };
  struct Flying {
    bool shares = false;
    double tried = 0;  // the probability with which it puts a vertex
    Vec3 from;
    double rate[kMaxKnots];   // s_k, 1/m
    double share[kMaxKnots];  // P_k r_k
    std::array<EquiangularLaw, kMostEquiangularLamps> of;
    std::array<double, kMostEquiangularLamps> chance;  // q_m
  };
  struct Vertex {  // of each shadow ray
    uint32_t path;
    const SampledLight* light;
    double t, weight;  // m; 1 / (a + e)
    LightSample sample;
    size_t through;  // in through_
  };
  bool has(uint16_t light) const {
    return std::any_of(lamps_.begin(), lamps_.end(), [&](const Lamp& l) { return l.light->index == light; });
  }
  bool start(Wave& wave, uint32_t p, double length);
  double tried(const Wave& wave, const Path& path, const Flying& flight, double worth) const;
  void put(Wave& wave, uint32_t p, double length);
  void shine(Wave& wave, const Vertex& v, size_t ray);
  // 1/m, of putting a vertex there at all.
  double density(const Flying& flight, double t) const {
    double e = 0;
    for (size_t m = 0; m < lamps_.size(); ++m)
      if (flight.chance[m] > 0) e += flight.chance[m] * flight.of[m].density(t);
    return flight.tried * e;
  }
  double free_density(const Wave& wave, const Flying& flight, double t) const {
    double a = 0;
    for (size_t k = 0; k < wave.knots(); ++k) a += flight.share[k] * flight.rate[k] * std::exp(-flight.rate[k] * t);
    return a;
  }

  std::vector<Lamp> lamps_;  // empty: not at work
  std::vector<const SampledLight*> lights_;
  std::vector<Flying> flights_;  // [path]
  std::vector<Vertex> vertices_;
  std::vector<float> through_;  // of each place, per bin: what the way to it leaves of light
  uint64_t nodes_ = 0;
};

// Where media do not scatter paths.
template <class Wave>
class NoEquiangular {
 public:
  void prepare(const Wave&) {}
  bool begin(Wave&, std::span<const uint32_t>) { return false; }
  void answer(Wave&) {}
  uint64_t take_nodes() { return 0; }
  double beside(const Wave&, const PathNode&, uint16_t, bool) const { return 1; }
};

template <class Wave>
void Equiangular<Wave>::prepare(const Wave& wave) {
  if (!wave.options.equiangular) return;
  for (const SampledLight& light : wave.lights.sampled) {
    if (light.nature.far || !light.nature.placed) continue;
    const size_t before = lamps_.size();
    for (size_t m = 0; m < light.light->members() && lamps_.size() <= kMostEquiangularLamps; ++m)
      if (light.light->is_point(m)) lamps_.push_back({&light, m});
    if (lamps_.size() > before) lights_.push_back(&light);
  }
  if (lamps_.size() > kMostEquiangularLamps) lamps_.clear();
  if (!lamps_.empty()) flights_.resize(wave.paths.size());
}

template <class Wave>
bool Equiangular<Wave>::begin(Wave& wave, std::span<const uint32_t> active) {
  if (lamps_.empty()) return false;
  wave.sight_rays.clear(), wave.space.clear_sight();
  wave.sight_rays.first = false;
  wave.sight_rays.expect(active.size() * lights_.size());
  vertices_.clear(), through_.clear();
  for (size_t slot = 0; slot < active.size(); ++slot) {
    const uint32_t p = active[slot];
    const double length = wave.way_to(wave.hits[slot], wave.paths[p]);
    // What is drawn by a guide has the same light as its other branch, which brings this.
    if (start(wave, p, length) && wave.paths[p].branch != Branch::forced) put(wave, p, length);
  }
  if (vertices_.empty()) return false;
  wave.space.sight().begin(wave.sight_rays);
  return true;
}

// Where the flight of path p begins, and how near it comes to lamps. False: it shares nothing.
template <class Wave>
bool Equiangular<Wave>::start(Wave& wave, uint32_t p, double length) {
  const Path& path = wave.paths[p];
  Flying& flight = flights_[p];
  flight.shares = false;
  if (!wave.space.starts_in_even_matter(p) || !(length > 0)) return false;
  // Free flights put vertices near lamps by themselves that are not near in mean free paths.
  const double rate = wave.space.scattering_around(p, 0), near = kNear / rate;
  double sum = 0;
  std::array<std::optional<Vec3>, kMostEquiangularLamps> places;
  bool any = false;
  for (size_t m = 0; m < lamps_.size(); ++m) {
    places[m] = lamps_[m].light->light->point_of(lamps_[m].member, path.time);
    any = any || (places[m] && dot(*places[m] - path.origin, *places[m] - path.origin) < near * near);
  }
  if (!any) return false;
  for (size_t m = 0; m < lamps_.size(); ++m) {
    const auto& place = places[m];
    flight.of[m] = place ? EquiangularLaw(path.origin, path.direction, length, *place) : EquiangularLaw();
    sum += flight.chance[m] = flight.of[m].worth();
  }
  if (!(sum > 0)) return false;
  for (size_t m = 0; m < lamps_.size(); ++m) flight.chance[m] /= sum;
  flight.from = path.origin;
  for (size_t k = 0; k < wave.knots(); ++k) {
    flight.rate[k] = wave.space.scattering_around(p, k);
    flight.share[k] = path.relative.part(wave.P(), k);
  }
  flight.tried = tried(wave, path, flight, sum);
  return flight.shares = true;
}

// Lamps far off, in mean free paths, and paths that carry little are worth a vertex now and then.
template <class Wave>
double Equiangular<Wave>::tried(const Wave& wave, const Path& path, const Flying& flight, double worth) const {
  double rate = 0;
  for (size_t k = 0; k < wave.knots(); ++k) rate += flight.share[k] * flight.rate[k];
  const double carries = *std::max_element(path.throughput, path.throughput + wave.knots());
  return std::clamp(carries * worth / (rate * kCarries), kLeast, 1.0);
}

template <class Wave>
void Equiangular<Wave>::put(Wave& wave, uint32_t p, double length) {
  const Path& path = wave.paths[p];
  const Flying& flight = flights_[p];
  const std::array<double, 4> u = dimensions::of_beside(path.stream, path.sample, path.flights, 0);
  if (u[2] >= flight.tried) return;
  size_t m = 0;
  for (double left = u[0]; m + 1 < lamps_.size() && (left -= flight.chance[m]) >= 0;) ++m;
  const double t = flight.of[m].draw(u[1]);
  if (!(t > 0 && t < length)) return;
  const double weight = 1 / (free_density(wave, flight, t) + density(flight, t));
  const Vec3 place = path.origin + path.direction * t;
  wave.space.begin_way(p, true, {}, kNone, {}, {});
  const size_t at = through_.size();
  through_.resize(at + wave.bins, 1.0f);
  wave.space.follow_way({path.origin, path.direction, path.time, path.draw}, t, {&through_[at], wave.bins},
                        wave.transmission);
  const std::array<double, 4> v = dimensions::of_beside(path.stream, path.sample, path.flights, 1);
  ++nodes_;
  for (const SampledLight* light : lights_) {
    const auto sample = light->light->sample({place, {}, true}, v, path.time);
    if (!sample || sample->density > 0 || !sample->spectrum || !(sample->scale > 0)) continue;
    vertices_.push_back({p, light, t, weight, *sample, at});
    wave.space.see_from_way();
    wave.sight_rays.add(sample->distance, false).set(place, sample->direction, path.time, path.draw);
  }
}

template <class Wave>
void Equiangular<Wave>::answer(Wave& wave) {
  const std::span<const uint8_t> blocked = wave.sight_rays.blocked();
  for (size_t i = 0; i < vertices_.size(); ++i)
    if (!blocked[i] && !wave.is_behind_earth(wave.sight_rays.rays()[i], wave.sight_rays.distance()[i]))
      shine(wave, vertices_[i], i);
  wave.hand_over();  // flights change throughputs
}

template <class Wave>
void Equiangular<Wave>::shine(Wave& wave, const Vertex& v, size_t i) {
  const Path& path = wave.paths[v.path];
  SuffixThroughput<Wave> suffix(wave, wave.dense(v.path));
  suffix.resume({&through_[v.through], wave.bins});
  // The flight has not begun: what surrounds its origin is what fills the place.
  wave.space.begin_way(v.path, true, {}, kNone, {}, {});
  const double scattered = suffix.scatter_apart(wave.space.stand_on_way(), -path.direction, v.sample.direction);
  double reach[kMaxKnots];
  const double distance = wave.sight_rays.distance()[i];
  if (wave.space.dims(wave.sight_rays.rays()[i], distance, i, wave.transmission, {reach, wave.knots()}))
    suffix.weaken(wave.transmission);
  Contribution& c = wave.contribution(v.path, v.light->index);
  c.events |= by_medium;
  c.order += 1;
  c.asked = true, c.beam = v.light->beam;
  if (wave.waters.any()) c.water = Waters::behind_scattering(path.water);
  c.scale = static_cast<float>(v.weight * scattered * v.sample.scale);
  c.radiance = v.sample.spectrum;
  wave.leaves(c, v.sample.source, -v.sample.direction, path.time);
  c.arrival += wave.space.optical_way(v.path, i, v.t + distance);
  suffix.contribute(c);
}

}  // namespace suite
