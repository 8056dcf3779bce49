// Time to 1 % relative RMSE of the default estimator against the paper's (Method::paper) at a fixed count, in the same
// code: terrain with trees, a street with 1000 lamps at night, satin and chrome objects under sun and clear sky.
//
// Every scene is rendered by both methods, interleaved, at two counts each; errors are taken against a long run of the
// default (another seed), whose own error is taken off. The time to 1 % follows from the error at the larger count and
// CPU time per path: by the measured slope of the default, by the slope -1/2 of independent samples of the paper's.
// Usage: equal_error [edge of the images = 64] [rounds = 3]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "base/parallel.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "radiometry/sources/solar_spectrum.h"
#include "tests/bench/terrain.h"
#include "tests/support/radiometry_kit.h"

namespace suite::bench {
namespace {

using test::box;
using test::lambert;
using test::material;
using test::mesh_of;
using test::scene_of;

// A pinhole camera of one band.
class Camera final : public Sensor {
 public:
  Camera(Vec3 from, Vec3 to, double half_angle, uint32_t edge, uint32_t paths)
      : bands_(test::one_band()),
        state_(make_state(bands_, 0.01)),
        position_(from),
        forward_(normalized(to - from)),
        half_(std::tan(half_angle)) {
    Capture c;
    c.columns = c.rows = edge;
    c.convergence.min_paths = c.convergence.max_paths = paths;
    tasks_.push_back({"picture", {}, {c}});
    right_ = normalized(cross(forward_, Vec3{0, 0, 1}));
    down_ = cross(forward_, right_);
  }
  std::string name() const override { return "camera"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    const double edge = r.capture.columns;
    const double x = (2 * (static_cast<double>(r.problem % r.capture.columns) + r.u[0]) / edge - 1) * half_;
    const double y = (2 * (static_cast<double>(r.problem / r.capture.columns) + r.u[1]) / edge - 1) * half_;
    return {{position_, normalized(forward_ + right_ * x + down_ * y), 0}, 1};
  }
  void accept(CaptureResult&& r) override { result = std::move(r); }
  CaptureResult result;

