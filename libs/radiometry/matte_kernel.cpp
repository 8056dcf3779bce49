#include "radiometry/matte_kernel.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/warps.h"
#include "radiometry/path_generator.h"

namespace suite {

namespace {

constexpr size_t kVector = 8;
constexpr float kLargest = 3e38f;

bool plain(const BakedMaterial& m) {
  return m.model->diffuse() && m.blackbody.empty() && !(m.maps && (m.maps->varies() || m.maps->bends()));
}

}  // namespace

bool MatteKernel::serves(const Surface& surface, const Optics& optics, const Environment& environment,
                         const PipelineOptions& options) {
  const Environment& e = environment;
  if (options.method != Method::standard || options.stop != StopRule::plan || !options.explicit_sources) return false;
  if (!optics.media().empty() || e.moon_disk || e.lamps || e.atmosphere || e.earth) return false;
  if (e.sky && (e.sky->tabulated() || !e.sky->spectrum())) return false;
  if (optics.state().knots.size() != 1) return false;
  for (uint32_t i = 0; i < surface.tracer().scene().materials.size(); ++i)
    if (const BakedMaterial& m = optics.material(i); m.model && !plain(m)) return false;
  return true;
}

MatteKernel::MatteKernel(const Surface& surface, const Optics& optics, const Environment& environment,
                         const PipelineOptions& options, bool record, size_t width)
    : surface_(surface),
      optics_(optics),
      environment_(environment),
      options_(options),
      record_(record),
      disk_(environment.sun_disk && !environment.sun_disk->collimated()),
      bins_(optics.state().size()),
      reference_bin_(optics.state().knots[0]),
      objects_(surface.tracer().objects()),
      meshes_(surface.tracer().scene().meshes),
      lanes_(width),
      steps_(width * static_cast<size_t>(options.max_nodes)),
      rays_(width),
      hits_(width),
      places_(width),
      numbers_(disk_ ? width : 0),
      x_((width + 3) / 4 * 4),
      y_(x_.size()),
      z_(x_.size()),
      reach_(width, std::numeric_limits<double>::infinity()),
      blocked_(width) {
  for (uint32_t i = 0; i < surface.tracer().scene().materials.size(); ++i) {
    const ScatterModel* model = optics.material(i).model;
    materials_.push_back(model ? padded(model->diffuse()) : Spectrum{});
  }
  sun_ = padded(environment.sun_disk ? environment.sun_disk->spectrum() : nullptr);
  sky_ = padded(environment.sky ? environment.sky->spectrum() : nullptr);
  active_.reserve(width), asked_.reserve(width);
}

MatteKernel::Spectrum MatteKernel::padded(const float* values) const {
  Spectrum s{std::vector<float>((bins_ + kVector - 1) / kVector * kVector), 0};
  if (!values) return s;
  std::copy_n(values, bins_, s.value.begin());
  for (const float v : s.value) s.most = v >= 0 ? std::max(s.most, v) : std::numeric_limits<float>::infinity();
  return s;
}

void MatteKernel::start(Wave& wave, size_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) {
  Lane& lane = lanes_[p];
  lane.stream = stream;
  lane.sample = sample;
  if (surface_.tracer().has_holes()) lane.draw = static_cast<uint32_t>(hash_of(stream.key(), sample));
  lane.size = 0;
  lane.origin = ray.ray.origin;
  lane.direction = ray.ray.direction;
  lane.time = ray.ray.time;
  lane.throughput = 1;
  lane.density = lane.truncated = 0;
  lane.weight = static_cast<float>(ray.weight);
  lane.sky = lane.disk = 0;
  active_.push_back(static_cast<uint32_t>(p));
  if (record_) wave.path(p).begin(ray.ray, ray.weight);
}

void MatteKernel::complete(Wave& wave, RunStatistics& statistics) {
  for (int depth = 0; !active_.empty(); ++depth) {
    meet(wave, depth, statistics.trace);
    statistics.nodes += active_.size();
    if (environment_.sun_disk) light(wave, depth, statistics.trace);
    go_on(depth);
  }
}

// Takes every path to its next node, or out of the scene.
void MatteKernel::meet(Wave& wave, int depth, TraceStatistics& statistics) {
  const size_t n = active_.size();
  for (size_t i = 0; i < n; ++i) {
    const Lane& lane = lanes_[active_[i]];
    rays_[i].set(lane.origin, lane.direction, lane.time, lane.draw);
  }
  surface_.tracer().nearest({rays_.data(), n}, {hits_.data(), n}, depth == 0, statistics);
  size_t kept = 0;
  for (size_t i = 0; i < n; ++i) {
    const uint32_t p = active_[i];
    if (!hits_[i].hit())
      escape(lanes_[p]);
    else if (arrive(wave, p, hits_[i], places_[kept])) {
      if (kept != i) hits_[kept] = hits_[i];
      active_[kept++] = p;
    }
  }
  active_.resize(kept);
}

// What a path meets outside the scene (the formulas of path_generator.h with one knot).
void MatteKernel::escape(Lane& lane) const {
  if (environment_.sky) lane.sky = static_cast<float>(environment_.sky->relative(lane.direction));
  const Sun* sun = environment_.sun_disk;
  if (sun && sun->contains(lane.direction))
    lane.disk = static_cast<float>(lane.density > 0 ? 1 / shared_density(1, sun->density() / lane.density, true) : 1);
}

// False when nothing scatters there.
bool MatteKernel::arrive(Wave& wave, uint32_t p, const Hit& hit, Place& place) {
  Lane& lane = lanes_[p];
  const TracedObject& object = objects_[hit.object];
  uint32_t material;
  if (object.mesh != kNone && meshes_[object.mesh].normals.empty()) {
    material = surface_.material(object, hit);
    place.shading = hit.normal;
  } else {
    surface_.interact(hit, -lane.direction, interaction_, lane.time);
    material = interaction_.material;
    place.shading = interaction_.frame.z;
  }
  if (record_) record(wave, p, hit, place.shading, material);
  if (material == kNone || materials_[material].value.empty()) return false;
  place.rho = &materials_[material];
  Step& step = steps(p)[lane.size++];
  step.rho = place.rho->value.data(), step.most = place.rho->most;
  step.sun = step.bounce = 0;
  return true;
}

// What truth looks at: the first node and the number of nodes.
void MatteKernel::record(Wave& wave, uint32_t p, const Hit& hit, Dir normal, uint32_t material) const {
  const Lane& lane = lanes_[p];
  Path& path = wave.path(p);
  path.size = lane.size + 1;
  if (lane.size > 0) return;
  Node& first = wave.node(p, 0);
  first.hit = hit;
  first.out = -lane.direction;
  first.optical_length = hit.distance;
  first.sunlit = false;
  first.at.position = hit.position;
  first.at.geometric_normal = hit.normal;
  first.at.frame = Frame::around(normal);
  first.at.material = material;
  first.at.baked = material == kNone ? nullptr : &optics_.material(material);
}

void MatteKernel::light(Wave& wave, int depth, TraceStatistics& statistics) {
  const Sun& sun = *environment_.sun_disk;
  DirectionSample drawn = sun.draw({});
  asked_.clear();
  for (uint32_t i = 0; i < active_.size(); ++i) {
    Lane& lane = lanes_[active_[i]];
    const Dir shading = places_[i].shading, geometric = hits_[i].normal;
    if (disk_) {
      numbers_[i] = lane.stream.draw(lane.sample, 1 + static_cast<uint32_t>(depth));
      drawn = sun.draw({numbers_[i][2], numbers_[i][3]});
    }
    // Light reaches the side that is looked at, by the geometric and by the shading normal.
    const double in = dot(drawn.direction, shading), in_side = dot(drawn.direction, geometric);
    const double out = -dot(lane.direction, shading), out_side = -dot(lane.direction, geometric);
    if (in_side * out_side <= 0 || in_side * in <= 0 || in * out <= 0) continue;
    const double w = std::fabs(in) / kPi;
    steps(active_[i])[lane.size - 1].sun =
        static_cast<float>(drawn.density > 0 ? w / shared_density(drawn.density, w, true) : w);
    rays_[asked_.size()].set(surface_.tracer().leave(hits_[i], drawn.direction), drawn.direction, lane.time, lane.draw);
    asked_.push_back(i);
  }
  const size_t n = asked_.size();
  surface_.tracer().occluded({rays_.data(), n}, {reach_.data(), n}, {blocked_.data(), n}, depth == 0, statistics);
  for (size_t k = 0; k < n; ++k) {
    const uint32_t p = active_[asked_[k]];
    if (blocked_[k])
      steps(p)[lanes_[p].size - 1].sun = 0;
    else if (record_ && depth == 0)
      wave.node(p, 0).sunlit = true;
  }
}

void MatteKernel::go_on(int depth) {
  for (size_t i = 0; i < active_.size(); ++i) {
    const Lane& lane = lanes_[active_[i]];
    const std::array<double, 4> u =
        disk_ ? numbers_[i] : lane.stream.draw(lane.sample, 1 + static_cast<uint32_t>(depth));
    x_[i] = u[0], y_[i] = u[1];
  }
  cosine_hemispheres(active_.size(), x_.data(), y_.data(), z_.data());
  size_t kept = 0;
  for (size_t i = 0; i < active_.size(); ++i) {
    const uint32_t p = active_[i];
    Lane& lane = lanes_[p];
    const double survival = scatter(lane, {x_[i], y_[i], z_[i]}, places_[i], hits_[i]);
    if (survival == 0) continue;
    steps(p)[lane.size - 1].bounce = static_cast<float>(1 / survival);
    active_[kept++] = p;
  }
  active_.resize(kept);
}

// Takes a path on from its last node, along `in` about the normal. Returns the probability of getting so far, 0 when it
// ends there.
double MatteKernel::scatter(Lane& lane, Dir in, const Place& at, const Hit& hit) {
  const double side = -dot(lane.direction, at.shading);
  if (side == 0 || !(in.z > 0)) return 0;
  lane.density = in.z / kPi;
  if (side < 0) in.z = -in.z;
  const Dir direction = Frame::around(at.shading).to_world(in);
  if (dot(direction, hit.normal) * in.z <= 0) return 0;  // would leak through the real surface
  lane.throughput *= static_cast<double>(at.rho->value[reference_bin_]);
  if (!(lane.throughput > 0) && bins_ == 1) return 0;  // nothing more can arrive
  double survival = 1;
  if (lane.size > options_.roulette_after) {
    survival = std::clamp(lane.throughput, 0.05, 1.0);
    const uint32_t node = static_cast<uint32_t>(lane.size) - 1;
    if (lane.stream.hashed(lane.sample, kRoulettePurpose + 16 * node) >= survival) return 0;
    lane.throughput /= survival;
  }
  if (lane.size >= options_.max_nodes) {
    lane.truncated = lane.throughput;
    return 0;
  }
  lane.direction = direction;
  lane.origin = surface_.tracer().leave(hit, direction);
  return survival;
}

float MatteKernel::radiance(size_t p, size_t bin) const {
  const Lane& lane = lanes_[p];
  const Step* step = steps(p);
  const float sun = sun_.value[bin];
  float L = lane.sky * sky_.value[bin] + lane.disk * sun;
  for (int n = lane.size - 1; n >= 0; --n) L = step[n].rho[bin] * (step[n].sun * sun + step[n].bounce * L);
  float most = L;
  if (bins_ > 1) {
    most = lane.sky * sky_.most + lane.disk * sun_.most;
    for (int n = lane.size - 1; n >= 0; --n) most = step[n].most * (step[n].sun * sun_.most + step[n].bounce * most);
  }
  const bool good = lane.weight >= 0 && L >= 0 && lane.weight * most < kLargest;
  return good ? lane.weight * L : std::numeric_limits<float>::quiet_NaN();
}

void MatteKernel::spectrum(size_t p, std::span<float> radiance) const {
  const Lane& lane = lanes_[p];
  const Step* step = steps(p);
  const float* __restrict const sun = sun_.value.data();
  float* __restrict const L = radiance.data();
  for (size_t k = 0; k < radiance.size(); ++k) L[k] = lane.sky * sky_.value[k] + lane.disk * sun[k];
  for (int n = lane.size - 1; n >= 0; --n) {
    const float* __restrict const rho = step[n].rho;
    const float s = step[n].sun, b = step[n].bounce;
    for (size_t k = 0; k < radiance.size(); ++k) L[k] = rho[k] * (s * sun[k] + b * L[k]);
  }
  for (float& x : radiance) x *= lane.weight;
}

void MatteKernel::add(std::span<const uint32_t> paths, double* sums) const {
  const auto all = [](float x) { return _mm256_set1_ps(x); };
  size_t k = 0;
  for (; k + kVector <= bins_; k += kVector) {
    const __m256 sun = _mm256_loadu_ps(&sun_.value[k]), sky = _mm256_loadu_ps(&sky_.value[k]);
    __m256d low = _mm256_loadu_pd(sums + k), high = _mm256_loadu_pd(sums + k + 4);
    for (const uint32_t p : paths) {
      const Lane& lane = lanes_[p];
      const Step* step = steps(p);
      __m256 L = all(lane.sky) * sky + all(lane.disk) * sun;
      for (int n = lane.size - 1; n >= 0; --n)
        L = _mm256_loadu_ps(step[n].rho + k) * (all(step[n].sun) * sun + all(step[n].bounce) * L);
      L *= all(lane.weight);
      low += _mm256_cvtps_pd(_mm256_castps256_ps128(L));
      high += _mm256_cvtps_pd(_mm256_extractf128_ps(L, 1));
    }
    _mm256_storeu_pd(sums + k, low), _mm256_storeu_pd(sums + k + 4, high);
  }
  for (; k < bins_; ++k)
    for (const uint32_t p : paths) sums[k] += static_cast<double>(radiance(p, k));
}

}  // namespace suite
