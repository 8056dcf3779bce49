// Definitions of kernel.h: splitting with a light-directed scattering vertex, in media that scatter forwards.
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

#include "transport/kernel.h"

namespace suite {

// The sun, else another light that the air is given beams of.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::choose_side_light() {
  if constexpr (kGuides) {
    if (refracted_ || lost_ || !options_.side_flights) return;
    for (const Asked& light : asked_) {
      if (!light.beam || !Estimator::parallel(light.nature)) continue;
      if (!side_light_ || light.index == environment_.sun) side_light_ = &light;
    }
    if (!side_light_) return;
    side_toward_ = side_light_->light->beam()->direction;
    sides_.resize(paths_.size()), side_rays_.resize(paths_.size()), side_hits_.resize(paths_.size());
    side_spectra_.resize(paths_.size() * bins_);
  }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::has_side(const NodeAt& node) const {
  if constexpr (kGuides)
    return side_light_ && node.event &&
           (options_.max_scatterings == 0 || paths_[node.path].scatterings < options_.max_scatterings) &&
           space_.asymmetry(node.path) > kForwards;
  return false;
}

// Tells a continuation of the other way to where it leads. True.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::share_with_side(const NodeAt& node, Continuation& on) const {
  if constexpr (kGuides) {
    on.sided = has_side(node);
    if (on.sided) space_.densities(node.path, -side_toward_, on.in, {on.other, knots()});
  }
  return true;
}

// The share of what has come one of two ways that is left to this one.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::alone(const Path& path) const {
  return 1 / path.other.mean_with(P(), 1);
}

// What a path's light would come to towards a direction, over even scattering of all of it.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::brings(const NodeAt& node, Dir in) const {
  if constexpr (kGuides) {
    const Path& path = paths_[node.path];
    float p[kMaxKnots];
    space_.densities(node.path, -path.direction, in, {p, knots()});
    return 4 * kPi * *std::max_element(path.throughput, path.throughput + knots()) * path.relative.mean(P(), p);
  }
  return 0;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::asks(const NodeAt& node, const Asked& light) const {
  const Path& path = paths_[node.path];
  if (!kGuides || !node.event || !path.sided || &light != side_light_) return 1;
  const double asks = std::clamp(brings(node, side_toward_) * alone(path) / kSideCarries, kSideLeast, 1.0);
  if (asks == 1) return 1;
  return path.stream.hashed(path.sample, dimensions::roulette_of_light(path.order() - 1)) < asks ? asks : 0;
}

// Draws side flights of the stage; false when there are none.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::begin_sides(TraceRequest& request) {
  side_count_ = 0;
  if constexpr (kGuides) {
    if (!side_light_) return false;
    for (const NodeAt& node : nodes_) {
      Side& side = sides_[side_count_];
      if (!has_side(node) || !begin_side(node, side, side_spectrum(side_count_))) continue;
      side_rays_[side_count_++].set(side.path.origin, side.path.direction, side.path.time, side.path.draw);
    }
  }
  request = {
      TraceRequest::Kind::nearest, {side_rays_.data(), side_count_}, false, {side_hits_.data(), side_count_}, {}, {}};
  return side_count_ > 0;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::begin_side(const NodeAt& node, Side& side,
                                                                     std::span<float> spectrum) {
  if constexpr (kGuides) {
    const Path& from = paths_[node.path];
    // Half way between both directions a phase function that falls with the angle brings most: a bound known
    // beforehand.
    const Vec3 half = from.direction + side_toward_;
    const double length2 = dot(half, half);
    const double most = length2 > 1e-6 ? brings(node, half / std::sqrt(length2)) / 2 : 0;
    const double tried = std::clamp(most / kSideCarries, kSideLeast, 1.0);
    if (from.stream.hashed(from.sample, dimensions::roulette_of_side(from.order() - 1)) >= tried) return false;
    const std::array<double, 4> u = dimensions::of_side(from.stream, from.sample, from.flights, 0);
    Path& path = side.path;
    path = from;
    if (!space_.scatter(node.path, -side_toward_, from.knot, {u[0], u[1]}, u[2], path.direction)) return false;
    float p[kMaxKnots], g[kMaxKnots];
    space_.densities(node.path, -from.direction, path.direction, {p, knots()});
    space_.densities(node.path, -side_toward_, path.direction, {g, knots()});
    const double own = g[from.knot];
    if (!(own > 0)) return false;
    path.relative.set(knots(), from.relative, g, own), path.other.set(knots(), from.relative, p, own);
    const double shares = path.relative.mean(P()), others = path.other.mean(P()),
                 brightest = std::max(0.0, *std::max_element(from.throughput, from.throughput + knots()));
    const double brings = 4 * kPi * brightest * own * shares * others / (shares + others);
    const double survives = std::min(tried, std::clamp(brings / kSideCarries, kSideLeast, 1.0));
    if (!(brings > 0) || u[3] * tried >= survives) return false;
    path.relative.divide(knots(), shares), path.other.divide(knots(), shares);
    path.origin = space_.place(node.path);
    path.branch = Branch::none, path.sided = true;
    side.node = static_cast<uint32_t>(&node - nodes_.data());
    const Factor w = space_.evaluate(node.path, scattering_cosine(-from.direction, path.direction), spectrum);
    if (w.spectrum != spectrum.data()) std::copy_n(w.spectrum, bins_, spectrum.data());
    side.scale = double{w.scale} / (own * shares * survives);
    return true;
  }
  return false;
}

