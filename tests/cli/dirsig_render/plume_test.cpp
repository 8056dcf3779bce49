// The plume scene through both programs: what gets through the smoke along known lines against the sum over its voxels,
// media in the summary, and faults of media told at their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "math/vec.h"
#include "support/run_command.h"

namespace suite::plume_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class Plume : public testing::Test {
 protected:
  Plume() { run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/plume/. " + folder_.path()); }
  CommandResult run(const std::string& command) {
    return run_command("cd " + folder_.path() + " && " + kBin + command);
  }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / file, text.replace(at, from.size(), to));
  }
  TempFolder folder_;
};

// A line of sight in scene ENU, from outside of the smoke to the sky.
struct Sight {
  Vec3 from, look;
};
// Through the smoke, 100 to 420 m downwind of the mouth; the plume's x axis points 15 degrees south of east.
std::vector<Sight> sights() {
  std::vector<Sight> all;
  for (const double along : {100.0, 180.0, 260.0, 340.0, 420.0})
    for (const double steep : {0.1, 0.6}) {
      const double turn = -15 * kDegree;
      const Vec3 wind{std::cos(turn), std::sin(turn), 0}, across{-std::sin(turn), std::cos(turn), 0};
      const Vec3 aim = wind * along + Vec3{0, 0, 92 + 70 * (1 - std::exp(-along / 140))};
      const Vec3 look = normalized(across + wind * 0.3 + Vec3{0, 0, steep});
      all.push_back({aim - look * 180, look});
    }
  return all;
}

// Integral of the density along a line through plume.u8 as plume.vox describes it, placed with a heading: cell by cell
// between the planes that the line crosses. 1/density-metres.
double column(const std::vector<std::byte>& cells, const Sight& s, double heading_deg) {
  const double c = std::cos(heading_deg * kDegree), n = std::sin(heading_deg * kDegree);
  const auto local = [&](Vec3 v) { return Vec3{c * v.x - n * v.y, n * v.x + c * v.y, v.z}; };
  const Vec3 from = local(s.from - Vec3{0, 0, 92}) - Vec3{0, -100, -30}, look = local(s.look);
  constexpr int size[3] = {96, 40, 32};
  constexpr double cell = 5;
  std::vector<double> cuts{0, 1000};
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k <= size[axis]; ++k)
      if (const double t = (cell * k - from[axis]) / look[axis]; t > 0 && t < 1000) cuts.push_back(t);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (size_t k = 1; k < cuts.size(); ++k) {
    const Vec3 at = from + look * (0.5 * (cuts[k - 1] + cuts[k]));
    int index[3];
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] = static_cast<int>(std::floor(at[axis] / cell));
      inside = inside && index[axis] >= 0 && index[axis] < size[axis];
    }
    if (inside)
      sum += (cuts[k] - cuts[k - 1]) / 64 *
             std::to_integer<int>(cells[static_cast<size_t>(index[0] + size[0] * (index[1] + size[1] * index[2]))]);
  }
  return sum;
}

// Mean transmittance over a band of 0.03 um of what falls from 0.09 at 0.4 um to 0.055 at 0.7 um.
double transmittance(double column_m, double center_um) {
  double sum = 0;
  constexpr int steps = 100;
  for (int k = 0; k < steps; ++k) {
    const double um = center_um + 0.03 * ((k + 0.5) / steps - 0.5);
    sum += std::exp(-column_m * (0.09 - (um - 0.4) / 0.3 * 0.035)) / steps;
  }
  return sum;
}

// Smoke that only absorbs, alone under a sky of 1: what comes along a line is the transmittance.
TEST_F(Plume, WhatGetsThroughIsTheSumOverItsVoxels) {
  change("scene.yaml", "albedo: {points: [[0.4, 0.72], [0.7, 0.86]], outside: hold}", "albedo: 0");
  change("scene.yaml", "  - {place: cloud, translate: [-150, 330, 230]}\n", "");
  std::string sim =
      "scene: scene.h5\nseed: 3\nsky: {radiance: 1}\nsensors:\n  - kind: point\n    name: lines\n    paths: 4096\n"
      "    bands:\n      - {name: blue, center_um: 0.475, fwhm_um: 0.03, shape: rectangular}\n"
      "      - {name: red, center_um: 0.655, fwhm_um: 0.03, shape: rectangular}\n    collectors:\n";
  for (const Sight& s : sights())
    sim += strf("      - {quantity: radiance, position_m: [%.17g, %.17g, %.17g], look: [%.17g, %.17g, %.17g]}\n",
                s.from.x, s.from.y, s.from.z, s.look.x, s.look.y, s.look.z);
  write_file(folder_ / "sim.yaml", sim);
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5"), render = run("dirsig-render sim.yaml -o out -q");
  ASSERT_EQ(prep.code, 0) << prep.err;
  ASSERT_EQ(render.code, 0) << render.err;
  EXPECT_THAT(run("scene-prep --summary scene.h5").out, HasSubstr("voxel grids"));
  const std::vector<double> seen = EnviImage(folder_ / "out/lines.img").read_all(),
                            error = EnviImage(folder_ / "out/lines_error.img").read_all();
  const std::vector<std::byte> cells = read_bytes(folder_ / "plume.u8");
  ASSERT_EQ(seen.size(), 2 * sights().size());
  size_t of_more_smoke = 0, of_other_wind = 0, thin = 0, thick = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const Sight s = sights()[i / 2];
    const double center = i % 2 ? 0.655 : 0.475, metres = 4 * column(cells, s, 15);
    const double exact = transmittance(metres, center), bound = 4.5 * error[i] + 2e-4;
    EXPECT_NEAR(seen[i], exact, bound) << "line " << i / 2 << " at " << center << " um";
    thin += exact > 0.5, thick += exact < 0.2;
    of_more_smoke += std::fabs(seen[i] - transmittance(1.05 * metres, center)) > bound;
    of_other_wind += std::fabs(seen[i] - transmittance(4 * column(cells, s, -15), center)) > bound;
  }
  // There is something to be seen; negative controls: 5 % more smoke, and wind from elsewhere.
  EXPECT_GE(thin, 2u);
  EXPECT_GE(thick, 2u);
  EXPECT_GE(of_more_smoke, 12u) << "of 20";
  EXPECT_GE(of_other_wind, 18u) << "of 20";
}

TEST_F(Plume, FaultsOfMedia) {
  change("scene.yaml", "medium: droplets", "medium: dropets");
  change("scene.yaml", "    index: 1.34\n", "    index: 1.34\n    extinction: 3\n");
  change("plume.vox", "[96, 40, 32]", "[96, 40, 33]");
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5");
  EXPECT_EQ(prep.code, 1);
  EXPECT_THAT(prep.err, HasSubstr("did you mean 'droplets'?"));
  EXPECT_THAT(prep.err, HasSubstr("extinction 3 is not absorption"));
  EXPECT_THAT(prep.err, HasSubstr("'plume.u8' has 122880 bytes, the grid needs 126720"));
}

}  // namespace

}  // namespace suite::plume_test
