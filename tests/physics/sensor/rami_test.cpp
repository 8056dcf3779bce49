// The RAMI instrument: closed forms over a bare ground, conservation, a canopy against the same leaves in Mitsuba, and
// the homogeneous canopy HOM03 against another tracer's table (its noise is 0.3 %, its discs are other random ones).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "math/sampling.h"
#include "support/message_of.h"
#include "support/platform_kit.h"

namespace suite::rami_test {
namespace {

using test::PlatformKit;

std::string instrument(double half, double top, int sun, double soil, int paths) {
  return strf(
      "kind: rami\nname: r\nbands: [{name: b, center_um: 0.85, fwhm_um: 0.01, shape: rectangular}]\npatch: {origin_m: "
      "[%g, %g], size_m: [%g, %g]}\ntop_m: %g\nsun_zenith_deg: %d\nsun_azimuth_deg: 90\nirradiance: "
      "2\nground_reflectance: %g\ntruth: []\npaths: %d\n",
      -half, -half, 2 * half, 2 * half, top, sun, soil, paths);
}

struct Views {
  std::map<double, std::array<double, 3>> principal;  // by zenith: BRF, standard error, single
  std::map<std::string, std::array<double, 2>> flux;
};
Views views_of(const test::Shot& shot) {
  Views v;
  for (const TextFile& text : shot.texts) {
    std::istringstream in(text.text);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::vector<std::string> cells;
      std::stringstream cell(line);
      for (std::string c; std::getline(cell, c, ',');) cells.push_back(c);
      if (text.name == "r_brf.csv" && cells[0] == "principal")
        v.principal[std::stod(cells[1])] = {std::stod(cells[4]), std::stod(cells[5]), std::stod(cells[6])};
      if (text.name == "r_fluxes.csv") v.flux[cells[1]] = {std::stod(cells[2]), std::stod(cells[3])};
    }
  }
  return v;
}

Views render(const std::shared_ptr<Scene>& scene, double half, const std::string& text, int sun, bool periodic = true) {
  PlatformKit kit;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(kit.make(text));
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(sun * kDegree, 0), 0, Curve::constant(2)});
  JobOptions job;
  job.progress = false;
  job.pipeline.max_nodes = 64;
  if (periodic) job.periodic = Periodic{{-half, -half}, {2 * half, 2 * half}};
  run_job(scene, sources, sensors, job);
  return views_of(kit.shots.at(0));
}

// Erectophile discs of radius r in a layer of 2 m, leaf area index 3.
std::shared_ptr<Scene> canopy(double half, double r, double rho, double tau, double soil, uint64_t layout = 7) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {test::material("leaf", test::lambert(rho, tau)), test::material("soil", test::lambert(soil))};
  scene->primitives = {{"disc", PrimitiveKind::disk, {r, 0}, 0},
                       {"ground", PrimitiveKind::plane, {2 * half, 2 * half}, 1}};
  Group root;
  Pcg32 random(layout);
  const int count = static_cast<int>(3 * 4 * half * half / (kPi * r * r));
  for (int i = 0; i < count; ++i) {
    double zenith = 0;
    do zenith = random.uniform() * kPi / 2;
    while (random.uniform() * 2 >= 1 - std::cos(2 * zenith));
    Placement p;
    p.kind = TargetKind::primitive;
    p.to_parent = rotation({0, 0, 1}, 2 * kPi * random.uniform()) * rotation({1, 0, 0}, zenith);
    p.to_parent.b = {half * (2 * random.uniform() - 1), half * (2 * random.uniform() - 1),
                     r + (2 - 2 * r) * random.uniform()};
    root.placements.push_back(p);
  }
  Placement ground;
  ground.kind = TargetKind::primitive;
  ground.target = 1;
  root.placements.push_back(ground);
  scene->groups.push_back(std::move(root));
  check_scene(*scene, "canopy");
  return scene;
}

