// North-up GeoTIFF of a tilted camera over hills: known ground points lie within half a pixel of where they are on the
// map, by EPSG code and in degrees, and within half a pixel of the picture by its RPCs, as GDAL reads both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster.h"
#include "motion/scene_frame.h"
#include "support/programs_kit.h"

namespace suite::map_rasters_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const Geodetic kOrigin{49, 8.6, 120};
constexpr double kTarget[4][2] = {{-20, -14}, {16, -18}, {-12, 18}, {22, 14}};  // middles of white squares, m
constexpr double kHalf = 3;
double hill(double x, double y) { return 5 * std::sin(x / 14) * std::cos(y / 18 + 0.5); }
bool white(double x, double y) {
  for (const auto& t : kTarget)
    if (std::fabs(x - t[0]) < kHalf && std::fabs(y - t[1]) < kHalf) return true;
  return false;
}

// Hills of 1 m steps; squares that are white on the map.
std::string hills() {
  std::string v, grey = "usemtl grey\n", bright = "usemtl white\n";
  constexpr int n = 100;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) v += strf("v %d %d %.6f\n", i - 50, j - 50, hill(i - 50, j - 50));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1;
      (white(i - 49.5, j - 49.5) ? bright : grey) += strf("f %d %d %d %d\n", a, a + 1, a + n + 2, a + n + 1);
    }
  return v + grey + bright;
}

const char* const kSimulation =
    "scene: SCENE\nsky: {radiance: 1}\noutput: {also: [geotiff]}\nsensors:\n"
    "  - kind: frame_camera\n    name: frame\n    geolocation: MAP\n    columns: 120\n    rows: 100\n"
    "    truth: [material, material_abundance]\n"
    "    pitch_um: 50\n    focal_length_mm: 8\n    position_m: [-55, -60, 80]\n    look_at_m: [0, 0, 0]\n"
    "    paths: 16\n    bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}]\n";
const char* const kFisheye =
    "scene: earth.h5\nsky: {radiance: 1}\noutput: {also: [geotiff]}\nsensors:\n"
    "  - {kind: fisheye, name: eye, size: 40, position_m: [0, 0, 30], look: down, geolocation: true, paths: 4,\n"
    "     bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}]}\n";

class MapRasters : public ProgramsTest<MapRasters> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    write_file(*folder_ / "hills.obj", std::string_view(hills()));
    for (const bool earth : {true, false})
      prepare(
          std::string("scene: 1\n") + (earth ? "origin: {latitude_deg: 49, longitude_deg: 8.6, height_m: 120}\n" : "") +
              "materials:\n  grey: {model: lambert, reflectance: 0.1}\n  white: {model: lambert, reflectance: 0.8}\n"
              "objects:\n  hills: {obj: hills.obj}\nworld:\n  - {place: hills}\n",
          earth ? "earth" : "plane");
  }
  static CommandResult map(const std::string& keys, const std::string& out, const std::string& scene = "earth.h5") {
    std::string text = kSimulation;
    text.replace(text.find("SCENE"), 5, scene);
    text.replace(text.find("MAP"), 3, keys);
    return render(text, out);
  }
  static std::string file(const std::string& name) { return *folder_ / name; }
  static bool no_gdal() { return run_command("command -v gdalinfo").code != 0; }
};

Vec2 on_map(double x, double y, bool degrees) {
  static const SceneFrame frame(kOrigin);
  const Geodetic g = frame.geodetic_from_enu({x, y, hill(x, y)});
  if (degrees) return {g.longitude_deg, g.latitude_deg};
  const UtmPoint u = utm_from_geodetic(g, {32, true});
  return {u.easting, u.northing};
}

