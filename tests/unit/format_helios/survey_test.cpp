// Surveys of HELIOS++: where beams go, against that program's own description of its scanners, and what is told.
#include "formats/helios/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/files.h"
#include "formats/helios/survey_parts.h"
#include "formats/motion/motion.h"
#include "lidar/lidar_text.h"
#include "lidar/pulse_train.h"

namespace suite::format_helios_survey_test {
namespace {

using testing::HasSubstr;

constexpr const char* kPlatforms = R"(<document>
 <platform id="plane" name="P" type="linearpath"><scannerMount x="0.1" y="0.2" z="0.7"><rot axis="x" angle_deg="-90"/><rot axis="z" angle_deg="90"/></scannerMount></platform>
 <platform id="tripod" type="static"><scannerMount z="1.5"/></platform>
 <platform id="copter" type="multicopter" drag="0.01"><scannerMount><rot axis="x" angle_deg="175"/></scannerMount></platform>
</document>)";
constexpr const char* kScanners = R"(<document>
 <scanner id="galvo" optics="oscillating" beamDivergence_rad="0.00033" pulseFreqs_Hz="83000" pulseLength_ns="10" rangeMin_m="50" scanAngleMax_deg="37.5" scanFreqMin_Hz="0" scanFreqMax_Hz="70"/>
 <scanner id="polygon" optics="rotating" accuracy_m="0.02" beamDivergence_rad="0.0005" pulseFreqs_Hz="50000" pulseLength_ns="4" scanAngleMax_deg="45" scanAngleEffectiveMax_deg="22.5" scanFreqMin_Hz="10" scanFreqMax_Hz="160" maxNOR="5"/>
 <scanner id="tls" optics="rotating" headRotatePerSecMax_deg="60" pulseFreqs_Hz="100000" scanAngleMax_deg="120" scanAngleEffectiveMax_deg="50" scanFreqMin_Hz="3" scanFreqMax_Hz="120"><beamOrigin x="0" y="0" z="0.2"><rot axis="y" angle_deg="10"/></beamOrigin><headRotateAxis x="0" y="0" z="1"/></scanner>
 <scanner id="cone" optics="conic" pulseFreqs_Hz="200000" scanAngleMax_deg="20" scanFreqMin_Hz="30" scanFreqMax_Hz="80" wavelength_nm="532"/>
 <scanner id="prisms" optics="risley" pulseFreqs_Hz="100000" rotorFreq1_Hz="-77.7" rotorFreq2_Hz="121.5" angle1_deg="-29.7" angle2_deg="18" refrIndex1="1.5095" refrIndex2="1.5095" refrIndex_air="1.0">
  <channels><channel id="a"><incidentBeam x="-0.05" y="0.99" z="0.02"/></channel><channel id="b" wavelength_nm="905"><beamOrigin><rot axis="z" angle_deg="30"/></beamOrigin></channel></channels></scanner>
</document>)";

std::string survey(const std::string& scanner, const std::string& platform, const std::string& settings) {
  return "<document>\n<scannerSettings id=\"base\" active=\"true\" pulseFreq_hz=\"1000\"/>\n<survey name=\"s\" "
         "scene=\"scene.xml#s\" platform=\"data/p.xml#" +
         platform + "\" scanner=\"data/s.xml#" + scanner +
         "\">\n<leg><platformSettings x=\"-10\" y=\"5\" z=\"400\" movePerSec_m=\"50\"/><scannerSettings "
         "template=\"base\" " +
         settings +
         "/></leg>\n<leg><platformSettings x=\"20\" y=\"45\" z=\"400\" movePerSec_m=\"50\"/><scannerSettings "
         "template=\"base\" active=\"false\"/></leg>\n</survey></document>";
}

HeliosSurvey parse(const std::string& text) {
  return parse_helios_survey(text, "survey.xml",
                             {[](const std::string& name) {
                                return HeliosSurveyFiles::Named{name, name == "data/p.xml" ? kPlatforms : kScanners};
                              },
                              [](const std::string& scene) { return scene + ".h5"; }});
}