TEST(Rami, BareLambertGroundHasItsReflectanceEverywhere) {
  auto scene = canopy(1, 1, 0.5, 0.4, 0.3);
  scene->groups[0].placements.erase(scene->groups[0].placements.begin(), scene->groups[0].placements.end() - 1);
  const Views v = render(scene, 1, instrument(1, 0.5, 30, 0.3, 16), 30);
  ASSERT_EQ(v.principal.size(), 76u);
  for (const auto& [zenith, value] : v.principal) {
    EXPECT_NEAR(value[0], 0.3, 1e-6) << zenith;
    EXPECT_NEAR(value[2], 0.3, 1e-6) << zenith;
  }
  EXPECT_NEAR(v.flux.at("black_sky_albedo")[0], 0.3, 1e-6);
  EXPECT_NEAR(v.flux.at("transmitted_to_ground")[0], 1, 1e-6);
  EXPECT_NEAR(v.flux.at("absorbed_by_canopy")[0], 0, 1e-6);
}

// Regression: a ground of reflectance 0 lost its fluxes without a word, and `planes: []` was refused.
TEST(Rami, ABlackGroundHasItsFluxesAlone) {
  // Leaves that only absorb: what comes down is the sum over their shadows, which a sun straight from above shows as
  // the area that no disc covers; nothing comes up. The same light over a grey ground, where nothing comes back down.
  auto scene = canopy(2, 0.2, 0, 0, 0);
  const std::string alone = instrument(2, 2, 0, 0, 1 << 12) + "planes: []\n";
  const Views black = render(scene, 2, alone, 0);
  EXPECT_TRUE(black.principal.empty());
  ASSERT_EQ(black.flux.size(), 4u);
  EXPECT_EQ(black.flux.at("black_sky_albedo")[0], 0);
  int open = 0;
  constexpr int n = 500;  // known to some 2e-4
  const Tracer tracer(scene, Periodic{{-2, -2}, {4, 4}});
  TraceStatistics statistics;
  const std::vector<double> far(n, std::numeric_limits<double>::infinity());
  for (int i = 0; i < n; ++i) {
    std::vector<Ray> up;
    std::vector<uint8_t> blocked(n);
    for (int j = 0; j < n; ++j) up.push_back({{-2 + 4 * (i + 0.5) / n, -2 + 4 * (j + 0.5) / n, 1e-3}, {0, 0, 1}, 0});
    tracer.occluded(up, far, blocked, true, statistics);
    open += static_cast<int>(std::count(blocked.begin(), blocked.end(), 0));
  }
  const auto [down, error] = black.flux.at("transmitted_to_ground");
  EXPECT_NEAR(down, 1.0 * open / (n * n), 4.5 * error + 1e-3);
  EXPECT_LT(4.5 * error, 0.05) << "a tenth would not be seen";
  EXPECT_EQ(black.flux.at("absorbed_by_ground")[0], down);
  EXPECT_EQ(black.flux.at("absorbed_by_canopy")[0], 1 - down);
  scene->materials[1] = test::material("soil", test::lambert(0.5));
  const Views grey = render(scene, 2, instrument(2, 2, 0, 0.5, 1 << 12) + "planes: []\n", 0);
  EXPECT_NEAR(grey.flux.at("transmitted_to_ground")[0], down,
              4.5 * std::hypot(error, grey.flux.at("transmitted_to_ground")[1]));
  EXPECT_NEAR(grey.flux.at("absorbed_by_ground")[0], 0.5 * grey.flux.at("transmitted_to_ground")[0], 1e-9);
}

TEST(Rami, RefusesWhatCannotBe) {
  const auto scene = canopy(2, 0.2, 0, 0, 0);
  const std::string text = instrument(2, 2, 0, 0.3, 4);
  EXPECT_THAT(message_of([&] { render(scene, 2, text + "planes: []\nby_reciprocity: true\n", 0); }),
              testing::HasSubstr("no plane is listed"));
  EXPECT_THAT(message_of([&] { render(scene, 2, instrument(2, 2, 0, 1.5, 4), 0); }),
              testing::HasSubstr("not between 0 and 1"));
}

TEST(Rami, NothingIsLostOverAWhiteGround) {
  // Leaves 0.5 / 0.5 over a ground that reflects all: the albedo is 1, and nothing is absorbed anywhere.
  const Views v = render(canopy(2, 0.1, 0.5, 0.5, 1), 2, instrument(2, 2, 20, 1, 512) + "planes: []\n", 20);
  const auto albedo = v.flux.at("black_sky_albedo");
  EXPECT_NEAR(albedo[0], 1, 4 * albedo[1] + 1e-3);
}

