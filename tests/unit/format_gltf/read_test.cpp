// glTF: every kind of primitive, transforms, copies, sparse values, motions; and faults with their place in the JSON.
#include "formats/gltf/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/track.h"
#include "scene/issues.h"
#include "support/gltf_kit.h"
#include "support/message_of.h"

namespace suite::format_gltf_read_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Read {
  Report report{scene_issues()};
  SourceModel model;
  explicit Read(const std::string& text, const SourceModelOptions& how = {.name = "m", .where = {}})
      : model(parse_gltf(std::as_bytes(std::span(text)), "t.gltf", how, report)) {}
  const DraftGroup& group(const std::string& name) const {
    for (const DraftGroup& g : model.groups)
      if (g.name == name) return g;
    throw std::runtime_error("no group " + name);
  }
  // Corners of the first mesh, one after the other.
  std::vector<Vec3> corners() const {
    std::vector<Vec3> all;
    for (const uint32_t i : model.meshes.at(0).mesh.indices) all.push_back(model.meshes[0].mesh.positions[i]);
    return all;
  }
};

const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

std::string one_node(const std::string& primitive, const std::string& node = "", const std::string& more = "") {
  return R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node + R"(}],"meshes":[{"primitives":[)" +
         primitive + "]}]" + more;
}

TEST(Gltf, ListsStripsAndFans) {
  test::GltfFile f;
  const int p = f.places(kSquare), list = f.indices({0, 1, 2, 0, 2, 3}), strip = f.indices({0, 1, 3, 2, 2});
  const auto corners = [&](const std::string& mode) {
    return Read(f.text(one_node(strf(R"({"attributes":{"POSITION":%d},%s})", p, mode.c_str())))).corners();
  };
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0};
  EXPECT_THAT(corners(strf(R"("indices":%d)", list)), ElementsAre(a, b, c, a, c, d));
  EXPECT_THAT(corners(strf(R"("mode":5,"indices":%d)", strip)), ElementsAre(a, b, d, b, c, d));  // and no fourth
  EXPECT_THAT(corners(R"("mode":6)"), ElementsAre(b, c, a, c, d, a));
  EXPECT_THAT(corners(R"("mode":5)"), ElementsAre(a, b, c, b, d, c));
}

TEST(Gltf, AContainerHoldsTheSame) {
  test::GltfFile f;
  const int p = f.places(kSquare);
  const std::string rest = one_node(strf(R"({"attributes":{"POSITION":%d},"mode":6})", p));
  EXPECT_EQ(Read(f.binary(rest)).corners(), Read(f.text(rest)).corners());
}

TEST(Gltf, NodesBecomeGroupsInMetresWithZUp) {
  test::GltfFile f;
  const int p = f.places(kSquare);
  const std::string text = f.text(strf(
      R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"top","children":[1,2],"translation":[1,2,3]},
      {"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,5,6,7,1]},{"mesh":0,"scale":[2,2,2],"rotation":[0,0,1,0]}],
      "meshes":[{"name":"sq","primitives":[{"attributes":{"POSITION":%d},"mode":6}]}])",
      p));
  const Read r(text, {.name = "m", .where = {}, .unit_m = 0.5, .y_up = true});
  ASSERT_EQ(r.model.meshes.size(), 1u);  // placed twice
  EXPECT_EQ(r.model.meshes[0].name, "m/sq");
  EXPECT_EQ(r.model.groups[0].name, "m");
  EXPECT_EQ(r.group("m").placements[0].to_parent.point({1, 2, 3}), (Vec3{1, -3, 2}));
  const DraftGroup& top = r.group("m/top");
  ASSERT_EQ(top.placements.size(), 2u);
  EXPECT_EQ(top.placements[0].target.name, "m/sq");
  EXPECT_EQ(top.placements[0].to_parent.point({1, 0, 0}), (Vec3{2.5, 4, 3.5}));
  const Vec3 turned = top.placements[1].to_parent.point({1, 0, 0});
  EXPECT_NEAR(turned.x, -2, 1e-15);
  EXPECT_NEAR(turned.y, 0, 1e-15);
  EXPECT_EQ(r.group("m/axes").placements[0].to_parent.b, (Vec3{0.5, 1, 1.5}));
}

