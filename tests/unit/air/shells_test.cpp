// Lines through shells against 113-bit arithmetic, from inside, outside and afar, at all angles.
#include "air/shells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "base/error.h"
#include "tests/support/message_of.h"

namespace suite::shells_test {
namespace {

__extension__ typedef __float128 Quad;

Quad square_root(Quad x) {
  if (!(x > 0)) return 0;
  Quad r = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3; ++i) r = (r + x / r) / 2;
  return r;
}

constexpr double kRadius = 6371000;

// Lengths in each layer, by all crossings of all shells and the radius in the middle between two of them.
std::map<size_t, double> by_brute_force(Vec3 centre, double radius, const std::vector<double>& heights, Vec3 from,
                                        Dir d, double distance, double displaced = 0) {
  Quad p[3], v[3], pv = 0, pp = 0, vv = 0;
  for (int i = 0; i < 3; ++i) {
    p[i] = Quad(from[i]) - Quad(centre[i]);
    v[i] = d[i];
    pv += p[i] * v[i], pp += p[i] * p[i], vv += v[i] * v[i];
  }
  std::vector<Quad> radii, cuts = {0, distance};
  for (size_t i = 0; i < heights.size(); ++i) {
    // The lowest height bounds nothing.
    if (i > 0) radii.push_back(Quad(radius) + heights[i] + (i % 2 ? displaced : -displaced));
    if (i == 0) continue;
    const Quad disc = pv * pv - vv * (pp - radii.back() * radii.back()), root = square_root(disc);
    if (disc > 0)
      for (const Quad t : {(-pv - root) / vv, (-pv + root) / vv})
        if (t > 0 && t < distance) cuts.push_back(t);
  }
  std::sort(cuts.begin(), cuts.end());
  std::map<size_t, double> lengths;
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Quad t = (cuts[i] + cuts[i + 1]) / 2, r = square_root(pp + 2 * t * pv + t * t * vv);
    size_t layer = 0;
    while (layer < radii.size() && r > radii[layer]) ++layer;
    if (layer < radii.size() && cuts[i + 1] > cuts[i]) lengths[layer] += static_cast<double>(cuts[i + 1] - cuts[i]);
  }
  return lengths;
}

struct Walked {
  std::map<size_t, double> lengths;
  double sum = 0, last = 0;
  int pieces = 0;
};

Walked walked(const Shells& shells, Vec3 from, Dir d, double distance) {
  Walked w;
  double reached = -1, height = 0;
  shells.walk(from, d, distance, [&](const Shells::Piece& p) {
    EXPECT_GT(p.far, p.near);
    EXPECT_GT(p.length, 0);
    EXPECT_NEAR(p.length, p.far - p.near, 1e-15 * p.far + 1e-15);
    if (reached >= 0) {
      EXPECT_EQ(p.near, reached);
      EXPECT_EQ(p.near_height, height);
    }
    reached = p.far, height = p.far_height;
    EXPECT_LT(p.layer, shells.layers());
    EXPECT_LE(std::max(p.near_height, p.far_height), shells.heights()[p.layer + 1]);
    if (p.layer > 0) {
      EXPECT_GE(std::min(p.near_height, p.far_height), shells.heights()[p.layer]);
    }
    w.lengths[p.layer] += p.length;
    w.sum += p.length;
    w.last = p.far;
    ++w.pieces;
  });
  return w;
}

// Directions everywhere, and half of them close to the tangent of some shell.
struct Rays {
  std::mt19937_64 random{20240719};
  std::uniform_real_distribution<double> u{0, 1};

  Vec3 on_sphere() { return dir_from_angles(std::acos(1 - 2 * u(random)), 2 * kPi * u(random)); }
  // A point at this height anywhere over the globe, and a direction from there.
  Vec3 at(Vec3 centre, double height) { return centre + on_sphere() * (kRadius + height); }
  Dir to_graze(Vec3 centre, Vec3 from, double height) {
    const Vec3 q = from - centre;
    const Frame frame = Frame::around(normalized(q));
    const double sine = std::min(1.0, (kRadius + height) / length(q)), phi = 2 * kPi * u(random);
    const double z = (u(random) < 0.8 ? -1 : 1) * std::sqrt((1 - sine) * (1 + sine));
    return normalized(frame.to_world({sine * std::cos(phi), sine * std::sin(phi), z}));
  }
};