TEST(Rami, ViewsByReciprocityAreTheViews) {
  // The same canopy in both modes: every view within its combined errors, and a mean that would tell 1 %.
  const auto scene = canopy(2, 0.1, 0.4957, 0.4409, 0.159);
  const Views direct = render(scene, 2, instrument(2, 2, 30, 0.159, 1024) + "planes: [principal]\n", 30);
  const Views shared = render(
      scene, 2, instrument(2, 2, 30, 0.159, 128) + "by_reciprocity: true\nstrata: 16\nplanes: [principal]\n", 30);
  ASSERT_EQ(shared.principal.size(), 76u);
  double sum = 0, variance = 0;
  for (const auto& [zenith, value] : direct.principal) {
    const auto& other = shared.principal.at(zenith);
    const double error = std::hypot(value[1], other[1]);
    EXPECT_NEAR(other[0], value[0], 4.5 * error) << zenith;
    // What was scattered once: both know it better than all of it.
    EXPECT_NEAR(other[2], value[2], 4.5 * error) << zenith;
    sum += other[0] / value[0] - 1;
    variance += error * error / (value[0] * value[0]);
  }
  // Views of the second mode share paths: their errors count as one.
  std::printf("reciprocity: mean difference %+.2f %%, error of one view %.2f %%\n", 100 * sum / 76,
              100 * std::sqrt(variance / 76));
  EXPECT_LT(std::fabs(sum / 76), 0.01);
}

// Bounds stand in one place, the table of sample_scenes/rami_hom03/expect.md, which says what was measured beside them:
// mean difference over all views, and that of one view, as shares.
struct Bounds {
  double mean = 0, view = 0;
};
Bounds bounds_of(const std::string& name) {
  std::ifstream in(SUITE_SOURCE_DIR "/sample_scenes/rami_hom03/expect.md");
  std::string line;
  while (std::getline(in, line)) {
    if (line.rfind("| " + name + " |", 0) != 0) continue;
    std::vector<double> percents;  // measured mean, its bound, measured view, its bound
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, '|');)
      if (double percent = 0; std::sscanf(cell.c_str(), "%lf %%", &percent) == 1) percents.push_back(percent);
    if (percents.size() != 4) break;
    EXPECT_LT(std::fabs(percents[0]), percents[1]) << line;
    EXPECT_LT(std::fabs(percents[2]), percents[3]) << line;
    return {percents[1] / 100, percents[3] / 100};
  }
  ADD_FAILURE() << "expect.md has no row of four percents for " << name;
  return {};
}

struct View {
  double zenith, brf, std_dev;
};
std::vector<View> table_of(const std::string& name) {
  std::ifstream in(SUITE_TEST_DATA "/canopy/" + name + ".csv");
  EXPECT_TRUE(in.is_open()) << name;
  std::string line;
  std::getline(in, line);
  std::vector<View> views;
  View v{};
  while (std::getline(in, line))
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &v.zenith, &v.brf, &v.std_dev) == 3) views.push_back(v);
  EXPECT_EQ(views.size(), 76u) << name;
  return views;
}

// The octagons of tests/data/canopy/tile_discs.csv, as scripts/canopy_reference makes them.
Mesh tile_leaves() {
  std::ifstream in(SUITE_TEST_DATA "/canopy/tile_discs.csv");
  std::string line;
  std::getline(in, line);
  std::vector<Vec3> corners;
  std::vector<uint32_t> triangles;
  Vec3 c, n;
  while (std::getline(in, line)) {
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &c.x, &c.y, &c.z, &n.x, &n.y, &n.z) != 6) continue;
    const Vec3 a = normalized(Vec3{-n.y, n.x, 0}), b = cross(n, a);
    const auto first = static_cast<uint32_t>(corners.size());
    for (int k = 0; k < 8; ++k) corners.push_back(c + (a * std::cos(k * kPi / 4) + b * std::sin(k * kPi / 4)) * 0.1);
    for (uint32_t k = 1; k < 7; ++k) triangles.insert(triangles.end(), {first, first + k, first + k + 1});
  }
  return test::mesh_of(corners, triangles, 0);
}

