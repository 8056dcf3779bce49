#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_scene_hdf_scene_test {
namespace {

using ::testing::HasSubstr;

void add_maps(Scene& s) {
  s.class_maps = {{"map", 2, 2, {0, 1, 1, 0}, {0, 1}, Projection::drape, {10, 20, 2, 3, Drape::Extend::repeat}}};
  s.map_bindings = {{0, 0}};
  PropertyMap cube;
  cube.name = "cube";
  cube.kind = MapKind::cube;
  cube.width = 2, cube.height = 1, cube.channels = 2;
  cube.values = {0.1f, 0.2f, 0.3f, 0.4f};
  cube.wavelength_um = {0.5, 0.6};
  cube.parameter = "reflectance";
  PropertyMap index = cube;
  index.name = "index";
  index.kind = MapKind::curve_index;
  index.channels = 1;
  index.values = {1, 0};
  index.wavelength_um = {};
  index.family = {Curve::constant(0.5), Curve({0.4, 0.5}, {0.1, 0.2}, Outside::zero)};
  index.projection = Projection::uv;
  s.property_maps = {cube, index};
  s.property_bindings = {{0, 1}};
}

Scene small_scene() {
  Scene s;
  s.name = "small";
  s.origin = {49.5, 8.25, 100.5, true};
  Mesh m;
  m.name = "quad";
  m.origin = {1e6, -2e6, 3.5};
  m.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0};
  m.indices = {0, 1, 2, 0, 2, 3};
  m.normals = std::vector<uint32_t>(4, oct_encode({0, 0, 1}));
  m.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  m.parts = {{"a", 0, 1, 0}, {"b", 1, 1, 1}};
  Mesh bare = m;
  bare.normals = {}, bare.uvs = {};
  bare.parts = {{"", 0, 2, kNone}};
  s.meshes = {m, bare};
  s.primitives = {{"ball", PrimitiveKind::sphere, {2.5}, 1}};
  Material grey{"grey",
                "a grey",
                {"lambert",
                 {},
                 {{"reflectance", Curve({0.4, 1.0}, {0.1, 0.3}, Outside::hold)}, {"transmittance", Curve::constant(0)}},
                 {},
                 nullptr},
                300,
                {{"density_kg_m3", 1000}}};
  Material mirror{"mirror", "", {"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}, 0, {}};
  s.materials = {grey, mirror};
  Placement p;
  p.to_parent = translation({1, 2, 3});
  p.kind = TargetKind::group;
  p.target = 1;
  p.tag = 0;
  Placement q;
  q.target = 1;
  q.material_override = 1;
  Placement b;
  b.kind = TargetKind::primitive;
  s.groups = {{"world", {p, b}}, {"inner", {q, q}}};
  s.tags = {"first"};
  add_maps(s);
  s.files = {{"data.bin", {std::byte{1}, std::byte{2}, std::byte{3}}}, {"empty.bin", {}}};
  s.bounds = scene_bounds(s);
  return s;
}

class SceneHdf : public ::testing::Test {
 protected:
  SceneHdf() { write_scene(small_scene(), {"gen 1", "args", "hash", {{"", "00ff"}, {"a.obj", "11"}}}, path_); }
  TempFolder folder_;
  std::string path_ = folder_ / "s.h5";
};

TEST_F(SceneHdf, RoundTrip) {
  const Scene a = small_scene(), b = read_scene(path_);
  EXPECT_EQ(b.name, a.name);
  EXPECT_EQ(b.origin.latitude_deg, a.origin.latitude_deg);
  ASSERT_EQ(b.meshes.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(b.meshes[k].origin, a.meshes[k].origin);
    EXPECT_EQ(b.meshes[k].positions, a.meshes[k].positions);
    EXPECT_EQ(b.meshes[k].indices, a.meshes[k].indices);
    EXPECT_EQ(b.meshes[k].normals, a.meshes[k].normals);
    EXPECT_EQ(b.meshes[k].uvs, a.meshes[k].uvs);
    ASSERT_EQ(b.meshes[k].parts.size(), a.meshes[k].parts.size());
  }
  EXPECT_EQ(b.meshes[0].parts[1].name, "b");
  EXPECT_EQ(b.meshes[1].parts[0].material, kNone);
  EXPECT_EQ(b.primitives.at(0).parameters, a.primitives[0].parameters);
  ASSERT_EQ(b.groups.size(), 2u);
  EXPECT_EQ(b.groups[0].placements.at(0).to_parent, a.groups[0].placements[0].to_parent);
  EXPECT_EQ(b.groups[1].placements.at(1).material_override, 1u);
  EXPECT_EQ(b.tags, a.tags);
  ASSERT_EQ(b.materials.size(), 2u);
  EXPECT_EQ(b.materials[0].temperature_k, 300);
  EXPECT_EQ(b.materials[0].thermal.at("density_kg_m3"), 1000);
  const Curve& c = b.materials[0].surface.curves.at("reflectance");
  EXPECT_DOUBLE_EQ(c.at(0.7), 0.2);
  EXPECT_EQ(c.outside(), Outside::hold);
  EXPECT_TRUE(b.materials[1].surface.curves.at("reflectance").is_constant());
  EXPECT_EQ(b.class_maps.at(0).classes, a.class_maps[0].classes);
  EXPECT_EQ(b.class_maps.at(0).drape.gsd_y, 3);
  ASSERT_EQ(b.property_maps.size(), 2u);
  EXPECT_EQ(b.property_maps[0].values, a.property_maps[0].values);
  EXPECT_EQ(b.property_maps[0].wavelength_um, a.property_maps[0].wavelength_um);
  EXPECT_EQ(b.property_maps[1].family.at(1).outside(), Outside::zero);
  EXPECT_EQ(b.property_maps[1].projection, Projection::uv);
  EXPECT_EQ(b.property_bindings.at(0).property_map, 1u);
  EXPECT_EQ(b.files.at(0).bytes, a.files[0].bytes);
  EXPECT_EQ(b.bounds.high, a.bounds.high);
  EXPECT_EQ(read_provenance(path_).input_sha256, "hash");
  EXPECT_EQ(read_provenance(path_).inputs.at(1).name, "a.obj");
}

TEST_F(SceneHdf, SameSceneSameBytes) {
  write_scene(small_scene(), {"gen 1", "args", "hash", {{"", "00ff"}, {"a.obj", "11"}}}, folder_ / "other.h5");
  EXPECT_EQ(read_bytes(path_), read_bytes(folder_ / "other.h5"));
}

// Two Lambert plates with texture coordinates, layers, a temperature and a long cube: a camera that sees 0.5 to 0.6 um
// needs the geometry only.
// A wavy sheet: large enough that its arrays are packed in several pieces.
Scene large_scene() {
  Scene s = small_scene();
  Mesh& m = s.meshes[1];
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  constexpr uint32_t n = 300;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i)
      for (const float x : {float(i), float(j), std::sin(0.1f * float(i)) * std::cos(0.07f * float(j))})
        positions.push_back(x);
  positions.push_back(0);
  for (uint32_t j = 0; j + 1 < n; ++j)
    for (uint32_t i = 0; i + 1 < n; ++i)
      for (const uint32_t v : {j * n + i, j * n + i + 1, (j + 1) * n + i}) indices.push_back(v);
  m.positions = std::move(positions), m.indices = std::move(indices);
  m.parts = {{"", 0, static_cast<uint32_t>(m.triangle_count()), kNone}};
  s.bounds = scene_bounds(s);
  return s;
}

TEST_F(SceneHdf, PackedDatasetsHoldTheSameAndRepeat) {
  const Scene s = large_scene();
  const Provenance made{"gen 1", "args", "hash", {}};
  const auto size_with = [&](std::initializer_list<const char*> how) {
    Compression c;
    for (const char* h : how) c.add(h);
    const std::string path = folder_ / "packed.h5", again = folder_ / "again.h5";
    write_scene(s, made, path, c);
    write_scene(s, made, again, c);
    EXPECT_EQ(read_bytes(path), read_bytes(again));
    const Scene b = read_scene(path);
    for (size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(b.meshes[k].positions, s.meshes[k].positions);
      EXPECT_EQ(b.meshes[k].indices, s.meshes[k].indices);
      EXPECT_EQ(b.meshes[k].normals, s.meshes[k].normals);
    }
    return file_size(path);
  };
  const size_t plain = size_with({}), none = size_with({"none"}), all = size_with({"deflate"}),
               hard = size_with({"deflate:9"}), indices = size_with({"/geometry/indices=deflate:6"}),
               but_indices = size_with({"deflate", "/geometry/indices=none"});
  EXPECT_EQ(plain, none);
  EXPECT_LE(hard, all);
  EXPECT_LT(all, plain / 2);
  EXPECT_LT(indices, plain);
  EXPECT_LT(all, but_indices);
  EXPECT_LT(but_indices, plain);
  // indices + the rest = all, up to the library's bookkeeping
  EXPECT_NEAR(double(plain) - double(all), 2 * double(plain) - double(indices) - double(but_indices), 4096.0);
}

// Arrays that wait are read once a mesh, when asked for, checked then, and are the same; from any thread.
TEST_F(SceneHdf, ArraysAreReadWhenAskedFor) {
  const Scene s = large_scene();
  const std::string path = folder_ / "later.h5";
  write_scene(s, {}, path);
  SceneNeeds needs;
  needs.later_from = 0;
  LoadReport report;
  const Scene b = read_scene(path, {}, needs, &report);
  ASSERT_TRUE(report.later);
  EXPECT_EQ(std::count(report.datasets.begin(), report.datasets.end(), "/geometry/positions"), 0);
  EXPECT_EQ(report.later->meshes, 2u);
  EXPECT_EQ(report.later->meshes_read, 0u);
  EXPECT_THAT(report.text(), HasSubstr("geometry             later"));
  EXPECT_FALSE(b.meshes[1].stored->here);
  EXPECT_EQ(b.meshes[1].vertex_count(), s.meshes[1].vertex_count());
  EXPECT_EQ(b.meshes[1].triangle_count(), s.meshes[1].triangle_count());
  EXPECT_EQ(mesh_box(b.meshes[1]).high, mesh_box(s.meshes[1]).high);
  EXPECT_EQ(scene_bounds(b).low, scene_bounds(s).low);
  EXPECT_EQ(report.later->meshes_read, 0u);
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) threads.emplace_back([&] { b.meshes[1].require(); });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(report.later->meshes_read, 1u);
  EXPECT_EQ(report.later->read, 12 * (s.meshes[1].vertex_count() + s.meshes[1].triangle_count()));
  // Behind the last vertex of a mapped mesh lies what comes next in the file.
  ASSERT_EQ(b.meshes[1].positions.size(), s.meshes[1].positions.size());
  EXPECT_TRUE(
      std::equal(b.meshes[1].positions.begin(), b.meshes[1].positions.end() - 1, s.meshes[1].positions.begin()));
  EXPECT_EQ(b.meshes[1].indices, s.meshes[1].indices);
  EXPECT_FALSE(b.meshes[0].stored->here);
  b.meshes[0].require();
  EXPECT_EQ(b.meshes[0].uvs, s.meshes[0].uvs);
  // Less than the limit is read at once.
  needs.later_from = uint64_t{1} << 30;
  EXPECT_FALSE(read_scene(path, {}, needs).meshes[1].stored);
}

