// Tiles under a limit of memory, and packed scenes that several readers share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "base/mapped_file.h"
#include "base/parallel.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "support/message_of.h"
#include "support/temp_folder.h"
#include "trace/tracer.h"

namespace suite::format_scene_hdf_tile_memory_test {
namespace {

constexpr int kTowns = 12;
constexpr uint32_t kEdge = 60;  // vertices along a side

// A wavy sheet in every town, 10 km apart, and a mast of which all towns have one.
Scene towns() {
  Scene s;
  s.groups = {{"world", {}}};
  const auto add = [&](const std::string& name, double size, double phase) {
    Mesh m;
    m.name = name;
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (uint32_t j = 0; j < kEdge; ++j)
      for (uint32_t i = 0; i < kEdge; ++i)
        for (const double x : {size * i, size * j, size * std::sin(0.3 * i + phase) * std::cos(0.2 * j)})
          positions.push_back(static_cast<float>(x));
    positions.push_back(0);
    for (uint32_t j = 0; j + 1 < kEdge; ++j)
      for (uint32_t i = 0; i + 1 < kEdge; ++i) {
        const uint32_t v = j * kEdge + i;
        indices.insert(indices.end(), {v, v + 1, v + kEdge + 1, v, v + kEdge + 1, v + kEdge});
      }
    m.positions = std::move(positions), m.indices = std::move(indices);
    m.parts = {{"", 0, static_cast<uint32_t>(m.triangle_count()), kNone}};
    s.meshes.push_back(m);
  };
  add("mast", 0.1, 0);
  for (int k = 0; k < kTowns; ++k) {
    add(strf("town %d", k), 10, k);
    Placement p, mast;
    p.target = static_cast<uint32_t>(k) + 1;
    p.to_parent = translation({k * 1e4, 0, 0});
    mast.to_parent = translation({k * 1e4 + 100, 100, 30});
    s.groups[0].placements.push_back(p);
    s.groups[0].placements.push_back(mast);
  }
  s.bounds = scene_bounds(s);
  return s;
}

std::shared_ptr<const Scene> load(const std::string& path, std::shared_ptr<SpillFile> spill = nullptr) {
  SceneNeeds needs;
  needs.later_from = 0;
  needs.spill = std::move(spill);
  return std::make_shared<const Scene>(read_scene(path, {}, needs));
}

// Rays that jump from town to town, from many threads; every fourth runs along all towns.
std::vector<Hit> shoot(const Tracer& tracer, size_t threads_at_work, size_t count = 6000) {
  std::vector<Hit> hits(count);
  std::atomic<size_t> next = 0;
  on_threads(static_cast<int>(threads_at_work), [&] {
    const FlushDenormals flush;
    const AtWork work(tracer);
    constexpr size_t kMany = 50;
    for (size_t first; (first = next.fetch_add(kMany)) < hits.size();) {
      std::vector<Ray> rays;
      for (size_t k = first; k < first + kMany; ++k) {
        const double town = static_cast<double>(k * 7 % kTowns) * 1e4, x = static_cast<double>(k * 13 % 590),
                     y = static_cast<double>(k * 29 % 590);
        rays.push_back(k % 4 ? Ray{{town + x, y, 500}, {0, 0, -1}, 0}
                             : Ray{{-100, y, 12}, normalized(Vec3{1, 0, -1e-4}), 0});
      }
      TraceStatistics statistics;
      tracer.nearest(rays, std::span(hits).subspan(first, kMany), false, statistics);
    }
  });
  return hits;
}

void expect_same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  size_t met = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].object, b[k].object) << k;
    met += a[k].hit();
    if (!a[k].hit()) continue;
    ASSERT_EQ(a[k].triangle, b[k].triangle) << k;
    ASSERT_EQ(a[k].position, b[k].position) << k;
  }
  EXPECT_GT(met, a.size() / 2);
}

TEST(TileMemory, HitsAreTheSameAndTilesGo) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  const std::vector<Hit> free = shoot(Tracer(load(folder / "towns.h5")), 4);
  const TileForecast all = Tracer(load(folder / "towns.h5"), {}, {}, nullptr, {SIZE_MAX, {}}).forecast();
  ASSERT_GE(all.tiles, size_t{kTowns});
  EXPECT_GT(all.geometry, uint64_t{kTowns} * kEdge * kEdge * 12);
  for (const double tiles : {3.0, 1.2}) {
    const auto limit = static_cast<uint64_t>(tiles * static_cast<double>(all.largest));
    std::string told;
    const Tracer tracer(load(folder / "towns.h5"), {}, {}, nullptr, {limit, [&](const std::string& t) { told = t; }});
    EXPECT_EQ(tracer.tiles_built(), 0u);
    expect_same(shoot(tracer, 9), free);
    const TileUse use = tracer.tile_use();
    EXPECT_EQ(use.built - use.dropped, tracer.tiles_built());
    EXPECT_GT(use.dropped, uint64_t{kTowns} / 2);
    EXPECT_LT(use.most_tiles, all.tiles);
    EXPECT_EQ(told, "");
  }
  // With room for all none goes.
  const Tracer roomy(load(folder / "towns.h5"), {}, {}, nullptr, {uint64_t{1} << 40, {}});
  expect_same(shoot(roomy, 9), free);
  EXPECT_EQ(roomy.tile_use().dropped, 0u);
  EXPECT_EQ(roomy.tiles_built(), roomy.tile_use().built);
}