struct Difference {
  double mean = 0, largest = 0, own = 0;  // relative; own: mean standard error
  double worst_z = 0, worst_at = 0;       // of the worst view, in combined standard errors; its zenith, degrees
};
Difference tile_against(const std::vector<View>& reference, double rho, int paths) {
  const double half = 1.5;
  auto scene = test::scene_of({tile_leaves()}, {test::material("leaf", test::lambert(rho, 0.4409)),
                                                test::material("soil", test::lambert(0.159))});
  scene->primitives = {{"ground", PrimitiveKind::plane, {2 * half, 2 * half}, 1}};
  Placement ground;
  ground.kind = TargetKind::primitive;
  scene->groups[0].placements.push_back(ground);
  check_scene(*scene, "tile");
  const Views mine =
      render(scene, half,
             instrument(half, 2, 20, 0.159, paths) + "by_reciprocity: true\nstrata: 32\nplanes: [principal]\n", 20);
  Difference d;
  for (const View& v : reference) {
    const auto& value = mine.principal.at(v.zenith);
    const double difference = value[0] / v.brf - 1;
    d.mean += difference / 76, d.own += value[1] / value[0] / 76;
    d.largest = std::max(d.largest, std::fabs(difference));
    const double z = std::fabs(value[0] - v.brf) / std::hypot(value[1], v.std_dev);
    if (z > d.worst_z) d.worst_z = z, d.worst_at = v.zenith;
  }
  std::printf(
      "tile, leaf %.4f: mean difference %+.3f %%, largest %.2f %%, worst view %.1f combined standard errors at %g deg, "
      "own "
      "%.2f %%\n",
      rho, 100 * d.mean, 100 * d.largest, d.worst_z, d.worst_at, 100 * d.own);
  return d;
}

// The same leaves, polygon by polygon, in another program (tests/data/canopy/README.md): no layout stands between them.
TEST(Rami, ACanopyIsThatOfAnotherProgram) {
  const bool thorough = std::getenv("SUITE_LONG") != nullptr;
  const std::vector<View> reference = table_of("tile_nir_20");
  const Bounds bounds = bounds_of(thorough ? "tile, long" : "tile");
  const Difference same = tile_against(reference, 0.4957, thorough ? 256 : 16);
  EXPECT_LT(same.worst_z, 4.5);
  EXPECT_LT(std::fabs(same.mean), bounds.mean);
  EXPECT_LT(same.largest, bounds.view);
  // Negative control: leaves that reflect 0.02 less are told apart.
  const Difference darker = tile_against(reference, 0.4757, thorough ? 256 : 16);
  EXPECT_GT(std::fabs(darker.mean), bounds.mean);
}

// HOM03 against the table of another tracer, whose random discs are not these: a tile of 60,000 discs lets through by
// chance half a percent more or less of the ground. The mean of several layouts is compared, and the spread of one,
// which the table's single layout has too, is printed beside. In the long run only.
struct Hom03 {
  std::string file;
  int sun;
  double rho, tau, soil;
};
void PrintTo(const Hom03& h, std::ostream* out) { *out << h.file; }
// One view over several layouts.
struct Layouts {
  int n = 0;
  double sum = 0, square = 0, variance = 0;  // of values, of their squares, of their own errors
  void add(double value, double standard_error) {
    ++n, sum += value, square += value * value, variance += standard_error * standard_error;
  }
  double mean() const { return sum / n; }
  double error() const { return std::sqrt(variance) / n; }  // of the mean, by the paths alone
  double spread() const {                                   // of one layout, paths and layout together
    return n > 1 ? std::sqrt(std::max(0.0, square - sum * sum / n) / (n - 1)) : 0;
  }
};
class Hom03Canopy : public testing::TestWithParam<Hom03> {};

