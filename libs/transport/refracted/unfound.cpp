#include "transport/refracted/unfound.h"

#include <utility>

#include "base/error.h"
#include "transport/parallel_faces.h"

namespace suite {

namespace {
constexpr size_t kMostFaces = 4096;  // across a straight ray
}  // namespace

void UnfoundLight::want(size_t number, const Ray& ray, double distance) {
  Line& line = lines_.emplace_back(number, ray, distance);
  line.leg.begin(ray.origin, ray.direction, ray.time, ray.draw);
}

bool UnfoundLight::next(RefractedSight& sight, TraceRequest& request) {
  const bool first = !std::exchange(begun_, true);
  size_t kept = 0;
  if (first) waiting_.resize(lines_.size());
  for (uint32_t j = 0; j < waiting_.size(); ++j) {
    const uint32_t i = first ? j : waiting_[j];
    if (!first && !advance(sight, lines_[i], hits_[j])) continue;
    waiting_[kept++] = i;
  }
  waiting_.resize(kept), rays_.resize(kept), hits_.resize(kept);
  for (size_t j = 0; j < kept; ++j) rays_[j] = lines_[waiting_[j]].leg.ray;
  request = {TraceRequest::Kind::nearest, rays_, false, hits_, {}, {}};
  return kept > 0;
}

// Takes a ray through what it has met; false when its way is known.
bool UnfoundLight::advance(RefractedSight& sight, Line& line, Hit& hit) {
  if (!sight.ends(line.leg, hit, nullptr)) return true;
  if (!hit.hit() || !(hit.distance < line.left) || line.reflected.size() == kMostFaces) return false;
  line.stopped = !sight.interfaces().has(sight.material(hit));
  if (line.stopped) return false;
  line.reflected.push_back(sight.reflectance(hit, line.from));
  line.left -= hit.distance;
  line.leg.begin(sight.leave(hit, line.from.direction), line.from.direction, line.from.time, line.from.draw);
  return true;
}

std::optional<double> UnfoundLight::share(size_t number) {
  while (read_ < lines_.size() && lines_[read_].number < number) ++read_;
  SUITE_CHECK(read_ < lines_.size() && lines_[read_].number == number);
  const Line& line = lines_[read_];
  if (line.stopped) return std::nullopt;
  if (line.reflected.size() < 2) return 0;
  const double lost = passed(line.reflected) - passed_within(line.reflected, RefractedWay::kMostEvents);
  return lost > kNothing ? lost : 0;
}

}  // namespace suite
