// Geometry of a tile is read from the prepared scene when the first ray comes there, and not before.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "base/parallel.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "support/message_of.h"
#include "support/temp_folder.h"
#include "trace/tracer.h"

namespace suite::format_scene_hdf_tile_loading_test {
namespace {

constexpr int kTowns = 30;

// A block in every town, 10 km apart, each a mesh of its own and of another height.
Scene towns() {
  Scene s;
  s.groups = {{"world", {}}};
  for (int k = 0; k < kTowns; ++k) {
    Mesh m;
    m.name = strf("town %d", k);
    const float h = 10.0f + static_cast<float>(k);
    std::vector<float> positions;
    for (int v = 0; v < 8; ++v)
      positions.insert(positions.end(), {v & 1 ? 5.0f : -5.0f, v & 2 ? 5.0f : -5.0f, v & 4 ? h : 0.0f});
    positions.push_back(0);
    m.positions = std::move(positions);
    m.indices = {4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 1, 3, 7, 1, 7, 5};
    m.parts = {{"", 0, 6, kNone}};
    s.meshes.push_back(m);
    Placement p;
    p.target = static_cast<uint32_t>(k);
    p.to_parent = translation({k * 1e4, 0, 0});
    s.groups[0].placements.push_back(p);
  }
  s.bounds = scene_bounds(s);
  return s;
}

struct Loaded {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const LaterReads> later;
};
Loaded load(const std::string& path) {
  SceneNeeds needs;
  needs.later_from = 0;
  LoadReport report;
  Loaded l{std::make_shared<const Scene>(read_scene(path, {}, needs, &report)), nullptr};
  l.later = report.later;
  return l;
}
Hit down(const Tracer& tracer, double x) {
  const FlushDenormals flush;
  const Ray ray{{x + 1, 2, 7e5}, {0, 0, -1}, 0};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
  return hit;
}

TEST(TileLoading, ARayReadsTheTileItComesTo) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  const Loaded l = load(folder / "towns.h5");
  const Tracer tracer(l.scene), at_once(std::make_shared<const Scene>(towns()));
  ASSERT_EQ(tracer.tiles(), size_t{kTowns});
  EXPECT_EQ(tracer.triangles(), at_once.triangles());
  EXPECT_EQ(l.later->meshes_read, 0u);
  const Hit hit = down(tracer, 7e4), same = down(at_once, 7e4);
  ASSERT_TRUE(hit.hit());
  EXPECT_EQ(hit.position, same.position);
  EXPECT_NEAR(hit.position.z, 17, 1e-5);
  EXPECT_EQ(l.later->meshes_read, 1u);
  EXPECT_TRUE(l.scene->meshes[7].stored->here);
  EXPECT_FALSE(l.scene->meshes[8].stored->here);
  EXPECT_FALSE(down(tracer, 5e3).hit());  // between two towns
  EXPECT_EQ(l.later->meshes_read, 1u);
  std::atomic<int> right{0};
  parallel_for(0, 2000, 1, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      const Hit h = down(tracer, static_cast<double>(k % 10) * 1e4);
      right += h.hit() && std::fabs(h.position.z - 10 - static_cast<double>(k % 10)) < 1e-5;
    }
  });
  EXPECT_EQ(right, 2000);
  EXPECT_EQ(l.later->meshes_read, 10u);
  EXPECT_EQ(l.later->read, 10u * (12 * 8 + 12 * 6));
}

// Damage in a tile shows when its first ray comes, as one Error that names file and mesh; the other tiles go on.
TEST(TileLoading, DamageIsAnErrorAtTheFirstRay) {
  TempFolder folder;
  write_scene(towns(), {}, folder / "towns.h5");
  std::vector<std::byte> bytes = read_bytes(folder / "towns.h5");
  const float height = 13, nan = NAN;  // of town 3
  const auto* want = reinterpret_cast<const std::byte*>(&height);
  const auto at = std::search(bytes.begin(), bytes.end(), want, want + 4);
  ASSERT_NE(at, bytes.end());
  std::copy_n(reinterpret_cast<const std::byte*>(&nan), 4, at);
  write_file(folder / "towns.h5", std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  const Loaded l = load(folder / "towns.h5");
  const Tracer tracer(l.scene);
  EXPECT_TRUE(down(tracer, 2e4).hit());
  EXPECT_THAT(message_of([&] { down(tracer, 3e4); }),
              ::testing::HasSubstr("mesh 'town 3': a coordinate is not finite"));
  EXPECT_THAT(message_of([&] { parallel_for(0, 100, 1, [&](size_t, size_t) { down(tracer, 3e4); }); }),
              ::testing::HasSubstr("towns.h5"));
  EXPECT_TRUE(down(tracer, 4e4).hit());
}

}  // namespace
}  // namespace suite::format_scene_hdf_tile_loading_test
