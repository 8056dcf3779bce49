// Strips and frames on the map: a target that is no mirror image of itself lies where it is, by the IGM, by the GLT and
// by GDAL.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster.h"
#include "motion/scene_frame.h"
#include "support/programs_kit.h"

namespace suite::geolocation_test {
namespace {

using testing::HasSubstr;

// An L and a dot, white on grey: rectangles in scene ENU, m.
constexpr double kWhite[3][4] = {{0, 0, 30, 6}, {0, 6, 6, 18}, {24, 20, 28, 24}};
const Geodetic kOrigin{49, 8, 120};

std::string scene_text(bool on_earth) {
  std::string text = "scene: 1\n";
  if (on_earth) text += "origin: {latitude_deg: 49, longitude_deg: 8, height_m: 120}\n";
  text +=
      "materials:\n  grey: {model: lambert, reflectance: 0.1}\n  white: {model: lambert, reflectance: 0.8}\n"
      "objects:\n  plane: {plane: {width: 120, depth: 120}, material: grey}\n";
  std::string world = "world:\n  - {place: plane}\n";
  for (int i = 0; i < 3; ++i) {
    const double* r = kWhite[i];
    text += strf("  white%d: {box: {x0: %g, y0: %g, z0: 0, x1: %g, y1: %g, z1: 0.01}, material: white}\n", i, r[0],
                 r[1], r[2], r[3]);
    world += strf("  - {place: white%d}\n", i);
  }
  return text + world;
}

const char* const kSimulation =
    "scene: SCENE\nsun: {direction: {zenith_deg: 30, azimuth_deg: 180}, irradiance: 1000, collimated: true}\nsensors:\n"
    "  - kind: platform\n    name: broom\n    geolocation: true\n"
    "    motion: {kind: straight, position_m: [-20, -50, 100], heading_deg: 30, speed_m_s: 20}\n"
    "    jitter: {rotate_x: {sigma_rad: 0.003}, rotate_y: {sigma_rad: 0.003}}\n"
    "    tasks: [{name: pass, start: 0, stop: 6}]\n    instruments:\n      - focal_length_mm: 50\n"
    "        arrays: [{columns: 120, pitch_um: 500, paths: 4, readout: {kind: line, line_rate_hz: 20}, BANDS}]\n"
    "  - kind: platform\n    name: whisk\n    geolocation: {pixel_m: 1}\n    truth: [material]\n"
    "    motion: {kind: straight, position_m: [0, 60, 100], heading_deg: 200, speed_m_s: 20}\n"
    "    tasks: [{name: pass, start: 0, stop: 6}]\n    instruments:\n      - focal_length_mm: 50\n"
    "        mount: {kind: line_scan, axis: across, start_deg: -28, rate_deg_s: 250, period_s: 0.25}\n"
    "        arrays: [{columns: 1, rows: 5, pitch_um: 500, paths: 4, readout: {kind: whisk, scan_rate_hz: 4, samples: "
    "110, sample_rate_hz: 500}, BANDS}]\n"
    "  - kind: frame_camera\n    name: frame\n    geolocation: {pixel_m: 0.5}\n    columns: 100\n    rows: 80\n"
    "    pitch_um: 40\n    focal_length_mm: 8\n    position_m: [-20, -60, 70]\n    look_at_m: [12, 10, 0]\n    paths: "
    "4\n"
    "    BANDS\n";

// Whether a place is white, grey, or too near to an edge to say.
enum class Colour { grey, white, unsure };
Colour colour_at(double x, double y, double near) {
  for (const auto& r : kWhite) {
    const double out = std::max({r[0] - x, x - r[2], r[1] - y, y - r[3]});
    if (std::fabs(out) < near) return Colour::unsure;
    if (out < 0) return Colour::white;
  }
  return Colour::grey;
}

class Geolocation : public ProgramsTest<Geolocation> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    std::string text = kSimulation;
    for (size_t at; (at = text.find("BANDS")) != std::string::npos;)
      text.replace(at, 5, "bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}]");
    for (const bool on_earth : {true, false}) {
      const std::string name = on_earth ? "earth" : "plane";
      prepare(scene_text(on_earth), name);
      std::string sim = text;
      sim.replace(sim.find("SCENE"), 5, name + ".h5");
      write_file(*folder_ / (name + "_sim.yaml"), std::string_view(sim));
      const CommandResult r = run("dirsig-render " + name + "_sim.yaml -o " + name + " -q");
      ASSERT_EQ(r.code, 0) << r.err;
    }
  }
};