const std::vector<double> kHeights = {0, 10, 1000, 2500, 8000, 20e3, 60e3, 100e3};

TEST(Shells, LengthsAreThoseOfExactArithmetic) {
  const Vec3 centre{0, 0, -kRadius};
  const Shells shells = Shells::round(centre, kRadius, kHeights);
  Rays rays;
  int crossed = 0, wrong_when_displaced = 0;
  for (int i = 0; i < 100000; ++i) {
    // Where from: near the scene's origin, anywhere over the globe, an orbit, or a billion metres away.
    const double h = std::array{3 * rays.u(rays.random), 120e3 * rays.u(rays.random), 800e3, 1e9}[size_t(i) % 4];
    const Vec3 from = i % 4 == 0 ? Vec3{1e4 * rays.u(rays.random), 1e4 * rays.u(rays.random), h} : rays.at(centre, h);
    const double graze = kHeights[size_t(rays.u(rays.random) * 8) % 8] +
                         std::pow(10, 6 * rays.u(rays.random) - 3) * (rays.u(rays.random) - 0.5);
    const Dir d = i % 2 ? rays.to_graze(centre, from, graze) : rays.on_sphere();
    const double distance = i % 4 == 3 ? 2e9 : std::pow(10, 10 * rays.u(rays.random) - 3);
    const Walked got = walked(shells, from, d, distance);
    const auto expected = by_brute_force(centre, kRadius, kHeights, from, d, distance);
    const auto displaced = by_brute_force(centre, kRadius, kHeights, from, d, distance, 4e-9),
               otherwise = by_brute_force(centre, kRadius, kHeights, from, d, distance, -4e-9);
    for (size_t layer = 0; layer < shells.layers(); ++layer) {
      const auto of = [&](const std::map<size_t, double>& m) { return m.contains(layer) ? m.at(layer) : 0.0; };
      const double range = std::fabs(of(displaced) - of(otherwise)), grid = 4e-16 * std::min({distance, got.last, 1e7});
      const double allowed = 1e-12 * of(expected) + range + grid + 1e-15;
      ASSERT_NEAR(of(got.lengths), of(expected), allowed) << i << ": layer " << layer << ", h " << h;
      crossed += of(expected) > 0;
      if (i % 50) continue;
      const auto off = by_brute_force(centre, kRadius, kHeights, from, d, distance, 1e-6);
      wrong_when_displaced += std::fabs(of(off) - of(expected)) > allowed;
    }
  }
  EXPECT_GT(crossed, 150000);
  EXPECT_GT(wrong_when_displaced, 1000);  // a micrometre of height would be seen
}

TEST(Shells, PiecesSumToTheSegment) {
  const Vec3 centre{100, -2000, -kRadius - 250};
  const Shells shells = Shells::round(centre, kRadius, kHeights);
  Rays rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = rays.at(centre, 90e3 * rays.u(rays.random));
    const double distance = std::pow(10, 8 * rays.u(rays.random) - 3);
    const Dir d = rays.on_sphere();
    const Walked w = walked(shells, from, d, distance);
    // The end is the segment's or where the air ends.
    const double end = std::min(distance, w.last);
    EXPECT_NEAR(w.sum, end, 1e-15 * end * (w.pieces + 1));
    if (end < distance) {
      EXPECT_NEAR(shells.height(from + d * end), 100e3, 1e-8);
    }
  }
}

