// Collectors and cameras that stand exactly on a surface: on the border of two media, on water, on a pane, on the
// ground. They are on the side to which they look, and see what they see a hair's breadth from there.
#include <gtest/gtest.h>

#include "tests/support/media_kit.h"

namespace suite::test::on_border_test {
namespace {

constexpr double kHair = 1e-4;  // m
using Receiver = SensorRay::Receiver;

class Looks final : public RaySensor {
 public:
  Looks(const Ray& ray, Receiver kind, uint32_t paths) : RaySensor(repeated(ray), one_band(), paths), kind_(kind) {}
  SensorRay ray(const RayRequest& r) const override {
    SensorRay out{rays_[r.problem], 1};
    out.receiver = kind_;
    return out;
  }

 private:
  Receiver kind_;
};

// Under a sky that shines from below, too.
Repeated look(const std::shared_ptr<const Scene>& scene, Vec3 at, Dir direction, Receiver kind) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  PipelineOptions options;
  options.max_nodes = 16;  // light goes to and fro in panes for long
  const auto r = render(scene, sources, std::make_unique<Looks>(Ray{at, direction, 0}, kind, 32), options);
  EXPECT_EQ(r.report.statistics.failures, 0u);
  return over_problems(r.result, 0);
}

double apart(const Repeated& a, const Repeated& b) {
  return std::fabs(a.mean - b.mean) / (std::hypot(a.error, b.error) + 1e-6 * std::fabs(a.mean));
}

// What is seen there is what is seen a hair off to the side that is looked to, much closer than their errors, as the
// same numbers are drawn. other: what would be seen otherwise; the control: 3 errors or more apart.
void expect_at(const char* what, const std::shared_ptr<const Scene>& scene, Vec3 at, Dir direction,
               const std::function<Repeated(Receiver)>& other) {
  for (const Receiver kind : {Receiver::none, Receiver::plane, Receiver::sphere}) {
    const Repeated here = look(scene, at, direction, kind), hair = look(scene, at + direction * kHair, direction, kind),
                   else_ = other(kind);
    std::printf("%s, looking %+.0f %+.0f %+.0f, receiver %d: %.5f +- %.5f, a hair off %.5f +- %.5f, else %.5f\n", what,
                direction.x, direction.y, direction.z, static_cast<int>(kind), here.mean, here.error, hair.mean,
                hair.error, else_.mean);
    EXPECT_LT(apart(here, hair), 1) << what;
    if (kind == Receiver::sphere) continue;  // sees both sides
    EXPECT_GT(apart(here, else_), 3) << what << ": the other side would not be told apart";
  }
}

Medium grey(double absorption, double scattering = 0) {
  return medium(Curve::constant(absorption), Curve::constant(scattering));
}

// Two media of 1 and 3 1/m that absorb and scatter, as bodies `above` and `below` a border. control: the same with the
// medium of one side on both.
using Build = std::function<void(Scene&, uint32_t above, uint32_t below)>;
void expect_border(const char* what, const Build& build, Vec3 at, Dir normal) {
  const auto made = [&](double above, double below) {
    auto scene = std::make_shared<Scene>();
    scene->media = {grey(above, 0.2), grey(below, 0.2)};
    scene->media[0].id = "above", scene->media[1].id = "below";
    scene->media[1].priority = 1;
    scene->materials = {boundary(0), boundary(1)};
    scene->materials[0].id = "side of above", scene->materials[1].id = "side of below";
    build(*scene, 0, 1);
    check_scene(*scene, what);
    return scene;
  };
  const auto scene = made(1, 3), only_above = made(1, 1), only_below = made(3, 3);
  for (const Dir d : {normal, -normal})
    expect_at(what, scene, at, d,
              [&](Receiver kind) { return look(dot(d, normal) > 0 ? only_below : only_above, at, d, kind); });
}

Affine3 tilted(Vec3 to) {
  const Frame f = Frame::around(normalized(Vec3{0.3, 0.2, 0.8}));
  Affine3 a = translation(to);
  const Vec3 axes[3] = {f.x, f.y, f.z};
  for (size_t row = 0; row < 3; ++row)
    for (size_t column = 0; column < 3; ++column) a.a[3 * row + column] = axes[column][static_cast<int>(row)];
  return a;
}

// Bug: a collector on the border of two layers of water took all below it for the upper one, Eu was 2.9 % low.
TEST(OnBorder, OfLayers) {
  expect_border("layers",
                [](Scene& s, uint32_t above, uint32_t below) {
                  place(s, PrimitiveKind::plane, {0, 0}, above);
                  place(s, PrimitiveKind::plane, {0, 0}, below, translation({0, 0, -1.1}));
                },
                {0.3, 0.2, -1.1}, {0, 0, 1});
}

TEST(OnBorder, OfATiltedBorderFarAway) {
  const Vec3 at{12345.678, 2345.6, 12.3};
  const Affine3 where = tilted(at);
  const Dir normal = where.vector({0, 0, 1});
  expect_border(
      "tilted",
      [&](Scene& s, uint32_t above, uint32_t below) {
        place(s, PrimitiveKind::plane, {0, 0}, above, translation(at + Vec3{0, 0, 1}));
        place(s, PrimitiveKind::plane, {0, 0}, below, where);
      },
      where.point({0.7, -0.4, 0}), normal);
}

// Two bodies of meshes that touch.
TEST(OnBorder, OfBodiesThatTouch) {
  expect_border(
      "boxes",
      [](Scene& s, uint32_t above, uint32_t below) {
        s.meshes = {box({-2, -2, 0.1}, {2, 2, 1.1}, above, true), box({-2, -2, -0.9}, {2, 2, 0.1}, below, true)};
        s.groups.push_back({"root", {}});
        for (uint32_t i = 0; i < 2; ++i)
          s.groups[0].placements.push_back({tilted({100.1, 30.3, 2.7}), TargetKind::mesh, i, kNone, kNone});
      },
      tilted({100.1, 30.3, 2.7}).point({0.31, 0.17, 0.1}), tilted({}).vector({0, 0, 1}));
}

// A surface that refracts or scatters: what is seen on the other side is the control.
void expect_surface(const char* what, const std::shared_ptr<const Scene>& scene, Vec3 at, Dir normal) {
  for (const Dir d : {normal, -normal})
    expect_at(what, scene, at, d, [&](Receiver kind) { return look(scene, at - d * kHair, d, kind); });
}

std::shared_ptr<Scene> scene_with_glass(double absorption) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(0.5)),
                      material("glass", {"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr})};
  if (absorption > 0) {
    scene->media = {grey(absorption)};
    scene->media[0].index = Curve::constant(1.5);
    scene->materials[1].inside = 0;
  }
  return scene;
}

TEST(OnBorder, OfWater) {
  auto scene = scene_with_glass(0.3);
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1.7}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, 0.3}));
  check_scene(*scene, "water");
  expect_surface("water", scene, {1.1, 0, 0.3}, {0, 0, 1});
}

