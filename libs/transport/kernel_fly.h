// Definitions of kernel.h: how paths start, fly, and what they meet.
#pragma once
#include <algorithm>
#include <limits>
#include <utility>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
PathKernel<Surfaces, Space, Throughputs, Estimator>::PathKernel(const KernelContext& c, size_t width,
                                                                Throughputs& throughputs, Sink<Throughputs>& sink)
    : surface_(c.surface),
      environment_(c.environment),
      options_(c.options),
      knots_(c.optics.state().knots.size()),
      knot_bins_(c.optics.state().knots),
      knot_of_bin_(c.optics.state().knot_of_bin()),
      bins_(c.optics.state().size()),
      probability_(Estimator::knot_probabilities(knots_)),
      keep_first_(c.keep_first),
      draws_(c.surface.tracer().has_holes() || may_lose(c)),
      lost_(may_lose(c) ? std::make_unique<LostLight>(c.surface, c.optics) : nullptr),
      refracted_(Surfaces::kDense > 0 && refracts(c) ? std::make_unique<RefractedSight>(c.surface, c.optics) : nullptr),
      gloss_(Surfaces::kDense > 0 && !(kGuides && refracted_) ? c.gloss : nullptr),
      contacts_(c.surface, c.optics),
      waters_(c),
      surfaces_(c.surface, c.optics, width, c.keep_first),
      space_(SpaceContext{c.surface, c.optics, c.environment, c.options, width,
                          std::span<const double>(probability_).first(knots_), lost_.get()}),
      throughputs_(throughputs),
      sink_(sink),
      paths_(width),
      records_(width),
      firsts_(c.keep_first ? width : 0),
      receivers_(c.receivers ? width : 0),
      passed_(Space::kGoesBack ? width : 0),
      throughput_there_(Space::kGoesBack ? width * bins_ : 0),
      branches_(kGuides && refracted_ && c.branches ? width : 0),
      rays_(width),
      hits_(width),
      flights_(Space::kFills ? width : 0),
      contributions_(std::max<size_t>(256, 4 * width)),
      transmission_(bins_) {
  list_lights();
  if (c.branches) choose_side_light();
  if (!glowing_.empty()) last_.resize(width);
  for (auto* list : {&active_, &received_, &onward_}) list->reserve(width);
  nodes_.reserve(width), points_.reserve(width);
}