TEST(Shells, HeightsAndVerticals) {
  const Shells shells = Shells::round({0, 0, -kRadius}, kRadius, kHeights);
  EXPECT_EQ(shells.height({0, 0, 1e-3}), 1e-3);
  EXPECT_NEAR(shells.height({0, 0, 1e9}), 1e9, 1e-6);
  EXPECT_NEAR(shells.height({3e5, 0, 0}), std::hypot(3e5L, 6371000.0L) - 6371000.0L, 1e-12 * 7e3);
  EXPECT_NEAR(shells.height({0, 0, -2 * kRadius - 5}), 5, 1e-8);
  const Dir up = shells.up({kRadius, 0, -kRadius});
  EXPECT_NEAR(up.x, 1, 1e-15);
  EXPECT_NEAR(up.z, 0, 1e-15);
  EXPECT_EQ(shells.layer_of(-50), 0u);
  EXPECT_EQ(shells.layer_of(9.99), 0u);
  EXPECT_EQ(shells.layer_of(10), 1u);
  EXPECT_EQ(shells.layer_of(99999), 6u);
  EXPECT_EQ(shells.layer_of(100e3), 7u);

  // Down to 5 km and up again, on the way and cut short of it.
  const double r0 = kRadius + 30e3, sine = (kRadius + 5e3) / r0, way = r0 * std::sqrt(1 - sine * sine);
  const Vec3 from{0, 0, 30e3};
  const Dir d{sine, 0, -std::sqrt(1 - sine * sine)};
  EXPECT_NEAR(shells.lowest_height(from, d, 1e9), 5e3, 1e-6);
  EXPECT_NEAR(shells.lowest_height(from, d, 0.5 * way), shells.height(from + d * (0.5 * way)), 1e-8);
  EXPECT_NEAR(shells.lowest_height(from, {0, 0, 1}, 1e9), 30e3, 1e-11);
  // The same line from afar.
  EXPECT_NEAR(shells.lowest_height(from - d * 1e9, d, INFINITY), 5e3, 1e-6);
}

TEST(Shells, LimbIsSymmetric) {
  const Shells shells = Shells::round({0, 0, -kRadius}, kRadius, kHeights);
  std::vector<Shells::Piece> pieces;
  // Level through 30 m above the ground, from 2000 km before that.
  shells.walk({-2e6, 0, 30}, {1, 0, 0}, INFINITY, [&](const Shells::Piece& p) { pieces.push_back(p); });
  ASSERT_EQ(pieces.size(), 12u);  // six layers down, and up
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(pieces[i].layer, 6 - i);
    EXPECT_EQ(pieces[11 - i].layer, 6 - i);
    EXPECT_NEAR(pieces[i].length, pieces[11 - i].length, 1e-8);
    EXPECT_EQ(pieces[i].near_height, pieces[11 - i].far_height);
  }
  EXPECT_NEAR(pieces[5].far_height, 30, 1e-9);
  EXPECT_NEAR(pieces[5].far, 2e6, 1e-8);
}

TEST(Shells, TouchingAndStartingOnAShell) {
  const Shells shells = Shells::round({0, 0, -kRadius}, kRadius, kHeights);
  const auto layers = [&](Vec3 from, Dir d, double distance) {
    std::vector<size_t> l;
    shells.walk(from, d, distance, [&](const Shells::Piece& p) { l.push_back(p.layer); });
    return l;
  };
  using testing::ElementsAre;
  EXPECT_THAT(layers({0, 0, 10}, {0, 0, 1}, 5), ElementsAre(1));
  EXPECT_THAT(layers({0, 0, 10}, {0, 0, -1}, 5), ElementsAre(0));
  EXPECT_THAT(layers({0, 0, 10}, {1, 0, 0}, 5), ElementsAre(1));
  EXPECT_THAT(layers({0, 0, 100e3}, {0, 0, -1}, 5), ElementsAre(6));
  EXPECT_THAT(layers({0, 0, 100e3}, {0, 0, 1}, 5), ElementsAre());
  EXPECT_THAT(layers({0, 0, 100e3}, {1, 0, 0}, 5), ElementsAre());
  EXPECT_THAT(layers({0, 0, 200e3}, {0, 0, -1}, 100e3), ElementsAre());
  EXPECT_THAT(layers({0, 0, 5}, {0, 0, -1}, 5), ElementsAre(0));
  EXPECT_THAT(layers({0, 0, 5}, {0, 0, 1}, 0), ElementsAre());
  EXPECT_THAT(layers({0, 0, 5}, {0, 0, 1}, NAN), ElementsAre());
  EXPECT_THAT(layers({0, 0, NAN}, {0, 0, 1}, 1), ElementsAre());
}

