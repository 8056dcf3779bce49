// sample_scenes/crossing: which vehicle a pixel saw, where and when, against the file of traffic, read here by other
// means; rows of a rolling shutter and strips of a push-broom see what moves at times of their own; at night, by lamps
// that ride, the reported intervals hold a long run.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "formats/envi/envi.h"
#include "math/vec.h"
#include "study/compare.h"
#include "support/programs_kit.h"

namespace suite::crossing_test {
namespace {

struct Record {
  double time, x, y, heading;  // m from the crossing, rad clockwise from north
  double half_width, length;   // m, as the scene's objects are
};
using Records = std::map<std::string, std::vector<Record>>;

// The script writes one element a line.
Records records_of(const std::string& path) {
  const std::map<std::string, std::pair<double, double>> sizes{{"red_car", {0.902, 4.52}},  {"white_car", {0.9, 4.52}},
                                                               {"blue_car", {0.902, 4.52}}, {"van", {0.945, 6.02}},
                                                               {"bus", {1.225, 11.02}},     {"", {0.2, 0.2}}};
  std::istringstream in(read_text(path));
  Records made;
  double time = 0;
  for (std::string line; std::getline(in, line);) {
    const auto value = [&](const std::string& key) {
      const size_t at = line.find(" " + key + "=\"");
      if (at == std::string::npos) return std::string();
      const size_t from = at + key.size() + 3;
      return line.substr(from, line.find('"', from) - from);
    };
    if (line.find("<timestep") != std::string::npos) time = std::stod(value("time"));
    if (value("id").empty()) continue;
    const auto [half, length] = sizes.at(value("type"));
    made[value("id")].push_back({time, std::stod(value("x")) - 110, std::stod(value("y")) - 110,
                                 std::stod(value("angle")) * kDegree, half, length});
  }
  return made;
}

// Where a thing is between its records; nothing outside them, and while it turns.
std::optional<Record> straight_at(const std::vector<Record>& records, double time) {
  for (size_t k = 0; k + 1 < records.size(); ++k) {
    const Record &a = records[k], &b = records[k + 1];
    if (time < a.time || time > b.time) continue;
    if (a.heading != b.heading) return std::nullopt;
    const double f = (time - a.time) / (b.time - a.time);
    return Record{time, std::lerp(a.x, b.x, f), std::lerp(a.y, b.y, f), a.heading, a.half_width, a.length};
  }
  return std::nullopt;
}

// How far a place is outside of a thing's outline; people are round.
double beyond(const Record& r, double x, double y) {
  const double ahead = (x - r.x) * std::sin(r.heading) + (y - r.y) * std::cos(r.heading);
  const double right = (x - r.x) * std::cos(r.heading) - (y - r.y) * std::sin(r.heading);
  if (r.length < 1) return std::hypot(ahead, right) - r.half_width;
  return std::max({std::fabs(right) - r.half_width, ahead - 0.02, -r.length - ahead});
}

struct Pixel {
  std::string id;  // empty: nothing of the traffic
  double x, y, time;
  size_t line;
};
// Of pixels all of whose rays saw one and the same.
std::vector<Pixel> pixels_of(const std::string& image) {
  const EnviImage truth(image + "_truth.img"), tag(image + "_tag.img");
  const std::vector<double> t = truth.read_all(), number = tag.read_all();
  const size_t bands = truth.header().bands, columns = truth.header().samples;
  std::vector<Pixel> made;
  for (size_t i = 0; i < number.size(); ++i) {
    const auto at = static_cast<size_t>(number[i]);
    if (at > 0 && t[i * bands + 1] < 1) continue;
    made.push_back({at ? tag.header().classes.at(at).name : "", t[i * bands + 2], t[i * bands + 3], t[i * bands + 5],
                    i / columns});
  }
  return made;
}

class Crossing : public ProgramsTest<Crossing> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    const CommandResult made = run_command("cp '" SUITE_SOURCE_DIR "/sample_scenes/crossing/'* '" + folder_->path() +
                                           "' && cd '" + folder_->path() + "' && python3 make_traffic.py");
    ASSERT_EQ(made.code, 0) << made.err;
    const CommandResult prep = run("scene-prep scene.yaml -o scene.h5 -q");
    ASSERT_EQ(prep.code, 0) << prep.err;
    const CommandResult day =
        run("dirsig-render day.yaml -o day --paths 4 -q --set 'sensors.0.truth=[tag, tag_fraction, location, time]' "
            "--set 'sensors.1.truth=[tag, tag_fraction, location, time]'");
    ASSERT_EQ(day.code, 0) << day.err;
  }
};

