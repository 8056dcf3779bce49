#include "radiometry/path_processor.h"

#include <algorithm>

namespace suite {

namespace {

// Radiance from outside the scene, where the path left it.
void from_outside(const Path& path, const Environment& environment, std::span<float> radiance) {
  std::fill(radiance.begin(), radiance.end(), 0.0f);
  if (path.end != PathEnd::escaped) return;
  if (environment.sky) {
    const float scale = static_cast<float>(environment.sky->relative(path.escape) * path.sky_factor);
    const float* spectrum = environment.sky->spectrum();
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += spectrum[i] * scale;
  }
  if (path.sun_factor > 0) {
    const float scale = static_cast<float>(path.sun_factor);
    const float* spectrum = environment.sun->spectrum();
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += spectrum[i] * scale;
  }
}

// Thermal emission of a node: (1 - W) B(T), Kirchhoff's law for this side and direction.
void add_emission(const Node& node, std::span<float> scratch, std::span<float> radiance) {
  node.at.baked->model->total(node.at.frame.to_local(node.out), scratch);
  const float factor = static_cast<float>(node.spectral_factor);
  const float* blackbody = node.at.baked->blackbody.data();
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += factor * std::max(0.0f, 1 - scratch[i]) * blackbody[i];
}

// L = S + w / p L for what factors: one pass over the wavelengths in the usual case of one source. Without `continues`
// the continuation is left out.
void propagate(const Node& node, bool continues, size_t n, float* __restrict L) {
  const ExplicitLight& sun = node.light[0];
  if (continues) {
    const float* __restrict w = node.bounce_spectrum;
    const float b = node.bounce_scale;
    if (sun.scatter == w) {
      const float* __restrict e = sun.spectrum;
      const float s = sun.scale;
      for (size_t i = 0; i < n; ++i) L[i] = w[i] * (b * L[i] + s * e[i]);
    } else {
      for (size_t i = 0; i < n; ++i) L[i] *= b * w[i];
    }
  } else {
    std::fill_n(L, n, 0.0f);
  }
  for (const ExplicitLight& light : node.light) {
    if (!light.scatter || (&light == &sun && continues && sun.scatter == node.bounce_spectrum)) continue;
    const float *__restrict e = light.spectrum, *__restrict w = light.scatter;
    const float s = light.scale;
    for (size_t i = 0; i < n; ++i) L[i] += s * e[i] * w[i];
  }
}

void add_node(Wave& wave, size_t p, int n, bool continues, std::span<float> radiance) {
  const Node& node = wave.node(p, n);
  propagate(node, continues, radiance.size(), radiance.data());
  if (node.has_direct) {
    const float* direct = wave.direct(p, n).data();
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += direct[i];
  }
  if (node.at.baked && !node.at.baked->blackbody.empty()) add_emission(node, wave.scratch(), radiance);
}

// L = gathered + through L of a segment.
void add_segment(Wave& wave, size_t p, int n, std::span<float> radiance) {
  const std::span<float> through = wave.through(p, n), gathered = wave.gathered(p, n);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = gathered[i] + through[i] * radiance[i];
}

}  // namespace

void process_path(Wave& wave, size_t p, const Environment& environment, std::span<float> radiance) {
  const Path& path = wave.path(p);
  from_outside(path, environment, radiance);
  const bool media = wave.has_media();
  // A path that did not go on from its last node has no segment behind it.
  if (media && (path.size == 0 || wave.node(p, path.size - 1).continues)) add_segment(wave, p, path.size, radiance);
  for (int n = path.size - 1; n >= 0; --n) {
    add_node(wave, p, n, wave.node(p, n).continues, radiance);
    if (media) add_segment(wave, p, n, radiance);
  }
  if (path.weight != 1)
    for (float& x : radiance) x *= static_cast<float>(path.weight);
}

void process_single(Wave& wave, size_t p, std::span<const float> radiance, std::span<float> single) {
  const Path& path = wave.path(p);
  if (path.size < 2) {
    std::copy(radiance.begin(), radiance.end(), single.begin());
    return;
  }
  add_node(wave, p, 0, false, single);
  if (wave.has_media()) add_segment(wave, p, 0, single);
  if (path.weight != 1)
    for (float& x : single) x *= static_cast<float>(path.weight);
}

}  // namespace suite