std::vector<LidarInstrument> instruments(const HeliosSurvey& s) {
  const Params root = Params::parse_made(s.text.yaml, "survey.xml", s.text.origins);
  SensorContext c;
  const MotionContext motion;
  c.track = [&](const Params& p) { return track_from(p, motion); };
  c.position = [&](const Params& p) { return position_from(p, motion); };
  c.time = [&](const Params& p) { return time_value(p, motion); };
  std::vector<LidarInstrument> all;
  for (const Params& p : root.at("sensors").items()) all.push_back(read_lidar(p, c));
  return all;
}

Vec3 turn(char axis, double angle, Vec3 v) {
  const double c = std::cos(angle), s = std::sin(angle);
  if (axis == 'x') return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
  if (axis == 'y') return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}
Vec3 mount_of_plane(Vec3 v) { return turn('z', 90 * kDegree, turn('x', -90 * kDegree, v)); }

// m, along a ray to the ground at z = 0, or a box 12 m high from (-60, -20) to (40, 60).
double range_of(Vec3 from, Vec3 to) {
  double near = to.z < 0 ? -from.z / to.z : 1e9;
  const Vec3 low{-60, -20, 0}, high{40, 60, 12};
  double in = 0, out = 1e9;
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - from[k]) / to[k], b = (high[k] - from[k]) / to[k];
    in = std::max(in, std::min(a, b)), out = std::min(out, std::max(a, b));
  }
  return in < out ? std::min(near, in) : near;
}

// Ranges of every 7th pulse within 1 cm of a ray cast of the deflector as that program describes it: beams leave along
// y of the emitter, which head, mount and platform turn.
void expect_ranges(const LidarInstrument& lidar, const std::function<Vec3(double t)>& direction,
                   const std::function<Vec3(double t)>& origin, int skip = 7) {
  int compared = 0;
  for (uint64_t i = 0; i < lidar.pulses->size(); i += static_cast<uint64_t>(skip)) {
    const auto p = lidar.pulses->pulse(i);
    if (!p) continue;
    const Vec3 from = p->emission.translation, to = p->emission.vector({0, 0, -1});
    const double ours = range_of(from, to), theirs = range_of(origin(p->time), direction(p->time));
    if (ours > 1e8 && theirs > 1e8) continue;
    EXPECT_NEAR(ours, theirs, 0.01) << "pulse " << i << " at " << p->time << " s";
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

// The plane flies from (-10, 5) to (20, 45): 50 m in 1 s, heading 36.87 degrees.
Vec3 of_plane(Vec3 in_emitter) { return turn('z', -std::atan2(30.0, 40.0), mount_of_plane(in_emitter)); }
Vec3 place_of_plane(double t) {
  return Vec3{-10 + 30 * t, 5 + 40 * t, 400} + turn('z', -std::atan2(30.0, 40.0), {0.1, 0.2, 0.7});
}

TEST(HeliosSurvey, Oscillating) {
  const auto all = instruments(parse(survey("galvo", "plane", R"(scanFreq_hz="20" scanAngle_deg="15")")));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].pulses->size(), 1000u);
  EXPECT_DOUBLE_EQ(all[0].laser.beam.full_angle_1_e2, 3.3e-4);
  EXPECT_NEAR(all[0].pulses->pulse(0)->energy, 4.0 / 1000, 1e-12);
  expect_ranges(
      all[0],
      [](double t) {  // from -15 degrees to 15 and back, 20 times a second
        const double x = 20 * t - std::floor(20 * t), a = (x < 0.5 ? -1 + 4 * x : 3 - 4 * x) * 15 * kDegree;
        return of_plane(turn('x', a, {0, 1, 0}));
      },
      place_of_plane);
}

