// From two-line elements to the latitude and longitude of a pixel: the middle of each picture of
// sample_scenes/orbit_pass against a place computed here, from the TEME state on by other formulas than the suite's.
//
// Based on: D. Vallado et al., "Revisiting Spacetrack Report #3", AIAA 2006-6753 (TEME, Greenwich mean sidereal time of
// 1982); the latitude by iteration on the ellipsoid's normal.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/tle/tle.h"
#include "math/vec.h"
#include "support/run_command.h"

namespace suite::orbit_pass_test {
namespace {

constexpr double kA = 6378137, kF = 1 / 298.257223563, kB = kA * (1 - kF), kEarth = 174, kRate = 7.29211514670698e-5;

// Greenwich mean sidereal time, rad. seconds: of UT1 since 2026-06-21T00:00 UTC (Julian date 2461212.5).
double sidereal(double seconds) {
  const double t = (2461212.5 - 2451545.0 + seconds / 86400) / 36525;
  const double s = 67310.54841 + (876600 * 3600.0 + 8640184.812866) * t + 0.093104 * t * t - 6.2e-6 * t * t * t;
  return std::fmod(s, 86400) / 240 * std::numbers::pi / 180;
}
Vec3 turned(Vec3 v, double angle) {  // from the sky's axes into ones turned by `angle` about z
  return {std::cos(angle) * v.x + std::sin(angle) * v.y, -std::sin(angle) * v.x + std::cos(angle) * v.y, v.z};
}
struct Place {
  double latitude, longitude, height;  // deg, deg, m
};
Place place_of(Vec3 p) {
  const double e2 = kF * (2 - kF), r = std::hypot(p.x, p.y);
  double latitude = std::atan2(p.z, r * (1 - e2)), n = kA;
  for (int i = 0; i < 20; ++i) {
    n = kA / std::sqrt(1 - e2 * std::pow(std::sin(latitude), 2));
    latitude = std::atan2(p.z + e2 * n * std::sin(latitude), r);
  }
  return {latitude * 180 / std::numbers::pi, std::atan2(p.y, p.x) * 180 / std::numbers::pi, r / std::cos(latitude) - n};
}
Vec3 up_at(const Place& p) {
  const double b = p.latitude * std::numbers::pi / 180, l = p.longitude * std::numbers::pi / 180;
  return {std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)};
}
// Where a line of sight meets the ellipsoid raised to the height of the simulation's Earth.
Place met(Vec3 from, Vec3 d) {
  const double a = kA + kEarth, b = kB + kEarth;
  const Vec3 o{from.x / a, from.y / a, from.z / b}, v{d.x / a, d.y / a, d.z / b};
  const double half = dot(o, v), q = dot(v, v);
  return place_of(from + d * ((-half - std::sqrt(half * half - q * (dot(o, o) - 1))) / q));
}

struct Expected {
  Place stare, nadir, along;
};
Expected expected(const std::string& tle, double time, double dut1) {
  const OrbitState teme =
      Sgp4(read_tle(tle).at(0).elements).at_minutes(time / 60);  // the epoch of the elements is second 0
  const double turn = sidereal(10.5 * 3600 + time + dut1);
  const Vec3 p = turned(teme.position, turn), v = turned(teme.velocity, turn) - Vec3{-kRate * p.y, kRate * p.x, 0};
  const Vec3 up = up_at(place_of(p)), y = normalized(v), z = normalized(up - y * dot(up, y));
  return {{49.4179346686601, 8.69198504652371, 175}, met(p, -up), met(p, -z)};
}

// The mean place of a picture, which is what its axis sees.
Place middle_of(const std::string& truth) {
  const EnviImage image(truth);
  const std::vector<double> t = image.read_all();
  const size_t bands = image.header().bands, n = t.size() / bands;
  Place mean{};
  for (size_t i = 0; i < n; ++i)
    mean.latitude += t[i * bands] / static_cast<double>(n), mean.longitude += t[i * bands + 1] / static_cast<double>(n),
        mean.height += t[i * bands + 2] / static_cast<double>(n);
  return mean;
}
double apart(const Place& a, const Place& b) {  // m over the ground
  const double m = kA * std::numbers::pi / 180;
  return std::hypot(m * (a.latitude - b.latitude),
                    m * std::cos(a.latitude * std::numbers::pi / 180) * (a.longitude - b.longitude));
}

TEST(OrbitPass, PixelsLieWhereElementsAndSiderealTimeSay) {
  const TempFolder folder;
  const std::string work = folder.path();
  // Small pictures without boards, so that all of each is Earth.
  const CommandResult prep = run_command(
      "cp '" SUITE_SOURCE_DIR "/sample_scenes/orbit_pass/'* '" + work + "' && cd '" + work +
      "' && sed -i 's/columns: 301, rows: 301/columns: 15, rows: 15/' sim.yaml && sed "
      "'s/dut1_s: 0.1/dut1_s: -0.4/' sim.yaml > other.yaml && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q");
  ASSERT_EQ(prep.code, 0) << prep.err;
  Place seen[2][3];
  for (const int run : {0, 1}) {
    const std::string name = run ? "other" : "sim";
    const CommandResult r = run_command("cd '" + work + "' && " SUITE_BIN_DIR "/dirsig-render " + name + ".yaml -o " +
                                        name + " --paths 64 -q");
    ASSERT_EQ(r.code, 0) << r.err;
    const Expected want = expected(work + "/orbit.tle", 2, run ? -0.4 : 0.1);
    const Place wanted[] = {want.stare, want.nadir, want.along};
    const char* names[] = {"stare", "nadir", "along"};
    for (int i = 0; i < 3; ++i) {
      seen[run][i] = middle_of(work + "/" + name + "/" + names[i] + "_truth.img");
      const double off = apart(seen[run][i], wanted[i]);
      std::printf("dut1 %+.1f s, %s: %.7f N, %.7f E, %.3f m; off by %.4f m\n", run ? -0.4 : 0.1, names[i],
                  seen[run][i].latitude, seen[run][i].longitude, seen[run][i].height, off);
      EXPECT_LT(off, 0.05) << names[i];
      EXPECT_NEAR(seen[run][i].height, i == 0 ? 175 : kEarth, 0.01);
    }
  }
  // Half a second of Earth rotation moves the track; the place that is stared at stays.
  EXPECT_LT(apart(seen[0][0], seen[1][0]), 0.2);
  EXPECT_NEAR(apart(seen[0][1], seen[1][1]), 0.5 * kRate * kA * std::cos(49.2 * kDegree), 2);
}

TEST(OrbitPass, WhatCannotBeIsRefused) {
  const TempFolder folder;
  const std::string work = folder.path();
  ASSERT_EQ(run_command("cp '" SUITE_SOURCE_DIR "/sample_scenes/orbit_pass/'* '" + work + "' && cd '" + work +
                        "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q")
                .code,
            0);
  auto message = [&](const std::string& edit) {
    const CommandResult r = run_command("cd '" + work + "' && sed '" + edit +
                                        "' sim.yaml > bad.yaml && " SUITE_BIN_DIR "/dirsig-render bad.yaml -o out -q");
    EXPECT_EQ(r.code, 1) << edit;
    EXPECT_FALSE(file_exists(work + "/out/stare.img"));
    return r.err;
  };
  EXPECT_NE(message("s/satellite: 99001/satellite: 99002/").find("99002"), std::string::npos);
  EXPECT_NE(message("s/dut1_s: 0.1/dut1_s: 1.5/").find("bad.yaml:6:9"), std::string::npos);
  EXPECT_NE(message("s/pointing: nadir/pointing: nadr/").find("nadir"), std::string::npos);
}

}  // namespace
}  // namespace suite::orbit_pass_test
