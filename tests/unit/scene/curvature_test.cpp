#include "scene/curvature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/combine.h"
#include "scene/issues.h"
#include "support/temp_folder.h"
#include "surface/map_lookup.h"

namespace suite::curvature_test {
namespace {

using ::testing::HasSubstr;

constexpr double kLatitude = 49.5, kLongitude = 8.25, kHeight = 110;

class Curvature : public ::testing::Test {
 protected:
  Scene scene(const std::string& rest, const std::string& curvature = "curvature: wgs84\n") {
    write_file(folder_ / "s.yaml",
               "scene: 1\norigin: {latitude_deg: 49.5, longitude_deg: 8.25, height_m: 110}\n" + curvature +
                   "materials: {grey: {model: lambert, reflectance: 0.2}, red: {model: lambert, reflectance: 0.1}}\n" +
                   rest);
    report_ = Report(scene_issues());
    const Draft draft = read_scene_text(folder_ / "s.yaml", {}, report_);
    Scene made = bake_scene(draft, report_);
    EXPECT_TRUE(report_.ok()) << report_.text();
    check_scene(made, "s");
    return made;
  }
  // Straight from GeographicLib: the geodesic of the plane's length and direction, then the local tangent frame. On the
  // plane distances count at the origin's height, so they shrink by R / (R + h) on the ellipsoid.
  static Vec3 truth(Vec3 plane) {
    const double azimuth = std::atan2(plane.x, plane.y) * 180 / kPi, r = std::hypot(plane.x, plane.y);
    const double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f), s = std::sin(kLatitude * kPi / 180);
    const double n = a / std::sqrt(1 - e2 * s * s), m = n * (1 - e2) / (1 - e2 * s * s),
                 c = std::cos(azimuth * kPi / 180), radius = 1 / (c * c / m + (1 - c * c) / n);
    double latitude = 0, longitude = 0;
    GeographicLib::Geodesic::WGS84().Direct(kLatitude, kLongitude, azimuth, r * radius / (radius + kHeight), latitude,
                                            longitude);
    Vec3 p;
    GeographicLib::LocalCartesian(kLatitude, kLongitude, kHeight)
        .Forward(latitude, longitude, kHeight + plane.z, p.x, p.y, p.z);
    return p;
  }
  TempFolder folder_;
  Report report_{scene_issues()};
};

Vec3 place(const Mesh& m, size_t v) {
  return m.origin + Vec3{m.positions[3 * v], m.positions[3 * v + 1], m.positions[3 * v + 2]};
}

// d^2 / 2R with the radius of curvature in the direction; the next term is d^4 / 8R^3 < 0.1 mm, and up to 0.35 % of R
// is what the ellipsoid bends differently along 20 km: together below 2 cm of 31 m.
TEST_F(Curvature, ThingsTwentyKilometresAwayDropAndTilt) {
  write_file(folder_ / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Scene s = scene(
      "objects: {t: {obj: t.obj, material: grey}}\n"
      "world: [{place: t}, {place: t, translate: [20000, 0, 0]}, {place: t, translate: [0, -20000, 5]},\n"
      "  {place: t, translate: [14142, 14142, 100], rotate: {heading_deg: 30}, scale: 2}]\n");
  const Vec3 flat[] = {{0, 0, 0}, {20000, 0, 0}, {0, -20000, 5}, {14142, 14142, 100}};
  const SceneFrame frame({kLatitude, kLongitude, kHeight});
  ASSERT_EQ(s.groups[0].placements.size(), 4u);
  ASSERT_EQ(s.meshes.size(), 1u);  // small: turned as a whole
  for (size_t k = 0; k < 4; ++k) {
    const Affine3& t = s.groups[0].placements[k].to_parent;
    EXPECT_LT(length(t.b - truth(flat[k])), 1e-6) << k;
    const double d2 = flat[k].x * flat[k].x + flat[k].y * flat[k].y;
    EXPECT_NEAR(t.b.z, flat[k].z - d2 / (2 * 6.38e6), 0.11 * d2 / 4e8 + 1e-7) << k;  // R is 6.36e6 to 6.40e6 m
    // Its z axis is the ellipsoid's normal there.
    const Vec3 up = normalized(t.vector({0, 0, 1}));
    EXPECT_LT(length(up - frame.local_axes(t.b).z), 1e-9) << k;
    EXPECT_NEAR(std::cbrt(t.determinant()), k == 3 ? 2 : 1, 1e-12);
  }
}

TEST_F(Curvature, LargeMeshesAreLaidDownVertexByVertex) {
  std::string obj;
  constexpr int n = 41;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) obj += strf("v %d %d %d\n", (i - n / 2) * 1000, (j - n / 2) * 1000, 10 * ((i + j) % 7));
  obj += "vn 0 0 1\n";
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i)
      obj +=
          strf("f %d//1 %d//1 %d//1 %d//1\n", j * n + i + 1, j * n + i + 2, (j + 1) * n + i + 2, (j + 1) * n + i + 1);
  write_file(folder_ / "wide.obj", obj);
  const Scene s = scene(
      "objects: {wide: {obj: wide.obj, material: grey}}\nworld: [{place: wide}, {place: wide, scale: [-1, 1, 1], "
      "translate: [0, 0, 500]}]\n",
      "curvature: {tolerance_m: 0.05}\n");
  EXPECT_EQ(report_.count("SP409"), 0u) << report_.text();
  ASSERT_EQ(s.meshes.size(), 2u);
  const SceneFrame frame({kLatitude, kLongitude, kHeight});
  for (int mirror = 0; mirror < 2; ++mirror) {
    const Mesh& m = s.meshes[s.groups[0].placements[mirror].target];
    ASSERT_EQ(m.vertex_count(), size_t{n * n});
    std::vector<Vec3> expected;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        expected.push_back(truth(
            {(mirror ? -1000.0 : 1000.0) * (i - n / 2), 1000.0 * (j - n / 2), 10.0 * ((i + j) % 7) + 500 * mirror}));
    double worst = 0, tilt = 0;
    for (size_t v = 0; v < m.vertex_count(); ++v) {
      double nearest = 1e9;
      for (const Vec3& e : expected) nearest = std::min(nearest, length(place(m, v) - e));
      worst = std::max(worst, nearest);
      tilt = std::max(tilt, length(oct_decode(m.normals[v]) - frame.local_axes(place(m, v)).z));
    }
    EXPECT_LT(worst, 0.0025);  // floats of a mesh 40 km wide; the points themselves are exact to 1e-6 m
    EXPECT_LT(tilt, 1e-4);
    for (size_t t = 0; t < m.triangle_count(); t += 97) {
      const Vec3 a = place(m, m.indices[3 * t]);
      EXPECT_GT(cross(place(m, m.indices[3 * t + 1]) - a, place(m, m.indices[3 * t + 2]) - a).z, 0);
    }
  }
  // Edges of 1 km leave the surface by 2 cm.
  scene("objects: {wide: {obj: wide.obj, material: grey}}\nworld: [{place: wide}]\n");
  EXPECT_EQ(report_.count("SP409"), 2u * (n - 1) * (n - 1));
}

