// A capture that is computed in parts, by problems or by scrambles, is joined to the bits of one that was computed at
// once: sums, rejected samples, what was cut and missed, and truth.
#include <gtest/gtest.h>

#include <algorithm>

#include "math/sampling.h"
#include "support/radiometry_kit.h"
#include "transport/pipeline.h"

namespace suite::test::join_test {
namespace {

// A row of 20 problems over a ground of six materials, some under a pane of glass that hides a lamp's worth of sun.
class Strip final : public RaySensor {
 public:
  explicit Strip(std::vector<Band> bands) : RaySensor(rays(), std::move(bands), 1) {}
  SensorRay ray(const RayRequest& r) const override {
    const Ray& middle = rays_[r.problem];
    SensorRay ray{{middle.origin + Vec3{r.u[0] - 0.5, r.u[1] - 0.5, 0}, middle.direction, 0}, 1};
    if (!rejects) return ray;
    ray.spectral = true;
    for (float& w : r.spectral) w = r.u[2] < 0.02 ? NAN : 1;
    return ray;
  }
  std::span<const std::string> truth() const override { return names; }
  std::vector<std::string> names{"material", "material_fraction", "location", "range", "nodes", "reflectance", "hits"};
  bool rejects = false;  // some samples are no number

 private:
  static std::vector<Ray> rays() {
    std::vector<Ray> all;
    for (int i = 0; i < 20; ++i) all.push_back({{-1.9 + 0.2 * i, 0.3, 4}, {0, 0, -1}, 0});
    return all;
  }
};

struct Kit {
  explicit Kit(bool covered) : scene(make(covered)) {
    SourceSpecs specs;
    specs.add(SunSpec{normalized(Vec3{0.3, 0.2, 1}), 0.005, Curve::constant(3)});
    specs.add(uniform_sky(1, false));
    environment = bake_environment(specs, tracer, false, optics.state());
    sensor.rejects = covered;
    options.max_nodes = 3;
  }
  static std::shared_ptr<Scene> make(bool covered) {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    for (uint32_t i = 0; i < 6; ++i) {
      const double x = -2 + 0.7 * i;
      meshes.push_back(mesh_of({{x, -2, 0}, {x + 0.7, -2, 0}, {x + 0.7, 2, 0}, {x, 2, 0}}, {0, 1, 2, 0, 2, 3}, i));
      materials.push_back(material("m" + std::to_string(i), lambert(0.9 - 0.1 * i)));
    }
    meshes.push_back(box({-1, -1, 0}, {0.5, 0.2, 1}, 3, true));
    if (covered) {
      meshes.push_back(mesh_of({{0, -2, 1.5}, {3, -2, 1.5}, {3, 2, 1.5}, {0, 2, 1.5}}, {0, 1, 2, 0, 2, 3}, 6));
      materials.push_back(material("glass", {"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr}));
    }
    return scene_of(std::move(meshes), std::move(materials));
  }
  Accumulators run(uint32_t paths, const std::vector<Block>& blocks, Accumulators sums) const {
    const std::vector<uint32_t> to(capture.problems(), paths);
    RunStatistics statistics;
    for (const Block& b : blocks) pipeline.run(sensor, capture, 7, b, to, sums, Slots::by_problem, statistics);
    return sums;
  }
  Accumulators nothing(uint32_t paths) const {
    return Accumulators({capture.problems(), 9, scrambles_for(paths), truth.slots(), pipeline.may_miss(capture)});
  }

  std::shared_ptr<Scene> scene;
  Strip sensor{[] {
    std::vector<Band> all;
    for (int b = 0; b < 9; ++b) all.push_back(Band::rectangular("b", 0.5 + 0.01 * b, 0.01));
    return all;
  }()};
  const Capture& capture = sensor.tasks()[0].captures[0];
  Tracer tracer{scene};
  Optics optics{*scene, sensor.states()[0]};
  Environment environment;
  BandProjection projection{optics.state(), sensor.bands(0)};
  TruthPlan truth{sensor.truth(), {tracer, optics.state(), 0, sensor.bands(0), projection, environment}};
  Surface surface{tracer, optics};
  PipelineOptions options;
  ChannelPlan channels{sensor.channels()};
  Pipeline pipeline{surface, optics, environment, optics.state(), projection, 0, truth, channels, options};
};

bool same_bytes(const Accumulators& a, const Accumulators& b) {
  const auto x = a.columns(), y = b.columns();
  const size_t rows = a.problems() * static_cast<size_t>(a.scrambles());
  for (size_t c = 0; c < x.size(); ++c)
    if (x[c].width != y[c].width ||
        !std::equal(x[c].data, x[c].data + rows * x[c].width, y[c].data, y[c].data + rows * y[c].width))
      return false;
  return true;
}

std::vector<Block> with(std::vector<Block> blocks, Scrambles scrambles) {
  for (Block& b : blocks) b.scrambles = scrambles;
  return blocks;
}

class Join : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Join, testing::Bool(),
                         [](auto& p) { return std::string(p.param ? "covered" : "matte"); });

TEST_P(Join, parts_by_scrambles_and_by_problems_make_the_bits_of_the_whole) {
  const Kit kit(GetParam());
  EXPECT_STREQ(kit.pipeline.kernel(), GetParam() ? "general" : "matte");
  EXPECT_EQ(kit.pipeline.may_miss(kit.capture), GetParam());
  const std::vector<Block> all = blocks_of(kit.capture);
  for (const uint32_t paths : {30u, 130u, 700u}) {
    SCOPED_TRACE(paths);
    const Accumulators whole = kit.run(paths, all, kit.nothing(paths));
    // By scrambles, of which the last part has two, in any order and one of them twice.
    Accumulators joined = kit.nothing(paths);
    for (const Scrambles part : {0x0c, 0xf2, 0x0c, 0x01})
      joined.join(kit.run(paths, with(all, part), kit.nothing(paths)));
    EXPECT_TRUE(same_bytes(joined, whole));
    // By problems, block by block from the last, in accumulators of a block.
    Accumulators pieced = kit.nothing(paths);
    for (auto b = all.rbegin(); b != all.rend(); ++b) {
      Accumulators::Shape shape = whole.shape();
      shape.problems = b->problems();
      Accumulators piece(shape);
      RunStatistics statistics;
      kit.pipeline.run(kit.sensor, kit.capture, 7, *b, std::vector<uint32_t>(20, paths), piece, Slots::by_place,
                       statistics);
      pieced.join(piece, b->column);
    }
    EXPECT_TRUE(same_bytes(pieced, whole));
    // A part that began with the others' samples, then went on by itself; the rest catches up.
    Accumulators further = kit.run(paths, with(all, 0x05), kit.run(paths / 2, all, kit.nothing(paths)));
    EXPECT_GE(further.next(0, 0x05), paths);
    EXPECT_LT(further.next(0, kAllScrambles), paths);
    EXPECT_TRUE(same_bytes(kit.run(paths, all, further), whole));
    further.join(joined);
    EXPECT_TRUE(same_bytes(further, whole));
    // What is compared is there, and a scramble less is seen.
    EXPECT_FALSE(same_bytes(kit.run(paths, with(all, 0xfe), kit.nothing(paths)), whole));
    EXPECT_EQ(whole.paths(3), paths);
    uint32_t failures = 0;
    for (size_t i = 0; i < 20; ++i) failures += whole.failures(i);
    EXPECT_EQ(failures > 0, GetParam());
  }
}

// Truth of the joined scrambles: shares of up to four materials are exact, sums are sums.
TEST_P(Join, truth_of_scrambles_is_truth_of_all) {
  const Kit kit(GetParam());
  const Accumulators sums = kit.run(130, blocks_of(kit.capture), kit.nothing(130));
  std::vector<double> values(kit.truth.columns().size());
  for (size_t i = 0; i < 20; ++i) {
    kit.truth.finish(sums.truth(i), sums.paths(i), values.data());
    double hits = 0, east = 0;
    for (int s = 0; s < 4; ++s) {
      const double* row = sums.truth(i).data() + static_cast<size_t>(s) * sums.truth_slots();
      hits += row[0], east += row[17];
    }
    EXPECT_DOUBLE_EQ(values.back(), hits);
    EXPECT_DOUBLE_EQ(values[2], east / hits);
    EXPECT_GT(values[1], 0.2);
    EXPECT_LE(values[1], 1);
    EXPECT_NEAR(values[1] * 130, std::round(values[1] * 130), 1e-9);
  }
}

TEST(ExactSum, does_not_depend_on_the_order) {
  Pcg32 random(3);
  std::vector<double> numbers(1000);
  for (double& x : numbers) x = random.uniform() * std::pow(10.0, -6 * random.uniform());
  ExactSum forth, back, halves[2];
  double plain = 0, plain_back = 0;
  for (size_t i = 0; i < 1000; ++i) {
    forth += numbers[i], back += numbers[999 - i], halves[i % 2] += numbers[i];
    plain += numbers[i], plain_back += numbers[999 - i];
  }
  halves[0] += halves[1];
  EXPECT_EQ(forth, back);
  EXPECT_EQ(forth, halves[0]);
  EXPECT_NE(plain, plain_back) << "nothing was tested";
  EXPECT_NEAR(forth, plain, 1e-6);
  forth += NAN, forth += -1;
  EXPECT_EQ(forth, back);
  forth += INFINITY;
  EXPECT_NEAR(forth - back, 0x1p20, 1e-3);
}

}  // namespace
}  // namespace suite::test::join_test