 private:
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
  Vec3 position_;
  Dir forward_, right_, down_;
  double half_;
};

struct Case {
  const char* name;
  std::shared_ptr<Scene> scene;
  SourceSpecs sources;
  Vec3 from, to;
  double half_angle;
  int max_nodes;
  uint32_t standard_paths, paper_paths, reference_paths;
};

// In green light, in which leaves are dark. A crown of 300 leaves in a ball of radius 2 m, as one mesh.
Mesh crown() {
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  Pcg32 random(5);
  auto number = [&] { return 2 * random.uniform() - 1; };
  while (f.size() < 3 * 300) {
    const Vec3 c{2 * number(), 2 * number(), 2 * number()};
    if (dot(c, c) > 4) continue;
    for (int k = 0; k < 3; ++k)
      f.push_back(static_cast<uint32_t>(v.size())), v.push_back(c + Vec3{number(), number(), number()} * 0.5);
  }
  return mesh_of(v, f, 1);
}

Case trees() {
  auto scene = terrain_scene(300, 0.25);
  scene->materials.push_back(material("leaf", lambert(0.12, 0.08)));
  scene->meshes.push_back(crown());
  Pcg32 random(9);
  for (int i = 0; i < 1000; ++i) {
    const double x = 300 * random.uniform() - 150, y = 300 * random.uniform() - 150;
    Placement p;
    p.target = 1;
    p.to_parent = translation({x, y, terrain_height(x, y) + 3});
    scene->groups[0].placements.push_back(p);
  }
  SourceSpecs sources = terrain_sources();
  sources.sun->half_angle = 0.00465;
  return {"terrain with trees", scene, std::move(sources), {0, -220, 190}, {0, 0, 0}, 0.1, 16, 512, 512, 8192};
}

// Blocks of houses with streets between them, lamps 8 m high every 10 m or so, three kinds.
Case street() {
  std::vector<Mesh> meshes{
      mesh_of({{-400, -400, 0}, {400, -400, 0}, {400, 400, 0}, {-400, 400, 0}}, {0, 1, 2, 0, 2, 3}, 0)};
  Pcg32 random(21);
  for (int j = -4; j < 4; ++j)
    for (int i = -4; i < 4; ++i)
      meshes.push_back(
          box({60.0 * i + 8, 60.0 * j + 8, 0}, {60.0 * i + 52, 60.0 * j + 52, 8 + 12 * random.uniform()}, 1, true));
  SourceSpecs sources;
  LampSpec lamp;
  lamp.kind = LampSpec::Kind::spot;
  lamp.inner = 1.0, lamp.outer = 1.4;
  for (int kind = 0; kind < 3; ++kind) {
    lamp.intensity = Curve::constant(100.0 * (kind + 1));
    lamp.positions.clear();
    for (int k = kind; k < 1000; k += 3) {
      const double along = 480 * random.uniform() - 240, side = random.uniform() < 0.5 ? -5 : 5,
                   line = 60.0 * std::floor(9 * random.uniform() - 4) + side;
      lamp.positions.push_back(k % 2 ? Vec3{along, line, 8} : Vec3{line, along, 8});
    }
    sources.lamps.push_back(lamp);
  }
  return {"street, 1000 lamps",
          scene_of(std::move(meshes), {material("road", lambert(0.15)), material("wall", lambert(0.4))}),
          std::move(sources),
          {90, -160, 120},
          {0, 0, 0},
          0.35,
          8,
          512,
          1024,
          8192};
}

// Low domes of satin paint and of polished chrome on a field, under sun and clear sky: the upper 20 degrees of spheres,
// so that the sun they mirror goes up and not onto the field.
Case gloss() {
  auto scene =
      scene_of({mesh_of({{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
               {material("field", lambert(0.3)),
                material("satin", {"ward",
                                   {{"roughness", 0.2}},
                                   {{"diffuse", Curve::constant(0.3)}, {"specular", Curve::constant(0.2)}},
                                   {},
                                   nullptr}),
                material("chrome", {"ggx", {{"roughness", 0.02}}, {{"f0", Curve::constant(0.65)}}, {}, nullptr})});
  const double radius = 8;
  for (int i = 0; i < 16; ++i) {
    Primitive ball;
    ball.kind = PrimitiveKind::sphere;
    ball.parameters = {radius};
    ball.material = i % 2 ? 2 : 1;
    scene->primitives.push_back(ball);
    Placement p;
    p.kind = TargetKind::primitive;
    p.target = static_cast<uint32_t>(i);
    p.to_parent = translation({6.0 * (i % 4) - 9, 6.0 * (i / 4) - 9, -radius * std::cos(20 * kDegree)});
    scene->groups[0].placements.push_back(p);
  }
  SourceSpecs sources;
  sources.sun = SunSpec{dir_from_angles(0.7, 0.5), 0.00465, solar_irradiance()};
  sources.clear = ClearSkySpec{};
  resolve_sources(sources, *scene);
  return {"satin and chrome", scene, std::move(sources), {0, -28, 30}, {0, 0, 0}, 0.3, 8, 256, 1024, 8192};
}

struct Outcome {
  double error = 0, seconds = 0;  // relative RMSE; CPU seconds
  std::vector<double> radiance;
};

Outcome render(const Case& c, uint32_t edge, uint32_t paths, Method method, uint64_t seed,
               const std::vector<double>* reference) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Camera>(c.from, c.to, c.half_angle, edge, paths));
  JobOptions options;
  options.progress = false;
  options.pipeline.seed = seed;
  options.pipeline.max_nodes = c.max_nodes;
  options.pipeline.method = method;

  const std::clock_t begun = std::clock();
  run_job(c.scene, c.sources, sensors, options);
  Outcome o;
  o.seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  o.radiance = std::move(static_cast<Camera&>(*sensors[0]).result.radiance);
  if (!reference) return o;
  double square = 0, mean = 0;
  for (size_t i = 0; i < o.radiance.size(); ++i) {
    const double d = o.radiance[i] - (*reference)[i];
    square += d * d, mean += (*reference)[i];
  }
  const auto n = static_cast<double>(o.radiance.size());
  o.error = std::sqrt(square / n) / (mean / n);
  return o;
}

// Mean squared error and CPU time per path of one method, over rounds with seeds of their own.
struct Measured {
  double square_few = 0, square_many = 0, seconds_few = 0, seconds_many = 0;
};

// Seconds to 1 %: slope = of the logarithm of the error over that of the paths.
double seconds_to_one_percent(const Measured& m, double paths, double pixels, double slope, double& per_path) {
  per_path = (m.seconds_many - m.seconds_few) / (pixels * paths * 0.75);
  return per_path * pixels * paths * std::pow(std::sqrt(m.square_many) / 0.01, 1 / slope);
}

}  // namespace
}  // namespace suite::bench

int main(int argc, char** argv) {
  using namespace suite;
  using namespace suite::bench;
  const auto edge = static_cast<uint32_t>(argc > 1 ? std::atol(argv[1]) : 64);
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  const double pixels = static_cast<double>(edge) * edge;
  std::printf("%-20s %12s %12s %12s %12s %10s %10s %8s\n", "scene", "us/path", "paper's", "error @ n", "paper's",
              "s to 1 %", "paper's", "ratio");
  double product = 1;
  int count = 0;
  for (const Case& c : {trees(), street(), gloss()}) {
    const Outcome reference = render(c, edge, c.reference_paths, Method::standard, 99, nullptr);
    Measured own, theirs;
    for (int r = 0; r < rounds; ++r)
      for (const Method method : {Method::standard, Method::paper}) {
        Measured& m = method == Method::standard ? own : theirs;
        const uint32_t paths = method == Method::standard ? c.standard_paths : c.paper_paths;
        const Outcome few = render(c, edge, paths / 4, method, 7 + 2 * static_cast<uint64_t>(r), &reference.radiance);
        const Outcome many = render(c, edge, paths, method, 8 + 2 * static_cast<uint64_t>(r), &reference.radiance);
        m.square_few += few.error * few.error / rounds, m.square_many += many.error * many.error / rounds;
        m.seconds_few += few.seconds / rounds, m.seconds_many += many.seconds / rounds;
      }
    // The reference's own error, extrapolated along the measured curve.
    const double raw = std::clamp(0.5 * std::log2(own.square_few / own.square_many) / 2, 0.5, 0.9);
    const double reference_square =
        own.square_many * std::pow(static_cast<double>(c.standard_paths) / c.reference_paths, 2 * raw);
    for (double* square : {&own.square_few, &own.square_many, &theirs.square_few, &theirs.square_many})
      *square -= reference_square;
    const double slope = std::clamp(0.5 * std::log2(own.square_few / own.square_many) / 2, 0.5, 0.75);
    double own_path = 0, their_path = 0;
    const double own_seconds = seconds_to_one_percent(own, c.standard_paths, pixels, slope, own_path),
                 their_seconds = seconds_to_one_percent(theirs, c.paper_paths, pixels, 0.5, their_path);
    std::printf("%-20s %12.3f %12.3f %6.2f%%@%4u %6.2f%%@%4u %10.3f %10.3f %8.2f\n", c.name, 1e6 * own_path,
                1e6 * their_path, 100 * std::sqrt(own.square_many), c.standard_paths,
                100 * std::sqrt(theirs.square_many), c.paper_paths, own_seconds, their_seconds,
                their_seconds / own_seconds);
    std::fflush(stdout);
    product *= their_seconds / own_seconds;
    ++count;
  }
  std::printf("geometric mean %.2f (CPU time, all threads; %u x %u pixels, %d rounds)\n",
              std::pow(product, 1.0 / count), edge, edge, rounds);
}