TEST(OnBorder, OfPanesAndTheGround) {
  for (const bool exact : {true, false}) {
    auto scene = scene_with_glass(exact ? 0 : 30);
    const Affine3 where = tilted({0.1, 0.2, 3.3});
    if (exact) {
      place(*scene, PrimitiveKind::box, {-1, -1, 0, 1, 1, 0.1}, 1, where);
    } else {
      scene->meshes = {box({-1, -1, 0}, {1, 1, 0.1}, 1, true)};
      scene->groups.push_back({"root", {}});
      scene->groups[0].placements.push_back({where, TargetKind::mesh, 0, kNone, kNone});
    }
    place(*scene, PrimitiveKind::plane, {0, 0}, 0);
    check_scene(*scene, "pane");
    const Dir up = where.vector({0, 0, 1});
    expect_surface("top of a pane", scene, where.point({0.13, 0.17, 0.1}), up);
    expect_surface("lower face of a pane", scene, where.point({0.13, 0.17, 0}), up);
    expect_at("ground", scene, {0.4, 0.3, 0}, {0, 0, 1}, [&](Receiver) {
      return look(scene, {0.4, 0.3, kHair}, {0, 0, -1}, Receiver::none);
    });
  }
}

}  // namespace
}  // namespace suite::test::on_border_test
