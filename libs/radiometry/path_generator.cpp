#include "radiometry/path_generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radiometry/lost_light.h"
#include "radiometry/receiver.h"
#include "radiometry/volume_paths.h"

namespace suite {

namespace {
constexpr uint32_t kLobes = kLobeBlock;
constexpr double kChainsCarry = 0.25;
}  // namespace

PathGenerator::PathGenerator(const Surface& surface, const Optics& optics, const Environment& environment,
                             const PipelineOptions& options)
    : surface_(surface),
      optics_(optics),
      environment_(environment),
      options_(options),
      knots_(optics.state().knots.size()),
      knot_bins_(optics.state().knots) {
  paper_ = options.method == Method::paper;
  // The reference keeps at least half of the paths.
  for (size_t k = 0; k < knots_; ++k)
    knot_probability_[k] = knots_ == 1 ? 1.0 : k == 0 ? 0.5 : 0.5 / static_cast<double>(knots_ - 1);
  if (paper_)
    std::fill_n(knot_probability_, knots_, 0.0), knot_probability_[0] = 1, options_.roulette_after = kMaxNodes;
  asks_disks_ = options.explicit_sources && !paper_;
  asks_around_ = asks_disks_ && (environment.lamps || (environment.sky && environment.sky->tabulated()));
  if (environment.lamps && !paper_)
    lamp_draws_ =
        static_cast<int>(std::clamp<size_t>(environment.lamps->size(), 1, static_cast<size_t>(options.lamp_draws)));
  if ((environment.sun_disk || environment.moon_disk || environment.lamps) &&
      LostLight::possible(surface.tracer().scene(), optics, options))
    lost_ = std::make_unique<LostLight>(surface, optics);
  if (!optics.media().empty()) {
    volume_ = std::make_unique<VolumePaths>(surface, optics, environment, options,
                                            std::span<const double>(knot_probability_, knots_), lost_.get());
    transmission_.resize(optics.state().size());
  }
}

PathGenerator::~PathGenerator() = default;
PathGenerator::PathGenerator(PathGenerator&&) noexcept = default;

void PathGenerator::start(Wave& wave, size_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) {
  if (live_.size() < wave.width()) live_.resize(wave.width());
  Live& live = live_[p];
  live.stream = stream;
  live.sample = sample;
  live.origin = ray.ray.origin;
  live.direction = ray.ray.direction;
  live.length = 0;
  live.shares = live.shares_before = 1;
  live.last_density = 0;
  live.flights = live.scatterings = 0;
  live.scattered = false;
  std::fill_n(live.relative, knots_, 1.0);
  std::fill_n(live.throughput, knots_, 1.0);
  Path& path = wave.path(p);
  path.begin(ray.ray, ray.weight);
  path.ray.draw = static_cast<uint32_t>(hash_of(stream.key(), sample));
  if (ray.receiver != SensorRay::Receiver::none) {
    path.received = true;
    BakedMaterial& receiver = receivers_[ray.receiver == SensorRay::Receiver::sphere];
    if (!receiver.model) receiver = bake_receiver(ray.receiver, optics_.state());
    live.receiver = &receiver;
  }
  if (volume_) volume_->start(live, ray.ray.time, probing_);
  if (knots_ > 1 && !paper_) {
    const double u = stream.hashed(sample, kKnotPurpose);
    if (u >= 0.5)
      path.knot =
          1 + std::min(static_cast<int>(knots_) - 2, static_cast<int>((u - 0.5) * 2 * static_cast<double>(knots_ - 1)));
  }
  wave.active.push_back(static_cast<uint32_t>(p));
}

void PathGenerator::complete(Wave& wave, RunStatistics& statistics) {
  statistics.trace.rays += std::exchange(probing_.rays, 0);
  statistics.trace.cycles += std::exchange(probing_.cycles, 0);
  for (int depth = 0; !wave.active.empty(); ++depth) {
    // Propagate every path to its next node or out of the scene.
    if (depth == 0) set_receivers_aside(wave);
    wave.rays.resize(wave.active.size());
    for (size_t i = 0; i < wave.active.size(); ++i) {
      const uint32_t p = wave.active[i];
      wave.rays[i].set(live_[p].origin, live_[p].direction, wave.path(p).ray.time, wave.path(p).ray.draw);
    }
    wave.hits.resize(wave.rays.size());
    surface_.tracer().nearest(wave.rays, wave.hits, depth == 0, statistics.trace);
    if (volume_) volume_->travel(wave, live_, statistics);
    size_t kept = 0;
    for (size_t i = 0; i < wave.active.size(); ++i) {
      const uint32_t p = wave.active[i];
      if (wave.hits[i].hit() ? arrive(wave, p, wave.hits[i]) : arrive_on_earth(wave, p)) wave.active[kept++] = p;
    }
    wave.active.resize(kept);
    statistics.nodes += kept;
    if (depth == 0)
      for (const uint32_t p : received_) receive(wave, p), wave.active.push_back(p);

    // Ask the explicit sources at every node, then see which of them are visible.
    wave.rays.clear(), wave.owner.clear(), wave.light.clear(), wave.distance.clear();
    for (const uint32_t p : wave.active) {
      live_[p].u = live_[p].stream.draw(live_[p].sample, 1 + static_cast<uint32_t>(depth));
      if (asks_disks_)
        ask_disks(wave, p);
      else if (options_.explicit_sources)
        ask_one(wave, p);
    }
    const size_t parallel = paper_ ? 0 : wave.rays.size();
    if (asks_around_)
      for (const uint32_t p : wave.active) ask_around(wave, p);
    wave.blocked.resize(wave.rays.size());
    if (volume_)
      volume_->look(wave, live_, statistics);
    else
      see(wave, parallel, depth == 0, statistics.trace);
    if (lost_) look_for_lost(wave, statistics.trace);
    for (size_t i = 0; i < wave.rays.size(); ++i) {
      const uint32_t p = wave.owner[i];
      if (wave.blocked[i] || (environment_.earth &&
                              environment_.earth->meet(wave.rays[i].origin, wave.rays[i].direction, wave.distance[i])))
        continue;
      Node& node = wave.node(p, wave.path(p).size - 1);
      node.sunlit = node.sunlit || wave.light[i] == light_sun;
      add_explicit(wave, p, wave.light[i], i);
    }

    // Draw the continuations.
    kept = 0;
    for (const uint32_t p : wave.active)
      if (go_on(wave, p)) wave.active[kept++] = p;
    wave.active.resize(kept);
  }
}

// Which sources are visible. Rays towards the same far disk run alongside each other where paths have just started, the
// others (from `parallel` on) do not.
void PathGenerator::see(Wave& wave, size_t parallel, bool first, TraceStatistics& statistics) const {
  const std::span<const Ray> rays = wave.rays;
  const std::span<const double> distance = wave.distance;
  const std::span<uint8_t> blocked = wave.blocked;
  const Tracer& tracer = surface_.tracer();
  if (parallel)
    tracer.occluded(rays.first(parallel), distance.first(parallel), blocked.first(parallel), first, statistics);
  if (parallel < rays.size())
    tracer.occluded(rays.subspan(parallel), distance.subspan(parallel), blocked.subspan(parallel), false, statistics);
}

// The next node of a path, without its surface.
Node& PathGenerator::add_node(Wave& wave, uint32_t p, const Hit& hit) {
  Path& path = wave.path(p);
  Live& live = live_[p];
  Node& node = wave.node(p, path.size++);
  node.hit = hit;
  node.out = -live.direction;
  live.length += hit.distance;
  node.optical_length = live.length;
  node.spectral_factor = 1 / live.shares;
  node.continues = node.has_direct = node.has_missed = node.sunlit = false;
  node.lights = 0;
  node.glow = nullptr;
  return node;
}

// Paths that start at a receiver have no ray to trace for their first node.
void PathGenerator::set_receivers_aside(Wave& wave) {
  received_.clear();
  std::erase_if(wave.active, [&](uint32_t p) {
    if (wave.path(p).received) received_.push_back(p);
    return wave.path(p).received;
  });
}

// The first node of a path that starts at a receiver.
void PathGenerator::receive(Wave& wave, uint32_t p) {
  Live& live = live_[p];
  if (volume_) volume_->open(wave, p);
  Hit hit;
  hit.position = live.origin;
  hit.normal = live.direction;
  hit.time = wave.path(p).ray.time;
  Node& node = add_node(wave, p, hit);
  node.out = hit.normal;
  node.at = Interaction{};
  node.at.position = hit.position;
  node.at.geometric_normal = hit.normal;
  node.at.frame = Frame::around(hit.normal);
  node.at.baked = live.receiver;
}

// False when the path ends at the node because nothing scatters.
bool PathGenerator::scatters(Path& path, const Node& node) const {
  if (node.at.baked && node.at.baked->model) return true;
  path.end = PathEnd::absorbed;
  return false;
}

bool PathGenerator::arrive(Wave& wave, uint32_t p, const Hit& hit) {
  Node& node = add_node(wave, p, hit);
  surface_.interact(hit, node.out, node.at, wave.path(p).ray.time);
  if (environment_.lamps) meet_glow(wave, p);
  return scatters(wave.path(p), node);
}

// A path that missed the scene meets the Earth under it, if there is one; false when the path ends.
bool PathGenerator::arrive_on_earth(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  const auto met = environment_.earth
                       ? environment_.earth->meet(live.origin, live.direction, std::numeric_limits<double>::infinity())
                       : std::nullopt;
  if (!met) {
    escape(wave.path(p), live);
    return false;
  }
  Hit hit;
  hit.distance = met->distance;
  hit.position = met->position;
  hit.normal = met->normal;
  hit.step = Earth::step;
  hit.time = wave.path(p).ray.time;
  Node& node = add_node(wave, p, hit);
  node.at = Interaction{};
  node.at.position = met->position;
  node.at.geometric_normal = met->normal;
  node.at.frame = Frame::around(met->normal);
  node.at.material = environment_.earth->material();
  node.at.baked = &optics_.material(node.at.material);
  return scatters(wave.path(p), node);
}

// Draws where the path goes from its last node; false when it ends there.
bool PathGenerator::go_on(Wave& wave, uint32_t p) {
  Path& path = wave.path(p);
  Live& live = live_[p];
  const std::array<double, 4>& u = live.u;
  const int n = path.size - 1;
  Node& node = wave.node(p, n);
  const ScatterModel& model = *node.at.baked->model;
  const Dir out = node.at.frame.to_local(node.out);
  path.end = PathEnd::absorbed;
  const double lobe_u = model.single_lobe() ? 0 : live.stream.draw(live.sample, kLobes + static_cast<uint32_t>(n))[0];
  const auto drawn = model.sample(out, {u[0], u[1]}, lobe_u, path.knot);
  if (!drawn) return false;
  node.in = node.at.frame.to_world(drawn->in);
  if (dot(node.in, node.at.geometric_normal) * drawn->in.z <= 0) return false;  // would leak through the real surface
  const std::span<float> w = wave.bounce(p, n);
  float density[kMaxKnots];
  std::optional<ScatterModel::Factored> factored;
  if (drawn->delta) {
    model.delta_weight(out, drawn->lobe, path.knot, w);
    model.delta_probability(out, drawn->lobe, path.knot, {density, knots_});
  } else {
    factored = model.factored(out, drawn->in);
    if (!factored) model.eval(out, drawn->in, w);
    model.pdf(out, drawn->in, {density, knots_});
  }
  const double own = density[path.knot];
  if (!(own > 0)) return false;
  live.shares_before = live.shares;
  live.shares = 0;
  double brightest = 0;
  for (size_t k = 0; k < knots_; ++k) {
    live.relative[k] *= density[k] / own;
    live.shares += knot_probability_[k] * live.relative[k];
    live.throughput[k] *= (factored ? factored->scale * factored->spectrum[knot_bins_[k]] : w[knot_bins_[k]]) / own;
    brightest = std::max(brightest, live.throughput[k]);
  }
  if (!(brightest > 0) && knots_ == 1 && optics_.state().size() == 1) return false;  // nothing more can arrive
  brightest /= live.shares;

  // Chains of Dirac events that still carry much play no roulette: there is nothing else that could vary.
  double survival = 1;
  if (path.size > options_.roulette_after && !(drawn->delta && brightest > kChainsCarry)) {
    survival = std::clamp(brightest, 0.05, 1.0);
    if (live.stream.hashed(live.sample, kRoulettePurpose + 16 * static_cast<uint32_t>(n)) >= survival) {
      path.end = PathEnd::roulette;
      return false;
    }
    for (size_t k = 0; k < knots_; ++k) live.throughput[k] /= survival;
  }
  if (path.size >= options_.max_nodes) {
    path.end = PathEnd::max_nodes;
    path.truncated = live.throughput[0] / live.shares;
    return false;
  }
  node.lobe = drawn->lobe;
  node.delta = drawn->delta;
  node.density = own * survival;
  node.continues = true;
  node.bounce_spectrum = factored ? factored->spectrum : w.data();
  node.bounce_scale = static_cast<float>((factored ? factored->scale : 1) / node.density);
  live.last_density = drawn->delta ? 0 : own;
  live.scattered = false;
  if (volume_ && dot(node.in, node.hit.normal) * dot(node.out, node.hit.normal) < 0) volume_->cross(live, node);
  live.direction = node.in;
  live.origin = surface_.tracer().leave(node.hit, node.in);
  return true;
}

}  // namespace suite
