#include "radiometry/path_processor.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace suite {

namespace {

// Radiance from outside the scene, where the path left it.
void from_outside(const Path& path, const Environment& environment, std::span<float> radiance) {
  std::fill(radiance.begin(), radiance.end(), 0.0f);
  if (path.end != PathEnd::escaped) return;
  if (environment.sky) environment.sky->add(path.escape, static_cast<float>(path.sky_factor), radiance);
  auto add_disk = [&](const Sun& disk, double factor) {
    const float scale = static_cast<float>(factor);
    const float* spectrum = disk.spectrum();
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += spectrum[i] * scale;
  };
  if (path.sun_factor > 0) add_disk(*environment.sun_disk, path.sun_factor);
  if (path.moon_factor > 0) add_disk(*environment.moon_disk, path.moon_factor);
}

// The air of a segment: L = T L + c S, from the segment's near end along -out.
void through_air(const Atmosphere& air, Vec3 from, Dir direction, double distance, double factor, Wave& wave,
                 std::span<float> radiance) {
  const std::span<float> T = wave.scratch(), S = wave.scratch3();
  air.path(from, direction, distance, T, S);
  const float c = static_cast<float>(factor);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = T[i] * radiance[i] + c * S[i];
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
  const ExplicitLight& sun = node.light[light_sun];
  const bool sunlit = node.lights & (1u << light_sun),
             together = sunlit && continues && sun.scatter == node.bounce_spectrum;
  if (continues) {
    const float* __restrict w = node.bounce_spectrum;
    const float b = node.bounce_scale;
    if (together) {
      const float* __restrict e = sun.spectrum;
      const float s = sun.scale;
      for (size_t i = 0; i < n; ++i) L[i] = w[i] * (b * L[i] + s * e[i]);
    } else {
      for (size_t i = 0; i < n; ++i) L[i] *= b * w[i];
    }
  } else {
    std::fill_n(L, n, 0.0f);
  }
  for (unsigned rest = together ? node.lights & ~(1u << light_sun) : node.lights; rest; rest &= rest - 1) {
    const ExplicitLight& light = node.light[static_cast<size_t>(std::countr_zero(rest))];
    const float* __restrict e = light.spectrum, * __restrict w = light.scatter;
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
  if (!node.glow) return;
  const float factor = static_cast<float>(node.glow_factor);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += factor * node.glow[i];
}

// L = gathered + through L of a segment through media.
void add_segment(Wave& wave, size_t p, int n, std::span<float> radiance) {
  const std::span<float> through = wave.through(p, n), gathered = wave.gathered(p, n);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = gathered[i] + through[i] * radiance[i];
}

// The same for light that was missed.
void add_missed(Wave& wave, size_t p, int n, bool continues, std::span<float> radiance) {
  const Node& node = wave.node(p, n);
  if (continues)
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] *= node.bounce_scale * node.bounce_spectrum[i];
  else
    std::fill(radiance.begin(), radiance.end(), 0.0f);
  if (!node.has_missed) return;
  const std::span<float> missed = wave.missed(p, n);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += missed[i];
}

void add_missed_on_way(Wave& wave, size_t p, int n, std::span<float> radiance) {
  const std::span<float> through = wave.through(p, n), missed = wave.missed_on_way(p, n);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = missed[i] + through[i] * radiance[i];
}

}  // namespace

void process_path(Wave& wave, size_t p, const Environment& environment, std::span<float> radiance) {
  const Path& path = wave.path(p);
  from_outside(path, environment, radiance);
  const bool media = wave.has_media();
  const Atmosphere* air = media ? nullptr : environment.atmosphere.get();  // flights through media have it in them
  auto start_of = [&](int n) { return n == 0 ? path.ray.origin : wave.node(p, n - 1).at.position; };
  if (air && path.end == PathEnd::escaped)
    through_air(*air, start_of(path.size), path.escape, std::numeric_limits<double>::infinity(), path.escape_factor,
                wave, radiance);
  // A path that did not go on from its last node has no segment behind it.
  if (media && (path.size == 0 || wave.node(p, path.size - 1).continues)) add_segment(wave, p, path.size, radiance);
  for (int n = path.size - 1; n >= 0; --n) {
    add_node(wave, p, n, wave.node(p, n).continues, radiance);
    if (media) add_segment(wave, p, n, radiance);
    if (air)
      through_air(*air, start_of(n), -wave.node(p, n).out, wave.node(p, n).hit.distance,
                  wave.node(p, n).spectral_factor, wave, radiance);
  }
  if (path.weight != 1)
    for (float& x : radiance) x *= static_cast<float>(path.weight);
}

void process_single(Wave& wave, size_t p, const Environment& environment, std::span<const float> radiance,
                    std::span<float> single) {
  const Path& path = wave.path(p);
  if (path.size < 2) {
    std::copy(radiance.begin(), radiance.end(), single.begin());
    return;
  }
  add_node(wave, p, 0, false, single);
  const Node& first = wave.node(p, 0);
  if (wave.has_media())
    add_segment(wave, p, 0, single);
  else if (const Atmosphere* air = environment.atmosphere.get())
    through_air(*air, path.ray.origin, -first.out, first.hit.distance, first.spectral_factor, wave, single);
  if (path.weight != 1)
    for (float& x : single) x *= static_cast<float>(path.weight);
}

void process_missed(Wave& wave, size_t p, const Environment& environment, bool single, std::span<float> radiance) {
  const Path& path = wave.path(p);
  const bool media = wave.has_media();
  const Atmosphere* air = media ? nullptr : environment.atmosphere.get();
  std::fill(radiance.begin(), radiance.end(), 0.0f);
  const int last = single ? std::min(path.size, 1) : path.size;
  if (media && last == path.size && (path.size == 0 || wave.node(p, path.size - 1).continues))
    add_missed_on_way(wave, p, path.size, radiance);
  for (int n = last - 1; n >= 0; --n) {
    const Node& node = wave.node(p, n);
    add_missed(wave, p, n, node.continues && (!single || path.size < 2), radiance);
    if (media) add_missed_on_way(wave, p, n, radiance);
    if (air)
      through_air(*air, n == 0 ? path.ray.origin : wave.node(p, n - 1).at.position, -node.out, node.hit.distance, 0,
                  wave, radiance);
  }
  if (path.weight != 1)
    for (float& x : radiance) x *= static_cast<float>(path.weight);
}

}  // namespace suite