TEST_F(Crossing, PixelsSawVehiclesWhereTheTrackFileHasThem) {
  const Records records = records_of(*folder_ / "traffic.xml");
  std::set<std::string> all;
  size_t fast = 0, elsewhere = 0;
  for (int k = 0; k < 7; ++k) {
    const std::vector<Pixel> pixels = pixels_of(*folder_ / strf("day/mast_%04d", k));
    std::set<std::string> seen;
    size_t checked = 0, later = 0, at_once = 0, moving = 0;
    for (const Pixel& p : pixels) {
      if (p.id.empty()) continue;
      ASSERT_TRUE(records.count(p.id)) << p.id;
      seen.insert(p.id);
      ASSERT_NEAR(p.time, 10 * k + 0.002 * (static_cast<double>(p.line) + 1), 0.0021);
      const auto here = straight_at(records.at(p.id), p.time), next = straight_at(records.at(p.id), p.time + 0.5),
                 first = straight_at(records.at(p.id), 10 * k);
      if (!here || !next || !first) continue;
      ++checked;
      ASSERT_LT(beyond(*here, p.x, p.y), 0.01) << p.id << " at " << p.time;
      if (std::hypot(next->x - here->x, next->y - here->y) < 4) continue;
      // Controls: half a second later, and all rows at the time of the first, vehicles at speed are elsewhere.
      ++moving;
      later += beyond(*next, p.x, p.y) > 0.1;
      at_once += beyond(*first, p.x, p.y) > 0.1;
    }
    std::printf(
        "%2d s: %zu ids, %zu pixels of them; of %zu on fast ones %zu lie outside half a second later, %zu with one "
        "time for all rows\n",
        10 * k, seen.size(), checked, moving, later, at_once);
    EXPECT_GT(checked, 300u);
    fast += moving, elsewhere += at_once;
    // Nothing stands between the camera and the middle of the crossing.
    for (const auto& [id, at] : records) {
      const auto here = straight_at(at, 10 * k + 0.15);
      if (here && at[0].length > 1 && std::hypot(here->x, here->y) < 15) {
        EXPECT_TRUE(seen.count(id)) << id;
      }
    }
    all.insert(seen.begin(), seen.end());
  }
  EXPECT_GT(all.size(), 40u);
  EXPECT_GT(fast, 300u);
  EXPECT_GT(10 * elsewhere, fast);
}