TEST_F(SceneHdf, DamageIsFoundWhenArraysAreRead) {
  const Scene s = large_scene();
  const std::string path = folder_ / "later.h5";
  write_scene(s, {}, path);
  std::vector<std::byte> bytes = read_bytes(path);
  // The x of vertices 299 and 599 of the sheet is 299, its largest; one of all is moved beyond the box.
  const float largest = 299;
  const auto* want = reinterpret_cast<const std::byte*>(&largest);
  const auto at = std::search(bytes.begin(), bytes.end(), want, want + 4);
  ASSERT_NE(at, bytes.end());
  const float wrong = 2990;
  std::copy_n(reinterpret_cast<const std::byte*>(&wrong), 4, at);
  write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  SceneNeeds needs;
  needs.later_from = 0;
  const Scene b = read_scene(path, {}, needs);
  EXPECT_THAT(message_of([&] { b.meshes[1].require(); }), HasSubstr("it is not as large as was said of it"));
}

TEST_F(SceneHdf, CompressionsAreCheckedAndDamageIsRefused) {
  Compression c;
  for (const char* wrong : {"zip", "deflate:0", "deflate:10", "/geometry=", "=deflate", "/=deflate", "deflate:", ""})
    EXPECT_THAT(message_of([&] { c.add(wrong); }), HasSubstr("compression '")) << wrong;
  c.add("/geometri=deflate");
  EXPECT_THAT(message_of([&] { write_scene(large_scene(), {}, folder_ / "x.h5", c); }),
              HasSubstr("no dataset '/geometri'"));
  EXPECT_FALSE(file_exists(folder_ / "x.h5"));
  Compression all;
  all.add("deflate");
  const std::string path = folder_ / "packed.h5";
  write_scene(large_scene(), {}, path, all);
  // Every byte of the packed pieces is under the checksum of its stream.
  std::vector<std::byte> bytes = read_bytes(path);
  size_t refused = 0, tried = 0;
  for (size_t at = bytes.size() / 4; at < bytes.size() * 3 / 4; at += bytes.size() / 40) {
    bytes[at] ^= std::byte{0x10};
    write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    bytes[at] ^= std::byte{0x10};
    ++tried;
    try {
      read_scene(path);
    } catch (const Error& e) {
      ++refused;
      EXPECT_THAT(e.what(), HasSubstr("packed.h5"));
    }
  }
  EXPECT_EQ(refused, tried);
}

