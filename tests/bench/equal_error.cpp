// CPU seconds to the same relative RMSE of the default estimator and the paper's (Method::paper), both at fixed counts
// and in the same code: terrain with trees, a street with 1000 lamps at night, low satin and chrome domes under sun and
// clear sky, and whole balls of the same, whose chrome throws the sun onto the field (a caustic: both methods find it
// by chance only).
//
// Every scene is rendered by both methods at three counts n / 16, n / 4 and n, in rounds of seeds of their own. Both
// are treated alike: mean squared errors over rounds; a straight line through the three in the logarithms of error and
// paths; where it crosses the target times the CPU time of a path. The target is the geometric mean of what both reach
// at n, so that none is extrapolated farther than the other; n' / n says how far. Errors are taken against the mean of
// two long runs of the default of other seeds, whose own error is known from their difference and is taken off. The
// uncertainty is the jackknife's over rounds (x/: a factor of one standard error); with few rounds it misses what none
// has seen.
//
// Usage: equal_error [edge of the images = 32] [rounds = 4]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "base/parallel.h"
#include "light/kinds/clear_sky.h"
#include "light/kinds/lamps.h"
#include "light/kinds/solar_spectrum.h"
#include "math/sampling.h"
#include "math/stats.h"
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
  SourceSpecs sources = terrain_sources(0.00465);
  return {"terrain with trees", scene, std::move(sources), {0, -220, 190}, {0, 0, 0}, 0.1, 16, 512, 512, 4096};
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
    sources.add(lamp);
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
          4096};
}

// Sixteen bodies of satin paint and of polished chrome on a field, under sun and clear sky: the parts above the field
// of spheres of that radius with their middles at that height.
Case gloss(const char* name, double radius, double height, double roughness, Vec3 from, Vec3 to, double half_angle) {
  auto scene =
      scene_of({mesh_of({{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
               {material("field", lambert(0.3)),
                material("satin", {"ward",
                                   {{"roughness", 0.2}},
                                   {{"diffuse", Curve::constant(0.3)}, {"specular", Curve::constant(0.2)}},
                                   {},
                                   nullptr}),
                material("chrome", {"ggx", {{"roughness", roughness}}, {{"f0", Curve::constant(0.65)}}, {}, nullptr})});
  for (int i = 0; i < 16; ++i) {
    Primitive ball;
    ball.kind = PrimitiveKind::sphere;
    ball.parameters = {radius};
    ball.material = i % 2 ? 2 : 1;
    scene->primitives.push_back(ball);
    Placement p;
    p.kind = TargetKind::primitive;
    p.target = static_cast<uint32_t>(i);
    p.to_parent = translation({6.0 * (i % 4) - 9, 6.0 * (i / 4) - 9, height});
    scene->groups[0].placements.push_back(p);
  }
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.7, 0.5), 0.00465, solar_irradiance()});
  sources.add(ClearSkySpec{});
  resolve_sources(sources, *scene);
  return {name, scene, std::move(sources), from, to, half_angle, 8, 256, 1024, 4096};
}
// The upper 20 degrees of large spheres: the sun they mirror goes up and not onto the field.
Case domes() {
  return gloss("satin, chrome domes", 8, -8 * std::cos(20 * kDegree), 0.02, {0, -28, 30}, {0, 0, 0}, 0.3);
}
Case balls() { return gloss("chrome balls, caustic", 2, 2, 0.05, {0, -28, 26}, {0, 0, 1}, 0.35); }

struct Outcome {
  double seconds = 0;  // CPU
  std::vector<double> radiance;
};

Outcome render(const Case& c, uint32_t edge, uint32_t paths, Method method, uint64_t seed) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Camera>(c.from, c.to, c.half_angle, edge, paths));
  JobOptions options;
  options.progress = false;
  options.pipeline.seed = seed;
  options.pipeline.max_nodes = c.max_nodes;
  options.pipeline.method = method;

  const std::clock_t begun = std::clock();
  run_job(c.scene, c.sources, sensors, options);
  return {static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC,
          std::move(static_cast<Camera&>(*sensors[0]).result.radiance)};
}

// Mean of squared differences over the squared mean of b.
double square_between(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0, mean = 0;
  for (size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]), mean += b[i];
  return square * static_cast<double>(a.size()) / (mean * mean);
}

struct Reference {
  std::vector<double> radiance;
  double square = 0;  // its own relative squared error
};
Reference reference_of(const Case& c, uint32_t edge) {
  Reference r{render(c, edge, c.reference_paths, Method::standard, 99).radiance, 0};
  const std::vector<double> other = render(c, edge, c.reference_paths, Method::standard, 101).radiance;
  r.square = square_between(other, r.radiance) / 4;
  for (size_t i = 0; i < other.size(); ++i) r.radiance[i] = 0.5 * (r.radiance[i] + other[i]);
  return r;
}

