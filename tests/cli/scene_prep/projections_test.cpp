// Terrain on maps of other systems than our own, through PROJ, and heights that count from the geoid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/error.h"
#include "math/vec.h"
#include "support/programs_kit.h"

namespace suite::projections_test {
namespace {

using testing::HasSubstr;

class Projections : public ProgramsTest<Projections> {
 protected:
  static void SetUpTestSuite() { make_folder(); }
  void SetUp() override {
    if (run_command("command -v gdaltransform && command -v gdal_translate").code != 0)
      GTEST_SKIP() << "GDAL's programs (Debian package gdal-bin) are not installed";
    if (run_command("ls " SUITE_BIN_DIR "/../lib/suite/proj.so").code != 0) GTEST_SKIP() << "built without PROJ";
  }
  static std::string in_folder(const std::string& command) {
    const CommandResult r = run_command("cd '" + folder_->path() + "' && " + command);
    EXPECT_EQ(r.code, 0) << command << r.err;
    return r.out;
  }
  // A level terrain of 3 x 3 pixels around (x, y), 100 m high, and a scene whose origin GDAL says is there.
  static void make(const std::string& system, double x, double y, const std::string& height) {
    write_file(*folder_ / "flat.asc", std::string_view(strf("ncols 3\nnrows 3\nxllcorner %.3f\nyllcorner %.3f\n"
                                                            "cellsize 10\n100 100 100\n100 100 100\n100 100 100\n",
                                                            x - 15, y - 15)));
    in_folder("gdal_translate -q -ot Float32 -a_srs '" + system + "' flat.asc flat.tif");
    std::istringstream said(in_folder(strf("echo '%.9g %.9g' | gdaltransform -s_srs '%s' -t_srs EPSG:4326", x, y,
                                           system.substr(0, system.find('+')).c_str())));
    double longitude = 0, latitude = 0;
    ASSERT_TRUE(said >> longitude >> latitude);
    write_file(*folder_ / "scene.yaml",
               std::string_view(strf("scene: 1\norigin: {latitude_deg: %.12f, longitude_deg: %.12f, height_m: 0}\n"
                                     "materials: {g: {model: lambert, reflectance: 0.5}}\n"
                                     "objects: {t: {material: g, terrain: flat.tif, height: %s}}\n"
                                     "world: [{place: t}]\n",
                                     latitude, longitude, height.c_str())));
  }
  // The vertex nearest to the origin, m; and what was said.
  static Vec3 middle(std::string& said) {
    const CommandResult r = run("scene-prep scene.yaml -o scene.h5 --force");
    said = r.out + r.err;
    EXPECT_EQ(r.code, 0) << said;
    EXPECT_EQ(run("scene-prep scene.h5 --export-obj scene.obj -q").code, 0);
    std::istringstream obj(read_text(*folder_ / "scene.obj"));
    Vec3 best{1e9, 1e9, 0};
    for (std::string line; std::getline(obj, line);) {
      Vec3 v;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3 &&
          std::hypot(v.x, v.y) < std::hypot(best.x, best.y))
        best = v;
    }
    return best;
  }
};

// Lambert-93, and State Plane in US survey feet: the pixel in the middle is at the origin, to a millimetre.
TEST_F(Projections, TerrainIsWhereGdalPutsIt) {
  for (const auto& [system, x, y] : {std::tuple{"EPSG:2154", 652709.4, 6862305.2},
                                     {"EPSG:2263", 987000.0, 211000.0},
                                     {"EPSG:26910", 551000.0, 4184000.0}}) {
    make(system, x, y, "ellipsoid");
    std::string said;
    const Vec3 at = middle(said);
    EXPECT_NEAR(at.x, 0, 1e-3) << system;
    EXPECT_NEAR(at.y, 0, 1e-3) << system;
    EXPECT_NEAR(at.z, 100, 1e-3) << system;
    EXPECT_THAT(said, testing::AllOf(HasSubstr("SP707"), HasSubstr(system), HasSubstr("is brought to WGS84 by PROJ")));
    EXPECT_THAT(said, testing::Not(HasSubstr("SP509")));
  }
}

// NAVD88 counts from the geoid: told, unless the text says so.
TEST_F(Projections, OrthometricHeightsAreReported) {
  make("EPSG:26910+5703", 551000, 4184000, "ellipsoid");
  std::string said;
  middle(said);
  EXPECT_THAT(said, testing::AllOf(HasSubstr("SP509"), HasSubstr("its heights count from EPSG:5703"),
                                   HasSubstr("say 'height: geoid'")));
  make("EPSG:26910+5703", 551000, 4184000, "geoid, geoid_separation_m: -32");
  EXPECT_NEAR(middle(said).z, 68, 1e-3);
  EXPECT_THAT(said, testing::Not(HasSubstr("SP509")));
}

}  // namespace
}  // namespace suite::projections_test