TEST(HeliosSurvey, Rotating) {
  const auto all = instruments(parse(survey("polygon", "plane", R"(scanFreq_hz="20" scanAngle_deg="20")")));
  expect_ranges(
      all[0],
      [](double t) {  // from 0 up, wrapped at 45 degrees; beams leave within 20
        const double x = 20 * t + 0.5, a = (-45 + 90 * (x - std::floor(x))) * kDegree;
        EXPECT_LE(std::fabs(a), 20 * kDegree + 1e-9);
        return of_plane(turn('x', a, {0, 1, 0}));
      },
      place_of_plane);
  size_t lit = 0;
  for (uint64_t i = 0; i < 1000; ++i) lit += all[0].pulses->pulse(i).has_value();
  EXPECT_NEAR(static_cast<double>(lit), 1000 * 40.0 / 90, 40);
}

TEST(HeliosSurvey, TurningHead) {
  const auto all = instruments(parse(survey(
      "tls", "tripod",
      R"(scanFreq_hz="40" scanAngle_deg="100" headRotatePerSec_deg="30" headRotateStart_deg="100" headRotateStop_deg="130" verticalAngleMin_deg="-40" verticalAngleMax_deg="20")")));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].pulses->size(), 1000u);
  expect_ranges(
      all[0],
      [](double t) {
        const double x = 40 * t + 0.5, a = (-120 + 240 * (x - std::floor(x))) * kDegree;
        EXPECT_GE(a, -40 * kDegree - 1e-9);
        EXPECT_LE(a, 20 * kDegree + 1e-9);
        return turn('z', (100 + 30 * t) * kDegree, turn('y', 10 * kDegree, turn('x', a, {0, 1, 0})));
      },
      [](double) {
        return Vec3{-10, 5, 401.7};
      },
      1);
}

TEST(HeliosSurvey, Conic) {
  const auto all = instruments(parse(survey("cone", "plane", R"(scanFreq_hz="40")")));
  EXPECT_DOUBLE_EQ(all[0].laser.wavelength_um, 0.532);
  expect_ranges(
      all[0],
      [](double t) {
        return of_plane(turn('y', 2 * kPi * 40 * t, turn('x', 20 * kDegree, {0, 1, 0})));
      },
      place_of_plane);
}

// Snell's law at each face, with the normals of that program's prisms: the first one's second face is tilted (its angle
// is below 0 degrees), and the other's first.
struct Prism {
  double rotation, wedge_deg;  // Hz
};
Vec3 through_prisms(Vec3 d, const Prism& first, const Prism& second, double t) {
  const auto face = [](Vec3 in, Vec3 normal, double ratio) {
    const double c = -dot(in, normal);
    return normalized(in * ratio + normal * (ratio * c - std::sqrt(1 - ratio * ratio * (1 - c * c))));
  };
  const double a1 = 2 * kPi * first.rotation * t, a2 = 2 * kPi * second.rotation * t, n = 1.5095;
  const double w1 = first.wedge_deg * kDegree, w2 = second.wedge_deg * kDegree;
  d = face(normalized(d), {0, -1, 0}, 1 / n);
  d = face(d, {-std::sin(a1) * std::sin(w1), -std::cos(w1), -std::cos(a1) * std::sin(w1)}, n);
  d = face(d, {std::sin(a2) * std::sin(w2), -std::cos(w2), std::cos(a2) * std::sin(w2)}, 1 / n);
  return face(d, {0, -1, 0}, n);
}

TEST(HeliosSurvey, Risley) {
  const auto all = instruments(parse(survey("prisms", "plane", "")));
  ASSERT_EQ(all.size(), 2u);
  const auto through = [](Vec3 d, double t) { return through_prisms(d, {-77.7, 29.7}, {121.5, 18}, t); };
  expect_ranges(
      all[0],
      [&](double t) {
        return of_plane(through({-0.05, 0.99, 0.02}, t));
      },
      place_of_plane);
  expect_ranges(
      all[1],
      [&](double t) {
        return of_plane(turn('z', 30 * kDegree, through({0, 1, 0}, t)));
      },
      place_of_plane);
}