constexpr int kCounts = 3;
// Squared errors and CPU seconds of one round at the three counts.
struct Round {
  double square[kCounts] = {}, seconds[kCounts] = {};
};

// A method on a scene: its rounds up to `most` paths a pixel.
struct Runs {
  std::vector<Round> rounds;
  uint32_t most = 0;
  double pixels = 0, reference_square = 0;
};
struct Line {
  double per_path = 0, error = 0, slope = 0, paths = 0, seconds = 0;  // paths a pixel and seconds to the target
};
// Over all rounds but one; none = -1. Seconds are not finite where errors do not fall with paths.
Line line_of(const Runs& runs, double target, int left_out = -1) {
  double y[kCounts] = {}, seconds[kCounts] = {}, n = 0;
  for (int r = 0; r < static_cast<int>(runs.rounds.size()); ++r) {
    if (r == left_out) continue;
    const Round& round = runs.rounds[static_cast<size_t>(r)];
    ++n;
    for (int k = 0; k < kCounts; ++k) y[k] += round.square[k], seconds[k] += round.seconds[k];
  }
  for (int k = 0; k < kCounts; ++k) y[k] = 0.5 * std::log(y[k] / n - runs.reference_square), seconds[k] /= n;
  Line line;
  const double most = runs.most;
  // What a job costs before its first path goes out with the difference.
  line.per_path = (seconds[2] - seconds[0]) / (runs.pixels * most * 15 / 16);
  line.error = std::exp(y[2]);
  line.slope = (y[2] - y[0]) / std::log(16.0);
  const double middle = (y[0] + y[1] + y[2]) / 3;
  line.paths = line.slope < 0 ? most / 4 * std::exp((std::log(target) - middle) / line.slope) : HUGE_VAL;
  line.seconds = line.per_path * runs.pixels * line.paths;
  return line;
}
// Standard error of the logarithm of the seconds to a target, by the jackknife over rounds.
double log_error(const Runs& runs, double target) {
  RunningStats left_out;
  for (int r = 0; r < static_cast<int>(runs.rounds.size()); ++r)
    left_out.add(std::log(line_of(runs, target, r).seconds));
  return static_cast<double>(runs.rounds.size() - 1) * left_out.stderr_of_mean();
}

Runs measure(const Case& c, uint32_t edge, int rounds, Method method, uint32_t most, const Reference& reference) {
  Runs runs{{}, most, static_cast<double>(edge) * edge, reference.square};
  uint64_t seed = 7;
  for (int round = 0; round < rounds; ++round) {
    runs.rounds.emplace_back();
    for (int k = 0; k < kCounts; ++k) {
      const Outcome o = render(c, edge, most >> (4 - 2 * k), method, seed++);
      runs.rounds.back().square[k] = square_between(o.radiance, reference.radiance);
      runs.rounds.back().seconds[k] = o.seconds;
    }
  }
  return runs;
}

void print(const char* scene, const char* method, const Runs& runs, double target) {
  const Line line = line_of(runs, target);
  std::printf("%-22s %-8s %8.3f  %6.2f %% @ %-5u %6.2f %10.3f x/: %-5.2f %8.2f\n", scene, method, 1e6 * line.per_path,
              100 * line.error, runs.most, line.slope, line.seconds, std::exp(log_error(runs, target)),
              line.paths / runs.most);
}

}  // namespace
}  // namespace suite::bench

int main(int argc, char** argv) {
  using namespace suite;
  using namespace suite::bench;
  const auto edge = static_cast<uint32_t>(argc > 1 ? std::atol(argv[1]) : 32);
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 4;
  if (edge < 8 || edge > 4096 || rounds < 2 || rounds > 1000) {
    std::fprintf(stderr, "equal_error [edge of the images, 8 to 4096] [rounds, 2 to 1000]\n");
    return 2;
  }
  std::printf("%-22s %-8s %8s  %16s %6s %10s %8s %8s\n", "scene", "method", "us/path", "error @ n", "slope", "seconds",
              "", "n'/n");
  for (const Case& c : {trees(), street(), domes(), balls()}) {
    const Reference reference = reference_of(c, edge);
    const Runs own = measure(c, edge, rounds, Method::standard, c.standard_paths, reference),
               theirs = measure(c, edge, rounds, Method::paper, c.paper_paths, reference);
    const double target = std::sqrt(line_of(own, 0.01).error * line_of(theirs, 0.01).error);
    print(c.name, "default", own, target);
    print(c.name, "paper's", theirs, target);
    std::printf("%-22s to %.2f %%: ratio %.2f x/: %.2f; the reference's own error %.2f %%\n", c.name, 100 * target,
                line_of(theirs, target).seconds / line_of(own, target).seconds,
                std::exp(std::hypot(log_error(own, target), log_error(theirs, target))),
                100 * std::sqrt(reference.square));
    std::fflush(stdout);
  }
  std::printf("%u x %u pixels, %d rounds; CPU time of all threads; x/: factor of one standard error\n", edge, edge,
              rounds);
}