TEST_F(SceneHdf, OnlyWhatIsNeededIsRead) {
  Scene s = small_scene();
  s.class_maps.clear(), s.map_bindings.clear(), s.property_maps.clear(), s.property_bindings.clear(), s.files.clear();
  s.materials[1] = s.materials[0];
  s.materials[1].id = "other";
  const auto map = [&](MapKind kind, uint32_t channels, std::vector<float> values) {
    PropertyMap m;
    m.name = "map";
    m.kind = kind;
    m.width = 2, m.height = 1, m.channels = channels;
    m.values = std::move(values);
    s.property_maps.push_back(m);
    s.property_bindings.push_back({0, static_cast<uint32_t>(s.property_maps.size() - 1)});
    return &s.property_maps.back();
  };
  map(MapKind::temperature, 1, {290, 310});
  s.temperatures = {{1, {"tabulated", {}, {0, 10}, {280, 300}, false, {SlabLayer{}}}}};
  s.temperatures[0].spec.layers.clear();
  write_scene(s, {}, path_);
  LoadReport all, seen;
  const Scene whole = read_scene(path_, {}, {}, &all);
  EXPECT_EQ(all.left_out(), 0u);
  EXPECT_EQ(whole.property_maps.size(), 1u);
  const SceneNeeds visible{{{0.5, 0.6}}}, thermal{{{0.5, 0.6}, {9, 11}}};
  const Scene part = read_scene(path_, {}, visible, &seen);
  EXPECT_EQ(part.meshes[0].positions, whole.meshes[0].positions);
  EXPECT_TRUE(part.meshes[0].uvs.empty());
  EXPECT_TRUE(part.property_maps.empty());
  EXPECT_TRUE(part.property_bindings.empty());
  EXPECT_TRUE(part.temperatures.empty());
  EXPECT_EQ(part.materials[0].temperature_k, 0);
  EXPECT_TRUE(part.materials[0].thermal.empty());
  const auto read = [&](const LoadReport& report, const char* name) {
    return std::find(report.datasets.begin(), report.datasets.end(), name) != report.datasets.end();
  };
  for (const char* name : {"/geometry/uvs", "/property_maps/values"}) {
    EXPECT_TRUE(read(all, name)) << name;
    EXPECT_FALSE(read(seen, name)) << name;
  }
  EXPECT_EQ(seen.datasets.size() + 2, all.datasets.size());
  EXPECT_EQ(seen.left_out(), 2u * 4 + 8 * 4 + 2 * 8 + 2 * 16 + 2 * 8);  // map, UVs, constants, table, densities
  EXPECT_EQ(read_scene(path_, {}, thermal).property_maps.size(), 1u);
  EXPECT_EQ(read_scene(path_, {}, thermal).temperatures.size(), 1u);
}