// Everything is read or named.
TEST(HeliosSurvey, WhatIsTold) {
  const HeliosSurvey s = parse(survey("polygon", "copter", R"(scanFreq_hz="20" flavour="mint")"));
  std::string told;
  for (const HeliosFinding& f : s.findings) told += to_text(f.where) + ": " + f.text + "\n";
  for (const char* text : {"accuracy_m = \"0.02\" is not used", "not used: flavour = \"mint\"",
                           "not used: drag = \"0.01\"", "type = \"multicopter\" moves", "survey.xml:4"})
    EXPECT_THAT(told, HasSubstr(text));
  EXPECT_THAT(s.text.yaml, HasSubstr("most: 5"));
}

TEST(HeliosSurvey, Refused) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to, const std::string& what) {
    text.replace(text.find(from), from.size(), to);
    try {
      parse(text);
      ADD_FAILURE() << to << " is taken";
    } catch (const Error& e) {
      EXPECT_THAT(e.message(), HasSubstr(what));
      EXPECT_FALSE(e.where().file.empty());
    }
  };
  const std::string good = survey("galvo", "plane", R"(scanFreq_hz="20")");
  refused(good, "#galvo", "#nothing", "there is no <scanner id=\"nothing\">");
  refused(good, "template=\"base\"", "template=\"other\"", "there is no <scannerSettings id=\"other\">");
  refused(good, "pulseFreq_hz=\"1000\"", "pulseFreq_hz=\"many\"", "is no number");
  refused(good, "pulseFreq_hz=\"1000\"", "", "has no pulseFreq_hz");
  refused(good, "z=\"400\" movePerSec_m", "trajectory=\"t.txt\" movePerSec_m", "file of poses");
  refused(good, "active=\"true\"", "active=\"false\"", "no leg of the survey measures anything");
  refused(good, "<survey", "<surveys", "");
}

// The public scanners and platforms, where they are: SUITE_HELIOS names their folder. All elements are read or named.
TEST(HeliosSurvey, PublicScanners) {
  const char* folder = std::getenv("SUITE_HELIOS");
  if (!folder) GTEST_SKIP() << "SUITE_HELIOS names no folder with scanners_als.xml, scanners_tls.xml and platforms.xml";
  size_t read = 0;
  for (const std::string file : {"scanners_als.xml", "scanners_tls.xml"}) {
    const std::string path = std::string(folder) + "/" + file;
    XmlElement::parse(read_text(path), path).each_child("scanner", [&](const XmlElement& e) {
      const std::string id = *e.attribute("id");
      std::string text = survey("galvo", "plane", R"(scanFreq_hz="20" scanAngle_deg="15")");
      text.replace(text.find("data/s.xml#galvo"), 16, path + "#" + id);
      const HeliosSurvey s = parse_helios_survey(
          text, "survey.xml",
          {[&](const std::string& name) {
             return HeliosSurveyFiles::Named{name, name == "data/p.xml" ? kPlatforms : read_text(name)};
           },
           [](const std::string& scene) { return scene + ".h5"; }});
      for (const HeliosFinding& f : s.findings)
        EXPECT_THAT(f.text, testing::Not(testing::StartsWith("not used: "))) << id << " " << f.text;
      EXPECT_FALSE(instruments(s).empty()) << id;
      ++read;
    });
  }
  EXPECT_EQ(read, 32u);
}

// A yard of a plane, three boxes and a tree: a crown of a sphere on a trunk that is a box. m, along a ray.
double range_in_yard(Vec3 from, Vec3 to) {
  double near = to.z < 0 ? -from.z / to.z : 1e9;
  const std::array<Vec3, 2> boxes[] = {{Vec3{-9.85, -15.2, 0}, {-9.6, -14.8, 0.3}},
                                       {Vec3{8, 20, 0}, {14, 24, 5}},
                                       {Vec3{-12, 20, 0}, {-9, 27, 6}},
                                       {Vec3{-6.2, 30.8, 0}, {-5.8, 31.2, 4}}};
  for (const auto& [low, high] : boxes) {
    double in = 0, out = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double a = (low[k] - from[k]) / to[k], b = (high[k] - from[k]) / to[k];
      in = std::max(in, std::min(a, b)), out = std::min(out, std::max(a, b));
    }
    if (in < out) near = std::min(near, in);
  }
  const Vec3 crown = from - Vec3{-6, 31, 5};
  const double b = dot(crown, to), inside = b * b - (dot(crown, crown) - 4);
  if (inside > 0 && -b - std::sqrt(inside) > 0) near = std::min(near, -b - std::sqrt(inside));
  return near;
}

