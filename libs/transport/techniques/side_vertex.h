// Splitting with a light-directed scattering vertex, in media that scatter forwards.
//
// A path in a cloud asks for the sun at each of its events, and what it finds there is the phase function: hundreds of
// times its mean when the path happens to travel along with the light, which few paths do and which is most of what
// makes a picture of a cloud noisy. So every event also sends a flight aside, drawn as matter there scatters what
// comes from the middle of the sun (density g_k of directions at knot k; the path's own continuation: p_k), to the next
// scattering, which asks for the sun and ends. Both ways draw the same: light that is scattered here and there. With
// t_k the density of flights, the same for both, what the path finds at its next event counts
//   sum P_k r_k p_k t_k / sum P_k r_k (p_k + g_k) t_k
// of it, and the side flight's the rest: neither is much more than the smaller one of two phase functions. Most side
// flights would bring little, that is the smaller one of p and g: chance takes the others (roulette). Not where light
// is asked for through smooth interfaces, or lost behind them.
// Based on: the multi-sample balance heuristic of E. Veach & L. Guibas, "Optimally combining sampling techniques for
// Monte Carlo rendering", 1995; directions drawn about those of light sources: J. Krivanek & E. d'Eon, "A
// zero-variance-based sampling scheme for Monte Carlo subsurface scattering", SIGGRAPH 2014 talks.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/techniques/suffix_throughput.h"

namespace suite {

template <class Wave>
class SideVertex {
 public:
  using Path = typename Wave::Path;
  // guides: whether another technique directs continuations towards the light.
  void prepare(const Wave& wave, bool guides);

  // The probability with which the node samples the light: less than 1 where side flights leave little of it; 0: not
  // this time.
  double asks(const Wave& wave, const PathNode& node, const SampledLight& light) const;
  // The share of what a path finds of a light at a node that side flights leave to it.
  double beside(const Wave& wave, const PathNode& node, uint16_t light) const {
    const Path& path = wave.paths[node.path];
    return node.event && path.sided && light == light_->index ? alone(wave, path) : 1;
  }
  // Gives a continuation the density of the other way to where it leads.
  void share(const Wave& wave, const PathNode& node, Continuation& on) const {
    on.sided = has_side(wave, node);
    if (on.sided) wave.space.densities(node.path, -toward_, on.in, {on.other, wave.knots()});
  }
  // Draws side flights of the stage; false when there are none.
  bool begin(Wave& wave, TraceRequest& request);
  // Flies them, and sends shadow rays from where they are scattered; returns how many are.
  size_t fly(Wave& wave);
  void answer(Wave& wave);

 private:
  struct Side {
    uint32_t node;       // of the stage
    Path path;           // that takes the way aside
    Flight flight;       // of it
    double scale = 0;    // times spectrum: what the event makes of light from there, over its density
    LightSample sample;  // of the light
    uint32_t hit = 0;    // in hits_
  };
  // Of the light that may come to pass, over even scattering of all of a path's light: less than kCarries is left to
  // chance, with kLeast at least.
  static constexpr double kCarries = 4, kLeast = 0.05;
  bool has_side(const Wave& wave, const PathNode& node) const {
    return light_ && node.event &&
           (wave.options.max_scatterings == 0 || wave.paths[node.path].scatterings < wave.options.max_scatterings) &&
           wave.space.asymmetry(node.path) > kForwardScattering;
  }
  double brings(const Wave& wave, const PathNode& node, Dir in) const;
  double alone(const Wave& wave, const Path& path) const;
  bool begin_one(Wave& wave, const PathNode& node, Side& side, std::span<float> spectrum);
  bool fly_one(Wave& wave, Side& side, std::span<float> spectrum);
  void shine(Wave& wave, const Side& side, size_t ray, std::span<float> spectrum);
  std::span<float> spectrum_of(const Wave& wave, size_t i) { return {&spectra_[i * wave.bins], wave.bins}; }

