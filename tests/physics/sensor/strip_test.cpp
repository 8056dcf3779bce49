// Which way up pictures are: a letter F on the ground, seen by push-brooms, whiskbrooms, framing cameras and the map.
// No picture is mirrored; lines of strips follow in time downwards, so that a strip flown northwards is the ground
// turned by half a turn.
#include <gtest/gtest.h>

#include <cmath>

#include "support/platform_kit.h"

namespace suite::strip_test {
namespace {

using test::PlatformKit;

// Top row first, as it is read. No turn and no mirror image of it is it again.
constexpr const char* kLetter[] = {"#####", "#....", "###..", "#....", "#....", "#...."};
constexpr int kRows = 6, kColumns = 5;

// A ground of 1 m cells; `up` is where the letter's top is.
struct Ground {
  Vec2 up;
  Vec2 right() const { return {up.y, -up.x}; }
  // Cell (row, column) of the letter has its middle at the origin for (2.5, 2).
  Vec2 middle(int row, int column) const {
    const double r = column - 2.0, u = 2.5 - row;
    return {right().x * r + up.x * u, right().y * r + up.y * u};
  }
  bool white(Vec2 p) const {
    const double column = p.x * right().x + p.y * right().y + 2.5, row = 3 - (p.x * up.x + p.y * up.y);
    const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
    return r >= 0 && r < kRows && c >= 0 && c < kColumns && kLetter[r][c] == '#';
  }
  std::shared_ptr<Scene> scene() const {
    std::vector<Mesh> meshes{test::quad(60, 0, 0)};
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c) {
        if (kLetter[r][c] != '#') continue;
        std::vector<Vec3> corners;
        for (const auto& [x, y] : {std::pair{-.5, -.5}, std::pair{.5, -.5}, std::pair{.5, .5}, std::pair{-.5, .5}}) {
          const Vec2 m = middle(r, c);
          corners.push_back({m.x + right().x * x + up.x * y, m.y + right().y * x + up.y * y, 0.001});
        }
        meshes.push_back(test::mesh_of(corners, {0, 1, 2, 0, 2, 3}, 1));
      }
    return test::scene_of(meshes,
                          {test::material("black", test::lambert(0)), test::material("white", test::lambert(1))});
  }
};

struct Picture {
  uint32_t columns = 0, rows = 0;
  std::vector<double> radiance;  // of the first band
  std::vector<Vec3> place;
  bool white(uint32_t r, uint32_t c) const { return radiance[r * columns + c] > 0.5; }
  Vec3 at(uint32_t r, uint32_t c) const { return place[r * columns + c]; }
};

Picture picture_of(const Ground& ground, const std::string& yaml) {
  PlatformKit kit;
  SourceSpecs sources;
  sources.add(test::uniform_sky(1, false));
  kit.render(ground.scene(), sources, yaml);
  Picture p;
  std::map<uint32_t, const test::Shot*> in_order;
  for (const test::Shot& s : kit.shots) in_order[s.rows.row_in_task] = &s;
  for (const auto& [row, s] : in_order) {
    p.columns = s->result.columns, p.rows += s->result.rows;
    for (size_t i = 0; i < s->result.problems(); ++i) {
      p.radiance.push_back(s->result.radiance[i * s->result.bands]);
      p.place.push_back({s->result.truth[3 * i], s->result.truth[3 * i + 1], s->result.truth[3 * i + 2]});
    }
  }
  return p;
}

// What is white is what the truth says is there, and right x down points into the ground everywhere.
void expect_not_mirrored(const Ground& ground, const Picture& p) {
  int whites = 0;
  for (uint32_t r = 0; r < p.rows; ++r)
    for (uint32_t c = 0; c < p.columns; ++c) {
      EXPECT_EQ(p.white(r, c), ground.white({p.at(r, c).x, p.at(r, c).y})) << r << ", " << c;
      whites += p.white(r, c) ? 1 : 0;
      if (r + 1 < p.rows && c + 1 < p.columns) {
        EXPECT_LT(cross(p.at(r, c + 1) - p.at(r, c), p.at(r + 1, c) - p.at(r, c)).z, 0) << r << ", " << c;
      }
    }
  EXPECT_GT(whites, 6);
}

// The letter's pixels are 1 m cells, sharp where the truth's mean place is the cell's middle.
const char* const kBand = "bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1, shape: rectangular}]";
std::string flight(double heading_deg, const std::string& instrument, double stop = 8) {
  const double h = heading_deg * kDegree, back = -3.5;
  return strf(
             "kind: platform\nmotion: {kind: straight, position_m: [%.17g, %.17g, 1000], heading_deg: %g, speed_m_s: "
             "1}\ntruth: [location]\ntasks: [{start: 0, stop: %g}]\ninstruments:\n  - focal_length_mm: 100\n",
             back * std::sin(h), back * std::cos(h), heading_deg, stop) +
         instrument;
}
// 7 detectors of 1 m, a line a metre.
std::string broom(const std::string& extra = "") {
  return std::string(
             "    arrays: [{columns: 7, pitch_um: 100, readout: {kind: line, line_rate_hz: 1, "
             "lines_per_capture: 3}, paths: 4, ") +
         extra + kBand + "}]\n";
}

// Down the picture is forwards, right is to the left of the flight.
void expect_strip(double heading_deg, const Ground& ground, const std::string& instrument) {
  SCOPED_TRACE(heading_deg);
  const Picture p = picture_of(ground, flight(heading_deg, instrument));
  ASSERT_EQ(p.columns, 7u);
  ASSERT_EQ(p.rows, 8u);
  const double h = heading_deg * kDegree;
  const Vec2 ahead{std::sin(h), std::cos(h)}, left{-ahead.y, ahead.x};
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < 7; ++c) {
      const double a = r - 3.5, l = c - 3.0;
      const Vec2 here{ahead.x * a + left.x * l, ahead.y * a + left.y * l};
      const Vec3 truth = p.at(static_cast<uint32_t>(r), static_cast<uint32_t>(c));
      // The mean place of a pixel's paths lies inside it.
      const Vec2 off{truth.x - here.x, truth.y - here.y};
      EXPECT_LT(std::fabs(off.x * ahead.x + off.y * ahead.y), 0.5) << r << ", " << c;
      EXPECT_LT(std::fabs(off.x * left.x + off.y * left.y), 0.5) << r << ", " << c;
      EXPECT_NEAR(p.radiance[static_cast<size_t>(r * 7 + c)], ground.white(here) ? 1 : 0, 1e-6) << r << ", " << c;
    }
  expect_not_mirrored(ground, p);
}

