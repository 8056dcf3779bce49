#include "transport/media/media_sight.h"

#include <algorithm>
#include <numeric>

namespace suite {

namespace {
constexpr int kMostBoundaries = 1 << 20;  // on one way to a source; then it counts as blocked
}  // namespace

MediaSight::MediaSight(const Surface& surface, Bodies& bodies, Flights& flights, size_t media, LostLight* lost)
    : surface_(surface),
      body_rules_(bodies),
      flights_(flights),
      media_(media),
      lost_(lost),
      ambient_(surface.tracer().scene().ambient) {}

void MediaSight::begin(SightRays& rays) {
  asked_ = &rays;
  round_ = 0;
  depths_.assign(rays.size() * media_, 0.0);
  bent_.assign(rays.size(), 0);
  passes_.assign(rays.size(), 1);
  start_.clear();
  for (size_t i = 0; i < rays.size(); ++i) start_.push_back(bodies_at_[i].medium(ambient_));
  rays_.clear();
  if (!body_rules_.any_boundary() && !lost_) return;
  rays_.assign(rays.rays().begin(), rays.rays().end());
  travelled_.assign(rays.size(), 0);
  gap_.assign(rays.size(), 0);
  owner_.resize(rays.size());
  std::iota(owner_.begin(), owner_.end(), 0u);
  std::fill(rays.blocked().begin(), rays.blocked().end(), uint8_t{0});
}

bool MediaSight::next(TraceRequest& request) {
  if (asked_->size() == 0) return false;
  const bool straight = !body_rules_.any_boundary() && !lost_;
  if (straight) {
    if (round_++ > 0) return add_depths(), false;
    request = {TraceRequest::Kind::occluded, asked_->rays(), false, {}, asked_->distance(), asked_->blocked()};
    return true;
  }
  if (round_++ > 0) take();
  if (rays_.empty()) return false;
  hits_.resize(rays_.size());
  request = {TraceRequest::Kind::nearest, rays_, false, hits_, {}, {}};
  return true;
}

void MediaSight::count(size_t ray, const Ray& from, double way) {
  flights_.add_depths(from, way, bodies_at_[ray].medium(ambient_), {&depths_[ray * media_], media_});
}

// Where nothing but surfaces stops light.
void MediaSight::add_depths() {
  for (size_t i = 0; i < asked_->size(); ++i) {
    if (asked_->blocked()[i]) continue;
    if (asked_->distance()[i] == std::numeric_limits<double>::infinity()) body_rules_.leave_scene(bodies_at_[i]);
    count(i, asked_->rays()[i], asked_->distance()[i]);
  }
}

// Takes the rays through what they have met.
void MediaSight::take() {
  size_t kept = 0;
  for (size_t i = 0; i < rays_.size(); ++i) {
    if (!pass(i)) continue;
    rays_[kept] = rays_[i];
    owner_[kept++] = owner_[i];
  }
  rays_.resize(kept);
  owner_.resize(kept);
}

// One ray; false when its way is known.
bool MediaSight::pass(size_t i) {
  const uint32_t r = owner_[i];
  Hit& hit = hits_[i];
  if (gap_[r] > 0) body_rules_.settle(hit, rays_[i], gap_[r]);
  const double left = asked_->distance()[r] - travelled_[r];
  const bool met = hit.hit() && hit.distance < left;
  if (met && round_ > kMostBoundaries) asked_->blocked()[r] = 1, passes_[r] = 0;
  const bool stopped = met && !body_rules_.is_boundary(surface_.material(hit));
  if (!(passes_[r] > 0) || (stopped && !bends(r, hit, rays_[i]))) return false;
  if (!hit.hit()) body_rules_.leave_scene(bodies_at_[r]);
  const double way = met ? hit.distance : left;
  Ray& ray = rays_[i];
  ray.origin -= ray.direction * gap_[r];
  count(r, ray, way);
  if (!met) return false;
  if (stopped) return go_behind(i, hit);
  const auto onward = body_rules_.pass(bodies_at_[r], hit, ray, way - gap_[r], statistics_);
  if (!onward) return hit.distance < left && bends(r, hit, ray) && go_behind(i, hit);
  travelled_[r] += way;
  gap_[r] = onward->gap;
  ray.origin = onward->start;
  return true;
}

// Whether what stops a ray, no boundary, passes light that can be lost there.
bool MediaSight::bends(uint32_t r, const Hit& hit, const Ray& from) {
  asked_->blocked()[r] = bent_[r] = 1;
  passes_[r] *= lost_ && asked_->losable()[r] ? lost_->through(hit, from) : 0;
  return passes_[r] > 0;
}

// Follows such light straight on. True.
bool MediaSight::go_behind(size_t i, const Hit& hit) {
  const uint32_t r = owner_[i];
  Ray& ray = rays_[i];
  body_rules_.transmit(bodies_at_[r], hit, surface_.material(hit), ray.direction, statistics_);
  travelled_[r] += hit.distance;
  gap_[r] = 0;
  ray.origin = surface_.tracer().leave(hit, ray.direction);
  return true;
}

}  // namespace suite