TEST(Gltf, SparseAndNormalizedValues) {
  test::GltfFile f;
  const int base = f.view(kSquare), at = f.view(std::vector<uint16_t>{2}), value = f.view(std::vector<float>{9, 8, 7});
  const int sparse = f.raw_accessor(strf(
      R"({"bufferView":%d,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":%d,"componentType":5123},"values":{"bufferView":%d}}})",
      base, at, value));
  EXPECT_THAT(Read(f.text(one_node(strf(R"({"attributes":{"POSITION":%d},"mode":6})", sparse)))).corners(),
              ElementsAre(Vec3{1, 0, 0}, Vec3{9, 8, 7}, Vec3{0, 0, 0}, Vec3{9, 8, 7}, Vec3{0, 1, 0}, Vec3{0, 0, 0}));
  const int bytes = f.view(std::vector<int8_t>{-128, 127, 0, 0, 0, 127, 0, 0, 127, 0, 0, 0});
  f.raw_accessor(strf(R"({"bufferView":%d,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"})", bytes));
  EXPECT_THAT(Read(f.text(one_node(R"({"attributes":{"POSITION":1}})"))).corners()[0], (Vec3{-1, 1, 0}));
}

TEST(Gltf, CopiesOfANodeAreRows) {
  test::GltfFile f;
  const int p = f.places(kSquare), t = f.places({1, 2, 3, 4, 5, 6});
  const Read r(
      f.text(one_node(strf(R"({"attributes":{"POSITION":%d},"mode":6})", p),
                      strf(R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":%d}}})", t),
                      R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])")));
  const DraftPlacement& placed = r.group("m/axes").placements[0];
  ASSERT_TRUE(placed.table);
  ASSERT_EQ(placed.rows.size(), 2u);
  EXPECT_EQ(placed.rows[1].b, (Vec3{4, 5, 6}));
  EXPECT_EQ(r.report.count(Severity::warning), 0u) << r.report.text();
}

// A translation that is linear, and a rotation that jumps, of one node; known from the first to the last of all times.
TEST(Gltf, AnimationsBecomeTracks) {
  test::GltfFile f;
  const int p = f.places(kSquare), t = f.floats({1, 3}, "SCALAR", 1), to = f.places({0, 0, 0, 4, 0, 0});
  const int t2 = f.floats({0, 2}, "SCALAR", 1), turn = f.floats({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 4);
  const std::string text = f.text(one_node(
      strf(R"({"attributes":{"POSITION":%d},"mode":6})", p), R"(,"scale":[3,3,3])",
      strf(R"(,"animations":[{"samplers":[{"input":%d,"output":%d},{"input":%d,"output":%d,"interpolation":"STEP"}],
      "channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},{"sampler":1,"target":{"node":0,"path":"rotation"}}]}])",
           t, to, t2, turn)));
  const Read r(text, {.name = "m", .where = {}, .unit_m = 2});
  const DraftPlacement& placed = r.group("m/axes").placements[0];
  ASSERT_TRUE(placed.motion);
  EXPECT_EQ(placed.to_parent, scaling({3, 3, 3}));
  EXPECT_EQ(placed.motion->covered().begin, 0);
  EXPECT_EQ(placed.motion->covered().end, 3);
  EXPECT_NEAR(placed.motion->at(0.5).translation.x, 0, 1e-15);
  EXPECT_NEAR(placed.motion->at(2.5).translation.x, 6, 1e-12);
  EXPECT_NEAR(placed.motion->at(1.99).vector({1, 0, 0}).x, 1, 1e-12);
  EXPECT_NEAR(placed.motion->at(2).vector({1, 0, 0}).x, -1, 1e-12);
  EXPECT_THAT(r.report.text(), HasSubstr("jumps take"));
  const Read still(text, {.name = "m", .where = {}, .animation = "none"});
  EXPECT_FALSE(still.group("m/axes").placements[0].motion);
  EXPECT_THAT(message_of([&] { Read(text, {.name = "m", .where = {}, .animation = "run"}); }),
              HasSubstr("has no animation 'run'"));
}

TEST(Gltf, TellsWhatItLeavesOut) {
  test::GltfFile f;
  const int p = f.places(kSquare);
  const Read r(f.text(one_node(
      strf(R"({"attributes":{"POSITION":%d},"mode":6,"material":0},{"attributes":{"POSITION":%d},"mode":1})", p, p), "",
      R"(,"materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0.1,1]}}],
      "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],"extensionsUsed":["XX_made_up"])")));
  const std::string text = r.report.text();
  for (const char* part : {"1 primitives of points or lines", "XX_made_up: unknown here", "1 cameras",
                           "left out of how surfaces look: transparency of 1 material (an 'opacity' map makes holes), "
                           "one-sidedness of 1 material"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_EQ(r.model.meshes[0].mesh.runs[0].material, "material_0");
  ASSERT_EQ(r.model.materials.size(), 1u);
  EXPECT_DOUBLE_EQ(r.model.materials[0].rgb[1], 0.25);
}

// A square laid out by a second set of texture coordinates and a transform of them.
struct LaidOut {
  std::string extension, attributes = R"("POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2)", set = R"(,"texCoord":1)";
  std::string text() const {
    test::GltfFile f;
    f.places(kSquare);
    f.floats({0, 0, 0, 0, 0, 0, 0, 0}, "VEC2", 2);
    f.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2", 2);
    const int image = f.view(std::vector<char>(4));
    return f.text(one_node(
        R"({"attributes":{)" + attributes + R"(},"mode":6,"material":0})", "",
        R"(,"materials":[{"doubleSided":true,"pbrMetallicRoughness":{"baseColorTexture":{"index":0)" + set +
            (extension.empty() ? "" : R"(,"extensions":{"KHR_texture_transform":)" + extension + "}") +
            R"(}}}],"extensionsUsed":["KHR_texture_transform"],"textures":[{"source":0}],"images":[{"bufferView":)" +
            std::to_string(image) + R"(,"mimeType":"image/png"}])"));
  }
};