TEST(Strips, PushBroomsAreTurnedAndNotMirrored) {
  const Ground north{{0, 1}};
  expect_strip(0, {{0, 1}}, broom());
  // Northwards the letter stands on its head and faces left: half a turn. Mirrored it would face right.
  const Picture p = picture_of(north, flight(0, broom()));
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c)
      EXPECT_EQ(p.white(static_cast<uint32_t>(6 - r), static_cast<uint32_t>(5 - c)), kLetter[r][c] == '#') << r << c;
}

TEST(Strips, EastAndSouthWest) {
  // Cells are aligned with the flight: the letter's top is to the east, the north, and ahead.
  expect_strip(90, {{1, 0}}, broom());
  expect_strip(90, {{-1, 0}}, broom());
  const double s = std::sqrt(0.5);
  expect_strip(225, {{-s, -s}}, broom());
}

TEST(Strips, TurnedCamerasTooAndOnlyAFlipMirrors) {
  // A camera that is turned half round sees the ground come in from its other side: its columns run the other way.
  expect_strip(0, {{0, 1}}, "    rotate_deg: [0, 0, 180]\n" + broom());
  // Chips with bands of their own are captures of their own, put together in the picture's order.
  expect_strip(0, {{0, 1}},
               std::string("    arrays: [{pitch_um: 100, readout: {kind: line, line_rate_hz: 1, lines_per_capture: 3}, "
                           "paths: 4, bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}], chips: [{columns: 2, "
                           "offset_mm: [-0.25, 0], bands: [{name: pan, center_um: 0.61, fwhm_um: 0.1}]}, {columns: 5, "
                           "offset_mm: [0.1, 0]}]}]\n"));
  // Read out from the other side on purpose, the picture is mirrored.
  const Picture p = picture_of({{0, 1}}, flight(0, broom("flip: [columns], ")));
  EXPECT_GT(cross(p.at(3, 4) - p.at(3, 3), p.at(4, 3) - p.at(3, 3)).z, 0);
}