// Which lights are asked, far disks first, and with which numbers: the first light of two numbers takes those that the
// scattering leaves over, the second those of the choice of lobe, and so on.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::list_lights() {
  for (size_t i = 0; i < environment_.lights.size(); ++i) {
    const Light& light = *environment_.lights[i];
    Asked asked{&light,       static_cast<uint16_t>(i), light.nature(), dimensions::kOfScatter, 0,
                std::nullopt, light.beam().has_value()};
    if (!asked.nature.delta) (asked.nature.far ? outside_ : glowing_).push_back(asked);
    if (!options_.explicit_sources || !light.nature().drawn) continue;
    if (asked.nature.far && asked.nature.delta) asked.only = light.sample({}, {}, 0);
    asked_.push_back(asked);
  }
  if (const Light* sky = options_.explicit_sources ? space_.sky() : nullptr)
    asked_.push_back({sky, kFromAir, sky->nature(), dimensions::kOfScatter, 0, std::nullopt, false});
  std::stable_sort(asked_.begin(), asked_.end(), [](const Asked& a, const Asked& b) {
    return Estimator::parallel(a.nature) > Estimator::parallel(b.nature);
  });
  uint32_t own = 0;
  bool scatter = true, second = true;
  for (Asked& asked : asked_) {
    if (asked.only) continue;
    const bool two = asked.nature.numbers <= 2;
    const bool with_scatter = two && std::exchange(scatter, scatter && !two);
    const bool with_second = two && !with_scatter && std::exchange(second, false);
    asked.use = with_scatter  ? dimensions::kOfScatter
                : with_second ? dimensions::kOfSecond
                              : dimensions::own_light(own++);
    asked.first_number = with_scatter || with_second ? 2 : 0;
  }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::start(uint32_t p, const SensorRay& ray,
                                                                const SampleStream& stream, uint32_t sample) {
  Path& path = paths_[p];
  path.stream = stream, path.sample = sample;
  if (draws_) path.draw = static_cast<uint32_t>(hash_of(stream.key(), sample));
  path.origin = ray.ray.origin, path.direction = ray.ray.direction;
  path.time = ray.ray.time;
  path.length = path.arrival = path.last_density = 0;
  path.before = 1;
  path.surfaces = path.scatterings = path.smooth = path.flights = 0, path.events = 0;
  if (refracted_) path.claims.clear();  // else nobody makes or reads claims
  path.branch = Branch::none, path.sided = false;
  path.share = 1;
  if (!branches_.empty()) branches_[p].surfaces = 0;
  path.water = WaterSeen::nothing, path.knot = 0;
  path.relative.start(knots());
  std::fill_n(path.throughput, knots(), 1.0);
  if (knots() > 1) path.knot = Estimator::draw_knot(stream.hashed(sample, dimensions::kKnot), static_cast<int>(knots_));
  PathRecord& record = records_[p];
  record.time = ray.ray.time, record.end = PathEnd::absorbed;
  record.truncated = record.strayed = 0;
  record.scattered_first = record.met = false;
  record.received = ray.receiver != SensorRay::Receiver::none;
  path.received = record.received, path.points_apart = ray.points_apart && !kGuides;
  space_.start(p, path);
  if constexpr (Space::kGoesBack) passed_[p].sum = 0, passed_[p].again = false;
  if (!record.received) return active_.push_back(p);
  receivers_[p] = ray.receiver;
  received_.push_back(p);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::next(TraceRequest& request) {
  for (;;) switch (stage_) {
      case Stage::leave:
        if (active_.empty() && received_.empty() && returned_.empty()) {
          first_stage_ = true;
          return false;
        }
        stage_ = Stage::arrive;
        if (active_.empty()) break;  // all start at receivers or places in the air
        request_hits(request);
        return true;
      case Stage::arrive:
        if constexpr (Space::kFills) fly();
        arrive();
        ask();
        stage_ = Stage::look;
        break;
      case Stage::look:
        if (space_.sight().next(request)) return true;
        answer();
        hand_over();
        stage_ = Stage::go_on;
        if (!begin_sides(request)) break;
        stage_ = Stage::fly_sides;
        return true;
      case Stage::fly_sides:
        fly_sides();
        stage_ = Stage::look_aside;
        break;
      case Stage::look_aside:
        if (space_.sight().next(request)) return true;
        answer_sides();
        hand_over();
        stage_ = Stage::go_on;
        break;
      case Stage::go_on:
        go_on();
        first_stage_ = false;
        stage_ = Stage::leave;
        break;
    }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::request_hits(TraceRequest& request) {
  const size_t n = active_.size();
  for (size_t i = 0; i < n; ++i) {
    const Path& path = paths_[active_[i]];
    rays_[i].set(space_.ray_from(active_[i], path), path.direction, path.time, path.draw);
  }
  request = {TraceRequest::Kind::nearest, {rays_.data(), n}, first_stage_, {hits_.data(), n}, {}, {}};
}

// Flies every path to its next event, then weakens its light. Nothing may change a throughput before the contributions
// that were made with it have been handed over.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::fly() {
  if (first_stage_) space_.begin_wave();
  for (size_t i = 0; i < active_.size(); ++i) fly_one(i);
  hand_over();
  if constexpr (Space::kGoesBack)
    for (size_t i = 0; i < active_.size(); ++i) pass(i);
  for (size_t i = 0; i < active_.size(); ++i)
    if (flights_[i].weakened) throughputs_.attenuate(active_[i], flights_[i].through);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::fly_one(size_t slot) {
  const uint32_t p = active_[slot];
  Path& path = paths_[p];
  Hit& hit = hits_[slot];
  const double length = way_to(hit, path);
  if (!throughputs_.has_room(p, Space::kDense)) throughputs_.make_room(p);
  const std::span<float> through = throughputs_.take(p), emitted = throughputs_.take(p);
  Contribution& c = contribution(p, Space::kEmitter);
  c.water = path.water;
  if constexpr (Space::kGoesBack) passed_[p].before = path;
  const double before = path.length;
  const bool ends = hit.hit() || length < std::numeric_limits<double>::infinity() || meets_outside(path);
  flights_[slot] = space_.fly(p, path, records_[p], hit, rays_[slot], length, ends, through, emitted);
  const Flight& flight = flights_[slot];
  const double flown = path.length - before;
  if (flight.arrival == Arrival::scattered) path.claims.scatter(flown);
  if (flight.arrival == Arrival::onward) path.claims.pass_boundary(flown);
  const bool leaves = flight.arrival == Arrival::met && length == std::numeric_limits<double>::infinity();
  c.radiance = leaves && is_claimed(path, ClaimedLight::sky()) ? nullptr : flight.emitted;
  if (flight.difference) c.light = kFromAir;
  // The sky of the air was asked for, too.
  if (const Light* sky = c.radiance && length == std::numeric_limits<double>::infinity() ? space_.sky() : nullptr)
    if (const double density = space_.sky_density(path.direction);
        density > 0 && options_.explicit_sources && path.last_density > 0)
      c.scale = static_cast<float>(Estimator::by_chance(sky->nature(), path.before * density / path.last_density));
  if (c.radiance) return contribute();
  throughputs_.give_back(p);
  if (!flight.through.spectrum) throughputs_.give_back(p);
}

// Sorts paths by what they have come to.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::arrive() {
  nodes_.clear(), onward_.clear();
  for (uint32_t i = 0; i < active_.size(); ++i) {
    const uint32_t p = active_[i];
    if constexpr (Space::kScatters) {
      const Arrival arrival = flights_[i].arrival;
      if (arrival == Arrival::onward) onward_.push_back(p);
      if (arrival == Arrival::scattered) {
        ++paths_[p].scatterings;
        paths_[p].events |= by_medium;
        nodes_.push_back({p, i, true});
      }
      if (arrival != Arrival::met) continue;
    }
    if (!(hits_[i].hit() ? meet(p, i) : meet_earth(p, i))) continue;
    nodes_.push_back({p, i, false});
    if (refracted_ && !is_interface(nodes_.back())) paths_[p].claims.clear();
  }
  nodes_met_ += nodes_.size();
  for (const uint32_t p : std::exchange(received_, {})) receive(p);
  for (const uint32_t p : returned_) {
    const auto slot = static_cast<uint32_t>(active_.size());
    active_.push_back(p);
    hits_[slot] = {};
    nodes_.push_back({p, slot, true});
  }
  nodes_met_ += returned_.size();
  returned_.clear();
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::is_first_surface(uint32_t p) const {
  if constexpr (Space::kGoesBack)
    if (passed_[p].again) return false;
  return paths_[p].surfaces == paths_[p].received;
}

// A path meets a surface. False when nothing scatters there.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::meet(uint32_t p, uint32_t slot) {
  Path& path = paths_[p];
  Hit& hit = hits_[slot];
  if constexpr (Surfaces::kDense > 0) contacts_.settle({{}, path.direction, path.time, path.draw}, hit, touching_);
  const bool first = is_first_surface(p);
  path.length += hit.distance;
  path.arrival += space_.delay(p) * hit.distance;
  const bool scatters = surfaces_.meet(p, hit, -path.direction, path.time, first);
  enter_node(p, hit, first);
  if (!glowing_.empty()) meet_glow(p, hit);
  emit(p);
  return scatters;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::enter_node(uint32_t p, const Hit& hit, bool first) {
  Path& path = paths_[p];
  ++path.surfaces;
  if (!first || !keep_first_) return;
  records_[p].met = !records_[p].scattered_first;
  firsts_[p] = {hit.object, -path.direction, path.length, false, &surfaces_.interaction(p)};
}

// A path that missed the scene meets the Earth under it, if there is one; false when the path ends.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::meet_earth(uint32_t p, uint32_t slot) {
  Path& path = paths_[p];
  const auto met = environment_.earth
                       ? environment_.earth->meet(path.origin, path.direction, std::numeric_limits<double>::infinity())
                       : std::nullopt;
  if (!met) {
    escape(p, Space::kGoesBack && flights_[slot].difference);
    return false;
  }
  Hit& hit = hits_[slot];
  hit = {};
  hit.distance = met->distance;
  hit.position = met->position;
  hit.normal = met->normal;
  hit.step = Earth::step;
  hit.time = path.time;
  const bool first = is_first_surface(p);
  path.length += hit.distance;
  path.arrival += hit.distance;
  const bool scatters = surfaces_.meet_earth(p, hit, environment_.earth->material(), first);
  enter_node(p, hit, first);
  emit(p);
  return scatters;
}

// The first node of a path that starts at a receiver.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::receive(uint32_t p) {
  if constexpr (requires(Surfaces & s) { s.receive(p, hits_[0], receivers_[p]); }) {
    Path& path = paths_[p];
    const auto slot = static_cast<uint32_t>(active_.size());
    active_.push_back(p);
    Hit& hit = hits_[slot];
    hit = {};
    hit.position = path.origin;
    hit.normal = path.direction;
    hit.time = path.time;
    surfaces_.receive(p, hit, receivers_[p]);
    ++path.surfaces;
    path.direction = -path.direction;  // out, as the receiver sees it, is along its normal
    nodes_.push_back({p, slot, false});
  }
}