SourceModelOptions textured() {
  SourceModelOptions how{.name = "m", .where = {}};
  how.textures = true;
  return how;
}

// The example of the extension's text: the lower left quarter of the image, turned by a quarter. In the file v counts
// downwards, so that this is u from 0 to 0.5 and v from 0.5 to 1 there, and 0 to 0.5 here.
TEST(Gltf, TexturesAreScaledTurnedAndMoved) {
  const Read r(LaidOut{R"({"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]})"}.text(), textured());
  // (0, 0), (1, 0), (1, 1), (0, 1) of the file become (0, 1), (0, 0.5), (0.5, 0.5), (0.5, 1).
  const std::vector<float> expected{0, 0, 0, 0.5, 0.5, 0.5, 0.5, 0};
  ASSERT_EQ(r.model.meshes[0].mesh.uvs.size(), 8u);
  for (size_t k = 0; k < 8; ++k) EXPECT_NEAR(r.model.meshes[0].mesh.uvs[k], expected[k], 1e-6) << k;
  EXPECT_TRUE(r.report.text().empty() || r.report.text().find("KHR_texture_transform") == std::string::npos);
  // Scaled before it is turned.
  const Read wide(LaidOut{R"({"rotation":1.57079632679,"scale":[4,2]})"}.text(), textured());
  EXPECT_NEAR(wide.model.meshes[0].mesh.uvs[2], 0, 1e-6);
  EXPECT_NEAR(wide.model.meshes[0].mesh.uvs[3], 1 + 4, 1e-6);
}

TEST(Gltf, TexturesAreLaidOutByTheirOwnCoordinates) {
  const std::vector<float> first{0, 1, 0, 1, 0, 1, 0, 1}, second{0, 1, 1, 1, 1, 0, 0, 0};
  EXPECT_EQ(Read(LaidOut{}.text(), textured()).model.meshes[0].mesh.uvs, second);
  EXPECT_EQ(Read(LaidOut{}.text()).model.meshes[0].mesh.uvs, first) << "no images are asked for";
  // The extension has the last word.
  EXPECT_EQ(Read(LaidOut{R"({"texCoord":0})"}.text(), textured()).model.meshes[0].mesh.uvs, first);
  const Read lacking(LaidOut{"", R"("POSITION":0,"TEXCOORD_0":1)"}.text(), textured());
  EXPECT_EQ(lacking.model.meshes[0].mesh.uvs, first);
  EXPECT_THAT(lacking.report.text(), HasSubstr("laid out by: TEXCOORD_0 is taken"));
  for (const char* wrong : {R"({"offset":[0]})", R"({"scale":["a",1]})", R"({"rotation":[1,2]})", R"({"texCoord":-1})",
                            R"({"offset":[1e300,0]})"})
    EXPECT_THAT(message_of([&] { Read(LaidOut{wrong}.text(), textured()); }), HasSubstr("baseColorTexture")) << wrong;
}