TEST_P(Hom03Canopy, AgreesWithAnotherTracer) {
  const Hom03 h = GetParam();
  if (!std::getenv("SUITE_LONG")) GTEST_SKIP() << "in the long run";
  const Bounds bounds = bounds_of(h.file);
  const std::string text = instrument(6.25, 2, h.sun, h.soil, 16);
  const double radius = h.file.find("r005") != std::string::npos ? 0.05 : 0.1;
  const int layouts = 6;
  std::map<double, Layouts> views;
  for (int layout = 0; layout < layouts; ++layout) {
    const Views v = render(canopy(6.25, radius, h.rho, h.tau, h.soil, 7 + static_cast<uint64_t>(layout)), 6.25,
                           text + "by_reciprocity: true\nstrata: 32\nplanes: [principal]\n", h.sun);
    for (const auto& [zenith, value] : v.principal) views[zenith].add(value[0], value[1]);
  }
  double sum = 0, worst = 0, worst_at = 0, own = 0, spread = 0;
  for (const View& v : table_of(h.file)) {
    const Layouts& mine = views.at(v.zenith);
    sum += mine.mean() / v.brf - 1;
    own += mine.error() / v.brf / 76;
    spread += mine.spread() / v.brf / 76;
    if (std::fabs(v.zenith + h.sun) < 6) continue;  // the hot spot depends on the layout and the size of the discs
    const double difference = std::fabs(mine.mean() / v.brf - 1);
    if (difference > worst) worst = difference, worst_at = v.zenith;
  }
  std::printf(
      "%s: mean difference %+.2f %%, largest away from the hot spot %.2f %% at %.0f deg, own standard error %.2f %% "
      "(%d layouts; one differs from another by %.2f %% standard deviation)\n",
      h.file.c_str(), 100 * sum / 76, 100 * worst, worst_at, 100 * own, layouts, 100 * spread);
  EXPECT_LT(std::fabs(sum / 76), bounds.mean);
  EXPECT_LT(worst, bounds.view);
}
INSTANTIATE_TEST_SUITE_P(Rami, Hom03Canopy,
                         testing::Values(Hom03{"hom03_ere_nir_20_r005", 20, 0.4957, 0.4409, 0.159},
                                         Hom03{"hom03_ere_nir_50_r005", 50, 0.4957, 0.4409, 0.159},
                                         Hom03{"hom03_ere_red_20_r005", 20, 0.0546, 0.0149, 0.127},
                                         Hom03{"hom03_ere_red_50", 50, 0.0546, 0.0149, 0.127}),
                         [](const auto& one) { return one.param.file; });

// A cell that repeats itself against 21 x 21 copies of it, seen in the middle one: the same discs, so that the paths
// differ only in how they go on.
TEST(Rami, PeriodicCellIsAGridOfTiles) {
  const bool thorough = std::getenv("SUITE_LONG") != nullptr;
  const double half = 1.5;
  auto cell = canopy(half, 0.1, 0.4957, 0.4409, 0.159);
  auto tiles = std::make_shared<Scene>(*cell);
  tiles->groups.push_back(tiles->groups[0]);
  tiles->groups[0].placements.clear();
  constexpr int side = 10;
  for (int x = -side; x <= side; ++x)
    for (int y = -side; y <= side; ++y) {
      Placement p;
      p.kind = TargetKind::group;
      p.target = 1;
      p.to_parent = translation({2 * half * x, 2 * half * y, 0});
      tiles->groups[0].placements.push_back(p);
    }
  check_scene(*tiles, "tiles");
  const std::string text =
      instrument(half, 2, 20, 0.159, thorough ? 1024 : 32) + "by_reciprocity: true\nstrata: 16\nplanes: [principal]\n";
  const Views a = render(cell, half, text, 20), b = render(tiles, half, text, 20, false);
  double sum = 0, error = 0;
  int n = 0;
  for (const auto& [zenith, value] : a.principal) {
    if (std::fabs(zenith) > 60) continue;  // from the middle tile, lower views leave the grid at its sides
    const auto& other = b.principal.at(zenith);
    EXPECT_NEAR(other[0], value[0], 4.5 * std::hypot(value[1], other[1])) << zenith;
    sum += other[0] / value[0] - 1;
    error += value[1] / value[0];
    ++n;
  }
  std::printf("tiles against the period: mean difference %+.3f %%, standard error of a view %.2f %%\n", 100 * sum / n,
              100 * error / n);
  EXPECT_LT(std::fabs(sum / n), 0.003);
}

}  // namespace
}  // namespace suite::rami_test