// What a path meets outside the scene. in_field: but for beams, which the field of the air has.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::escape(uint32_t p, bool in_field) {
  const Path& path = paths_[p];
  records_[p].end = PathEnd::escaped;
  records_[p].escape = path.direction;
  for (const Asked& light : outside_) {
    if (in_field && light.beam) continue;
    if (is_refracted(light.nature) && is_claimed(path, {ClaimedLight::Kind::small, light.index})) continue;
    const auto met = light.light->met_outside(path.direction, path.time);
    if (!met) continue;
    std::span<float> memory;
    if (!met->spectrum) {  // its shape changes with direction
      memory = dense(p);
      std::fill(memory.begin(), memory.end(), 0.0f);
      path.points_apart&& path.order() == 0 ? light.light->add_without_points(path.direction, path.time, 1, memory)
                                            : light.light->add(path.direction, path.time, 1, memory);
    }
    Contribution& c = contribution(p, light.index);
    c.scale = static_cast<float>(met->scale);
    if (options_.explicit_sources && path.last_density > 0 && met->density > 0)
      c.scale *= static_cast<float>(Estimator::by_chance(light.nature, path.before * met->density / path.last_density));
    c.beam = light.beam;
    c.water = path.water;
    c.radiance = met->spectrum;
    if (!c.radiance) c.radiance = memory.data();
    if (c.scale != 0) contribute();
  }
}