TEST_F(Curvature, LargeGroupsAreResolvedSmallOnesAreNot) {
  write_file(folder_ / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const Scene s = scene(
      "objects: {t: {obj: t.obj, material: grey}, sea: {plane: {width: 30000, depth: 30000}, material: red}, ball: "
      "{sphere: {radius: 1}, material: red}}\n"
      "groups:\n  town: [{place: street, translate: [100, 0, 0]}, {place: street, translate: [9000, 0, 0], tag: far}, "
      "{place: rotor, translate: [0, 9000, 0]}]\n"
      "  street: [{place: t}, {place: t, translate: [20, 0, 0], material: red}]\n"
      "  rotor: [{place: hub}]\n  hub: [{place: ball, motion: {kind: spin, position_m: [0, 0, 3], axis: [0, 0, 1], "
      "rate_deg_s: 10}}]\n"
      "world: [{place: town, tag: near, translate: [1000, 0, 0]}, {place: sea}]\n");
  EXPECT_EQ(report_.count("SP408"), 1u) << report_.text();
  EXPECT_THAT(report_.text(), HasSubstr("exact surface 'sea' is too large"));
  const std::vector<Placement>& root = s.groups[0].placements;
  ASSERT_EQ(root.size(), 4u);
  EXPECT_EQ(s.groups.size(), 4u);  // the root, street, rotor, hub; town is resolved
  EXPECT_LT(length(root[0].to_parent.b - truth({1100, 0, 0})), 1e-6);
  EXPECT_LT(length(root[1].to_parent.b - truth({10000, 0, 0})), 1e-6);
  EXPECT_LT(length(root[2].to_parent.b - truth({1000, 9000, 0})), 1e-6);
  EXPECT_EQ(s.tags.at(root[0].tag), "near");
  EXPECT_EQ(s.tags.at(root[1].tag), "far");
  EXPECT_EQ(s.groups[root[0].target].name, "street");
  EXPECT_EQ(s.groups[root[2].target].name, "rotor");
}

// A moving part of a group that had to be resolved keeps a group, and parents still come before children.
TEST_F(Curvature, MovingPartsOfLargeGroupsStayInAGroup) {
  const Scene s = scene(
      "objects: {ball: {sphere: {radius: 1}, material: red}}\n"
      "groups:\n  town: [{place: ball, translate: [9000, 0, 0]}, {place: pair, motion: {kind: spin, position_m: [0, 0, "
      "3], axis: [0, 0, 1], rate_deg_s: 10}}]\n"
      "  pair: [{place: ball}, {place: ball, translate: [3, 0, 0]}]\n"
      "world: [{place: town, translate: [1000, 0, 0]}]\n");
  EXPECT_EQ(report_.count("SP410"), 1u);
  ASSERT_EQ(s.groups.size(), 3u);
  const Placement& alone = s.groups[0].placements.at(1);
  EXPECT_EQ(s.groups[alone.target].placements.at(0).track, 0u);
  EXPECT_EQ(s.groups[s.groups[alone.target].placements[0].target].name, "pair");
  EXPECT_LT(length(alone.to_parent.b - truth({1000, 0, 0})), 1e-6);
}

TEST_F(Curvature, GeoreferencedTerrainStaysOnTheEarth) {
  const auto at_dem = [&](const std::string& curvature) {
    return scene("objects: {dem: {terrain: '" SUITE_SOURCE_DIR
                 "/sample_scenes/calibration_range/dem_hd_sub.tif', height: ellipsoid, material: grey}}\n"
                 "world: [{place: dem}]\n",
                 curvature);
  };
  const Scene flat = at_dem(""), curved = at_dem("curvature: wgs84\n");
  ASSERT_EQ(flat.meshes.size(), curved.meshes.size());
  for (size_t k = 0; k < flat.meshes.size(); ++k) {
    ASSERT_EQ(flat.meshes[k].indices, curved.meshes[k].indices);
    const Affine3& t = curved.groups[0].placements[k].to_parent;
    for (size_t v = 0; v < flat.meshes[k].vertex_count(); ++v)
      ASSERT_LT(length(place(flat.meshes[k], v) - t.point(place(curved.meshes[k], v))), 2e-3);
  }
}

// A map asks where the point came from on the plane: after the file, and in a second scene elsewhere on the Earth.
TEST_F(Curvature, DrapesStayOnThePlane) {
  Scene s;
  s.origin = {kLatitude, kLongitude, kHeight, true};
  s.groups = {{"world", {}}};
  s.materials.resize(1);
  s.materials[0].id = "a";
  s.materials[0].surface = {
      "lambert", {}, {{"reflectance", Curve::constant(0.2)}, {"transmittance", Curve::constant(0)}}, {}, nullptr};
  ClassMap map;
  map.name = "land", map.width = 4, map.height = 4, map.classes.assign(16, 0), map.materials = {0};
  map.drape = {-20000, 20000, 10000, 10000, Drape::Extend::none};
  s.class_maps = {map};
  s.map_bindings = {{0, 0}};
  curve_scene(s, 0.01);
  write_scene(s, {}, folder_ / "s.h5");
  Scene back = read_scene(folder_ / "s.h5");
  EXPECT_TRUE(back.curved);
  Scene first;
  first.origin = {kLatitude + 0.1, kLongitude - 0.2, 0, true};
  first.groups = {{"world", {}}};
  const SceneFrame here({kLatitude, kLongitude, kHeight}), there({kLatitude + 0.1, kLongitude - 0.2, 0});
  std::vector<ScenePart> parts;
  parts.push_back({"first", first, {}, {}});
  parts.push_back({"second", back, {}, {}});
  const Scene both = combine_scenes(std::move(parts));
  for (const Vec3 plane : {Vec3{19999, -19999, 30}, Vec3{-19999.5, 0.25, 0}, Vec3{1, 2, 3}}) {
    const Vec3 enu = truth(plane), other = there.enu_from_ecef(here.ecef_from_enu(enu));
    const Vec2 expected{(plane.x + 20000) / 10000, (20000 - plane.y) / 10000};
    const ClassMap *own = &back.class_maps[0], *far = &both.class_maps[0];
    for (const auto& [m, p] : {std::pair{own, enu}, std::pair{far, other}}) {
      const Vec2 at = pixel_of(m->projection, m->drape, m->width, m->height, {p, {}});
      EXPECT_NEAR(at.x, expected.x, 1e-9);
      EXPECT_NEAR(at.y, expected.y, 1e-9);
    }
    // Without the plane the pixel would be off by the contraction towards the tangent plane.
    Drape naked = own->drape;
    naked.plane.reset();
    if (std::fabs(plane.x) > 1e4) {
      EXPECT_GT(std::fabs(pixel_of(own->projection, naked, 4, 4, {enu, {}}).x - expected.x), 1e-6);
    }
  }
}

TEST_F(Curvature, NeedsAnOrigin) {
  write_file(folder_ / "s.yaml",
             "scene: 1\ncurvature: wgs84\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {b: {sphere: "
             "{radius: 1}, material: grey}}\nworld: [{place: b}]\n");
  Report report(scene_issues());
  read_scene_text(folder_ / "s.yaml", {}, report);
  EXPECT_THAT(report.text(), HasSubstr("s.yaml:2:12: 'curvature' needs the scene's 'origin'"));
}

}  // namespace
}  // namespace suite::curvature_test
