// `textures` of a glTF or OBJ object: its base colours as spectra, texel by texel or in classes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/picture/picture.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "spectral/display_colour.h"
#include "support/gltf_kit.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_textures_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A square with texture coordinates and two materials: `leaf`, with an image of 2 x 1 texels, and the plain `red`.
class Textures : public ::testing::Test {
 protected:
  Textures() {
    write_png(folder_ / "a leaf.png", 2, 1, std::vector<uint8_t>{10, 200, 30, 120, 120, 120}, "");
    const std::vector<std::byte> png = read_bytes(folder_ / "a leaf.png");
    write_file(folder_ / "outside.gltf", file(R"({"uri":"a%20leaf.png"})").text_);
    write_file(folder_ / "inside.glb", file(R"({"bufferView":4,"mimeType":"image/png"})", png).binary_);
  }
  struct Made {
    std::string text_, binary_;
  };
  static Made file(const std::string& image, const std::vector<std::byte>& bytes = {}, const std::string& info = "") {
    test::GltfFile f;
    f.places({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    f.floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    f.indices({0, 1, 2, 0, 2, 3});
    f.indices({0, 1, 3});
    if (!bytes.empty()) f.view(bytes);
    const std::string rest =
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
        {"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0},
        {"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":3,"material":1}]}],
        "materials":[{"name":"leaf","pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0)" +
        info + R"(},"baseColorFactor":[0.5,1,1,1]}},
        {"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.6,0.1,0.1,1]}}],
        "textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071,"wrapT":33071}],"images":[)" +
        image + "]";
    return {f.text(rest), f.binary(rest)};
  }
  Scene bake(const std::string& name, const std::string& textures, const std::string& more = "") {
    write_file(folder_ / "s.yaml", "scene: 1\n" + more + "objects: {m: {gltf: " + name + ", textures: {" + textures +
                                       "}}}\nworld: [{place: m}]\n");
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  static const Material& material(const Scene& s, const std::string& id) {
    for (const Material& m : s.materials)
      if (m.id == id) return m;
    throw std::runtime_error("no material " + id);
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

LinearRgb leaf_texel(bool second) {
  const auto linear = [](int v) { return linear_from_srgb(v / 255.0); };
  return second ? LinearRgb{0.5 * linear(120), linear(120), linear(120)}
                : LinearRgb{0.5 * linear(10), linear(200), linear(30)};
}

TEST_F(Textures, BecomeSpectraOfEveryTexel) {
  for (const char* name : {"outside.gltf", "inside.glb"}) {
    const Scene s = bake(name, "uplift: texel");
    ASSERT_TRUE(report_.ok()) << report_.text();
    ASSERT_EQ(s.property_maps.size(), 1u);
    const PropertyMap& map = s.property_maps[0];
    EXPECT_EQ(map.kind, MapKind::cube);
    EXPECT_EQ(map.projection, Projection::uv);
    EXPECT_EQ(map.drape.extend, Drape::Extend::clamp);
    EXPECT_EQ(map.filter, PropertyMap::Filter::linear);
    ASSERT_EQ(map.values.size(), 2 * kUpliftedWaves) << name;
    for (const bool second : {false, true}) {
      const auto expected = uplifted_values(leaf_texel(second));
      for (size_t k = 0; k < kUpliftedWaves; ++k)
        EXPECT_NEAR(map.values[second * kUpliftedWaves + k], expected[k], 1e-6) << name << " " << k;
    }
    EXPECT_NEAR(material(s, "m/red").surface.curves.at("reflectance").at(0.7), 0.6, 1e-6);
    EXPECT_THAT(report_.text(), HasSubstr("2 materials are matte with reflectances uplifted from display colours, 1 of "
                                          "them from textures"));
    EXPECT_THAT(report_.text(), HasSubstr("a guess from 0.38 to 0.78 um"));
  }
}

TEST_F(Textures, BecomeClasses) {
  const Scene s = bake("inside.glb", "uplift: classes, classes: 2");
  ASSERT_TRUE(report_.ok()) << report_.text();
  const PropertyMap& map = s.property_maps.at(0);
  EXPECT_EQ(map.kind, MapKind::curve_index);
  ASSERT_EQ(map.family.size(), 2u);
  ASSERT_EQ(map.values.size(), 2u);
  for (const bool second : {false, true}) {
    const Curve& curve = map.family[static_cast<size_t>(map.values[second])];
    EXPECT_NEAR(curve.at(0.53), leaf_texel(second)[1], 1e-6);
  }
  // One class: the mean, and its distance is told.
  const Scene one = bake("inside.glb", "uplift: classes, classes: 1");
  EXPECT_NEAR(one.property_maps.at(0).family.at(0).at(0.53), (leaf_texel(false)[1] + leaf_texel(true)[1]) / 2, 1e-6);
  EXPECT_THAT(report_.text(), HasSubstr("1 classes of colours: texels are"));
}

// An atlas that many materials share is one map.
TEST_F(Textures, AreSharedByMaterials) {
  std::string text = file(R"({"uri":"a%20leaf.png"})").text_;
  const std::string plain = R"("baseColorFactor":[0.6,0.1,0.1,1])";
  ASSERT_NE(text.find(plain), std::string::npos);
  text.replace(text.find(plain), plain.size(), R"("baseColorFactor":[0.5,1,1,1],"baseColorTexture":{"index":0})");
  write_file(folder_ / "atlas.gltf", text);
  const Scene s = bake("atlas.gltf", "uplift: texel");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(s.property_maps.size(), 1u);
  EXPECT_EQ(s.property_bindings.size(), 2u);
}

TEST_F(Textures, LeaveMaterialsOfTheTextAlone) {
  const Scene s = bake("inside.glb", "uplift: texel", "materials: {leaf: {model: lambert, reflectance: 0.3}}\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_TRUE(s.property_maps.empty());
  EXPECT_EQ(material(s, "leaf").surface.curves.at("reflectance").at(0.5), 0.3);
}

TEST_F(Textures, AreRefusedWhereTheyCannotBeRead) {
  const auto told = [&](const std::string& name, const std::string& textures) {
    bake(name, textures);
    EXPECT_FALSE(report_.ok());
    return report_.text();
  };
  write_file(folder_ / "none.gltf", file(R"({"uri":"none.png"})").text_);
  EXPECT_THAT(told("none.gltf", "uplift: texel"), HasSubstr("its file 'none.png': no such file"));
  write_file(folder_ / "text.glb",
             file(R"({"bufferView":4,"mimeType":"image/png"})", std::vector<std::byte>(40)).binary_);
  EXPECT_THAT(told("text.glb", "uplift: texel"), HasSubstr("is no PNG and no JPEG"));
  std::vector<std::byte> half = read_bytes(folder_ / "a leaf.png");
  half.resize(half.size() / 2);
  write_file(folder_ / "half.glb", file(R"({"bufferView":4,"mimeType":"image/png"})", half).binary_);
  EXPECT_THAT(told("half.glb", "uplift: texel"), HasSubstr("the image is damaged"));
  write_file(folder_ / "no.glb", file(R"({"bufferView":40,"mimeType":"image/png"})").binary_);
  EXPECT_THAT(told("no.glb", "uplift: texel"), HasSubstr("40"));
  EXPECT_THAT(told("inside.glb", "uplift: both"), HasSubstr("classes"));
  EXPECT_THAT(told("inside.glb", "uplift: texel, classes: 3"), HasSubstr("'classes' goes with"));
  EXPECT_THAT(told("inside.glb", "uplift: classes, classes: 0"), HasSubstr("1"));
}

// A square of an OBJ in two triangles of two materials that share their corners.
class ObjTextures : public Textures {
 protected:
  ObjTextures() { write_file(folder_ / "t.obj", kText); }
  Scene bake_obj(const std::string& library, const std::string& textures = ", textures: {uplift: texel}") {
    write_file(folder_ / "t.mtl", library);
    write_file(folder_ / "s.yaml", "scene: 1\nobjects: {m: {obj: t.obj" + textures + "}}\nworld: [{place: m}]\n");
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  static constexpr std::string_view kText =
      "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
      "usemtl leaf\nf 1/1 2/2 3/3\nusemtl red paint\nf 1/1 3/3 4/4\n";
};

TEST_F(ObjTextures, BecomeSpectraAsThoseOfModels) {
  const Scene s = bake_obj("newmtl leaf\nKd 0.5 1 1\nmap_Kd -clamp on a leaf.png\nnewmtl red paint\nKd 0.6 0.1 0.1\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  ASSERT_EQ(s.property_maps.size(), 1u);
  const PropertyMap& map = s.property_maps[0];
  EXPECT_EQ(map.kind, MapKind::cube);
  EXPECT_EQ(map.drape.extend, Drape::Extend::clamp);
  for (const bool second : {false, true}) {
    const auto expected = uplifted_values(leaf_texel(second));
    for (size_t k = 0; k < kUpliftedWaves; ++k) EXPECT_NEAR(map.values[second * kUpliftedWaves + k], expected[k], 1e-6);
  }
  EXPECT_NEAR(material(s, "m/red paint").surface.curves.at("reflectance").at(0.7), 0.6, 1e-6);
}

// -s and -o hold for their own material alone, whose corners are no longer those of the other.
TEST_F(ObjTextures, AreScaledAndMoved) {
  const Scene s =
      bake_obj("newmtl leaf\nKd 1 1 1\nmap_Kd -s 2 3 -o 0.25 0.5 a leaf.png\nnewmtl red paint\nKd 0.6 0.1 0.1\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  const Mesh& mesh = s.meshes.at(0);
  ASSERT_EQ(mesh.uvs.size(), 12u);  // two corners are of both
  const auto uv = [&](size_t corner, size_t c) { return double{mesh.uvs[2 * mesh.indices[corner] + c]}; };
  const auto at = [&](size_t corner, size_t c) { return double{mesh.positions[3 * mesh.indices[corner] + c]}; };
  for (size_t corner = 0; corner < 6; ++corner) {
    const bool leaf = corner < 3;
    EXPECT_NEAR(uv(corner, 0), leaf ? 2 * at(corner, 0) + 0.25 : at(corner, 0), 1e-6) << corner;
    EXPECT_NEAR(uv(corner, 1), leaf ? 3 * at(corner, 1) + 0.5 : at(corner, 1), 1e-6) << corner;
  }
}

TEST_F(ObjTextures, WhatIsLeftOutIsTold) {
  const std::string red = "newmtl red paint\nKd 0.6 0.1 0.1\n";
  bake_obj(
      "newmtl leaf\nKd 0 0 0\nmap_Kd -mm 0.2 1 a leaf.png\nd 0.5\nKe 1 0 0\nmap_Bump b.png\nillum 2\nKs 0.5 0.5 0.5\n" +
      red);
  EXPECT_THAT(report_.text(),
              HasSubstr("left out of how surfaces look: transparency of 1 material (an 'opacity' map makes holes), "
                        "emission of 1 material"));
  EXPECT_THAT(report_.text(), HasSubstr("normal or bump maps of 1 material"));
  EXPECT_THAT(report_.text(), HasSubstr("gloss, metal or occlusion of 1 material"));
  EXPECT_THAT(report_.text(), HasSubstr("have a Kd of 0: it is taken as 1"));
  EXPECT_THAT(report_.text(), HasSubstr("have -mm or -t"));
  bake_obj("newmtl leaf\nKd 1 1 1\n" + red);
  EXPECT_THAT(report_.text(), Not(HasSubstr("left out")));
  std::string coloured(kText);
  coloured.replace(coloured.find("v 0 0 0"), 7, "v 0 0 0 1 0 0");
  write_file(folder_ / "t.obj", std::string_view(coloured));
  bake_obj("newmtl leaf\nKd 1 1 1\n" + red);
  EXPECT_THAT(report_.text(), HasSubstr("colours of vertices of 1 mesh part"));
  // Without `textures` the library is not opened, and that is told.
  bake_obj("", ", materials: {leaf: x, red paint: x}}, x: {box: {}");
  EXPECT_THAT(report_.text(), HasSubstr("mtllib t.mtl: its display colours are no spectra"));
}

TEST_F(ObjTextures, AreRefusedWhereTheyCannotBeRead) {
  const auto told = [&](const std::string& library) {
    bake_obj(library);
    EXPECT_FALSE(report_.ok());
    return report_.text();
  };
  const std::string red = "newmtl red paint\nKd 0.6 0.1 0.1\n";
  EXPECT_THAT(told(red + "newmtl leaf\nmap_Kd none.png\n"), HasSubstr("t.mtl:3:1: its file 'none.png': no such file"));
  EXPECT_THAT(told(red + "newmtl leaf\nKd 1 x\n"), HasSubstr("t.mtl:4:1: Kd of 'leaf' is no colour"));
  EXPECT_THAT(told(red + "newmtl leaf\nmap_Kd -s 1e99 1 a leaf.png\n"), HasSubstr("t.mtl:3:1: map_Kd of 'leaf'"));
  EXPECT_THAT(told(red + std::string("newmtl leaf\0", 12)), HasSubstr("is not a text file"));
  // What has no colour is no material.
  EXPECT_THAT(told(red + "newmtl leaf\nNs 3\n"), HasSubstr("leaf"));
  write_file(folder_ / "t.obj", kText.substr(kText.find('\n') + 1));
  EXPECT_THAT(told(red), HasSubstr("'t.obj' names no library of materials (mtllib)"));
  write_file(folder_ / "t.obj", "mtllib gone.mtl\n" + std::string(kText));
  EXPECT_THAT(told(red), HasSubstr("its file 'gone.mtl': no such file"));
}

}  // namespace
}  // namespace suite::format_scene_text_textures_test