// What a picture on a map shows where, compared with what is there.
struct Agreement {
  size_t right = 0, wrong = 0, white = 0;
  void count(double x, double y, double near, bool bright) {
    const Colour c = colour_at(x, y, near);
    if (c == Colour::unsure) return;
    (bright == (c == Colour::white) ? right : wrong)++;
    white += c == Colour::white;
  }
};

bool bright(double radiance) { return radiance > 0.4 * 1000 * std::cos(30 * kDegree) / kPi; }

struct Table {
  EnviImage image, table;
  std::vector<double> radiance, cells;
  double west, north, cell;
  explicit Table(const std::string& base) : image(base + ".img"), table(base + "_glt.img") {
    radiance = image.read_all(), cells = table.read_all();
    const std::vector<std::string>& m = table.header().map_info;
    west = std::stod(m[3]), north = std::stod(m[4]), cell = std::stod(m[5]);
  }
};

// enu_of: scene ENU of a place of the table's map. mirrored: columns of the picture are looked up from the other side.
Agreement agreement(const Table& t, const std::function<Vec2(double, double)>& enu_of, double pixel, bool mirrored) {
  Agreement a;
  const size_t columns = t.table.header().samples, samples = t.image.header().samples;
  for (size_t i = 0; i < columns * t.table.header().lines; ++i) {
    const auto sample = static_cast<size_t>(std::fabs(t.cells[2 * i])),
               line = static_cast<size_t>(std::fabs(t.cells[2 * i + 1]));
    if (!sample) continue;
    const Vec2 at = enu_of(t.west + (static_cast<double>(i % columns) + 0.5) * t.cell,
                           t.north - (static_cast<double>(i / columns) + 0.5) * t.cell);
    const size_t column = mirrored ? samples - sample : sample - 1;
    a.count(at.x, at.y, pixel, bright(t.radiance[(line - 1) * samples + column]));
  }
  return a;
}

Vec2 enu_of_utm(double easting, double northing) {
  static const SceneFrame frame(kOrigin);
  const Vec3 p = frame.enu_from_utm({{32, true}, easting, northing, 120});
  return {p.x, p.y};
}

// A pixel of the sensors is at most about 1.2 m (the frame's 1.5 m far away); the target lies right to one of them.
constexpr double kPixel = 1.5;

TEST_F(Geolocation, TheLookupTablePutsTheTargetWhereItIs) {
  for (const char* name : {"broom", "whisk", "frame"}) {
    const Table t(*folder_ / (std::string("earth/") + name));
    EXPECT_EQ(t.table.header().type, EnviType::int32);
    EXPECT_EQ(t.table.header().map_info[0], "UTM");
    EXPECT_EQ(t.table.header().map_info[7], "32");
    EXPECT_NE(t.table.header().coordinate_system.find(R"(AUTHORITY["EPSG","32632"]])"), std::string::npos);
    const Agreement a = agreement(t, enu_of_utm, kPixel, false);
    EXPECT_EQ(a.wrong, 0u) << name;
    EXPECT_GT(a.right, 5000u) << name;
    EXPECT_GT(a.white, 60u) << name;
    // The comparison can fail.
    EXPECT_GT(agreement(t, enu_of_utm, kPixel, true).wrong, 60u) << name;
    EXPECT_GT(agreement(
                  t, [](double e, double n) { return enu_of_utm(e + 4 * kPixel, n); }, kPixel, false)
                  .wrong,
              10u)
        << name;
  }
}

TEST_F(Geolocation, ThePlaceOfEveryPixelIsOnTheEarth) {
  const SceneFrame frame(kOrigin);
  for (const char* name : {"broom", "whisk", "frame"}) {
    const std::string base = *folder_ / (std::string("earth/") + name);
    const EnviImage igm(base + "_igm.img"), image(base + ".img");
    EXPECT_EQ(igm.header().band_names[0], "longitude [deg]");
    const std::vector<double> place = igm.read_all(), radiance = image.read_all();
    ASSERT_EQ(place.size(), 3 * radiance.size());
    Agreement a;
    for (size_t i = 0; i < radiance.size(); ++i) {
      if (std::isnan(place[3 * i])) {
        EXPECT_EQ(radiance[i], 0) << "nothing was hit";
        continue;
      }
      const Vec3 at = frame.enu_from_geodetic({place[3 * i + 1], place[3 * i], place[3 * i + 2]});
      EXPECT_NEAR(at.z, 0.005, 0.0051);
      a.count(at.x, at.y, 0.8 * kPixel, bright(radiance[i]));
    }
    EXPECT_EQ(a.wrong, 0u) << name;
    EXPECT_GT(a.white, 60u) << name;
  }
}

