// A board beside a metal and on a ground, in every order of their reflections, against photons that are followed from
// the sun here, by themselves: the mirrored beam of smooth metal is followed from the sun by the library, too, that of
// slightly rough metal is found by paths from the board.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "support/heated_scene_kit.h"

namespace suite::mirror_and_ground_test {
namespace {

using namespace test;

constexpr double kDisk = 0.00465;  // rad, of the sun
constexpr double kUp = 30 * kDegree;
const Dir kSun{std::cos(kUp), 0, std::sin(kUp)};
constexpr double kGround = 0.5, kBoard = 0.2, kMetal = 0.9;  // reflectances

// A rectangle of the scene: where it is, which way it faces, its half lengths along the two others.
struct Rectangle {
  Vec3 centre;
  Dir normal, along, across;
  double a, b;
};
enum What { ground, metal, board };
const Rectangle kScene[] = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 4, 4},
                            {{-1, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1},
                            {{1, 0, 0.25}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, 1, 0.25}};

// W that the sides of the board absorb of 1 W/m2: towards the metal, and towards the sun.
struct Side {
  double mean = 0, error = 0;
};
struct Taken {
  Side west, east;
};

class Photons {
 public:
  explicit Photons(double alpha) : alpha_(alpha) {}
  Taken follow(size_t photons) {
    constexpr double kAround = 6;  // m, radius of what the sun is let on
    const Frame sun = Frame::around(kSun);
    RunningStats west, east;
    for (size_t k = 0; k < photons; ++k) {
      const Vec2 at = disk_from_square({random(), random()}), in = disk_from_square({random(), random()});
      const Dir from = normalized(sun.z + kDisk * (sun.x * in.x + sun.y * in.y));
      deposit_[0] = deposit_[1] = 0;
      fly(Vec3{} + kAround * (sun.x * at.x + sun.y * at.y) + from * 20.0, -from, kPi * kAround * kAround);
      west.add(deposit_[0]), east.add(deposit_[1]);
    }
    return {{west.mean(), west.stderr_of_mean()}, {east.mean(), east.stderr_of_mean()}};
  }

