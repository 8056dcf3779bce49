// Ways through voxel grids: every cell in its order and length against planes in long double, over 1e5 cells, too;
// whole ways and parts of them against sums over cells.
#include "transport/media/grid_walk.h"

#include <gtest/gtest.h>

#include <random>

#include "transport/media/field.h"

namespace suite::grid_walk_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Random = std::mt19937;
double uniform(Random& random, double low, double high) { return low + (high - low) * (random() / 4294967296.0); }

PlacedGrid placed(const VoxelGrid& g, const Affine3& to_world = {}) {
  PlacedGrid p;
  p.grid = &g;
  p.place = to_world * g.to_local;
  p.to_index = p.place.inverse();
  p.blocks = GridBlocks::of(g);
  return p;
}

VoxelGrid empty_grid(std::array<uint32_t, 3> cells, const Affine3& to_local) {
  VoxelGrid g;
  g.cells = cells;
  g.to_local = to_local;
  g.media = {0};
  g.density.assign(g.size(), 0);
  return g;
}

// Distances at which a ray crosses the planes of a grid's cells, ascending.
std::vector<long double> crossings(const PlacedGrid& p, Vec3 origin, Dir direction, long double end) {
  const Vec3 o = p.to_index.point(origin), d = p.to_index.vector(direction);
  std::vector<long double> all;
  for (int a = 0; a < 3; ++a)
    for (uint32_t i = 0; d[a] != 0 && i <= p.grid->cells[static_cast<size_t>(a)]; ++i) {
      const long double t = (static_cast<long double>(i) - o[a]) / static_cast<long double>(d[a]);
      if (t > 0 && t < end) all.push_back(t);
    }
  std::sort(all.begin(), all.end());
  return all;
}

// Of the densities that pass at a place of the ray; nothing outside of the grid.
std::optional<size_t> cell_at(const PlacedGrid& p, Vec3 origin, Dir direction, long double t) {
  const Vec3 o = p.to_index.point(origin), d = p.to_index.vector(direction);
  size_t cell = 0;
  for (int a = 2; a >= 0; --a) {
    const long double x = std::floor(o[a] + t * d[a]);
    const uint32_t n = p.grid->cells[static_cast<size_t>(a)];
    if (!(x >= 0 && x < n)) return std::nullopt;
    cell = cell * n + static_cast<size_t>(x);
  }
  return cell;
}

TEST(GridWalk, PlanesDoNotDriftOverManyCells) {
  Random random(7);
  VoxelGrid g = empty_grid({100000, 8, 8}, scaling({0.7, 0.9, 1.1}));
  for (float& d : g.density) d = static_cast<float>(uniform(random, 0.1, 1));
  const PlacedGrid p = placed(g);
  for (const bool back : {false, true}) {
    const Vec3 from{-3.1, 0.33, 8.6}, to{70003.7, 6.9, 0.05};
    const Vec3 origin = back ? to : from;
    const Dir direction = normalized(back ? from - to : to - from);
    const double end = length(to - from);
    const std::vector<long double> exact = crossings(p, origin, direction, end);
    // A plane: one subtraction, a reciprocal and a product; then up to 7 additions.
    constexpr long double kBound = 10 * 0x1p-53L;
    size_t cells = 0;
    long double worst = 0, added = exact[0], worst_added = 0;
    const long double gap = 1 / static_cast<long double>(std::fabs(p.to_index.vector(direction).x));
    GridWalk walk;
    ASSERT_TRUE(walk.start(p, origin, direction, 0, 0, end));
    double sum = static_cast<double>(exact[0]);
    for (; !walk.ended(); walk.advance(), ++cells) {
      ASSERT_LT(cells + 1, exact.size());
      worst = std::max(worst, std::fabs(walk.begin() - exact[cells]) / exact[cells]);
      worst = std::max(worst, std::fabs(walk.end() - exact[cells + 1]) / exact[cells + 1]);
      // What the bound must not let pass: a plane's distance that is added up all the way.
      sum += static_cast<double>(gap), added += gap;
      worst_added = std::max(worst_added, std::fabs(sum - added) / added);
    }
    EXPECT_EQ(cells + 1, exact.size());
    EXPECT_GT(cells, 100000u);
    EXPECT_LT(worst, kBound);
    EXPECT_GT(worst_added, 10 * kBound);
  }
}