// Strips of three bands laid over each other by the ground: what moves has gone on from one to the next.
TEST_F(Crossing, StripsSeeTheSameVehicleAtDifferentTimes) {
  const Records records = records_of(*folder_ / "traffic.xml");
  struct Sums {
    double x = 0, y = 0, time = 0, n = 0;
  };
  std::map<std::string, std::array<Sums, 2>> of;
  for (const int band : {0, 1})
    for (const Pixel& p : pixels_of(*folder_ / (band ? "day/broom_red" : "day/broom_blue"))) {
      Sums& s = of[p.id][static_cast<size_t>(band)];
      s.x += p.x, s.y += p.y, s.time += p.time, s.n += 1;
    }
  size_t fast = 0, still = 0;
  for (auto& [id, both] : of) {
    if (id.empty() || both[0].n < 12 || both[1].n < 12) continue;
    for (Sums& s : both) s.x /= s.n, s.y /= s.n, s.time /= s.n;
    const auto a = straight_at(records.at(id), both[0].time), b = straight_at(records.at(id), both[1].time);
    if (!a || !b || std::fabs(a->x) > 40 || std::fabs(a->y) > 40) continue;
    const double moved = std::hypot(b->x - a->x, b->y - a->y);
    EXPECT_NEAR(both[1].time - both[0].time, 40 / 75.0, 0.1) << id;
    EXPECT_NEAR(std::hypot(both[1].x - both[0].x, both[1].y - both[0].y), moved, 0.5) << id;
    (moved > 3 ? fast : still) += 1;
  }
  std::printf("%zu that went on by more than 3 m from blue to red, %zu others\n", fast, still);
  EXPECT_GE(fast, 3u);
  EXPECT_GE(still, 3u);
}

StudyImage image_of(const std::string& name) {
  const EnviImage value(name + ".img"), error(name + "_error.img"), quality(name + "_quality.img");
  const std::vector<double> l = value.read_all(), e = error.read_all();
  const size_t bands = value.header().bands;
  StudyImage made;
  for (size_t b = 0; b < bands; ++b) {
    StudyImage::Series s{value.header().band_names[b], {}, {}};
    for (size_t i = b; i < l.size(); i += bands) s.radiance.push_back(l[i]), s.standard_error.push_back(e[i]);
    made.series.push_back(std::move(s));
  }
  for (const double q : quality.read_all()) made.flagged.push_back(q != 0);
  const std::string& told = error.header().description;
  const size_t at = told.find("(Student, ");
  EXPECT_NE(at, std::string::npos) << told;
  made.degrees = std::stod(told.substr(at + 10));
  return made;
}

TEST_F(Crossing, IntervalsAtNightHoldALongRun) {
  const std::string text = read_text(*folder_ / "night.yaml");
  write_file(*folder_ / "one.yaml", std::string_view(text).substr(0, text.find("  - kind: platform\n    name: broom")));
  const auto picture = [&](const char* name, int paths, int seed) {
    const CommandResult r =
        run(strf("dirsig-render one.yaml -o %s --paths %d --seed %d -q --set 'sensors.0.tasks=[{start: 20}]' "
                 "--set sensors.0.instruments.0.clock=null --set sensors.0.instruments.0.arrays.0.columns=36 "
                 "--set sensors.0.instruments.0.arrays.0.rows=26 --set sensors.0.instruments.0.arrays.0.pitch_um=265 "
                 "--set sensors.0.instruments.0.arrays.0.readout.row_time_s=0.0105",
                 name, paths, seed));
    EXPECT_EQ(r.code, 0) << r.err;
    return image_of(*folder_ / (std::string(name) + "/mast"));
  };
  const StudyImage reference = picture("long", 1024, 99);
  StudyImage short_run = picture("short", 64, 3);
  for (const Comparison& c : compare(short_run, reference)) {
    std::printf("%s: coverage %.1f %% of %zu, %zu flagged, bias %+.2f +- %.2f\n", c.series.c_str(), 100 * c.coverage,
                c.counted, c.flagged, c.bias, c.bias_error);
    EXPECT_GT(c.counted, 700u) << c.series;
    EXPECT_GT(c.coverage, 0.93) << c.series;
    EXPECT_LT(c.coverage, 0.985) << c.series;
    EXPECT_LT(std::fabs(c.bias), 3.3 * c.bias_error) << c.series;  // 1e-3
  }
  // Control: errors that are halved.
  for (auto& s : short_run.series)
    for (double& e : s.standard_error) e *= 0.5;
  for (const Comparison& c : compare(short_run, reference)) EXPECT_LT(c.coverage, 0.92) << c.series;
}

}  // namespace
}  // namespace suite::crossing_test