// `inverseBindMatrices` is optional; a file without it was refused.
TEST(Gltf, SkinsNeedNoMatrices) {
  test::GltfFile f;
  const int p = f.places(kSquare);
  const Read r(f.text(one_node(strf(R"({"attributes":{"POSITION":%d},"mode":6})", p), R"(,"skin":1)",
                               R"(,"skins":[{"joints":[0]},{"joints":[0]}])")));
  EXPECT_EQ(r.corners().size(), 6u);
  EXPECT_THAT(r.report.text(), HasSubstr("2 skins: bodies stand as their meshes are stored"));
}

// Data URIs of other media types or none, which were refused: the same bytes, '+' and '/' among them (FB EF BE FF).
TEST(Gltf, DataOfAnyType) {
  const auto corner = [](const std::string& type) {
    const std::string text =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)"
        R"("attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
        R"("min":[-100,-100,-100],"max":[100,100,100]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)"
        R"("byteLength":36,"uri":"data:)" +
        type + ";base64,++++PwAAgD/7776/AAAAAAAAAAAAAIA/AAAAAAAAgD8AAAAA" + R"("}]})";
    const Read r(text);
    EXPECT_EQ(r.corners().size(), 3u);
    return r.corners().at(0);
  };
  const Vec3 known = corner("application/octet-stream");
  for (const std::string type : {"", "text/plain", "model/gltf-binary;charset=utf-8"})
    EXPECT_EQ(length(corner(type) - known), 0) << type;
  EXPECT_THAT(
      message_of([&] { Read r(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":9,"uri":"data:,abc"}]})"); }),
      HasSubstr("t.gltf: error: a buffer's data URI begins 'data:,abc'"));
}

// A container whose JSON is not padded to 4 bytes, as some writers leave it, and compression that is named.
TEST(Gltf, ContainersOfEveryLength) {
  test::GltfFile f;
  const int p = f.places(kSquare);
  std::string json = f.text(one_node(strf(R"({"attributes":{"POSITION":%d},"mode":6})", p)));
  const auto word = [](size_t n) {
    const auto w = static_cast<uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&w), 4);
  };
  const auto container = [&] { return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json; };
  for (int blank = 0; blank < 4; ++blank, json += ' ') EXPECT_EQ(Read(container()).corners().size(), 6u) << blank;
  json.replace(json.find("\"version\""), 9, "\"KHR_draco_mesh_compression\"");
  EXPECT_THAT(message_of([&] { Read r(container()); }), HasSubstr("compressed by Draco (KHR_draco_mesh_compression)"));
}

TEST(Gltf, FaultsHaveTheirPlace) {
  const auto fault = [](const std::string& primitive, const std::string& node = "", const std::string& more = "") {
    test::GltfFile f;
    f.places(kSquare), f.indices({0, 1, 4}), f.indices({0, 1});
    f.raw_accessor(R"({"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"})");
    f.raw_accessor(R"({"componentType":5126,"count":4000000000,"type":"VEC3"})");
    return message_of([&] { Read(f.text(one_node(primitive, node, more))); });
  };
  const std::string good = R"({"attributes":{"POSITION":0},"mode":6})";
  EXPECT_EQ(fault(good), "no error");
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":0},"indices":1})"), HasSubstr("accessors[1]: index 4 of 4 vertices"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":0},"indices":2})"),
              HasSubstr("primitives[0]: 2 corners of triangles"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":3}})"), HasSubstr("accessors[3]: 4000000000 values of 12 bytes"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":4}})"), HasSubstr("accessors[4]/count: 4000000000 values without"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":9}})"), HasSubstr("POSITION: accessor 9 of 5"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":1}})"), HasSubstr("accessors[1]/type"));
  EXPECT_THAT(fault(good, R"(,"rotation":[0,0,0,0])"), HasSubstr("nodes[0]/rotation: a quaternion without length"));
  EXPECT_THAT(fault(good, R"(,"children":[0])"), HasSubstr("scenes[0]/nodes: node 0 has a parent"));
  EXPECT_THAT(fault(good, "", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"),
              HasSubstr("extensionsRequired: 'KHR_draco_mesh_compression' is not read here; write the file again"));
  EXPECT_THAT(fault(R"({"attributes":{"POSITION":0},"mode":1})"), HasSubstr("places no triangle"));
  EXPECT_THAT(message_of([] { Read(std::string(100'000, '[')); }), HasSubstr("byte 200: error: JSON of more than 200"));
}

}  // namespace
}  // namespace suite::format_gltf_read_test
