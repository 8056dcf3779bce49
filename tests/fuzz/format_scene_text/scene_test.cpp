// Damaged scene texts, prepared scenes, rasters, curves and instance tables: a value, findings, or one Error.
#include "base/files.h"
#include "formats/curve/curve.h"
#include "formats/instances/instances.h"
#include "formats/raster/raster.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_scene_test {

namespace {

class FuzzScene : public ::testing::Test {
 protected:
  FuzzScene() { write_file(folder_ / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n"); }
  // The bytes as a file of that name, handed to `read`.
  auto as_file(const std::string& name, std::function<void(const std::string&)> read) {
    return [this, name, read](std::span<const std::byte> bytes) {
      test::put_file(folder_ / name, bytes);
      read(folder_ / name);
    };
  }
  TempFolder folder_;
};

const std::string kText =
    "scene: 1\norigin: {latitude_deg: 49, longitude_deg: 8}\nwindows_um: [[0.4, 1.0]]\n"
    "materials:\n  grey: {model: lambert, reflectance: {points: [[0.3, 0.1], [1.2, 0.2]], outside: hold}}\n  red: "
    "{model: lambert, reflectance: 0.3, temperature_k: 300}\n"
    "objects:\n  tri: {obj: tri.obj, up: y, normals: smooth}\n  ball: {sphere: {radius: 2}, material: red}\n  sea: "
    "{sinusoid: {width: 3, depth: 4, terms: [{amplitude: 1, kx: 2}]}, material: red}\n"
    "groups:\n  a: [{place: tri, rotate: {euler_deg: [1, 2, 3], order: zyx}}, {place: b}]\n  b: [{place: ball, scale: "
    "[1, 2, 3]}]\n"
    "world:\n  - {place: a, translate: [1, 2, 3], tag: t, material: red}\n  - {place: tri, on: tri, scatter: "
    "{density_per_m2: 10}}\n  - {place: sea, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}\n"
    "  - {place: tri, motion: {kind: composed, outer: {kind: keyframes, keys: [{time_s: 0, latitude_deg: 49, "
    "longitude_deg: "
    "8, height_m: 2}, {time_s: 5, position_m: [1, 2, 3], heading_deg: 4}]}, inner: {kind: spin, position_m: [0, 0, 1], "
    "axis: "
    "[0, 0, 1], rate_deg_s: 9}, pointing: nadir}}\n";

}  // namespace

TEST_F(FuzzScene, Text) {
  const auto read = [](const std::string& path) {
    Report report(scene_issues());
    const Draft draft = read_scene_text(path, {}, report);
    const Scene scene = bake_scene(draft, report);
    if (report.ok()) check_scene(scene, path);
  };
  test::fuzz(test::bytes_of(kText), as_file("s.yaml", read), 1, test::kMutations,
             {"{",
              "}",
              "[",
              "]",
              ": ",
              ", ",
              "- ",
              "&x ",
              "*x",
              "<<",
              "nan",
              "1e999",
              "-1",
              "0",
              "material",
              "place: a",
              "place: world",
              "scale: 0",
              "\n",
              "  ",
              "!!",
              "|",
              "density_per_m2: 1e6"});
}

TEST_F(FuzzScene, PreparedScene) {
  Report report(scene_issues());
  write_file(folder_ / "s.yaml", kText);
  const Scene scene = bake_scene(read_scene_text(folder_ / "s.yaml", {}, report), report);
  ASSERT_TRUE(report.ok()) << report.text();
  write_scene(scene, {"g", "a", "h", {{"", "00"}}}, folder_ / "good.h5");
  test::fuzz(read_bytes(folder_ / "good.h5"),
             as_file("s.h5", [](const std::string& path) { check_scene(read_scene(path), path); }), 2);
}

TEST_F(FuzzScene, PackedScene) {
  Report report(scene_issues());
  write_file(folder_ / "s.yaml", kText);
  Scene scene = bake_scene(read_scene_text(folder_ / "s.yaml", {}, report), report);
  ASSERT_TRUE(report.ok()) << report.text();
  std::vector<std::byte> content(9000);
  for (size_t k = 0; k < content.size(); ++k) content[k] = std::byte(k * k >> 7 & 0xff);
  scene.files.push_back({"data", content});
  Compression all;
  all.add("deflate");
  write_scene(scene, {"g", "a", "h", {{"", "00"}}}, folder_ / "packed.h5", all);
  test::fuzz(read_bytes(folder_ / "packed.h5"),
             as_file("s.h5", [](const std::string& path) { check_scene(read_scene(path), path); }), 22);
}

TEST_F(FuzzScene, GeoTiff) {
  const auto read = [](const std::string& path) {
    read_raster(path, 1 << 22);
    read_georeference(path);
  };
  test::fuzz(read_bytes(SUITE_SOURCE_DIR "/sample_scenes/calibration_range/dem_hd_sub.tif"), as_file("d.tif", read), 3);
}

TEST_F(FuzzScene, Png) {
  test::fuzz(read_bytes(SUITE_SOURCE_DIR "/sample_scenes/shallow_bay/kinds.png"),
             as_file("m.png", [](const std::string& path) { read_raster(path, 1 << 22); }), 4);
}

TEST_F(FuzzScene, PortableMapsAndGdalTags) {
  const auto read = [](const std::string& path) { values_of(read_raster(path, 1 << 22), Numbers::scaled); };
  for (const char* map :
       {"P2\n# grey\n3 2\n1000\n0 1 2 3 4 1000\n", "P5 3 2 255\nabcdef", "P6 1 2 65535\nabcdefghijkl"})
    test::fuzz(test::bytes_of(map), as_file("m.pgm", read), 23, 300, {"65536", "0", "-1", "#", "\n", "99999999999"});
  test::fuzz(read_bytes(SUITE_SOURCE_DIR "/tests/data/raster/dem_scaled.tif"), as_file("d.tif", read), 24, 300,
             {"nan", "1e999", "sample=\"9\"", "</Item>", "role=\"scale\""});
}

TEST_F(FuzzScene, CurveTable) {
  test::fuzz(test::bytes_of("# nm\n400 0.1\n500 0.2\n600 0.3\n"),
             as_file("c.txt", [](const std::string& p) { read_curve(p, {}); }), 5, test::kMutations,
             {"nan", "1e999", "-1", "\r", ",", ";", "#"});
  test::fuzz(test::bytes_of("Y Units: percent\n0.4 10\n0.5 20\n"),
             as_file("c.txt", [](const std::string& p) { read_curve(p, {}); }), 6, test::kMutations,
             {"nm", "percent", "0", "1e999"});
}

TEST_F(FuzzScene, Emissivity) {
  std::string ems = "2\n";
  for (int k = 0; k < 91; ++k) ems += "1.0\n";
  ems += "CURVE_BEGIN\n0.4\t0.9\n0.8\t0.7\nCURVE_BEGIN\n0.4 0.5\n";
  test::fuzz(test::bytes_of(ems), as_file("c.ems", [](const std::string& p) { read_curve_family(p, {}); }), 7,
             test::kMutations, {"CURVE_BEGIN", "CURVE_END", "99999", "\n", "0"});
}

TEST_F(FuzzScene, SpectralLibrary) {
  const float values[6] = {0.1f, 0.2f, 0.3f, 0.5f, 0.6f, 0.75f};
  write_file(folder_ / "l.sli", std::as_bytes(std::span(values)));
  const std::string header =
      "ENVI\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\nwavelength units = Nanometers\nspectra names = {a, "
      "b}\nwavelength = {400, 500,\n 800}\n";
  test::fuzz(test::bytes_of(header),
             as_file("l.sli.hdr", [&](const std::string&) { read_curve_family(folder_ / "l.sli", {}); }), 8,
             test::kMutations, {"{", "}", "=", ",", "99999999999", "-1", "\n", "wavelength"});
}

TEST_F(FuzzScene, InstanceTable) {
  test::fuzz(test::bytes_of("x,y,z,heading_deg,scale\n1,2,3,270,2\n-1, 0.5, 0, 0, 1\n"),
             as_file("t.csv", [](const std::string& p) { read_instances(p); }), 9, test::kMutations,
             {"qw", ",", "nan", "1e999", "scale", "\n", "#", "0"});
}

}  // namespace suite::format_scene_text_scene_test