TEST(Shells, FlatIsTheLimitOfLargeRadii) {
  const Shells flat = Shells::flat(kHeights), round = Shells::round({0, 0, -1e12}, 1e12, kHeights);
  Rays rays;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from{0, 0, 110e3 * rays.u(rays.random)};
    const Dir d = rays.on_sphere();
    const double distance = std::pow(10, 8 * rays.u(rays.random) - 3);
    const Walked a = walked(flat, from, d, distance), b = walked(round, from, d, distance);
    // On the way x the Earth falls by x^2 / 2R, and the path to a height grows by that over the slope.
    const double way = std::min(distance, std::max(a.last, b.last)), off = way * way / 1e12 / std::fabs(d.z) + 1e-9;
    if (off > 1e-2) continue;
    for (const auto& [layer, length] : a.lengths) {
      const double other = b.lengths.contains(layer) ? b.lengths.at(layer) : 0;
      ASSERT_NEAR(length, other, off) << i;
    }
    ASSERT_NEAR(a.sum, b.sum, off);
  }
}

TEST(Shells, FlatLinesEnd) {
  const Shells flat = Shells::flat({0, 1000, 2000});
  const Walked level = walked(flat, {0, 0, 500}, {1, 0, 0}, INFINITY),
               down = walked(flat, {0, 0, 500}, {0, 0, -1}, 700);
  EXPECT_EQ(level.sum, Shells::kLongestLevel);
  EXPECT_EQ(down.sum, 700);
  EXPECT_EQ(walked(flat, {0, 0, 1e9}, {0, 0, -1}, 1e9 - 500).sum, 1500);
  EXPECT_EQ(flat.lowest_height({0, 0, 500}, {0, 0, -1}, 700), -200);
  EXPECT_EQ(flat.lowest_height({0, 0, 500}, {0, 0, -1}, INFINITY), -INFINITY);
  EXPECT_EQ(flat.lowest_height({0, 0, 500}, {1, 0, 0}, INFINITY), 500);
}

TEST(Shells, BadHeightsAreRefused) {
  using testing::HasSubstr;
  EXPECT_THAT(message_of([] { Shells::flat({5}); }), HasSubstr("1 heights bound no layer"));
  EXPECT_THAT(message_of([] { Shells::flat({0, 5, 5}); }), HasSubstr("not ascending: 5 m, then 5 m"));
  EXPECT_THAT(message_of([] { Shells::flat({0, NAN}); }), HasSubstr("height 2 of the air is not finite"));
  EXPECT_THAT(message_of([] { Shells::round({}, 0, {0, 1}); }), HasSubstr("radius"));
  EXPECT_THAT(message_of([] { Shells::round({}, 10, {-11, 1}); }), HasSubstr("below the centre"));
}

// Straight down from the scene's origin there is the centre of the Earth, where no ground ends a ray.
TEST(Shells, DirectionsNearTheCentre) {
  const double radius = 6371e3;
  const Shells shells = Shells::round({0, 0, -radius}, radius, {0, 1e3, 1e5});
  for (const double beside : {0.0, 1e-9, 1e-3, 0.02, 0.06, 1.0})
    for (const double above : {-0.1, -1e-9, 0.0, 1e-6, 0.03}) {
      const Vec3 p{beside, 0.3 * beside, -radius + above};
      const double height = shells.height(p);
      for (const Dir d : {Dir{0, 0, -1}, Dir{0, 0, 1}, normalized(Vec3{1, 2, 0.5})}) {
        const double c = shells.cosine(p, height, d);
        EXPECT_TRUE(c >= -1 && c <= 1) << beside << " " << above << ": " << c;
      }
      EXPECT_NEAR(length(shells.up(p)), 1, 1e-12) << beside << " " << above;
    }
}

}  // namespace
}  // namespace suite::shells_test
