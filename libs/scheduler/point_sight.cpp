#include "scheduler/point_sight.h"

#include <algorithm>
#include <limits>

namespace suite {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kEarth = 6371e3;  // m
constexpr int kMostFaces = 12;
constexpr float kPointSightLeast = 1e-6f;  // of a point's light
constexpr int kLobes = 64;                 // draws that find the lobes of a model

struct Lobe {
  int number;
  Dir in;  // local
};
std::vector<Lobe> lobes_of(const ScatterModel& model, Dir out, int knot) {
  std::vector<Lobe> found;
  for (int i = 0; i < kLobes; ++i) {
    const auto s = model.sample(out, {0.5, 0.5}, (i + 0.5) / kLobes, knot);
    if (!s || !s->delta) continue;
    if (std::none_of(found.begin(), found.end(), [&](const Lobe& l) { return l.number == s->lobe; }))
      found.push_back({s->lobe, s->in});
  }
  return found;
}

}  // namespace

PointSight::PointSight(const Primed& primed)
    : primed_(primed), knot_of_bin_(primed.state().knot_of_bin()), air_(primed.state().size()) {}

std::span<const Dir> PointSight::mirrors() const {
  const FlatMirrors* const mirrors = primed_.pipeline.mirrors();
  return mirrors ? std::span<const Dir>(mirrors->normals()) : std::span<const Dir>();
}

bool PointSight::leaves(const Line& line) const {
  if (const auto& earth = primed_.kit.environment->earth) return !earth->meet(line.origin, line.direction, kFar);
  if (line.direction.z >= 0) return true;
  const Vec3 from = line.origin + Vec3{0, 0, kEarth};
  const double along = dot(from, line.direction);
  return !(along < 0 && dot(from, from) - along * along < kEarth * kEarth);
}

void PointSight::through_air(const Line& line, double distance, std::vector<float>& weight) {
  const auto& air = primed_.kit.environment->atmosphere;
  if (!air || line.within) return;
  std::fill(air_.begin(), air_.end(), 1.0f);
  air->transmittance(line.origin, line.direction, distance, air_);
  for (size_t k = 0; k < weight.size(); ++k) weight[k] *= air_[k];
}

std::span<const double> PointSight::look(const Sightline& sight) {
  sight_ = sight;
  arrived_.assign(knot_of_bin_.size(), 0.0);
  Line line{sight.origin, sight.direction, 0, false, false, std::vector<float>(knot_of_bin_.size(), 1.0f)};
  if (primed_.pipeline.mirrors()) {
    // Wavelengths part at interfaces: each bin goes as its knot does.
    for (int k = 0; k < static_cast<int>(primed_.state().knots.size()); ++k) follow(line, k);
    return arrived_;
  }
  if (!leaves(line)) return arrived_;
  Ray ray{sight.origin, sight.direction, sight.time};
  uint8_t blocked = 0;
  TraceStatistics statistics;
  primed_.tracer->occluded({&ray, 1}, {&kFar, 1}, {&blocked, 1}, false, statistics);
  if (blocked) return arrived_;
  through_air(line, kFar, line.weight);
  for (size_t k = 0; k < arrived_.size(); ++k) arrived_[k] = double{line.weight[k]};
  return arrived_;
}

void PointSight::follow(const Line& line, int knot) {
  const Ray ray{line.origin, line.direction, sight_.time};
  Hit hit;
  TraceStatistics statistics;
  primed_.tracer->nearest({&ray, 1}, {&hit, 1}, false, statistics);
  if (hit.hit()) return split(line, hit, knot);
  if (line.mirrored != sight_.mirrored) return;
  const Vec3 off = line.direction - sight_.to;
  if (dot(off, off) > FlatMirrors::kAlong * FlatMirrors::kAlong || !leaves(line)) return;
  std::vector<float> weight = line.weight;
  through_air(line, kFar, weight);
  for (size_t k = 0; k < weight.size(); ++k)
    if (knot_of_bin_[k] == knot) arrived_[k] += double{weight[k]};
}

void PointSight::split(const Line& line, const Hit& hit, int knot) {
  if (line.faces == kMostFaces) return;
  Interaction at;
  primed_.surface.interact(hit, -line.direction, at, sight_.time);
  if (!at.baked || !at.baked->model || !at.baked->model->has_delta()) return;
  const ScatterModel& model = *at.baked->model;
  const Dir out = at.frame.to_local(-line.direction);
  for (const Lobe& lobe : lobes_of(model, out, knot)) {
    const Dir in = at.frame.to_world(lobe.in);
    const bool passes = dot(in, hit.normal) * dot(line.direction, hit.normal) > 0;
    if (!passes && (line.mirrored || !primed_.pipeline.mirrors()->has(hit))) continue;
    Line on{primed_.tracer->leave(hit, in), in, line.faces + 1, line.mirrored || !passes, line.within, {}};
    if (passes) on.within = dot(in, hit.normal) < 0;
    on.weight.resize(line.weight.size());
    model.delta_weight(out, lobe.number, knot, on.weight);
    for (size_t k = 0; k < on.weight.size(); ++k) on.weight[k] *= line.weight[k];
    through_air(line, hit.distance, on.weight);
    if (*std::max_element(on.weight.begin(), on.weight.end()) > kPointSightLeast) follow(on, knot);
  }
}

}  // namespace suite