  const SampledLight* light_ = nullptr;  // towards which there are side flights; null: there are none
  Dir toward_;                           // its middle
  std::vector<Side> sides_;              // the first count_ of them
  size_t count_ = 0;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<float> spectra_;  // [side][bin]
};

// Where media do not scatter paths.
template <class Wave>
class NoSideVertex {
 public:
  void prepare(const Wave&, bool) {}
  double asks(const Wave&, const PathNode&, const SampledLight&) const { return 1; }
  double beside(const Wave&, const PathNode&, uint16_t) const { return 1; }
  void share(const Wave&, const PathNode&, Continuation&) const {}
  bool begin(Wave&, TraceRequest&) { return false; }
  size_t fly(Wave&) { return 0; }
  void answer(Wave&) {}
};

// The sun, else another light that the air is given beams of.
template <class Wave>
void SideVertex<Wave>::prepare(const Wave& wave, bool guides) {
  if (guides || wave.lost || !wave.options.side_flights) return;
  for (const SampledLight& light : wave.lights.sampled) {
    if (!light.beam || !Wave::Estimator::parallel(light.nature)) continue;
    if (!light_ || light.index == wave.environment.sun) light_ = &light;
  }
  if (!light_) return;
  toward_ = light_->light->beam()->direction;
  const size_t width = wave.paths.size();
  sides_.resize(width), rays_.resize(width), hits_.resize(width);
  spectra_.resize(width * wave.bins);
}

// The share of what has come one of two ways that is left to this one.
template <class Wave>
double SideVertex<Wave>::alone(const Wave& wave, const Path& path) const {
  return 1 / path.other.mean_with(wave.P(), 1);
}

// What a path's light would come to towards a direction, over even scattering of all of it.
template <class Wave>
double SideVertex<Wave>::brings(const Wave& wave, const PathNode& node, Dir in) const {
  const Path& path = wave.paths[node.path];
  float p[kMaxKnots];
  wave.space.densities(node.path, -path.direction, in, {p, wave.knots()});
  return 4 * kPi * *std::max_element(path.throughput, path.throughput + wave.knots()) * path.relative.mean(wave.P(), p);
}

template <class Wave>
double SideVertex<Wave>::asks(const Wave& wave, const PathNode& node, const SampledLight& light) const {
  const Path& path = wave.paths[node.path];
  if (!node.event || !path.sided || &light != light_) return 1;
  const double asks = std::clamp(brings(wave, node, toward_) * alone(wave, path) / kCarries, kLeast, 1.0);
  if (asks == 1) return 1;
  return path.stream.hashed(path.sample, dimensions::roulette_of_light(path.order() - 1)) < asks ? asks : 0;
}

template <class Wave>
bool SideVertex<Wave>::begin(Wave& wave, TraceRequest& request) {
  count_ = 0;
  if (!light_) return false;
  for (const PathNode& node : wave.nodes) {
    Side& side = sides_[count_];
    if (!has_side(wave, node) || !begin_one(wave, node, side, spectrum_of(wave, count_))) continue;
    rays_[count_++].set(side.path.origin, side.path.direction, side.path.time, side.path.draw);
  }
  request = {TraceRequest::Kind::nearest, {rays_.data(), count_}, false, {hits_.data(), count_}, {}, {}};
  return count_ > 0;
}

template <class Wave>
bool SideVertex<Wave>::begin_one(Wave& wave, const PathNode& node, Side& side, std::span<float> spectrum) {
  const Path& from = wave.paths[node.path];
  // Half way between both directions a phase function that falls with the angle brings most: a bound known
  // beforehand.
  const Vec3 half = from.direction + toward_;
  const double length2 = dot(half, half);
  const double most = length2 > 1e-6 ? brings(wave, node, half / std::sqrt(length2)) / 2 : 0;
  const double tried = std::clamp(most / kCarries, kLeast, 1.0);
  if (from.stream.hashed(from.sample, dimensions::roulette_of_side(from.order() - 1)) >= tried) return false;
  const std::array<double, 4> u = dimensions::of_side(from.stream, from.sample, from.flights, 0);
  Path& path = side.path;
  path = from;
  if (!wave.space.scatter(node.path, -toward_, from.knot, {u[0], u[1]}, u[2], path.direction)) return false;
  float p[kMaxKnots], g[kMaxKnots];
  wave.space.densities(node.path, -from.direction, path.direction, {p, wave.knots()});
  wave.space.densities(node.path, -toward_, path.direction, {g, wave.knots()});
  const double own = g[from.knot];
  if (!(own > 0)) return false;
  path.relative.set(wave.knots(), from.relative, g, own), path.other.set(wave.knots(), from.relative, p, own);
  const double shares = path.relative.mean(wave.P()), others = path.other.mean(wave.P()),
               brightest = std::max(0.0, *std::max_element(from.throughput, from.throughput + wave.knots()));
  const double brings = 4 * kPi * brightest * own * shares * others / (shares + others);
  const double survives = std::min(tried, std::clamp(brings / kCarries, kLeast, 1.0));
  if (!(brings > 0) || u[3] * tried >= survives) return false;
  path.relative.divide(wave.knots(), shares), path.other.divide(wave.knots(), shares);
  path.origin = wave.space.place(node.path);
  path.branch = Branch::none, path.sided = true;
  side.node = static_cast<uint32_t>(&node - wave.nodes.data());
  SuffixThroughput<Wave> suffix(wave, spectrum);
  side.scale = suffix.leave_apart(node, path.direction) / (own * shares * survives);
  return true;
}

template <class Wave>
size_t SideVertex<Wave>::fly(Wave& wave) {
  wave.sight_rays.clear(), wave.space.clear_sight();
  wave.sight_rays.first = false;
  wave.sight_rays.expect(count_);
  size_t n = 0;
  for (size_t i = 0; i < count_; ++i) {
    const std::span<float> spectrum = spectrum_of(wave, i);
    sides_[i].hit = static_cast<uint32_t>(i);
    if (!fly_one(wave, sides_[i], spectrum)) continue;
    const uint32_t p = wave.nodes[sides_[i].node].path;
    wave.space.see_from_side(p, hits_[i]);
    const Path& path = sides_[i].path;
    wave.sight_rays.add(std::numeric_limits<double>::infinity(), false)
        .set(wave.space.place(wave.space.side(p)), sides_[i].sample.direction, path.time, path.draw);
    if (n < i) sides_[n] = sides_[i], std::copy_n(spectrum.data(), wave.bins, &spectra_[n * wave.bins]);
    ++n;
  }
  count_ = n;
  wave.sight_rays.parallel = n;
  wave.space.sight().begin(wave.sight_rays);
  return n;
}

template <class Wave>
bool SideVertex<Wave>::fly_one(Wave& wave, Side& side, std::span<float> spectrum) {
  Path& path = side.path;
  const uint32_t p = wave.nodes[side.node].path;
  const std::array<double, 4> u = dimensions::of_side(path.stream, path.sample, path.flights, 1);
  const Hit& hit = hits_[side.hit];
  const std::span<float> through = wave.transmission;
  if (!wave.space.fly_aside(p, path, hit, wave.way_to(hit, path), {u[0], 0}, side.flight, through)) return false;
  side.scale *= double{side.flight.through.scale};
  if (side.flight.through.spectrum) SuffixThroughput<Wave>(wave, spectrum).weaken(through);
  const auto sample = light_->only ? light_->only : light_->light->sample({}, {u[2], u[3], 0, 0}, path.time);
  if (!sample || !(sample->scale > 0)) return false;
  side.sample = *sample;
  return true;
}

template <class Wave>
void SideVertex<Wave>::answer(Wave& wave) {
  const std::span<const uint8_t> blocked = wave.sight_rays.blocked();
  for (size_t i = 0; i < count_; ++i)
    if (!blocked[i] && !wave.is_behind_earth(wave.sight_rays.rays()[i], wave.sight_rays.distance()[i]))
      shine(wave, sides_[i], i, spectrum_of(wave, i));
  wave.hand_over();
}

template <class Wave>
void SideVertex<Wave>::shine(Wave& wave, const Side& side, size_t i, std::span<float> spectrum) {
  const uint32_t p = wave.nodes[side.node].path, event = wave.space.side(p);
  const Path& path = side.path;
  const LightSample& sample = side.sample;
  double reach[kMaxKnots];
  std::fill_n(reach, wave.knots(), 1.0);
  const bool dim = wave.space.dims(wave.sight_rays.rays()[i], wave.sight_rays.distance()[i], i, wave.transmission,
                                   {reach, wave.knots()});
  SuffixThroughput<Wave> suffix(wave, wave.dense(p, 2));
  suffix.resume(spectrum, wave.nodes[side.node], path.direction);
  if (dim) suffix.weaken(wave.transmission);
  double denominator = 1;
  if (sample.density > 0) {
    // As for the path's own way, which shares with what meets the light by chance.
    float density[kMaxKnots];
    wave.space.densities(event, -path.direction, sample.direction, {density, wave.knots()});
    const double others = path.other.mean(wave.P()),
                 by_chance = path.other.mean(wave.P(), density, {reach, wave.knots()});
    denominator = Wave::Estimator::asked(sample.density, others > 0 ? by_chance / others : 0, light_->nature.disk);
  }
  const double scattered = suffix.scatter_apart(event, -path.direction, sample.direction);
  const float* radiance = sample.spectrum;
  if (!radiance) {
    const std::span<float> own = wave.dense(p);
    std::fill(own.begin(), own.end(), 0.0f);
    light_->light->add(sample.direction, path.time, 1, own);
    radiance = own.data();
  }
  Contribution& c = wave.contribution(p, light_->index);
  c.events |= by_medium;
  c.order += 1;
  c.asked = true, c.beam = light_->beam;
  if (wave.waters.any()) c.water = Waters::behind_scattering(Waters::behind_scattering(wave.paths[p].water));
  c.scale = static_cast<float>(side.scale * scattered * sample.scale / denominator * alone(wave, path));
  c.radiance = radiance;
  c.arrival += wave.space.optical_way(p, i, side.flight.length);
  wave.leaves(c, sample.source, -sample.direction, path.time);
  suffix.contribute(c);
}

}  // namespace suite