// A grid with empty blocks, blocks alike and blocks of all kinds of cells.
VoxelGrid patchy_grid(Random& random, bool plain) {
  std::array<uint32_t, 3> cells;
  for (uint32_t& n : cells) n = 1 + random() % 40;
  VoxelGrid g =
      empty_grid(cells, translation({uniform(random, -3, 3), uniform(random, -3, 3), 1}) * scaling({0.5, 1.25, 2}));
  if (!plain) g.media = {0, 1}, g.kind.assign(g.size(), 0), g.temperature.assign(g.size(), 0);
  std::array<uint32_t, 125> kinds;
  for (uint32_t& k : kinds) k = random() % 4;
  size_t cell = 0;
  for (uint32_t k = 0; k < cells[2]; ++k)
    for (uint32_t j = 0; j < cells[1]; ++j)
      for (uint32_t i = 0; i < cells[0]; ++i, ++cell) {
        const uint32_t what = kinds[i / 8 + 5 * (j / 8 + 5 * (k / 8))];
        if (what == 0) continue;
        const bool each = what > 1;
        g.density[cell] = each ? (random() % 3 ? static_cast<float>(uniform(random, 0, 2)) : 0) : 0.5f;
        if (plain) continue;
        g.kind[cell] = each ? random() % 2 : 1;
        g.temperature[cell] = each && random() % 2 ? 300.0f : 0.0f;
      }
  return g;
}

struct Way {
  Vec3 origin;
  Dir direction;
  double length;
};
// Through the middle of a grid, or along its cells; from outside or inside, to its end or to somewhere in it.
Way any_way(Random& random, const PlacedGrid& p) {
  const auto somewhere = [&](double margin) {
    Vec3 at;
    for (int a = 0; a < 3; ++a) {
      const double n = p.grid->cells[static_cast<size_t>(a)];
      at[a] = uniform(random, -margin * n, (1 + margin) * n);
    }
    return p.place.point(at);
  };
  Way way{somewhere(random() % 2 ? 1 : 0), {}, random() % 2 ? kInfinity : uniform(random, 0.1, 30)};
  way.direction = normalized(somewhere(0) - way.origin);
  if (random() % 4 == 0) {
    const int level = static_cast<int>(random() % 3);
    way.direction[level] = 0;
    if (random() % 2) way.direction[(level + 1) % 3] = 0;
    way.direction = normalized(way.direction);
  }
  return way;
}

// Of each medium, by sums over cells.
std::array<double, 2> depths(const PlacedGrid& p, const Way& way) {
  std::vector<long double> at = crossings(p, way.origin, way.direction, way.length);
  at.insert(at.begin(), 0);
  if (way.length < kInfinity) at.push_back(way.length);
  std::array<double, 2> sum{};
  for (size_t i = 0; i + 1 < at.size(); ++i)
    if (const auto cell = cell_at(p, way.origin, way.direction, 0.5L * (at[i] + at[i + 1])))
      sum[p.medium(*cell)] += static_cast<double>(p.grid->density[*cell] * (at[i + 1] - at[i]));
  return sum;
}

std::unique_ptr<Scene> scene_of(std::vector<VoxelGrid> grids) {
  auto scene = std::make_unique<Scene>();
  scene->media.resize(2);
  scene->grids = std::move(grids);
  for (uint32_t i = 0; i < scene->grids.size(); ++i) scene->volumes.push_back({i, {}});
  return scene;
}