// Rays that cross the boxes of tiles, which a mast makes high, but none of the boxes of what is in them.
TEST(TileMemory, TilesAreNotBuiltAgainForRaysThatMissTheirHulls) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  const uint64_t largest = Tracer(load(folder / "towns.h5"), {}, {}, nullptr, {SIZE_MAX, {}}).forecast().largest;
  const Tracer tracer(load(folder / "towns.h5"), {}, {}, nullptr, {3 * largest, {}});
  const FlushDenormals flush;
  TraceStatistics statistics;
  std::vector<Hit> hits(kTowns);
  std::vector<Ray> down;
  for (int k = 0; k < kTowns; ++k) down.push_back({{k * 1e4 + 300, 300, 500}, {0, 0, -1}, 0});
  tracer.nearest(down, hits, false, statistics);
  const uint64_t before = tracer.tile_use().built;
  EXPECT_GE(before, uint64_t{kTowns});
  const auto along = [&](double y, double z) {
    std::vector<Ray> rays;
    for (size_t k = 0; k < hits.size(); ++k)
      rays.push_back({{-100, y + 20.0 * static_cast<double>(k), z}, {1, 0, 0}, 0});
    tracer.nearest(rays, hits, false, statistics);
  };
  along(150, 20);
  for (const Hit& hit : hits) EXPECT_FALSE(hit.hit());
  EXPECT_EQ(tracer.tile_use().built, before);
  along(150, 9.5);  // the sheets are 10 m high
  EXPECT_GT(tracer.tile_use().built, before);
}

TEST(TileMemory, WhatIsLargerThanTheLimitIsToldOnceAndHeld) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  constexpr size_t kRays = 1500;  // in groups of 50, of which each needs all tiles built again
  const std::vector<Hit> free = shoot(Tracer(load(folder / "towns.h5")), 1, kRays);
  std::vector<std::string> told;
  const Tracer tracer(load(folder / "towns.h5"), {}, {}, nullptr,
                      {4096, [&](const std::string& t) { told.push_back(t); }});
  expect_same(shoot(tracer, 3, kRays), free);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0], testing::HasSubstr("more than the 4.1 kB"));
}

// What was unpacked once is not unpacked again by whoever shares the file, and another scene keeps out of it.
TEST(PackedScene, IsUnpackedOnceForAllWhoShareTheFile) {
  TempFolder folder;
  Compression packed;
  packed.add("deflate");
  const Scene s = towns();
  write_scene(s, {}, folder / "plain.h5");
  write_scene(s, {}, folder / "packed.h5", packed);
  const auto spill = std::make_shared<SpillFile>(folder.path());
  const auto first = load(folder / "packed.h5", SpillFile::open(spill->address()));
  const auto second = load(folder / "packed.h5", SpillFile::open(spill->address()));
  expect_same(shoot(Tracer(first), 1), shoot(Tracer(load(folder / "plain.h5")), 1));
  for (size_t k = 0; k < s.meshes.size(); ++k) {
    EXPECT_EQ(first->meshes[k].positions, s.meshes[k].positions);
    EXPECT_EQ(second->meshes[k].indices, s.meshes[k].indices);
  }
  // What one process wrote there afterwards the other reads: it is one memory.
  const float changed = 77;
  const auto* at = reinterpret_cast<const std::byte*>(&changed);
  const auto arrays = SpillFile::open(spill->address());
  arrays->reserve(8 + 4 * s.meshes.size());
  arrays->write_at(arrays->reserve(1), {at, sizeof(changed)});
  EXPECT_EQ(first->meshes[0].positions[0], changed);
  EXPECT_EQ(second->meshes[0].positions[0], changed);
  Scene fewer = s;
  fewer.meshes[1].indices = std::vector<uint32_t>(s.meshes[1].indices.begin(), s.meshes[1].indices.end() - 3);
  --fewer.meshes[1].parts[0].triangle_count;
  write_scene(fewer, {}, folder / "other.h5", packed);
  EXPECT_EQ(load(folder / "other.h5", SpillFile::open(spill->address()))->meshes[0].positions, s.meshes[0].positions);
}

// Arrays that a plain file says to have beyond its end are refused, so that no mapped page is missing.
TEST(PlainScene, ThatWasCutIsRefused) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  const size_t size = file_size(folder / "towns.h5");
  for (const size_t left : {size - 1, size - 4096, size / 2}) {
    std::filesystem::resize_file(folder / "towns.h5", left);
    EXPECT_THAT(message_of([&] { load(folder / "towns.h5"); }), testing::HasSubstr("towns.h5")) << left;
  }
}

}  // namespace
}  // namespace suite::format_scene_hdf_tile_memory_test