 private:
  double random() { return unit_double(hash_of(7, ++drawn_)); }
  void fly(Vec3 p, Dir d, double watts) {
    while (watts > 1e-3) {
      std::optional<What> met;
      double nearest = INFINITY;
      for (const What what : {ground, metal, board}) {
        const Rectangle& r = kScene[what];
        const double t = dot(r.centre - p, r.normal) / dot(d, r.normal);
        const Vec3 off = p + d * t - r.centre;
        if (t > 1e-9 && t < nearest && std::fabs(dot(off, r.along)) < r.a && std::fabs(dot(off, r.across)) < r.b)
          nearest = t, met = what;
      }
      if (!met) return;
      p = p + d * nearest;
      const Dir normal = dot(d, kScene[*met].normal) < 0 ? kScene[*met].normal : -kScene[*met].normal;
      if (*met == board) deposit_[dot(normal, kScene[board].normal) > 0 ? 0 : 1] += watts * (1 - kBoard);
      if (*met == metal)
        watts *= mirrored(d, normal);
      else
        watts *= *met == ground ? kGround : kBoard, d = lambert_from(normal);
      // Without a bias: few go on with more.
      if (watts < 1 && random() < 0.5) return;
      if (watts < 1) watts *= 2;
    }
  }
  Dir lambert_from(Dir normal) {
    return normalized(Frame::around(normal).to_world(cosine_hemisphere({random(), random()})));
  }
  // By a facet's normal, drawn from GGX's distribution times its cosine; shadowing is nothing at these roughnesses.
  double mirrored(Dir& d, Dir normal) {
    const double u = random(), tan = alpha_ * std::sqrt(u / (1 - u)), turn = 2 * kPi * random();
    const Dir h =
        normalized(Frame::around(normal).to_world(normalized(Dir{tan * std::cos(turn), tan * std::sin(turn), 1})));
    const double facing = -dot(d, h), weight = facing / (-dot(d, normal) * dot(h, normal));
    d = normalized(d + h * (2 * facing));
    const double reflectance = alpha_ > 0 ? kMetal + (1 - kMetal) * std::pow(1 - facing, 5) : kMetal;
    return facing > 0 && dot(d, normal) > 0 ? reflectance * weight : 0;
  }
  double alpha_;
  uint64_t drawn_ = 0;
  double deposit_[2] = {};
};

enum class Faces { west, east, both };

// As the library finds it; of a board with one face its back is closed.
Taken found(double alpha, Faces faces, const PathOptions& options) {
  HeatedScene s;
  const uint32_t taken = s.heated(1 - kBoard, faces == Faces::both ? heat({}, {{"back", "open"}}) : heat());
  const ModelSpec optics =
      alpha > 0 ? ModelSpec{"ggx", {{"roughness", alpha}}, {{"f0", Curve::constant(kMetal)}}, {}, nullptr}
                : ModelSpec{"mirror", {}, {{"reflectance", Curve::constant(kMetal)}}, {}, nullptr};
  const auto put = [&](What what, uint32_t material, double turned = 1) {
    const Rectangle& r = kScene[what];
    s.plane(2 * r.a, 2 * r.b, material, with_axes(r.along * turned, r.across, r.centre));
  };
  put(ground, s.given(1 - kGround, 300));
  put(metal, s.given(optics, 300));
  put(board, taken, faces == Faces::east ? -1 : 1);
  const HeatKit kit(std::move(s), 16);
  const Sunlight light = kit.sunlight(still_sun(kSun, kDisk, {0, 600, 1200}), options);
  Taken out;
  for (Side* side : {&out.west, &out.east}) {
    const bool back = faces == Faces::both && side == &out.east;
    if (faces != Faces::both && (side == &out.east) != (faces == Faces::east)) continue;
    std::vector<double> blocks(options.blocks, 0.0);
    for (size_t f = 0; f < light.faces(); ++f) {
      if (kit.faces->is_back(f) != back) continue;
      const double area = (*kit.elements)[kit.faces->element(f)].area;
      for (size_t k = 0; k < 3; ++k) side->mean += area * light.beam.at(f, k) / 3;
      for (size_t k = 0; k < blocks.size() * Sunlight::kParts; ++k)
        blocks[k / Sunlight::kParts] +=
            area * light.beam_of_block.at(f * blocks.size() + k / Sunlight::kParts, k % Sunlight::kParts) / 3;
    }
    side->error = error_of(blocks);
  }
  return out;
}

bool agree(const Side& a, const Side& b) { return std::fabs(a.mean - b.mean) < 3.5 * std::hypot(a.error, b.error); }

// Either way the board faces, and with both sides open. A beam that smooth metal sends to a closed back, straight or
// by the ground, was once counted as its front's. Negative control: with that the numbers would not agree, neither
// would those of the other roughness.
TEST(MirrorAndGround, SidesOfABoard) {
  const Taken smooth = Photons(0).follow(4000000), rough = Photons(0.1).follow(4000000);
  for (const auto& [alpha, paths, photons] : {std::tuple{0.0, 512u, smooth}, std::tuple{0.1, 2048u, rough}}) {
    const auto tell = [alpha = alpha](const char* what, const Side& side, const Side& photons_side) {
      std::printf("roughness %g, %s: %.4f +- %.4f W, photons %.4f +- %.4f\n", alpha, what, side.mean, side.error,
                  photons_side.mean, photons_side.error);
      EXPECT_TRUE(agree(side, photons_side)) << what;
    };
    const PathOptions options{8, paths, 1};
    const Taken both = found(alpha, Faces::both, options);
    tell("front of an open board", both.west, photons.west);
    tell("back of an open board", both.east, photons.east);
    tell("closed board towards the metal", found(alpha, Faces::west, options).west, photons.west);
    const Side east = found(alpha, Faces::east, options).east;
    tell("closed board towards the sun", east, photons.east);
    EXPECT_FALSE(agree({east.mean + both.west.mean, east.error}, photons.east));
  }
  EXPECT_FALSE(agree(smooth.west, rough.west));
}

}  // namespace
}  // namespace suite::mirror_and_ground_test