// How far the middle of a white square on the map is from where it is, pixels; `shift` to the east, for what would be
// wrong.
double farthest(const std::string& tif, size_t band, double least, bool degrees, double shift = 0) {
  const Raster r = read_raster(tif);
  const GeoReference ref = read_georeference(tif);
  const double pixel = ref.to_map[1];
  double worst = 0;
  for (const auto& t : kTarget) {
    const Vec2 at = on_map(t[0], t[1], degrees), beside = on_map(t[0] + 1.6 * kHalf, t[1], degrees),
               above = on_map(t[0], t[1] + 1.6 * kHalf, degrees);
    double x = 0, y = 0, sum = 0;
    for (size_t i = 0; i < size_t{r.width} * r.height; ++i) {
      const double px = ref.to_map[0] + pixel * (static_cast<double>(i % r.width) + 0.5 + shift),
                   py = ref.to_map[3] + ref.to_map[5] * (static_cast<double>(i / r.width) + 0.5);
      const double w = r.values[i * r.channels + band] - least;
      if (std::fabs(px - at.x) > beside.x - at.x || std::fabs(py - at.y) > above.y - at.y || !(w > 0)) continue;
      x += w * px, y += w * py, sum += w;
    }
    EXPECT_GT(sum, 0);
    worst = std::max(worst, std::hypot(x / sum - at.x, y / sum - at.y) / pixel);
  }
  return worst;
}

TEST_F(MapRasters, GroundPointsLieOnTheMap) {
  struct Case {
    const char *keys, *out;
    bool degrees;
    int epsg;
  };
  for (const Case& c :
       {Case{"true", "area", false, 32632}, Case{"{resampling: nearest, crs: EPSG:25832}", "nearest", false, 25832},
        Case{"{crs: degrees}", "degrees", true, 4326}}) {
    const CommandResult r = map(c.keys, c.out);
    ASSERT_EQ(r.code, 0) << r.err;
    const std::string base = file(std::string(c.out) + "/frame");
    const GeoReference ref = read_georeference(base + "_map.tif");
    EXPECT_EQ(ref.epsg, c.epsg);
    EXPECT_EQ(ref.to_map[1], -ref.to_map[5]);
    const std::vector<std::string> names = EnviImage(base + "_truth.img").header().band_names;
    const auto share = static_cast<size_t>(
        std::find_if(names.begin(), names.end(), [](auto& n) { return n.find("white") != n.npos; }) - names.begin());
    ASSERT_LT(share, names.size());
    EXPECT_LT(farthest(base + "_truth_map.tif", share, 0, c.degrees), 0.5) << c.out;
    EXPECT_LT(farthest(base + "_map.tif", 0, 0.45, c.degrees), 0.5) << c.out;
    EXPECT_GT(farthest(base + "_map.tif", 0, 0.45, c.degrees, 1), 0.5) << "the comparison can fail";
  }
}

// Names stay names, errors shrink by what is averaged, and what is not seen is not a number.
TEST_F(MapRasters, OtherRasters) {
  ASSERT_EQ(map("{pixel_m: 3}", "coarse").code, 0);
  ASSERT_EQ(map("{pixel_m: 3, resampling: nearest}", "coarse_nearest").code, 0);
  const Raster material = read_raster(file("coarse/frame_truth_map.tif"));
  size_t unseen = 0;
  for (size_t i = 0; i < size_t{material.width} * material.height; ++i) {
    const float m = material.values[i * material.channels];
    unseen += std::isnan(m);
    EXPECT_TRUE(std::isnan(m) || m == 0 || m == 1) << m;
  }
  EXPECT_GT(unseen, 10u);
  const auto mean_of = [](const Raster& r) {
    double sum = 0, n = 0;
    for (const float x : r.values)
      if (!std::isnan(x)) sum += x, ++n;
    return sum / n;
  };
  const double by_area = mean_of(read_raster(file("coarse/frame_error_map.tif"))),
               by_one = mean_of(
                   read_raster(file("coarse/frame_error_map.tif")
                                   .replace(file("coarse/frame_error_map.tif").rfind("coarse"), 6, "coarse_nearest")));
  EXPECT_LT(by_area, 0.6 * by_one);
  EXPECT_TRUE(file_exists(file("coarse/frame_quality_map.tif")));
  EXPECT_TRUE(file_exists(file("coarse/frame_map.qml")));
}

