#include "radiometry/volume_light.h"

#include <algorithm>

namespace suite {

namespace {
constexpr int kMostBoundaries = 1 << 20;  // on one way to a source; then it counts as blocked
}  // namespace

VolumeLight::VolumeLight(const Surface& surface, Bodies& bodies, Flights& flights, size_t media, LostLight* lost)
    : surface_(surface),
      body_rules_(bodies),
      flights_(flights),
      media_(media),
      lost_(lost),
      ambient_(surface.tracer().scene().ambient) {}

void VolumeLight::look(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked,
                       TraceStatistics& statistics) {
  depths_.assign(rays.size() * media_, 0.0);
  if (body_rules_.any_boundary() || lost_) return look_past_boundaries(rays, distance, blocked, statistics);
  surface_.tracer().occluded(rays, distance, blocked, false, statistics);
  for (size_t i = 0; i < rays.size(); ++i) {
    if (blocked[i]) continue;
    if (distance[i] == std::numeric_limits<double>::infinity()) body_rules_.leave_scene(bodies_at_[i]);
    flights_.add_depths(rays[i], distance[i], bodies_at_[i].medium(ambient_), {&depths_[i * media_], media_});
  }
}

void VolumeLight::look_past_boundaries(std::span<const Ray> rays, std::span<const double> distance,
                                       std::span<uint8_t> blocked, TraceStatistics& statistics) {
  rays_.assign(rays.begin(), rays.end());
  travelled_.assign(rays.size(), 0);
  gap_.assign(rays.size(), 0);
  owner_.resize(rays.size());
  for (size_t i = 0; i < owner_.size(); ++i) owner_[i] = static_cast<uint32_t>(i);
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  passes_.assign(rays.size(), 1);
  bent_.assign(rays.size(), 0);
  for (int round = 0; !rays_.empty(); ++round) {
    hits_.resize(rays_.size());
    surface_.tracer().nearest(rays_, hits_, false, statistics);
    size_t kept = 0;
    for (size_t i = 0; i < rays_.size(); ++i) {
      const uint32_t r = owner_[i];
      Hit& hit = hits_[i];
      if (gap_[r] > 0) body_rules_.settle(hit, rays_[i], gap_[r]);
      const double left = distance[r] - travelled_[r];
      const bool met = hit.hit() && hit.distance < left;
      const uint32_t material = met ? surface_.material(hit) : kNone;
      if (met && !body_rules_.is_boundary(material)) {
        blocked[r] = bent_[r] = 1;
        passes_[r] *= lost_ ? lost_->through(hit, rays_[i]) : 0;
      }
      if (met && round >= kMostBoundaries) blocked[r] = 1, passes_[r] = 0;
      if (!(passes_[r] > 0)) continue;
      if (!hit.hit()) body_rules_.leave_scene(bodies_at_[r]);
      const double way = met ? hit.distance : left;
      Ray ray = rays_[i];
      ray.origin -= ray.direction * gap_[r];
      flights_.add_depths(ray, way, bodies_at_[r].medium(ambient_), {&depths_[r * media_], media_});
      if (!met) continue;
      const auto onward = body_rules_.pass(bodies_at_[r], hit, ray, way - gap_[r], statistics);
      if (!onward && hit.distance < left) {
        blocked[r] = 1;
        continue;
      }
      if (!onward) continue;
      travelled_[r] += way;
      gap_[r] = onward->gap;
      ray.origin = onward->start;
      rays_[kept] = ray;
      owner_[kept++] = r;
    }
    rays_.resize(kept);
    owner_.resize(kept);
  }
}

}  // namespace suite
