#include "radiometry/many_suns.h"

#include <algorithm>
#include <limits>

namespace suite {

// Which suns can light the node towards the path, and which of them do; or whose light is lost on its way.
void ManySuns::look(const Node& node, std::span<const Dir> suns, const Ray& ray, bool lost,
                    TraceStatistics& statistics) {
  rays_.clear(), sun_.clear();
  for (size_t i = 0; i < suns.size(); ++i) {
    const double in_side = dot(suns[i], node.at.geometric_normal);
    if (node.at.baked->model->opaque() && in_side * dot(node.out, node.at.geometric_normal) <= 0) continue;
    if (in_side * dot(suns[i], node.at.frame.z) <= 0) continue;
    rays_.push_back({surface_.tracer().leave(node.hit, suns[i]), suns[i], ray.time, ray.draw});
    sun_.push_back(i);
  }
  distance_.assign(rays_.size(), std::numeric_limits<double>::infinity());
  blocked_.resize(rays_.size());
  surface_.tracer().occluded(rays_, distance_, blocked_, true, statistics);
  if (!lost) return;
  lost_->begin(rays_.size());
  for (size_t k = 0; k < rays_.size(); ++k)
    if (blocked_[k]) lost_->want(k);
  lost_->look(rays_, distance_, statistics);
}

bool ManySuns::Radiance::good() const {
  return std::all_of(all.begin(), all.end(), [](float L) { return L >= 0 && L < 3e38f; });
}

void ManySuns::Radiance::project(const BandProjection& projection, size_t bins, bool single,
                                 std::span<double> sums) const {
  const size_t bands = projection.bands(), suns = all.size() / bins;
  for (size_t i = 0; i < suns; ++i) {
    projection.add({&all[i * bins], bins}, sums.subspan(i * bands, bands));
    if (single) projection.add({&once[i * bins], bins}, sums.subspan((suns + i) * bands, bands));
  }
}

bool ManySuns::add(Wave& wave, size_t p, std::span<const Dir> suns, const BandProjection& projection, bool single,
                   std::span<double> sums, std::span<double> missing, TraceStatistics& statistics) {
  Path& path = wave.path(p);
  const size_t bins = wave.bins();
  const bool lost = lost_ && !missing.empty();
  weight_.assign(bins, static_cast<float>(path.weight));
  seen_.all.assign(suns.size() * bins, 0.0f);
  if (lost) missed_.all.assign(suns.size() * bins, 0.0f);
  const std::span<float> w = wave.scratch();
  for (int n = 0; n < path.size; ++n) {
    const Node& node = wave.node(p, n);
    if (!node.at.baked || !node.at.baked->model) break;
    look(node, suns, path.ray, lost, statistics);
    const Dir out = node.at.frame.to_local(node.out);
    for (size_t k = 0; k < rays_.size(); ++k) {
      const double passes = !blocked_[k] ? 1 : lost ? lost_->passes(k) : 0;
      if (passes == 0) continue;
      node.at.baked->model->eval(out, node.at.frame.to_local(suns[sun_[k]]), w);
      float* const L = &(blocked_[k] ? missed_ : seen_).all[sun_[k] * bins];
      const float factor = static_cast<float>(node.spectral_factor * passes);
      for (size_t b = 0; b < bins; ++b) L[b] += factor * weight_[b] * w[b];
      if (blocked_[k] && L[0] > 0) path.missed_chance = 0;
    }
    if (n == 0 && single) seen_.once = seen_.all, missed_.once = missed_.all;
    if (!node.continues) break;
    for (size_t b = 0; b < bins; ++b) weight_[b] *= node.bounce_scale * node.bounce_spectrum[b];
  }
  if (!seen_.good()) return false;
  if (path.size == 0) return true;
  seen_.project(projection, bins, single, sums);
  if (path.missed() && missed_.good()) missed_.project(projection, bins, single, missing);
  return true;
}

}  // namespace suite