// Without an origin the map is scene ENU, and no GDAL file claims a place on the Earth.
TEST_F(Geolocation, APlaneSceneHasItsOwnMap) {
  const Table t(*folder_ / "plane/broom");
  EXPECT_EQ(t.table.header().map_info[0], "Arbitrary");
  const Agreement a = agreement(
      t,
      [](double x, double y) {
        return Vec2{x, y};
      },
      kPixel, false);
  EXPECT_EQ(a.wrong, 0u);
  EXPECT_GT(a.white, 60u);
  EXPECT_EQ(EnviImage(*folder_ / "plane/broom_igm.img").header().band_names[0], "east [m]");
  EXPECT_FALSE(file_exists(*folder_ / "plane/broom_geo.vrt"));
}

TEST_F(Geolocation, GdalWarpsTheStrip) {
  if (run_command("command -v gdalwarp").code != 0)
    GTEST_SKIP() << "gdalwarp (Debian package gdal-bin) is not installed";
  for (const char* name : {"broom", "frame"}) {
    const std::string to = *folder_ / (std::string(name) + "_warped.tif");
    const CommandResult r = run_command("gdalwarp -q -geoloc -t_srs EPSG:32632 -tr 1 1 -dstnodata -1 '" +
                                        (*folder_ / (std::string("earth/") + name + "_geo.vrt")) + "' '" + to + "'");
    ASSERT_EQ(r.code, 0) << r.err;
    const Raster raster = read_raster(to);
    const GeoReference ref = read_georeference(to);
    EXPECT_EQ(ref.epsg, 32632);
    Agreement a;
    for (size_t i = 0; i < raster.values.size(); ++i) {
      if (!(raster.values[i] > 0)) continue;
      const double c = static_cast<double>(i % raster.width) + 0.5, l = static_cast<double>(i / raster.width) + 0.5;
      const Vec2 at = enu_of_utm(ref.to_map[0] + c * ref.to_map[1], ref.to_map[3] + l * ref.to_map[5]);
      a.count(at.x, at.y, 1.5 * kPixel, bright(raster.values[i]));
    }
    EXPECT_EQ(a.wrong, 0u) << name;
    EXPECT_GT(a.white, 30u) << name;
  }
}

TEST_F(Geolocation, CostsNothingWhenItIsNotAskedFor) {
  std::string sim = read_text(*folder_ / "earth_sim.yaml");
  for (size_t at; (at = sim.find("    geolocation:")) != std::string::npos;) sim.erase(at, sim.find('\n', at) + 1 - at);
  write_file(*folder_ / "without.yaml", std::string_view(sim));
  ASSERT_EQ(run("dirsig-render without.yaml -o without -q").code, 0);
  EXPECT_FALSE(file_exists(*folder_ / "without/broom_igm.img"));
  for (const char* file : {"broom.img", "broom_truth.img", "whisk_error.img"})
    EXPECT_EQ(read_bytes(*folder_ / (std::string("without/") + file)),
              read_bytes(*folder_ / (std::string("earth/") + file)))
        << file;
}

// Places of a scene that repeats itself all lie in its cell: on a map its pictures would be folded.
TEST_F(Geolocation, APeriodicSceneIsRefused) {
  const std::string sim =
      "periodic: {origin_m: [-60, -60], size_m: [120, 120]}\n" + read_text(*folder_ / "earth_sim.yaml");
  write_file(*folder_ / "periodic.yaml", std::string_view(sim));
  const CommandResult r = run("dirsig-render periodic.yaml -o periodic -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("periodic.yaml:5:5: error: geolocation: a scene that repeats itself"));
  EXPECT_FALSE(file_exists(*folder_ / "periodic/frame.img"));
}

// A table that would be too large is no reason to lose the pictures.
TEST_F(Geolocation, TooFineAGridIsTold) {
  std::string sim = read_text(*folder_ / "earth_sim.yaml");
  const std::string key = "geolocation: {pixel_m: 0.5}";
  sim.replace(sim.find(key), key.size(), "geolocation: {pixel_m: 0.0001}");
  write_file(*folder_ / "fine.yaml", std::string_view(sim));
  const CommandResult r = run("dirsig-render fine.yaml -o fine -q");
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.err, HasSubstr("warning: 'fine/frame.img' gets no lookup table (GLT): a lookup table of"));
  EXPECT_THAT(r.err, HasSubstr("[DR801]"));
  EXPECT_TRUE(file_exists(*folder_ / "fine/frame_igm.img"));
  EXPECT_FALSE(file_exists(*folder_ / "fine/frame_glt.img"));
}

}  // namespace
}  // namespace suite::geolocation_test
