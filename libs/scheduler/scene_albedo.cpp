#include "scheduler/scene_albedo.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "surface/surface.h"

namespace suite {

namespace {

constexpr uint32_t kPaths = 4096;
constexpr uint32_t kPurpose = 0x616c62;  // of random numbers
constexpr uint32_t kMostSurfaces = 64;   // met by a path; what is left then, counts as absorbed
constexpr float kNothing = 1e-3f;        // of a path's light

class Paths {
 public:
  Paths(const Tracer& tracer, const Optics& optics, double time)
      : tracer_(tracer),
        bins_(optics.state().size()),
        knots_(optics.state().knots.size()),
        surface_(tracer, optics),
        numbers_(1, kPurpose, 0),
        time_(time) {}

  SceneAlbedo run() {
    start();
    std::vector<double> sums(bins_, 0.0);
    RunningStats of_paths;
    uint32_t met = 0;
    for (uint32_t n = 0; n < kMostSurfaces && !rays_.empty(); ++n) {
      hits_.resize(rays_.size());
      tracer_.nearest(rays_, hits_, n == 0, trace_);
      size_t kept = 0;
      for (size_t i = 0; i < rays_.size(); ++i) {
        const uint32_t path = paths_[i];
        float* const light = &light_[path * bins_];
        Ray ray = rays_[i];
        if (!hits_[i].hit()) {
          if (n == 0) continue;
          double mean = 0;
          for (size_t b = 0; ray.direction.z > 0 && b < bins_; ++b)
            sums[b] += double{light[b]}, mean += double{light[b]} / static_cast<double>(bins_);
          of_paths.add(mean);
          continue;
        }
        if (n == 0) ++met;
        if (go_on(hits_[i], ray, path, n))
          rays_[kept] = ray, paths_[kept++] = path;
        else
          of_paths.add(0);
      }
      rays_.resize(kept), paths_.resize(kept);
    }
    SceneAlbedo out;
    if (met == 0) return out;
    for (const double sum : sums) out.of_bins.push_back(static_cast<float>(std::clamp(sum / met, 0.0, 1.0)));
    out.error = of_paths.stderr_of_mean();
    return out;
  }

 private:
  void start() {
    Box3 box = tracer_.scene().bounds;
    if (box.empty()) box.grow(Vec3{});
    light_.assign(size_t{kPaths} * bins_, 1.0f);
    const double above = box.high.z + 1;
    for (uint32_t p = 0; p < kPaths; ++p) {
      const std::array<double, 4> u = numbers_.draw(p, 0);
      const Vec3 size = box.size();
      const Dir up = cosine_hemisphere({u[2], u[3]});
      const double z = std::min(1e5, (above - box.center().z) / up.z);
      // Rays aim at the outline in the middle of the heights, so that they come from all around it.
      const Vec3 aim{box.low.x + u[0] * size.x, box.low.y + u[1] * size.y, box.center().z};
      rays_.push_back({aim + up * z, -up, time_, p});
      paths_.push_back(p);
    }
  }

  // False when the path has ended.
  bool go_on(const Hit& hit, Ray& ray, uint32_t path, uint32_t n) {
    surface_.interact(hit, -ray.direction, at_, ray.time);
    if (!at_.baked || !at_.baked->model) {
      ray.origin = tracer_.leave(hit, ray.direction);
      return true;
    }
    const ScatterModel& model = *at_.baked->model;
    const Dir out = at_.frame.to_local(-ray.direction);
    const std::array<double, 4> u = numbers_.draw(path, 1 + n);
    const auto knot = static_cast<int>(numbers_.hashed(path, n) * static_cast<double>(knots_));
    const auto drawn = model.sample(out, {u[0], u[1]}, u[2], knot);
    if (!drawn) return false;
    w_.resize(bins_), p_.resize(knots_);
    if (drawn->delta) {
      model.delta_weight(out, drawn->lobe, knot, w_);
      model.delta_probability(out, drawn->lobe, knot, p_);
    } else {
      model.eval(out, drawn->in, w_);
      model.pdf(out, drawn->in, p_);
    }
    float density = 0, largest = 0;
    for (const float p : p_) density += p / static_cast<float>(knots_);
    if (!(density > 0)) return false;
    float* const light = &light_[path * bins_];
    for (size_t b = 0; b < bins_; ++b) largest = std::max(largest, light[b] *= w_[b] / density);
    if (!(largest > kNothing)) return false;
    const Dir d = at_.frame.to_world(drawn->in);
    ray.origin = tracer_.leave(hit, d), ray.direction = d;
    return true;
  }

  const Tracer& tracer_;
  const size_t bins_, knots_;
  Surface surface_;
  SampleStream numbers_;
  double time_;
  Interaction at_;
  TraceStatistics trace_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> paths_;
  std::vector<float> light_, w_, p_;  // of [path][bin], of a reflection
};

Curve curve_of(const SceneAlbedo& albedo, const SpectralState& state) {
  std::vector<std::pair<double, double>> points;
  for (size_t b = 0; b < albedo.of_bins.size(); ++b)
    points.push_back({state.bins[b].center_um(), double{albedo.of_bins[b]}});
  std::sort(points.begin(), points.end());
  std::vector<double> um, value;
  for (const auto& [x, y] : points)
    if (um.empty() || x > um.back()) um.push_back(x), value.push_back(y);
  if (um.size() == 1) return Curve::constant(value[0]);
  return Curve(std::move(um), std::move(value), Outside::hold);
}

}  // namespace

SceneAlbedo scene_albedo(const Tracer& tracer, const Optics& optics, double time) {
  return Paths(tracer, optics, time).run();
}

std::shared_ptr<const AirSpec> over_scene(const std::shared_ptr<const AirSpec>& air, const Tracer& tracer,
                                          const Optics& optics, double time) {
  if (!asks_for_scene(air)) return air;
  const SceneAlbedo albedo = scene_albedo(tracer, optics, time);
  if (albedo.of_bins.empty() && !air->ground_of_scene) return air;
  if (albedo.of_bins.empty())
    throw Error(air->where, "`ground_albedo: scene`, but from above nothing of the scene is met",
                "a number or a curve");
  auto own = std::make_shared<AirSpec>(*air);
  own->ground_albedo = curve_of(albedo, optics.state());
  own->ground_of_scene = own->ground_of_any_scene = false;
  return own;
}

}  // namespace suite