// A surface met by chance may shine; what an explicit sample of it brings is shared with it.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::meet_glow(uint32_t p, const Hit& hit) {
  const Path& path = paths_[p];
  const LastAsked& last = last_[p];
  const bool shared = path.order() > 1 && options_.explicit_sources && path.last_density > 0;
  double distance = hit.distance;
  if (Space::kScatters && shared)  // boundaries of media may have been passed on the way
    distance = surface_.tracer().periodic() ? path.length - last.length : length(hit.position - last.at.position);
  const double cosine = -dot(path.direction, hit.normal);
  for (const Asked& light : glowing_) {
    if (light.nature.placed && is_claimed(path, {ClaimedLight::Kind::small, light.index}) && light.light->draws(hit))
      continue;
    const auto met =
        light.light->met_surface(last.at, hit, surfaces_.material(p), path.direction, distance, cosine, path.time);
    if (!met) continue;
    Contribution& c = contribution(p, light.index);
    c.order -= 1;  // not scattered by what shines
    c.scale = static_cast<float>(met->scale);
    if (shared && met->density > 0)
      c.scale *= static_cast<float>(
          Estimator::by_chance(light.nature, path.before * last.draws * met->density / path.last_density));
    c.radiance = met->spectrum;
    if (c.scale != 0) contribute();
  }
}

// Warm surfaces.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::emit(uint32_t p) {
  if constexpr (Surfaces::kDense > 0) {
    if (!surfaces_.warm(p)) return;
    const std::span<float> memory = dense(p);
    const auto emission = surfaces_.emission(p, -paths_[p].direction, memory);
    space_.emit_within(p, memory);
    Contribution& c = contribution(p, kFromMatter);
    c.order -= 1;  // not scattered by what emits
    c.factor = emission.emissivity;
    c.radiance = emission.radiance;
    if constexpr (kStokes) c.polarised = polarise_emission(p);
    contribute();
    if constexpr (kStokes) hand_over();
  }
}

}  // namespace suite
