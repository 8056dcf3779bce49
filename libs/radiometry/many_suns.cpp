#include "radiometry/many_suns.h"

#include <algorithm>
#include <limits>

namespace suite {

bool ManySuns::add(Wave& wave, size_t p, std::span<const Dir> suns, const BandProjection& projection, bool single,
                   std::span<double> sums, TraceStatistics& statistics) {
  const Path& path = wave.path(p);
  const size_t bins = wave.bins(), bands = projection.bands();
  weight_.assign(bins, static_cast<float>(path.weight));
  radiance_.assign(suns.size() * bins, 0.0f);
  const std::span<float> w = wave.scratch();
  for (int n = 0; n < path.size; ++n) {
    const Node& node = wave.node(p, n);
    if (!node.at.baked || !node.at.baked->model) break;
    const ScatterModel& model = *node.at.baked->model;
    // Which suns can light the node towards the path, and which of them do.
    rays_.clear(), sun_.clear();
    for (size_t i = 0; i < suns.size(); ++i) {
      const double in_side = dot(suns[i], node.at.geometric_normal);
      if (model.opaque() && in_side * dot(node.out, node.at.geometric_normal) <= 0) continue;
      if (in_side * dot(suns[i], node.at.frame.z) <= 0) continue;
      rays_.push_back({surface_.tracer().leave(node.hit, suns[i]), suns[i], path.ray.time, path.ray.draw});
      sun_.push_back(i);
    }
    distance_.assign(rays_.size(), std::numeric_limits<double>::infinity());
    blocked_.resize(rays_.size());
    surface_.tracer().occluded(rays_, distance_, blocked_, true, statistics);
    const Dir out = node.at.frame.to_local(node.out);
    for (size_t k = 0; k < rays_.size(); ++k) {
      if (blocked_[k]) continue;
      model.eval(out, node.at.frame.to_local(suns[sun_[k]]), w);
      float* const L = &radiance_[sun_[k] * bins];
      const float factor = static_cast<float>(node.spectral_factor);
      for (size_t b = 0; b < bins; ++b) L[b] += factor * weight_[b] * w[b];
    }
    if (n == 0 && single) single_ = radiance_;
    if (!node.continues) break;
    for (size_t b = 0; b < bins; ++b) weight_[b] *= node.bounce_scale * node.bounce_spectrum[b];
  }
  for (const float L : radiance_)
    if (!(L >= 0 && L < 3e38f)) return false;
  if (path.size == 0) return true;
  for (size_t i = 0; i < suns.size(); ++i) {
    projection.add({&radiance_[i * bins], bins}, sums.subspan(i * bands, bands));
    if (single) projection.add({&single_[i * bins], bins}, sums.subspan((suns.size() + i) * bands, bands));
  }
  return true;
}

}  // namespace suite