// Flies them, and asks for the light where they are scattered.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::fly_sides() {
  if constexpr (kGuides) {
    sight_rays_.clear(), space_.clear_sight();
    sight_rays_.first = false;
    sight_rays_.expect(side_count_);
    size_t n = 0;
    for (size_t i = 0; i < side_count_; ++i) {
      const std::span<float> spectrum = side_spectrum(i);
      sides_[i].hit = static_cast<uint32_t>(i);
      if (!fly_side(sides_[i], spectrum)) continue;
      const uint32_t p = nodes_[sides_[i].node].path;
      space_.see_from_side(p, side_hits_[i]);
      const Path& path = sides_[i].path;
      sight_rays_.add(std::numeric_limits<double>::infinity(), false)
          .set(space_.place(space_.side(p)), sides_[i].sample.direction, path.time, path.draw);
      if (n < i) sides_[n] = sides_[i], std::copy_n(spectrum.data(), bins_, &side_spectra_[n * bins_]);
      ++n;
    }
    side_count_ = n;
    sight_rays_.parallel = n;
    nodes_met_ += n;
    space_.sight().begin(sight_rays_);
  }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::fly_side(Side& side, std::span<float> spectrum) {
  if constexpr (kGuides) {
    Path& path = side.path;
    const uint32_t p = nodes_[side.node].path;
    const std::array<double, 4> u = dimensions::of_side(path.stream, path.sample, path.flights, 1);
    const Hit& hit = side_hits_[side.hit];
    const std::span<float> through = transmission_;
    if (!space_.fly_aside(p, path, hit, way_to(hit, path), {u[0], 0}, side.flight, through)) return false;
    side.scale *= double{side.flight.through.scale};
    if (side.flight.through.spectrum)
      for (size_t i = 0; i < bins_; ++i) spectrum[i] *= through[i];
    const auto sample =
        side_light_->only ? side_light_->only : side_light_->light->sample({}, {u[2], u[3], 0, 0}, path.time);
    if (!sample || !(sample->scale > 0)) return false;
    side.sample = *sample;
    return true;
  }
  return false;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::answer_sides() {
  const std::span<const uint8_t> blocked = sight_rays_.blocked();
  for (size_t i = 0; i < side_count_; ++i)
    if (!blocked[i] && !is_behind_earth(sight_rays_.rays()[i], sight_rays_.distance()[i]))
      shine_aside(sides_[i], i, side_spectrum(i));
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_aside(const Side& side, size_t i,
                                                                      std::span<float> spectrum) {
  if constexpr (kGuides) {
    const uint32_t p = nodes_[side.node].path, event = space_.side(p);
    const Path& path = side.path;
    const LightSample& sample = side.sample;
    double reach[kMaxKnots];
    std::fill_n(reach, knots(), 1.0);
    const bool dim = space_.dims(sight_rays_.rays()[i], sight_rays_.distance()[i], i, transmission_, {reach, knots()});
    for (size_t k = 0; dim && k < bins_; ++k) spectrum[k] *= transmission_[k];
    double denominator = 1;
    if (sample.density > 0) {
      // As for the path's own way, which shares with what meets the light by chance.
      float density[kMaxKnots];
      space_.densities(event, -path.direction, sample.direction, {density, knots()});
      const double others = path.other.mean(P()), by_chance = path.other.mean(P(), density, {reach, knots()});
      denominator = Estimator::asked(sample.density, others > 0 ? by_chance / others : 0, side_light_->nature.disk);
    }
    const std::span<float> memory = dense(p, 2);
    const Factor w = space_.evaluate(event, scattering_cosine(-path.direction, sample.direction), memory);
    for (size_t k = 0; k < bins_; ++k) memory[k] = (w.spectrum ? w.spectrum[k] : 1.0f) * spectrum[k];
    const float* radiance = sample.spectrum;
    if (!radiance) {
      const std::span<float> own = dense(p);
      std::fill(own.begin(), own.end(), 0.0f);
      side_light_->light->add(sample.direction, path.time, 1, own);
      radiance = own.data();
    }
    Contribution& c = contribution(p, side_light_->index);
    c.events |= by_medium;
    c.order += 1;
    c.asked = true, c.beam = side_light_->beam;
    if (waters_.any()) c.water = Waters::behind_scattering(Waters::behind_scattering(paths_[p].water));
    c.scale = static_cast<float>(side.scale * w.scale * sample.scale / denominator * alone(path));
    c.factor = {1, memory.data()};
    c.radiance = radiance;
    c.arrival += space_.optical_way(p, i, side.flight.length);
    if constexpr (kStokes) c.polarised = polarise_aside(side);
    contribute();
    if constexpr (kStokes) hand_over();
  }
}

}  // namespace suite