TEST_F(MapRasters, GdalSeesPlaceAndRpc) {
  if (no_gdal()) GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  ASSERT_EQ(map("true", "gdal").code, 0);
  EXPECT_THAT(run_command("gdalinfo '" + file("gdal/frame_map.tif") + "'").out, HasSubstr("ID[\"EPSG\",32632]"));
  const std::string info = run_command("gdalinfo '" + file("gdal/frame.tif") + "'").out;
  EXPECT_THAT(info, HasSubstr("RPC Metadata"));
  EXPECT_THAT(info, HasSubstr("rpc_residual"));
  // The places of pixels by the picture's own truth; GDAL counts from the outer corner of the first pixel.
  const EnviImage igm(file("gdal/frame_igm.img"));
  const std::vector<double> place = igm.read_all();
  std::string points;
  const std::vector<size_t> pixels{30 * 120 + 40, 50 * 120 + 60, 70 * 120 + 75, 62 * 120 + 44};
  for (const size_t i : pixels) points += strf("%.12f %.12f %.6f\n", place[3 * i], place[3 * i + 1], place[3 * i + 2]);
  write_file(file("points.txt"), std::string_view(points));
  const CommandResult r =
      run_command("gdaltransform -rpc -i '" + file("gdal/frame.tif") + "' < '" + file("points.txt") + "'");
  std::istringstream out(r.out);
  for (const size_t i : pixels) {
    double x = 0, y = 0, z = 0;
    ASSERT_TRUE(out >> x >> y >> z) << r.out << r.err;
    EXPECT_NEAR(x, static_cast<double>(i % 120) + 0.5, 0.5);
    EXPECT_NEAR(y, static_cast<double>(i / 120) + 0.5, 0.5);
  }
}

// A fisheye sees the horizon: no map, and ground control points in its raw picture.
TEST_F(MapRasters, AHorizonHasNoMap) {
  write_file(file("eye.yaml"), std::string_view(kFisheye));
  const CommandResult r = run("dirsig-render eye.yaml -o eye");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("gets no map: the horizon is in view"));
  EXPECT_THAT(r.err, HasSubstr("[DR802]"));
  EXPECT_THAT(r.err + r.out, HasSubstr("ground control points: "));
  EXPECT_FALSE(file_exists(file("eye/eye_map.tif")));
  EXPECT_TRUE(file_exists(file("eye/eye_error.tif")));
  if (no_gdal()) return;
  const std::string info = run_command("gdalinfo '" + file("eye/eye.tif") + "'").out;
  EXPECT_THAT(info, HasSubstr("GCP[  0]"));
  EXPECT_THAT(info, Not(HasSubstr("RPC Metadata")));
}

TEST_F(MapRasters, APlaneSceneHasItsOwnMap) {
  ASSERT_EQ(map("true", "flat", "plane.h5").code, 0);
  EXPECT_TRUE(file_exists(file("flat/frame_map.tif")));
  const CommandResult r = map("{crs: degrees}", "flat2", "plane.h5");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("needs a scene with an origin on the Earth"));
}

TEST_F(MapRasters, WrongKeysAreRefused) {
  EXPECT_THAT(map("{crs: EPSG:9999}", "no").err, HasSubstr("unknown reference system 'EPSG:9999'"));
  EXPECT_THAT(map("{crs: degrees, pixel_m: 2}", "no").err, HasSubstr("pixel_deg"));
  EXPECT_THAT(map("{pixel_deg: 2}", "no").err, HasSubstr("pixel_m"));
  EXPECT_THAT(map("{resampling: cubic}", "no").err, HasSubstr("area"));
  std::string text = kSimulation;
  text.replace(text.find("SCENE"), 5, "earth.h5");
  text.replace(text.find("MAP"), 3, "{resampling: nearest}");
  text.erase(text.find("output:"), text.find("sensors:") - text.find("output:"));
  EXPECT_THAT(render(text, "no").err, HasSubstr("output: {also: [geotiff]}"));
  EXPECT_FALSE(file_exists(file("no/frame.img")));
}

}  // namespace
}  // namespace suite::map_rasters_test