TEST(GridWalk, StretchesAreThoseOfTheCells) {
  Random random(3);
  const SpectralState state;
  size_t met = 0;
  for (int n = 0; n < 1500; ++n) {
    const bool plain = random() % 2;
    const auto scene = scene_of({patchy_grid(random, plain)});
    const PlacedGrid p = placed(scene->grids[0]);
    const VolumeField field(*scene, state);
    const Way way = any_way(random, p);
    const std::array<double, 2> expected = depths(p, way);
    met += expected[0] + expected[1] > 0;
    FieldWalk walk;
    // Cell by cell; each is where it says.
    std::array<double, 2> sum{};
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    for (double last = 0; walk.next(); last = walk.end()) {
      ASSERT_GE(walk.begin(), last);
      ASSERT_GE(walk.end(), walk.begin());
      ASSERT_EQ(walk.contents().size(), 1u);
      const Constituent c = walk.contents()[0];
      sum[c.medium] += c.density * (walk.end() - walk.begin());
      if (walk.end() - walk.begin() < 1e-9) continue;
      const auto cell = cell_at(p, way.origin, way.direction, 0.5L * (walk.begin() + walk.end()));
      ASSERT_TRUE(cell);
      EXPECT_EQ(c.density, double{p.grid->density[*cell]});
      EXPECT_EQ(c.medium, p.medium(*cell));
      EXPECT_EQ(c.kelvin, p.kelvin(*cell));
    }
    // And in one go.
    std::array<double, 2> whole{};
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    walk.add_depths(whole);
    for (size_t m = 0; m < 2; ++m) {
      EXPECT_NEAR(sum[m], expected[m], 1e-11) << "case " << n;
      EXPECT_NEAR(whole[m], expected[m], 1e-11) << "case " << n;
    }
  }
  EXPECT_GT(met, 750u);
}

TEST(GridWalk, StridesEndWhereTheDepthIsReached) {
  Random random(5);
  const SpectralState state;
  int reached = 0, passed = 0;
  for (int n = 0; n < 1000; ++n) {
    const auto scene = scene_of({patchy_grid(random, true)});
    const PlacedGrid p = placed(scene->grids[0]);
    const VolumeField field(*scene, state);
    const Way way = any_way(random, p);
    const double whole = depths(p, way)[0], most = uniform(random, 0, 1.2) * whole;
    FieldWalk walk;
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    if (!(whole > 0)) continue;
    ASSERT_EQ(walk.lone_medium(), 0u);
    const double mass = walk.pass(most);
    EXPECT_LE(mass, most);
    // The stretch that follows is where it becomes more, and the way up to there is what was passed.
    if (!walk.next()) {
      ++passed;
      EXPECT_NEAR(mass, whole, 1e-11);
      continue;
    }
    ++reached;
    EXPECT_GT(mass + walk.contents()[0].density * (walk.end() - walk.begin()), most);
    EXPECT_NEAR(depths(p, {way.origin, way.direction, walk.begin()})[0], mass, 1e-11);
    // On from the middle of the way, cells and strides in turn.
    double sum = mass;
    do {
      for (const Constituent& c : walk.contents()) sum += c.density * (walk.end() - walk.begin());
      sum += walk.pass(uniform(random, 0, 0.1) * whole);
    } while (walk.next());
    EXPECT_NEAR(sum, whole, 1e-11);
  }
  EXPECT_GT(reached, 300);
  EXPECT_GT(passed, 50);
}

TEST(GridWalk, SeveralGridsAddUp) {
  Random random(9);
  const SpectralState state;
  for (int n = 0; n < 300; ++n) {
    const auto scene = scene_of({patchy_grid(random, true), patchy_grid(random, true)});
    const VolumeField field(*scene, state);
    const Way way = any_way(random, field.placed()[0]);
    std::array<double, 2> expected{}, sum{}, whole{};
    for (const PlacedGrid& p : field.placed()) expected[0] += depths(p, way)[0];
    const uint32_t background = random() % 2 ? 1 : kNone;
    expected[1] = background == 1 ? std::min(way.length, kEndlessWay) : 0;
    FieldWalk walk;
    walk.start(field, way.origin, way.direction, way.length, background, 0);
    while (walk.next())
      for (const Constituent& c : walk.contents())
        sum[c.medium] += c.density * std::min(walk.end() - walk.begin(), kEndlessWay);
    walk.start(field, way.origin, way.direction, way.length, background, 0);
    walk.add_depths(whole);
    EXPECT_NEAR(sum[0], expected[0], 1e-11);
    EXPECT_NEAR(whole[0], expected[0], 1e-11);
    EXPECT_NEAR(sum[1], expected[1], 1e-12 * expected[1]);
    EXPECT_EQ(whole[1], expected[1]);
  }
}