TEST(Strips, WhiskbroomsLikewise) {
  // Scans of two lines, from the left to the right and back, each heading; pixels are points of 0.1 m.
  for (const double heading : {0.0, 90.0, 225.0})
    for (const int way : {1, -1}) {
      SCOPED_TRACE(heading);
      SCOPED_TRACE(way);
      const double h = heading * kDegree;
      const Ground ground{{std::sin(h), std::cos(h)}};
      // 31 samples of 0.25 m at 1000 m: 0.014324 degrees each; rows of 0.5 m, a scan a metre.
      const Picture p = picture_of(
          ground,
          flight(heading, strf("    mount: {kind: line_scan, axis: across, start_deg: %.6f, rate_deg_s: %.6f, "
                               "period_s: 1}\n    arrays: [{rows: 2, pitch_um: [10, 50], readout: {kind: whisk, "
                               "samples: 31, sample_rate_hz: 1000, scan_rate_hz: 1, lines_per_capture: 3}, paths: "
                               "16, ",
                               -way * 15 * 0.0143239, way * 14.3239) +
                              kBand + "}]\n"));
      ASSERT_EQ(p.columns, 31u);
      ASSERT_EQ(p.rows, 16u);
      const Vec2 ahead{std::sin(h), std::cos(h)};
      int whites = 0;
      for (uint32_t r = 0; r < p.rows; ++r)
        for (uint32_t c = 0; c < p.columns; ++c) {
          const Vec3 q = p.at(r, c);
          const double radiance = p.radiance[r * p.columns + c];
          if (radiance > 0.01 && radiance < 0.99) continue;  // on an edge
          EXPECT_EQ(p.white(r, c), ground.white({q.x, q.y})) << r << ", " << c;
          whites += p.white(r, c) ? 1 : 0;
          if (r + 1 == p.rows || c + 1 == p.columns) continue;
          const Vec3 right = p.at(r, c + 1) - q, down = p.at(r + 1, c) - q;
          EXPECT_LT(cross(right, down).z, 0) << r << ", " << c;
          EXPECT_GT(down.x * ahead.x + down.y * ahead.y, 0) << r;  // first in time, first in the picture
        }
      EXPECT_GT(whites, 50);
    }
}

TEST(Strips, FramesAndMapsAreNotMirrored) {
  const Ground ground{{0, 1}};
  const std::string platform = strf(
      "kind: platform\nmotion: {kind: straight, position_m: [0, 0, 1000], heading_deg: 0, speed_m_s: 0}\ntruth: "
      "[location]\ntasks: [{start: 0}]\ninstruments:\n  - focal_length_mm: 100\n    arrays: [{columns: 7, rows: 8, "
      "pitch_um: 100, paths: 4, %s}]\n",
      kBand);
  const std::string frame = strf(
      "kind: frame_camera\ncolumns: 7\nrows: 8\npitch_um: 100\nfocal_length_mm: 100\nposition_m: [0, 0, 1000]\n"
      "look_at_m: [0, 0, 0]\npaths: 4\ntruth: [location]\n%s\n",
      kBand);
  const std::string map = strf(
      "kind: orthographic\ncolumns: 7\nrows: 8\ngsd_m: 1\ncenter_m: [0, 0]\npaths: 4\ntruth: [location]\n%s\n", kBand);
  for (const std::string& yaml : {platform, frame, map}) {
    const Picture p = picture_of(ground, yaml);
    expect_not_mirrored(ground, p);
    EXPECT_GT(p.at(0, 3).y, p.at(7, 3).y);  // the top is ahead, or north
  }
}

}  // namespace
}  // namespace suite::strip_test