// Of a leg with 1e5 pulses a second: where beams leave from and to by that program's description, t s after its begin.
struct Leg {
  std::function<Vec3(double t)> direction, origin;
};
void expect_yard(const LidarInstrument& lidar, const Leg& leg) {
  int compared = 0, ground = 0;
  for (uint64_t i = 0; i < lidar.pulses->size(); i += 97) {
    const auto p = lidar.pulses->pulse(i);
    if (!p) continue;
    const Vec3 from = p->emission.translation, to = p->emission.vector({0, 0, -1});
    const double t = 1e-5 * static_cast<double>(i), ours = range_in_yard(from, to),
                 theirs = range_in_yard(leg.origin(t), leg.direction(t));
    if (ours > 200 && theirs > 200) continue;  // near the horizon
    EXPECT_NEAR(ours, theirs, 0.01) << "pulse " << i;
    ++compared, ground += from.z + ours * to.z < 1e-6;
  }
  EXPECT_GT(ground, 100);
  EXPECT_GT(compared - ground, 20) << "boxes and the tree";
}

// The public surveys over the yard, ranges within 1 cm of a ray cast of the documented deflectors.
TEST(HeliosSurvey, PublicSurveys) {
  const char* folder = std::getenv("SUITE_HELIOS");
  if (!folder) GTEST_SKIP() << "SUITE_HELIOS names no folder with livox_test.xml and tls_arbaro_demo.xml";
  const auto legs = [&](const std::string& file) {
    const std::string path = std::string(folder) + "/" + file;
    return instruments(parse_helios_survey(
        read_text(path), path,
        {[&](const std::string& name) {
           return HeliosSurveyFiles::Named{name, read_text(std::string(folder) + name.substr(name.rfind('/')))};
         },
         [](const std::string& scene) { return scene + ".h5"; }}));
  };
  // Risley prisms, straight down from 0.7 m, while the platform goes 1 cm to the north-east.
  const auto livox = legs("livox_test.xml");
  ASSERT_EQ(livox.size(), 1u);
  EXPECT_NEAR(static_cast<double>(livox[0].pulses->size()), 1e5 * std::sqrt(2.0), 2);
  const auto of_platform = [](Vec3 v) { return turn('z', -45 * kDegree, mount_of_plane(v)); };
  expect_yard(livox[0],
              {[&](double t) {
                 return of_platform(through_prisms({0, 1, 0}, {-77.733333333, 29.7}, {121.566666666, 29.7}, t));
               },
               [](double t) {
                 const double on = 0.01 * t / std::sqrt(2.0);
                 return Vec3{-10.01 + on, -15.01 + on, 0.7};
               }});
  // A mirror that turns over 240 degrees with a head that turns on.
  const auto tls = legs("tls_arbaro_demo.xml");
  ASSERT_EQ(tls.size(), 2u);
  const struct { double x, y, start; } stands[] = {{1, 25.5, 100}, {-4, -2.5, -45}};
  for (size_t k = 0; k < 2; ++k)
    expect_yard(tls[k], {[&](double t) {
                           const double x = 120 * t + 0.5, a = (-120 + 240 * (x - std::floor(x))) * kDegree;
                           return turn('z', (stands[k].start + 10 * t) * kDegree, turn('x', a, {0, 1, 0}));
                         },
                         [&](double) {
                           return Vec3{stands[k].x, stands[k].y, 1.7};
                         }});
}

}  // namespace
}  // namespace suite::format_helios_survey_test
