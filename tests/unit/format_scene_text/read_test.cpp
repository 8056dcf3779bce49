#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_read_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SceneText : public ::testing::Test {
 protected:
  SceneText() { write_file(folder_ / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n"); }
  Scene bake(const std::string& text) {
    write_file(folder_ / "s.yaml", text);
    report_ = Report(scene_issues());
    return bake_scene(read_scene_text(folder_ / "s.yaml", {}, report_), report_);
  }
  std::string findings(const std::string& text) {
    bake(text);
    return report_.text();
  }
  static std::string whole(const std::string& world, const std::string& more = "") {
    return "scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2}\nobjects:\n  tri: {obj: tri.obj}\n" +
           more + "world:\n" + world;
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

TEST_F(SceneText, TransformsScaleThenRotateThenTranslate) {
  const Scene s = bake(
      whole("  - {place: tri, translate: [10, 20, 30], rotate: {axis: [0, 0, 1], angle_deg: 90}, scale: [2, 3, 4]}\n"));
  ASSERT_TRUE(report_.ok()) << report_.text();
  const Vec3 p = s.groups.at(0).placements.at(0).to_parent.point({1, 1, 1});
  EXPECT_NEAR(p.x, 10 - 3, 1e-12);
  EXPECT_NEAR(p.y, 20 + 2, 1e-12);
  EXPECT_NEAR(p.z, 30 + 4, 1e-12);
}

TEST_F(SceneText, RotationsAgree) {
  // A quarter turn about z said in four ways, compass 270 being counter-clockwise from above.
  const Scene s =
      bake(whole("  - {place: tri, rotate: {euler_deg: [0, 0, 90]}}\n"
                 "  - {place: tri, rotate: {quaternion: [1, 0, 0, 1]}}\n"
                 "  - {place: tri, rotate: {heading_deg: 270}}\n"
                 "  - {place: tri, matrix: [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0]}\n"
                 "  - {place: tri, rotate: [{axis: [0, 0, 2], angle_deg: 45}, {axis: [0, 0, 1], angle_deg: 45}]}\n"));
  ASSERT_TRUE(report_.ok()) << report_.text();
  for (const Placement& p : s.groups.at(0).placements) {
    const Vec3 v = p.to_parent.point({1, 0, 0});
    EXPECT_NEAR(v.x, 0, 1e-12);
    EXPECT_NEAR(v.y, 1, 1e-12);
  }
}

TEST_F(SceneText, EulerOrderIsFixedAxesFirstLetterFirst) {
  const Scene s = bake(whole("  - {place: tri, rotate: {euler_deg: [90, 0, 90], order: xyz}}\n"));
  // (0, 1, 0): about x by 90 to (0, 0, 1), about z it stays.
  const Vec3 v = s.groups.at(0).placements.at(0).to_parent.point({0, 1, 0});
  EXPECT_NEAR(v.z, 1, 1e-12);
}

TEST_F(SceneText, GroupsNestAndChildrenComeAfterParents) {
  std::string groups = "groups:\n";
  for (int k = 0; k < 64; ++k)
    groups += strf("  g%d: [{place: %s, translate: [1, 0, 0], rotate: {axis: [0, 0, 1], angle_deg: 1}}]\n", k,
                   k == 63 ? "tri" : strf("g%d", k + 1).c_str());
  const Scene s = bake(whole("  - {place: g0}\n", groups));
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_NO_THROW(check_scene(s, "t"));
  // The composed pose against the closed form of 64 equal screw steps: a turn by 64 degrees, and a geometric sum.
  Affine3 all;
  uint32_t group = 0;
  for (int depth = 0; depth < 65; ++depth) {
    all = all * s.groups[group].placements.at(0).to_parent;
    group = s.groups[group].placements.at(0).target;
  }
  const double a = kDegree, x = (std::sin(32 * a) / std::sin(a / 2)) * std::cos(31.5 * a),
               y = (std::sin(32 * a) / std::sin(a / 2)) * std::sin(31.5 * a);
  EXPECT_NEAR(all.b.x, x, 1e-12);
  EXPECT_NEAR(all.b.y, y, 1e-12);
  EXPECT_NEAR(all.a[0], std::cos(64 * a), 1e-12);
}

TEST_F(SceneText, TablesPlaceManyInTheirOrder) {
  write_file(folder_ / "t.csv", "# trees\nx,y,z,heading_deg,scale\n1,2,3,270,2\n-1, +0.5, 0, 0, 1\n");
  const Scene s = bake(whole("  - {place: tri, table: t.csv, translate: [100, 0, 0]}\n"));
  ASSERT_TRUE(report_.ok()) << report_.text();
  ASSERT_EQ(s.groups[0].placements.size(), 2u);
  const Vec3 v = s.groups[0].placements[0].to_parent.point({1, 0, 0});
  EXPECT_NEAR(v.x, 101, 1e-12);
  EXPECT_NEAR(v.y, 4, 1e-12);
  EXPECT_NEAR(s.groups[0].placements[1].to_parent.b.y, 0.5, 0);
  const double rows[16] = {1, 2, 3, 1, 0, 0, 0, 2, 4, 5, 6, 1, 0, 0, 1, 1};
  write_file(folder_ / "t.f64", std::as_bytes(std::span(rows)));
  const Scene b = bake(whole("  - {place: tri, table: t.f64}\n"));
  EXPECT_NEAR(b.groups[0].placements.at(1).to_parent.point({1, 0, 0}).y, 6, 1e-12);
  write_file(folder_ / "t.csv", "x,y,hdg\n1,2,3\n");
  EXPECT_THAT(findings(whole("  - {place: tri, table: t.csv}\n")), HasSubstr("t.csv:1:1: unknown column 'hdg'"));
  write_file(folder_ / "t.csv", "x,y\n1,2\n1;2\n");
  EXPECT_THAT(findings(whole("  - {place: tri, table: t.csv}\n")), HasSubstr("t.csv:3:1: expected 2 numbers"));
  write_file(folder_ / "t.csv", "x,y,scale\n1,2,0\n");
  EXPECT_THAT(findings(whole("  - {place: tri, table: t.csv}\n")), HasSubstr("t.csv:2:1: a scale of 0"));
}

TEST_F(SceneText, ScatterKeepsToItsDensityAndSurface) {
  // Two triangles of 50 and 150 m2, one of them steep: points per area agree within 4 sigma.
  write_file(folder_ / "two.obj",
             "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 100 0 0\nv 110 0 0\nv 100 10 28.2842712\nusemtl grey\nf 1 2 3\nf 4 5 6\n");
  const std::string text =
      whole("  - {place: two}\n  - {place: tri, on: two, scatter: {density_per_m2: 20, seed: 7, scale: [0.5, 2]}}\n",
            "  two: {obj: two.obj}\n");
  const Scene s = bake(text), t = bake(text);
  ASSERT_TRUE(report_.ok()) << report_.text();
  size_t flat = 0, steep = 0;
  for (size_t k = 1; k < s.groups[0].placements.size(); ++k) {
    const Affine3& a = s.groups[0].placements[k].to_parent;
    EXPECT_EQ(a, t.groups[0].placements[k].to_parent);
    if (a.b.x < 50) {
      ++flat;
      EXPECT_EQ(a.b.z, 0);
    } else {
      ++steep;
      EXPECT_NEAR(a.b.z, a.b.y * 2.82842712, 1e-5);
    }
    EXPECT_NEAR(a.a[8], 1.25, 0.7500001);
  }
  EXPECT_EQ(flat + steep, 4000u);
  EXPECT_NEAR(static_cast<double>(flat), 1000, 4 * std::sqrt(4000 * 0.25 * 0.75));
  EXPECT_THAT(findings(whole("  - {place: tri, scatter: {density_per_m2: 1}}\n")), HasSubstr("'scatter' needs 'on'"));
}

TEST_F(SceneText, TerrainInSceneCoordinatesFromPngAndEnvi) {
  // 3 x 2 samples of 16 bit: PNG by OpenImageIO is tested with the sample scene; ENVI is written here.
  const float heights[6] = {100, 200, 300, 400, 500, 65535};
  write_file(folder_ / "h.img", std::as_bytes(std::span(heights)));
  write_file(folder_ / "h.img.hdr",
             "ENVI\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\ninterleave = bsq\nbyte order = 0\n");
  const Scene s = bake(
      "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {terrain: h.img, local: {origin: "
      "[10, 20], gsd: [2, 4]}, height_scale: 0.01, height_offset: -1, no_data: 65535, material: grey}}\nworld: "
      "[{place: t}]\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  // Samples at pixel centres: x 11, 13, 15; y 18, 14; the last one is a gap, which leaves out two of four triangles.
  EXPECT_EQ(s.meshes.at(0).triangle_count(), 2u);
  EXPECT_NEAR(s.bounds.low.x, 11, 1e-6);
  EXPECT_NEAR(s.bounds.high.y, 18, 1e-6);
  EXPECT_NEAR(s.bounds.low.z, 0, 1e-6);
}

TEST_F(SceneText, PropertyMapsAreCheckedAndBound) {
  const float cube[8] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f};
  write_file(folder_ / "c.img", std::as_bytes(std::span(cube)));
  write_file(folder_ / "c.img.hdr",
             "ENVI\nsamples = 2\nlines = 2\nbands = 2\ndata type = 4\ninterleave = bip\nbyte order = 0\nwavelength "
             "units = um\nwavelength = {0.5, 0.6}\n");
  const std::string head =
      "scene: 1\nwindows_um: [[0.45, 0.7]]\nmaterials:\n  grey: {model: lambert, reflectance: 0.2, maps: "
      "[cube]}\nobjects: {tri: {obj: tri.obj}}\nworld: [{place: tri}]\nmaps:\n";
  const Scene s = bake(head + "  cube: {type: cube, file: c.img, outside: hold, projection: uv}\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(s.property_maps.at(0).values, std::vector<float>(cube, cube + 8));
  EXPECT_EQ(s.property_bindings.at(0).material, 0u);
  EXPECT_NO_THROW(check_scene(s, "t"));
  EXPECT_EQ(s.property_maps[0].outside, Outside::hold);
  // Beyond its channels a cube holds nothing unless it says so; what it reflects leaves room for what is let through.
  EXPECT_THAT(findings(head + "  cube: {type: cube, file: c.img, projection: uv}\n"),
              HasSubstr("cube 'cube' has channels from 0.5 to 0.6 um, the window is 0.45 to 0.7 um"));
  std::string leaf = head;
  leaf.replace(leaf.find("reflectance: 0.2"), 16, "reflectance: 0.2, transmittance: 0.25");
  EXPECT_THAT(findings(leaf + "  cube: {type: cube, file: c.img, outside: hold, projection: uv}\n"),
              HasSubstr("map 'cube' has reflectance 0.8, with transmittance 0.25 at 0.6 um"));
  leaf.replace(leaf.find("0.25"), 4, "0.19");
  EXPECT_THAT(findings(leaf + "  cube: {type: cube, file: c.img, outside: hold, projection: uv}\n"),
              Not(HasSubstr("SP105")));
  EXPECT_THAT(findings(head + "  cube: {type: cube, file: c.img, projection: uv, scale: 10}\n"),
              HasSubstr("a value of 2"));
  EXPECT_THAT(findings(head + "  cube: {type: cube, file: c.img, projection: uv, parameter: roughness}\n"),
              HasSubstr("has no curve 'roughness'"));
  EXPECT_THAT(findings(head + "  cub: {type: cube, file: c.img, projection: uv}\n"),
              HasSubstr("unknown map 'cube'; did you mean 'cub'?"));
  EXPECT_THAT(findings(head + "  cube: {type: cube, file: c.img, drape: {origin: [0, 0]}}\n"),
              HasSubstr("the key 'gsd' is missing"));
}

TEST_F(SceneText, AllFaultsInOneRun) {
  const std::string text = findings(
      "scene: 1\n"
      "materials:\n"
      "  grey: {model: lambrt, reflectance: 0.2}\n"
      "  red: {model: lambert, reflectance: 1.2}\n"
      "  blue: {model: lambert, reflectance: blue.txt}\n"
      "objects:\n"
      "  tri: {obj: tri.obj, normls: smooth}\n"
      "  sphere: {sphere: {radius: 1}, material: gray}\n"
      "world:\n"
      "  - {place: trii}\n"
      "  - {place: sphere, scale: 0}\n"
      "  - {place: tri, rotate: {angle: 3}}\n");
  EXPECT_THAT(text, HasSubstr("s.yaml:3:17: unknown model 'lambrt'; did you mean 'lambert'?\n    grey: {model: lambrt, "
                              "reflectance: 0.2}\n                  ^"));
  EXPECT_THAT(text, HasSubstr("s.yaml:4:16: model 'lambert': reflectance = 1.2 is outside its range"));
  EXPECT_THAT(text, HasSubstr("s.yaml:5:39: file 'blue.txt' no such file"));
  EXPECT_THAT(text, HasSubstr("s.yaml:7:23: unknown key 'normls'; did you mean 'normals'?"));
  EXPECT_THAT(text, HasSubstr("s.yaml:8:43: unknown material 'gray'; did you mean 'grey'?"));
  EXPECT_THAT(text, HasSubstr("s.yaml:10:13: unknown object 'trii'; did you mean 'tri'?"));
  EXPECT_THAT(text, HasSubstr("[SP404] x1"));
  EXPECT_THAT(text, HasSubstr("a rotation needs"));
  EXPECT_THAT(text, HasSubstr("verdict: refused (8 errors"));
}

// What could not be read is told once, not again by everything that names it.
TEST_F(SceneText, OneFaultOneMessage) {
  const auto faults = [&](const std::string& text) {
    findings(text);
    return report_.count(Severity::error) + report_.count(Severity::warning);
  };
  const std::string grey = "materials: {grey: {model: lambert, reflectance: 0.2}}\n";
  write_file(folder_ / "bad.obj", std::string("\0\1\2", 3));
  write_file(folder_ / "bad.csv", std::string_view("x,y,z\n1,2,nan\n"));
  write_file(folder_ / "far.csv", std::string_view("x,y,z\n1e300,0,0\n"));
  EXPECT_EQ(
      faults("scene: 1\n" + grey + "objects: {t: {obj: bad.obj, material: grey}}\nworld: [{place: t}, {place: t}]\n"),
      1u);
  EXPECT_EQ(faults("scene: 1\n" + grey +
                   "objects: {t: {obj: gone.obj, material: grey}, u: {sphere: {radius: 1}, material: grey}}\n"
                   "world: [{place: t}, {place: u, on: t}]\n"),
            1u);
  EXPECT_EQ(faults("scene: 1\n" + grey +
                   "objects: {t: {obj: tri.obj, material: grey}}\nworld: [{place: t, table: bad.csv}]\n"),
            1u);
  EXPECT_EQ(faults("scene: 1\n" + grey +
                   "objects: {t: {obj: tri.obj, material: grey}}\nworld: [{place: t, table: far.csv}]\n"),
            1u);
  EXPECT_EQ(faults("scene: 1\nmaps: {m: {type: class, file: gone.png, materials: {0: grey}, projection: uv}}\n"
                   "materials: {grey: {model: lambert, reflectance: 0.2}, land: {map: m}}\n"
                   "objects: {t: {obj: tri.obj, material: land}, u: {obj: tri.obj, material: grey}}\nworld: [{place: "
                   "t}, {place: u}]\n"),
            1u);
}

TEST_F(SceneText, CirclesOfGroupsAreFound) {
  EXPECT_THAT(findings(whole("  - {place: tri}\n", "groups:\n  a: [{place: b}]\n  b: [{place: a}]\n")),
              HasSubstr("[SP402] x2"));
}

TEST_F(SceneText, CoverageEnergyAndUnused) {
  const std::string text = findings(
      "scene: 1\nwindows_um: [[0.4, 2.0]]\n"
      "materials:\n"
      "  grey: {model: lambert, reflectance: {points: [[0.4, 0.5], [1.0, 0.6]]}}\n"
      "  leaf: {model: lambert, reflectance: 0.6, transmittance: {points: [[0.3, 0.1], [2.5, 0.5]]}}\n"
      "objects: {tri: {obj: tri.obj}}\nworld: [{place: tri}]\n");
  EXPECT_THAT(text, HasSubstr("[SP104] x1"));
  EXPECT_THAT(text, HasSubstr("[SP105] x1"));
  EXPECT_THAT(text, HasSubstr("material 'leaf' is not used"));
  EXPECT_THAT(findings("scene: 1\nwindows_um: [[0.4, 2.0]]\nmaterials: {grey: {model: lambert, reflectance: {points: "
                       "[[0.4, 0.5], [1.0, 0.6]], outside: hold}}}\n"
                       "objects: {tri: {obj: tri.obj}}\nworld: [{place: tri}]\n"),
              Not(HasSubstr("SP104")));
}

TEST_F(SceneText, MirroredUpAxisKeepsWindingAndNormals) {
  write_file(folder_ / "up.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nvn 0 1 0\nf 1//1 2//1 3//1\n");
  const Scene s = bake(
      "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: up.obj, up: y, material: "
      "grey}}\nworld: [{place: t}]\n");
  const Mesh& m = s.meshes.at(0);
  const auto p = [&](int k) {
    return Vec3{m.positions[3 * m.indices[k]], m.positions[3 * m.indices[k] + 1], m.positions[3 * m.indices[k] + 2]};
  };
  const Dir facet = normalized(cross(p(1) - p(0), p(2) - p(0)));
  EXPECT_NEAR(facet.z, 1, 1e-6);
  EXPECT_NEAR(oct_decode(m.normals[0]).z, 1, 1e-4);
}

TEST_F(SceneText, EmptyAndForeignTexts) {
  EXPECT_THAT(message_of([&] { bake(""); }), HasSubstr("is empty"));
  EXPECT_THAT(message_of([&] { bake("scene: 7\n"); }), HasSubstr("s.yaml:1:8: error: 7 is outside the valid range"));
  EXPECT_THAT(message_of([&] { bake("[1, 2"); }), HasSubstr("s.yaml:1:1: error"));
  EXPECT_THAT(message_of([&] { bake("just text"); }), HasSubstr("s.yaml:1:1"));
}

TEST_F(SceneText, TemperaturesAndLayers) {
  const std::string tail = "objects:\n  tri: {obj: tri.obj}\nworld:\n  - {place: tri}\n";
  const auto material = [&](const std::string& more) {
    return "scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2, " + more + "}\n" + tail;
  };
  Scene s = bake(material("temperature: {table: [[0, 280], [100, 300]], repeat: true}"));
  ASSERT_TRUE(report_.ok()) << report_.text();
  ASSERT_EQ(s.temperatures.size(), 1u);
  EXPECT_EQ(s.temperatures[0].spec.model, "tabulated");
  EXPECT_EQ(s.temperatures[0].spec.kelvins, (std::vector<double>{280, 300}));
  EXPECT_TRUE(s.temperatures[0].spec.repeat);
  s =
      bake(material("thermal: {layers: [{thickness_m: 0.01, density_kg_m3: 1000, specific_heat_j_kg_k: [800, 0.5], "
                    "conductivity_w_m_k: 2}]}"));
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_EQ(s.temperatures.at(0).spec.layers.at(0).specific_heat[1], 0.5);
  EXPECT_THAT(findings(material("temperature: {table: [[0, 280], [0, 300]]}")), HasSubstr("s.yaml:3"));
  // The declared time must lie in a table that does not repeat.
  const std::string early = "times_s: [-1, 50]\n" + tail, within = "times_s: [0, 100]\n" + tail;
  const auto timed = [&](const std::string& more, const std::string& rest) {
    return "scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2, " + more + "}\n" + rest;
  };
  EXPECT_THAT(findings(timed("temperature: {table: [[0, 280], [100, 300]]}", early)),
              HasSubstr("temperatures are given from 0 to 100 s, 'times_s' is -1 to 50 s"));
  EXPECT_THAT(findings(timed("temperature: {table: [[0, 280], [100, 300]]}", within)), Not(HasSubstr("SP106")));
  EXPECT_THAT(findings(timed("temperature: {table: [[0, 280], [100, 300]], repeat: true}", early)),
              Not(HasSubstr("SP106")));
  EXPECT_THAT(findings(material("temperature: {table: [[0, 280, 1]]}")), HasSubstr("a point is [seconds, kelvin]"));
  EXPECT_THAT(findings(material("temperature: {model: tabluated}")), HasSubstr("did you mean 'tabulated'?"));
  EXPECT_THAT(findings(material("temperature_k: 300, temperature: {model: constant, kelvin: 300}")),
              HasSubstr("either"));
  EXPECT_THAT(
      findings(material(
          "thermal: {layers: [{thickness_m: 0, density_kg_m3: 1, specific_heat_j_kg_k: 1, conductivity_w_m_k: 1}]}")),
      HasSubstr("thickness_m"));
}

TEST_F(SceneText, MapsMayBeEnviImages) {
  // Bands one after the other: 2 x 1 pixels of shares 1 and 0, 1 and 3; whole numbers; kelvin.
  const float shares[] = {1, 1, 0, 3}, kelvin[] = {290, 310};
  const uint8_t classes[] = {7, 9};
  const auto image = [&](const char* name, std::span<const std::byte> bytes, int bands, int type) {
    write_file(folder_ / (std::string(name) + ".img"), bytes);
    write_file(folder_ / (std::string(name) + ".img.hdr"),
               std::string_view(strf("ENVI\nsamples = 2\nlines = 1\nbands = %d\nheader offset = 0\ndata type = %d\n"
                                     "interleave = bsq\nbyte order = 0\n",
                                     bands, type)));
  };
  image("shares", std::as_bytes(std::span(shares)), 2, 4), image("kelvin", std::as_bytes(std::span(kelvin)), 1, 4);
  image("classes", std::as_bytes(std::span(classes)), 1, 1);
  const std::string text =
      "scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2}\n  warm: {model: lambert, reflectance: 0.1, "
      "maps: [heat]}\n  mix: {model: lambert, reflectance: 0.2, maps: [parts]}\n  chosen: {map: which}\n"
      "maps:\n  parts: {type: mixture, file: shares.img, materials: [grey, grey], projection: uv}\n"
      "  heat: {type: temperature, file: kelvin.img, projection: uv}\n"
      "  which: {type: class, file: classes.img, materials: {7: grey, 9: warm}, projection: uv}\n"
      "objects:\n  tri: {obj: tri.obj, materials: {grey: mix}}\nworld:\n  - {place: tri}\n  - {place: tri, material: "
      "warm}\n  - {place: tri, material: chosen}\n";
  const Scene scene = bake(text);
  EXPECT_TRUE(report_.ok()) << report_.text();
  ASSERT_EQ(scene.class_maps.size(), 1u);
  EXPECT_EQ(scene.class_maps[0].classes, (std::vector<uint16_t>{0, 1}));  // the materials in their order
  for (const PropertyMap& map : scene.property_maps)
    EXPECT_EQ(map.values,
              map.name == "parts" ? (std::vector<float>{1, 0, 0.25f, 0.75f}) : (std::vector<float>{290, 310}));
  // Floats are no classes, and what is cut is told.
  std::string wrong = text;
  EXPECT_THAT(findings(wrong.replace(wrong.find("classes.img"), 11, "kelvin.img")), HasSubstr("has 1 of floats"));
  write_file(folder_ / "shares.img", std::string_view("short"));
  EXPECT_THAT(findings(text), HasSubstr("shares.img"));
}

TEST_F(SceneText, PartsOfMixturesAreWholeMaterials) {
  // A 1 x 1 pixel RGB image in the plain PPM format, which every reader of images knows.
  write_file(folder_ / "one.ppm", std::string_view("P3\n1 1\n255\n100 100 55\n"));
  const std::string text =
      "scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2}\n  other: {model: lambert, reflectance: 0.1, "
      "maps: [deep]}\n"
      "  mix: {model: lambert, reflectance: 0.2, maps: [fractions]}\n"
      "maps:\n  fractions: {type: mixture, file: one.ppm, materials: [grey, PART, grey], projection: uv}\n"
      "  deep: {type: normal, file: one.ppm, projection: uv}\n"
      "objects:\n  tri: {obj: tri.obj, materials: {grey: mix}}\nworld:\n  - {place: tri}\n  - {place: tri, material: "
      "other}\n";
  const auto with = [&](const std::string& part) {
    std::string t = text;
    return findings(t.replace(t.find("PART"), 4, part));
  };
  EXPECT_THAT(with("grey"), Not(HasSubstr("cannot be part")));
  EXPECT_TRUE(report_.ok()) << report_.text();
  EXPECT_THAT(with("other"), HasSubstr("material 'other' cannot be part of mixture 'fractions'"));
  EXPECT_THAT(with("mix"), HasSubstr("material 'mix' cannot be part of mixture 'fractions'"));
}

}  // namespace
}  // namespace suite::format_scene_text_read_test
