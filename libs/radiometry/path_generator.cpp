#include "radiometry/path_generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "radiometry/volume_paths.h"

namespace suite {

namespace {
// Dimensions of the sample streams: block 0 is the sensor's, 1 + n is node n's continuation and sources, kLobes + n its
// choice of lobe. Roulette and knots use hashed numbers, which take no stratification away from the others.
constexpr uint32_t kLobes = 128;
constexpr uint32_t kKnotPurpose = 1, kRoulettePurpose = 2;
}  // namespace

PathGenerator::PathGenerator(const Surface& surface, const Optics& optics, const Environment& environment, const PipelineOptions& options)
    : surface_(surface), optics_(optics), environment_(environment), options_(options), knots_(optics.state().knots.size()), knot_bins_(optics.state().knots) {
  // The reference keeps at least half of the paths.
  for (size_t k = 0; k < knots_; ++k) knot_probability_[k] = knots_ == 1 ? 1.0 : k == 0 ? 0.5 : 0.5 / static_cast<double>(knots_ - 1);
  if (!optics.media().empty()) {
    volume_ = std::make_unique<VolumePaths>(surface, optics, environment, options, std::span<const double>(knot_probability_, knots_));
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
  std::fill_n(live.relative, knots_, 1.0);
  std::fill_n(live.throughput, knots_, 1.0);
  Path& path = wave.path(p);
  path = Path{};
  path.ray = ray.ray;
  path.weight = ray.weight;
  if (volume_) volume_->start(live, ray.ray.time, probing_);
  if (knots_ > 1) {
    const double u = stream.hashed(sample, kKnotPurpose);
    if (u >= 0.5) path.knot = 1 + std::min(static_cast<int>(knots_) - 2, static_cast<int>((u - 0.5) * 2 * static_cast<double>(knots_ - 1)));
  }
  wave.active.push_back(static_cast<uint32_t>(p));
}

void PathGenerator::complete(Wave& wave, RunStatistics& statistics) {
  statistics.trace.rays += std::exchange(probing_.rays, 0);
  statistics.trace.cycles += std::exchange(probing_.cycles, 0);
  for (int depth = 0; !wave.active.empty(); ++depth) {
    // Propagate every path to its next node or out of the scene.
    wave.rays.clear();
    for (const uint32_t p : wave.active) wave.rays.push_back({live_[p].origin, live_[p].direction, wave.path(p).ray.time});
    wave.hits.resize(wave.rays.size());
    surface_.tracer().nearest(wave.rays, wave.hits, depth == 0, statistics.trace);
    if (volume_) volume_->travel(wave, live_, statistics);
    size_t kept = 0;
    for (size_t i = 0; i < wave.active.size(); ++i) {
      const uint32_t p = wave.active[i];
      if (!wave.hits[i].hit()) escape(wave.path(p), live_[p]);
      else if (arrive(wave, p, wave.hits[i])) wave.active[kept++] = p;
    }
    wave.active.resize(kept);
    statistics.nodes += kept;

    // Ask the explicit sources at every node, then see which of them are visible.
    wave.rays.clear(), wave.owner.clear(), wave.light.clear();
    for (const uint32_t p : wave.active) {
      live_[p].u = live_[p].stream.draw(live_[p].sample, 1 + static_cast<uint32_t>(depth));
      if (options_.explicit_sources) ask_sources(wave, p);
    }
    wave.distance.assign(wave.rays.size(), std::numeric_limits<double>::infinity());
    wave.blocked.resize(wave.rays.size());
    if (volume_) volume_->look(wave, live_, statistics);
    else surface_.tracer().occluded(wave.rays, wave.distance, wave.blocked, depth == 0, statistics.trace);
    for (size_t i = 0; i < wave.rays.size(); ++i) {
      const uint32_t p = wave.owner[i];
      if (wave.blocked[i]) continue;
      Node& node = wave.node(p, wave.path(p).size - 1);
      node.sunlit = node.sunlit || wave.light[i] == 0;
      add_explicit(wave, p, node.light[wave.light[i]], i);
    }

    // Draw the continuations.
    kept = 0;
    for (const uint32_t p : wave.active)
      if (go_on(wave, p)) wave.active[kept++] = p;
    wave.active.resize(kept);
  }
}

void PathGenerator::escape(Path& path, const Live& live) const {
  path.end = PathEnd::escaped;
  path.escape = live.direction;
  path.escape_factor = 1 / live.shares;
  const bool by_chance = live.last_density > 0 && options_.explicit_sources;
  if (environment_.sky) {
    const double density = by_chance && environment_.sky->tabulated() ? environment_.sky->density(live.direction) : 0;
    path.sky_factor = density > 0 ? 1 / (live.shares + live.shares_before * density / live.last_density) : path.escape_factor;
  }
  if (environment_.sun && environment_.sun->contains(live.direction))
    path.sun_factor = by_chance ? 1 / (live.shares + live.shares_before * environment_.sun->density() / live.last_density) : path.escape_factor;
}

// Makes the node; false when the path ends there because nothing scatters.
bool PathGenerator::arrive(Wave& wave, uint32_t p, const Hit& hit) {
  Path& path = wave.path(p);
  Live& live = live_[p];
  Node& node = wave.node(p, path.size++);
  node.hit = hit;
  node.out = -live.direction;
  live.length += hit.distance;
  node.optical_length = live.length;
  node.spectral_factor = 1 / live.shares;
  node.continues = false;
  node.light = {};
  surface_.interact(hit, node.out, node.at);
  node.has_direct = node.sunlit = false;
  if (node.at.baked && node.at.baked->model) return true;
  path.end = PathEnd::absorbed;
  return false;
}

void PathGenerator::ask_sources(Wave& wave, uint32_t p) {
  const std::array<double, 4>& u = live_[p].u;
  Node& node = wave.node(p, wave.path(p).size - 1);
  const double out_side = dot(node.out, node.at.geometric_normal);
  auto ask = [&](const DirectionSample& drawn, double relative_radiance, const float* spectrum, uint8_t which) {
    if (!(relative_radiance > 0)) return;
    const double in_side = dot(drawn.direction, node.at.geometric_normal);
    if (node.at.baked->model->opaque() && in_side * out_side <= 0) return;
    // Light may come in only from the side of the surface that the shading frame says it comes from.
    if (in_side * dot(drawn.direction, node.at.frame.z) <= 0) return;
    node.light[which] = {drawn.direction, drawn.density, static_cast<float>(relative_radiance), spectrum, nullptr, 0};
    wave.rays.push_back({surface_.tracer().leave(node.hit, drawn.direction), drawn.direction, wave.path(p).ray.time});
    wave.owner.push_back(p);
    wave.light.push_back(which);
  };
  if (environment_.sun) ask(environment_.sun->sample({u[2], u[3]}), 1, environment_.sun->spectrum(), 0);
  if (environment_.sky && environment_.sky->tabulated()) {
    const std::array<double, 4> v = live_[p].stream.draw(live_[p].sample, kLobes + static_cast<uint32_t>(wave.path(p).size - 1));
    const DirectionSample drawn = environment_.sky->sample({v[2], v[3]});
    ask(drawn, environment_.sky->relative(drawn.direction), environment_.sky->spectrum(), 1);
  }
}

void PathGenerator::add_explicit(Wave& wave, uint32_t p, ExplicitLight& light, size_t ray) {
  const int n = wave.path(p).size - 1;
  Node& node = wave.node(p, n);
  const Live& live = live_[p];
  const Dir out = node.at.frame.to_local(node.out), in = node.at.frame.to_local(light.direction);
  double reach[kMaxKnots];
  std::fill_n(reach, knots_, 1.0);
  const bool dim = volume_ && volume_->dims(ray, transmission_, {reach, knots_});
  double denominator = live.shares;
  if (light.density > 0) {
    float pdf[kMaxKnots];
    node.at.baked->model->pdf(out, in, {pdf, knots_});
    denominator = live.shares * light.density;
    for (size_t k = 0; k < knots_; ++k) denominator += knot_probability_[k] * live.relative[k] * pdf[k] * reach[k];
  }
  const float scale = static_cast<float>(light.radiance_scale / denominator);
  if (const auto factored = node.at.baked->model->factored(out, in); factored && !dim) {
    light.scatter = factored->spectrum;
    light.scale = scale * factored->scale;
    return;
  }
  const std::span<float> w = wave.scratch();
  node.at.baked->model->eval(out, in, w);
  float* direct = wave.direct(p, n).data();
  if (!node.has_direct) std::fill_n(direct, w.size(), 0.0f);
  node.has_direct = true;
  const float* spectrum = light.spectrum;
  for (size_t i = 0; i < w.size(); ++i) direct[i] += w[i] * spectrum[i] * (dim ? transmission_[i] : 1.0f) * scale;
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

  double survival = 1;
  if (path.size > options_.roulette_after) {
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
  if (volume_ && dot(node.in, node.hit.normal) * dot(node.out, node.hit.normal) < 0) volume_->cross(live, node);
  live.direction = node.in;
  live.origin = surface_.tracer().leave(node.hit, node.in);
  return true;
}

}  // namespace suite
