// How the contrast of a Secchi disk falls with its depth, by collectors in the water, against theory and the numbers of
// the sample's expect.md.
#include <cmath>
#include <map>
#include <sstream>

#include "base/files.h"
#include "math/vec.h"
#include "support/sample_kit.h"
#include "water/water.h"

namespace suite::secchi_disk_test {
namespace {

struct Value {
  double mean = 0, error = 0;
};
constexpr double kDepths[] = {0.5, 1, 2, 3, 4, 5, 6};

class SecchiDisk : public SampleScene {
 protected:
  SecchiDisk() : SampleScene("secchi_disk") {}
  void SetUp() override {
    SampleScene::SetUp();
    render("out", "--set sensors.0.rows=1 --set sensors.0.columns=1 --set sensors.0.paths=1");
    std::istringstream rows(read_text(folder_ / "out/meters.csv"));
    for (std::string row; std::getline(rows, row);) {
      std::vector<std::string> cells;
      std::istringstream line(row);
      for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
      if (cells.size() == 7 && cells[3] == "green") seen_[cells[0]] = {std::stod(cells[5]), std::stod(cells[6])};
    }
  }
  Value at(const std::string& what, double depth) { return seen_[what + strf(" at %g m", depth)]; }
  // Of the radiance of a thing over that of the water.
  Value contrast(const std::string& thing, double depth) {
    const Value L = at("Lu of " + thing, depth), water = seen_["Lu of water"];
    return {L.mean / water.mean - 1, std::hypot(L.error, L.mean / water.mean * water.error) / water.mean};
  }
  std::map<std::string, Value> seen_;
};

TEST_F(SecchiDisk, ContrastFallsAsTheorySays) {
  WaterSpec spec;
  spec.chlorophyll = 1, spec.case_1_dissolved = true, spec.particles = "hg";
  const Medium water = water_medium(spec);
  const auto mean = [](const Curve& c) { return c.integral(0.54, 0.56) / 0.02; };
  const double c = mean(water.absorption) + mean(water.scattering);
  const double down = at("Ed", 0.5).mean, K = std::log(down / at("Ed", 5).mean) / 4.5;
  std::printf("c %.4f 1/m, Kd %.4f 1/m\n", c, K);
  EXPECT_NEAR(K, 0.103, 0.006);
  const double first = at("Lu of dot", 0.5).mean - seen_["Lu of water"].mean;
  for (const double z : kDepths) {
    const Value dot = contrast("dot", z), disk = contrast("disk", z);
    // From the light at the dot itself: what its reflectance makes of Ed, less the water's own light there.
    const double own =
        0.85 / kPi * at("Ed", z).mean - seen_["Lu of water"].mean * at("Ed", z).mean / seen_["Ed at 0.01 m"].mean;
    const double there = own * std::exp(-c * z), L = at("Lu of dot", z).mean - seen_["Lu of water"].mean;
    const double noise =
        std::hypot(at("Lu of dot", z).error, seen_["Lu of water"].error) + there * at("Ed", z).error / at("Ed", z).mean;
    std::printf(
        "%.1f m: contrast of the dot %.3f +- %.3f, theory %.3f; fallen to %.4f, exp(-(c + Kd) z) %.4f; disk "
        "%.3f +- %.3f\n",
        z, dot.mean, dot.error, there / seen_["Lu of water"].mean, L / first, std::exp(-(c + K) * (z - 0.5)), disk.mean,
        disk.error);
    EXPECT_NEAR(L, there, 4 * noise + 0.03 * there) << z;  // 3 %: light scattered by less than the dot is wide
    EXPECT_GT(disk.mean, dot.mean) << "a wide disk keeps what is scattered forwards";
    // Negative controls: by c or by Kd alone it would not fall so.
    if (z == 3 || z == 4) {
      EXPECT_GT(own * std::exp(-c * z * 0.75) - L, 4 * noise);
      EXPECT_LT(own * std::exp(-c * z * 1.25) - L, -4 * noise);
    }
  }
}

}  // namespace
}  // namespace suite::secchi_disk_test
