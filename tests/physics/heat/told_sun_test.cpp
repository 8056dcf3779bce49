// What surfaces send on of the sun, told from when their elements are lit: as much light as joins to the sun find, with
// less scatter, whatever is told.
#include <gtest/gtest.h>

#include <cmath>

#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::told_sun_test {
namespace {

using namespace test;

// A street with a wall that is white, one that shines, a pillar and a leaf that lets light through.
HeatKit street() {
  HeatedScene s;
  const uint32_t ground = s.heated(0.6, heat()), white = s.heated(0.2, heat()),
                 leaf = s.heated(lambert(0.3, 0.3), heat({}, {{"back", "open"}})),
                 shiny = s.heated({"ward",
                                   {{"roughness", 0.15}},
                                   {{"diffuse", Curve::constant(0.3)}, {"specular", Curve::constant(0.3)}},
                                   {},
                                   nullptr},
                                  heat());
  s.mesh(quad(8, 0, ground));
  s.mesh(box({-6, -7, 0}, {-3, 7, 5}, white, true));
  s.mesh(box({3, -7, 0}, {6, 7, 4}, shiny, true));
  s.mesh(box({-0.5, -0.5, 0}, {0.5, 0.5, 3}, white, true));
  s.plane(1.5, 1.5, leaf, shifted({0, 3, 3}));
  return HeatKit(std::move(s), 150);
}

SunCourse day() {
  SunCourse course = still_sun({0, 0, 1}, 0.00465, evenly({0, 43200}, 36));
  course.towards = [](double t) {
    const double turn = kPi * (t / 43200);
    return normalized(Vec3{std::cos(turn), -0.3, std::sin(turn) - 0.05});
  };
  return course;
}

// Light that faces absorb but what comes straight, by face: means over the day, and the variance of that by blocks.
struct Scattered {
  std::vector<double> mean, variance;
};
enum class Told { truly, wrongly, nothing };
Scattered scattered(const HeatKit& kit, Told told, uint32_t joins, uint64_t seed) {
  const SunCourse course = day();
  const PathOptions options{8, 16, seed};
  Sunlight light = untraced_sunlight(*kit.elements, *kit.faces, course, options);
  const auto trace = [&](SunStage stage) {
    trace_sunlight(*kit.tracer, *kit.elements, *kit.faces, kit.optics, course, options, joins, stage,
                   {0, kit.faces->size()}, light);
  };
  trace(SunStage::straight);
  light.beam = CompactRows(light.beam.rows(), light.beam.width());
  light.beam_of_block = CompactRows(light.beam_of_block.rows(), light.beam_of_block.width());
  if (told != Told::truly)
    for (uint8_t& lit : light.lit) lit = told == Told::wrongly ? 255 : 0;
  trace(SunStage::scattered);
  Scattered out;
  for (size_t f = 0; f < light.faces(); ++f) {
    std::vector<double> blocks(options.blocks);
    double mean = 0;
    for (size_t m = 0; m < light.moments; ++m) mean += light.beam.at(f, m) / static_cast<double>(light.moments);
    for (size_t k = 0; k < blocks.size() * Sunlight::kParts; ++k)
      blocks[k / Sunlight::kParts] +=
          light.beam_of_block.at(f * blocks.size() + k / Sunlight::kParts, k % Sunlight::kParts) /
          static_cast<double>(light.moments);
    out.mean.push_back(mean), out.variance.push_back(std::pow(error_of(blocks), 2));
  }
  return out;
}

// Over all faces: how far apart in standard errors, and the second's variance over the first's.
struct Compared {
  double off = 0, ratio = 0;
};
Compared compared(const HeatKit& kit, const Scattered& a, const Scattered& b) {
  double apart = 0, variance_a = 0, variance_b = 0;
  for (size_t f = 0; f < a.mean.size(); ++f) {
    const double area = (*kit.elements)[kit.faces->element(f)].area;
    apart += area * (b.mean[f] - a.mean[f]);
    variance_a += area * area * a.variance[f], variance_b += area * area * b.variance[f];
  }
  return {apart / std::sqrt(variance_a + variance_b), variance_b / variance_a};
}

TEST(ToldSun, UnbiasedWhateverIsToldAndLessNoisyWhereItIsTrue) {
  const HeatKit kit = street();
  // Joins alone, at many moments.
  const Scattered joined = scattered(kit, Told::nothing, 4, 1);
  const Compared truly = compared(kit, scattered(kit, Told::truly, 4, 2), joined),
                 wrongly = compared(kit, scattered(kit, Told::wrongly, 4, 3), joined),
                 alone = compared(kit, scattered(kit, Told::wrongly, 0, 4), joined);
  std::printf(
      "scattered sun, told and joined: %+.2f standard errors off joins, whose variance is %.1f times as much; told "
      "wrongly %+.2f; that without joins %+.1f\n",
      truly.off, truly.ratio, wrongly.off, alone.off);
  // Significance 0.3 %.
  EXPECT_LT(std::fabs(truly.off), 3);
  EXPECT_LT(std::fabs(wrongly.off), 3);
  EXPECT_GT(std::fabs(alone.off), 6);  // negative control
  EXPECT_GT(truly.ratio, 2);
}

}  // namespace
}  // namespace suite::told_sun_test