TEST(GridWalk, PeriodicScenesRepeatTheirGrids) {
  Random random(13);
  const SpectralState state;
  const Periodic cell{{-2, 1}, {17, 19}};
  int met = 0;
  for (int n = 0; n < 60; ++n) {
    const auto scene = scene_of({patchy_grid(random, true)});
    const PlacedGrid p = placed(scene->grids[0]);
    const VolumeField field(*scene, state, cell);
    Way way = any_way(random, p);
    way.length = uniform(random, 1, 60);
    double expected = 0;
    for (int x = -15; x <= 15; ++x)
      for (int y = -15; y <= 15; ++y) {
        const Vec3 shift{x * cell.size.x, y * cell.size.y, 0};
        expected += depths(p, {way.origin + shift, way.direction, way.length})[0];
      }
    std::array<double, 2> sum{}, whole{};
    FieldWalk walk;
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    while (walk.next())
      for (const Constituent& c : walk.contents()) sum[c.medium] += c.density * (walk.end() - walk.begin());
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    walk.add_depths(whole);
    // Strides and cells in turn, where grids are alone.
    double strides = 0;
    walk.start(field, way.origin, way.direction, way.length, kNone, 0);
    for (;;) {
      if (walk.lone_medium() != kNone) strides += walk.pass(0.1 * expected);
      if (!walk.next()) break;
      for (const Constituent& c : walk.contents()) strides += c.density * (walk.end() - walk.begin());
    }
    met += expected > 0;
    EXPECT_NEAR(sum[0], expected, 1e-10) << "case " << n;
    EXPECT_NEAR(whole[0], expected, 1e-10) << "case " << n;
    EXPECT_NEAR(strides, expected, 1e-10) << "case " << n;
  }
  EXPECT_GT(met, 30);
}

TEST(GridBlocks, AreSharedAndHoldOnlyWhatDiffers) {
  VoxelGrid g = empty_grid({20, 9, 8}, {});  // 3 x 2 x 1 blocks
  g.density[3] = 1;                          // in the first block
  for (uint32_t k = 0; k < 8; ++k)           // all of the last block, 4 x 1 x 8 cells
    for (uint32_t i = 16; i < 20; ++i) g.density[i + 20 * (8 + 9 * k)] = 0.5f;
  const auto blocks = GridBlocks::of(g);
  EXPECT_EQ(GridBlocks::of(g), blocks);
  constexpr uint32_t kEmpty = GridBlocks::kEmpty;
  EXPECT_EQ(blocks->kind, (std::vector<uint32_t>{0, kEmpty, kEmpty, kEmpty, kEmpty, GridBlocks::kAlike}));
  EXPECT_EQ(blocks->densities.size(), 512u);
  EXPECT_EQ(blocks->densities[3], 1);
  // Cells of one density and two media, or two temperatures, differ.
  VoxelGrid media = empty_grid({8, 8, 8}, {});
  media.density.assign(512, 1);
  EXPECT_EQ(GridBlocks(media).kind, std::vector<uint32_t>{GridBlocks::kAlike});
  media.kind.assign(512, 0);
  media.kind[511] = 1;
  EXPECT_EQ(GridBlocks(media).kind, std::vector<uint32_t>{0});
  media.kind[511] = 0;
  media.temperature.assign(512, 0);
  media.temperature[100] = 290;
  EXPECT_EQ(GridBlocks(media).kind, std::vector<uint32_t>{0});
}

}  // namespace
}  // namespace suite::grid_walk_test
