#include "scheduler/scene_albedo.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "surface/surface.h"
#include "surface/surface_walk.h"

namespace suite {

namespace {

constexpr uint32_t kPaths = 4096;
constexpr uint32_t kPurpose = 0x616c62;  // of random numbers
constexpr uint32_t kMostSurfaces = 256;  // met by a path; what is left then, counts as absorbed
constexpr uint32_t kRouletteFrom = 2;    // surfaces

class Paths {
 public:
  Paths(const Tracer& tracer, const Optics& optics, double time)
      : tracer_(tracer),
        bins_(optics.state().size()),
        knots_(optics.state().knots.size()),
        surface_(tracer, optics),
        numbers_(1, kPurpose, 0),
        time_(time),
        walk_(optics.state()) {}

  SceneAlbedo run() {
    start();
    sums_.assign(bins_, 0.0);
    walk(
        tracer_, going_, rays_, hits_, true, trace_,
        [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) {
          if (!hit.hit()) {
            if (n > 0) of_paths_.add(leave(path, ray.direction));
            return false;
          }
          met_ += n == 0;
          const bool goes_on = go_on(path, hit, ray, n);
          if (!goes_on) of_paths_.add(0);
          return goes_on;
        },
        [] {});
    SceneAlbedo out;
    if (met_ == 0) return out;
    for (const double sum : sums_) out.of_bins.push_back(static_cast<float>(std::clamp(sum / met_, 0.0, 1.0)));
    out.error = of_paths_.stderr_of_mean();
    return out;
  }

 private:
  struct Going {
    uint32_t number;
    WalkDensities drawn;
  };
  std::span<float> light(const Going& path) { return {&light_[path.number * bins_], bins_}; }
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
      Going path{p, {}};
      path.drawn.start(numbers_.hashed(p, 0), knots_);
      going_.push_back(path);
    }
  }

  // What a path takes out of the scene, the mean over the bins.
  double leave(const Going& path, Dir d) {
    if (!(d.z > 0)) return 0;
    const double weight = path.drawn.weight(knots_);
    double mean = 0;
    const std::span<const float> T = light(path);
    for (size_t b = 0; b < bins_; ++b) {
      const double value = double{T[b]} * weight;
      sums_[b] += value, mean += value / static_cast<double>(bins_);
    }
    return mean;
  }

  // False when the path has ended.
  bool go_on(Going& path, const Hit& hit, Ray& ray, uint32_t n) {
    surface_.interact(hit, -ray.direction, at_, ray.time);
    if (n + 1 >= kMostSurfaces) return false;
    if (!at_.baked || !at_.baked->model) {
      ray.origin = tracer_.leave(hit, ray.direction);
      return true;
    }
    const std::array<double, 4> u = numbers_.draw(path.number, 1 + n);
    const auto drawn = walk_.draw(*at_.baked->model, at_.frame.to_local(-ray.direction), u, path.drawn.knot);
    if (!drawn) return false;
    const std::span<float> T = light(path);
    const double most = walk_.take(path.drawn, T);
    if (!(most > 0)) return false;
    if (n >= kRouletteFrom && !SurfaceWalk::survives(T, most * path.drawn.weight(knots_), u[3])) return false;
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
  SurfaceWalk walk_;
  TraceStatistics trace_;
  std::vector<Going> going_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<float> light_;  // of [path][bin]
  std::vector<double> sums_;  // of what left upwards, per bin
  RunningStats of_paths_;
  uint32_t met_ = 0;
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
