// Stars over a lake: the numbers of expect.md of the sample.
#include <cmath>
#include <map>
#include <sstream>

#include "base/files.h"
#include "support/sample_kit.h"

namespace suite::star_lake_test {
namespace {

class StarLake : public SampleScene {
 protected:
  StarLake() : SampleScene("star_lake") {}
};

struct Seen {
  double column, row, green;
};

// Fresnel's equations for a refractive index and the cosine of incidence.
double mirrored(double c, double n) {
  const double t = std::sqrt(1 - (1 - c * c) / (n * n)), s = (c - n * t) / (c + n * t), p = (n * c - t) / (n * c + t);
  return 0.5 * (s * s + p * p);
}

TEST_F(StarLake, WaterMirrorsStars) {
  render("out", "--paths 4 --set sensors.0.columns=120 --set sensors.0.rows=120 --set sensors.0.pitch_um=80");
  std::istringstream lines(read_text(folder_ / "out/lake_stars.csv"));
  std::map<std::string, std::vector<Seen>> stars;
  for (std::string line; std::getline(lines, line);) {
    char name[32];
    Seen s{};
    if (std::sscanf(line.c_str(), "%31[^,],%*f,%lf,%lf,%*f,%lf", name, &s.column, &s.row, &s.green) == 4)
      stars[name].push_back(s);
  }
  // The camera looks up by atan(1.5 / 100); rows are 0.08 mm at 5.5 mm.
  size_t pairs = 0;
  double off = 0;
  for (const auto& [name, seen] : stars) {
    if (seen.size() != 2) continue;
    const double x = (seen[0].column - 60) * 0.08 / 5.5, y = (seen[0].row - 60) * 0.08 / 5.5, up = std::atan(0.015);
    const double sine = (std::sin(up) - std::cos(up) * y) / std::sqrt(1 + x * x + y * y);
    if (sine < 0.25) continue;  // where a row matters too much
    ++pairs;
    off = std::max(off, std::fabs(seen[1].green / seen[0].green / mirrored(sine, 1.34) - 1));
  }
  EXPECT_GT(pairs, 100u);
  EXPECT_LT(off, 0.15) << "a row of 0.8 degrees changes the reflectance by 10 %";
}

}  // namespace
}  // namespace suite::star_lake_test