// Of a cube and of curves only what decides inside the window stays, and decides the same.
TEST_F(SceneHdf, SpectraAreCutToTheWindow) {
  Scene s = small_scene();
  PropertyMap& cube = s.property_maps[0];
  cube.channels = 5, cube.wavelength_um = {0.4, 0.5, 0.6, 0.7, 0.8}, cube.values.clear();
  for (int i = 0; i < 10; ++i) cube.values.push_back(0.05f * static_cast<float>(i));
  s.materials[0].surface.curves["reflectance"] =
      Curve({0.3, 0.4, 0.5, 0.6, 0.7}, {0.1, 0.2, 0.3, 0.4, 0.5}, Outside::hold);
  write_scene(s, {}, path_);
  const Scene part = read_scene(path_, {}, {{{0.52, 0.58}}});
  EXPECT_EQ(part.property_maps[0].wavelength_um, (std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(part.property_maps[0].values, (std::vector<float>{0.05f, 0.1f, 0.05f * 6, 0.05f * 7}));
  EXPECT_EQ(part.materials[0].surface.curves.at("reflectance").wavelength_um(), (std::vector<double>{0.5, 0.6}));
  EXPECT_DOUBLE_EQ(part.materials[0].surface.curves.at("reflectance").at(0.55), 0.35);
  const Scene beyond = read_scene(path_, {}, {{{0.9, 1.0}}});
  EXPECT_EQ(beyond.property_maps[0].wavelength_um, (std::vector<double>{0.8}));
  EXPECT_DOUBLE_EQ(beyond.materials[0].surface.curves.at("reflectance").at(0.95), 0.5);
}

TEST_F(SceneHdf, EmptySceneRoundTrips) {
  Scene s;
  s.groups = {{"world", {}}};
  write_scene(s, {}, path_);
  EXPECT_EQ(read_scene(path_).groups.size(), 1u);
}

TEST_F(SceneHdf, BadIndicesAreRefused) {
  const auto refused = [&](const std::function<void(Scene&)>& damage) {
    Scene s = small_scene();
    damage(s);
    write_scene(s, {}, path_);
    return message_of([&] { read_scene(path_); });
  };
  EXPECT_THAT(refused([](Scene& s) { s.meshes[0].indices = {0, 1, 2, 4, 2, 3}; }), HasSubstr("vertex index 4 of 4"));
  EXPECT_THAT(refused([](Scene& s) { s.meshes[0].parts[0].material = 7; }),
              HasSubstr("names a material that is not there"));
  EXPECT_THAT(refused([](Scene& s) { s.groups[0].placements[0].target = 9; }),
              HasSubstr("names a group that is not there"));
  EXPECT_THAT(refused([](Scene& s) { s.groups[1].placements[0].kind = TargetKind::group; }), HasSubstr("not below it"));
  EXPECT_THAT(refused([](Scene& s) { s.class_maps[0].classes[0] = 5; }), HasSubstr("class 5 has no material"));
  EXPECT_THAT(refused([](Scene& s) { s.property_maps[1].values[0] = 2; }), HasSubstr("curve 2 of 2"));
  EXPECT_THAT(refused([](Scene& s) { s.property_maps[0].wavelength_um = {0.6, 0.5}; }), HasSubstr("do not ascend"));
  EXPECT_THAT(refused([](Scene& s) { s.property_bindings[0].material = 9; }), HasSubstr("a map binding"));
  EXPECT_THAT(refused([](Scene& s) { s.primitives[0].parameters = {1, 2}; }), HasSubstr("has 2 parameters"));
  EXPECT_THAT(refused([](Scene& s) { s.materials[0].surface.model = "nothing"; }),
              HasSubstr("unknown model 'nothing'"));
}

TEST_F(SceneHdf, ForeignAndDamagedFilesAreRefused) {
  const auto fault = [](const std::string& path) { return message_of([&] { read_scene(path); }); };
  EXPECT_THAT(fault(folder_ / "none.h5"), HasSubstr("no such file"));
  EXPECT_THAT(fault(folder_.path()), HasSubstr("is a directory"));
  write_file(folder_ / "text.h5", "hello");
  EXPECT_THAT(fault(folder_ / "text.h5"), HasSubstr("is not an HDF5 file"));
  std::vector<std::byte> bytes = read_bytes(path_);
  bytes.resize(bytes.size() - 100);
  write_file(folder_ / "short.h5", bytes);
  EXPECT_THAT(fault(folder_ / "short.h5"), HasSubstr("damaged"));
}

TEST_F(SceneHdf, UnwritablePlaceLeavesNothing) {
  EXPECT_THAT(message_of([&] { write_scene(small_scene(), {}, folder_ / "no/such/s.h5"); }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(folder_.entries(), 1u);
}

}  // namespace
}  // namespace suite::format_scene_hdf_scene_test
