// The map gallery from text to pixels: each plate against a closed form. The sun is collimated, nothing but the leaf
// stands up, so a Lambert surface at z = 0 shows rho (E cos z / pi + L_sky); the thermal band shows (1 - rho) B(T).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "math/vec.h"
#include "spectral/planck.h"
#include "support/run_command.h"

namespace suite::map_gallery_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class MapGallery : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/map_gallery/. " + folder_->path());
    prep_ = run("scene-prep scene.yaml -o scene.h5 -q");
    render_ = run("dirsig-render sim.yaml -o out --paths 16");
    if (render_.code) return;
    vnir_ = EnviImage(*folder_ / "out/vnir.img").read_all();
    tir_ = EnviImage(*folder_ / "out/tir.img").read_all();
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override {
    ASSERT_EQ(prep_.code, 0) << prep_.err;
    ASSERT_EQ(render_.code, 0) << render_.err;
  }
  static CommandResult run(const std::string& command) {
    return run_command("cd " + folder_->path() + " && " + kBin + command);
  }
  // The camera stands 60 m up, one pixel is 0.05 m on the ground; the middle of the picture is the origin.
  static size_t pixel(double x, double y) {
    const auto column = static_cast<size_t>(std::floor(130 + x / 0.05)),
               row = static_cast<size_t>(std::floor(90 - y / 0.05));
    return row * 260 + column;
  }
  // Reflectance that a Lambert surface would need.
  static double rho(double x, double y, size_t band) {
    return vnir_[4 * pixel(x, y) + band] / (1000 * std::cos(30 * kDegree) / kPi + 40);
  }
  static double thermal(double x, double y) { return tir_[pixel(x, y)]; }

  static TempFolder* folder_;
  static CommandResult prep_, render_;
  static std::vector<double> vnir_, tir_;
};
TempFolder* MapGallery::folder_ = nullptr;
CommandResult MapGallery::prep_, MapGallery::render_;
std::vector<double> MapGallery::vnir_, MapGallery::tir_;

}  // namespace

TEST_F(MapGallery, ClassesByTextureCoordinates) {
  EXPECT_NEAR(rho(-5.0, 2.5, 0), 0.05, 1e-4);
  EXPECT_NEAR(rho(-4.0, 2.5, 1), 0.30, 1e-4);
  EXPECT_NEAR(rho(-5.0, 3.5, 2), 0.60, 1e-4);
  EXPECT_NEAR(rho(-4.0, 3.5, 3), 0.40 + 0.10 * (0.85 - 0.72) / 0.28, 1e-4);  // the green curve
}

TEST_F(MapGallery, MixtureIsLinearBetweenItsParts) {
  // Fractions (1 - x)(1 - y/2), x (1 - y/2), y/2 of 0.6, 0.05 and green, which is 0.05 + 0.1 * 0.07 / 0.15 at 0.47 um.
  const double green = 0.05 + 0.10 * 0.07 / 0.15;
  for (const double x : {-0.72, -0.22, 0.33, 0.63})
    for (const double y : {-0.62, 0.13, 0.72}) {
      // What the pixel in the picture really looks at: its middle.
      const double u = (std::floor(x / 0.05) + 0.5) * 0.05 / 2 + 0.5, v = (std::ceil(y / 0.05) - 0.5) * 0.05 / 2 + 0.5;
      const double expected = 0.6 * (1 - u) * (1 - v / 2) + 0.05 * u * (1 - v / 2) + green * v / 2;
      EXPECT_NEAR(rho(-1.5 + x, 3 + y, 0), expected, 0.01 * expected + 0.003) << x << ' ' << y;
    }
}

TEST_F(MapGallery, TextureHasMeanAndCovarianceOfItsFamily) {
  // The family's curves at the four bands, linear between their channels.
  const std::string bytes = read_text(*folder_ / "soils.sli");
  ASSERT_EQ(bytes.size(), 24u * 16 * 4);
  const auto* values = reinterpret_cast<const float*>(bytes.data());
  constexpr double kUm[] = {0.47, 0.55, 0.66, 0.85};
  const auto curve = [&](size_t k, size_t b) {
    const double x = (kUm[b] - 0.35) / 0.05;
    const auto i = static_cast<size_t>(x);
    return values[16 * k + i] + (x - static_cast<double>(i)) * (values[16 * k + i + 1] - values[16 * k + i]);
  };
  const auto moments = [](size_t n, const auto& value) {
    std::vector<double> m(20, 0.0);
    for (size_t i = 0; i < n; ++i)
      for (size_t b = 0; b < 4; ++b) m[b] += value(i, b) / static_cast<double>(n);
    for (size_t i = 0; i < n; ++i)
      for (size_t a = 0; a < 4; ++a)
        for (size_t b = 0; b < 4; ++b)
          m[4 + 4 * a + b] += (value(i, a) - m[a]) * (value(i, b) - m[b]) / static_cast<double>(n);
    return m;
  };
  const auto wanted = moments(24, curve);
  // The centres of the 32 x 32 pixels of the image, those that lie well inside a pixel of the picture.
  std::vector<std::pair<double, double>> places;
  for (int r = 0; r < 32; ++r)
    for (int c = 0; c < 32; ++c) places.push_back({0.5 + (c + 0.5) / 16, 4 - (r + 0.5) / 16});
  const auto got =
      moments(places.size(), [&](size_t i, size_t b) { return rho(places[i].first, places[i].second, b); });
  // Pixels of the picture blend neighbouring curves a little, which takes from the covariance: a tenth, not the
  // twentieth that tests/physics/surface/maps_test.cpp holds where every pixel of the map is seen alone.
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(got[i] / wanted[i], 1, 0.03) << i;
  for (size_t i = 4; i < 20; ++i) {
    EXPECT_GT(got[i] / wanted[i], 0.6) << i;
    EXPECT_LT(got[i] / wanted[i], 1.05) << i;
  }
}

TEST_F(MapGallery, CubeShowsTheSpectrumOfEveryPixel) {
  constexpr double kUm[] = {0.47, 0.55, 0.66, 0.85};
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < 8; ++c)
      for (size_t b = 0; b < 4; ++b) {
        const double x = (c + 0.5) / 8, y = 1 - (r + 0.5) / 8;
        EXPECT_NEAR(rho(-5.5 + 2 * x, -1 + 2 * y, b), 0.1 + 0.4 * x + 0.8 * (y - 0.5) * (kUm[b] - 0.7), 1e-3)
            << r << ' ' << c << ' ' << b;
      }
}

TEST_F(MapGallery, TemperaturesOfMapAndTable) {
  const auto shown = [](double kelvin) { return 0.9 * planck_band_radiance(9.5, 10.5, kelvin); };
  for (const double x : {-0.8, -0.3, 0.2, 0.7}) {
    const double u = (std::floor((-1.5 + x) / 0.05) + 0.5) * 0.05 + 1.5;
    EXPECT_NEAR(thermal(-1.5 + x, 0.1) / shown(280 + 40 * (u / 2 + 0.5)), 1, 0.003) << x;
  }
  EXPECT_NEAR(thermal(1.5, 0.2) / shown(305), 1, 1e-3);   // 250 s after 300 K, 20 K in 1000 s
  EXPECT_NEAR(thermal(-5.0, 3.5) / shown(300), 0, 1e-3);  // the others do not emit
}

TEST_F(MapGallery, BumpsTiltAndOpacityCasts) {
  // A ramp of 40 K x 100 x 0.0002 m = 0.8 m over 2 m: slope 0.4 towards the east, its normal leans to the west.
  const Vec3 n = normalized(Vec3{-0.4, 0, 1});
  const double azimuth = azimuth_from_compass_deg(135);
  const Dir sun = dir_from_angles(30 * kDegree, azimuth);
  double l = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) l += vnir_[4 * pixel(1.02 + 0.05 * i, -3.48 + 0.05 * j) + 1] / 400;
  // The sky above the true surface only; what of it the tilt hides is at most (1 - n.z) / 2 of it.
  const double from_sun = 0.5 * 1000 / kPi * dot(n, sun);
  EXPECT_GE(l, from_sun + 0.5 * 40 * (1 + n.z) / 2 * 0.98);
  EXPECT_LE(l, from_sun + 0.5 * 40 * 1.01);
  // Under the leaf the plate is in part in shadow: both full and hidden sun occur.
  double darkest = 1, brightest = 0;
  for (double x = 3.7; x < 5.3; x += 0.05)
    for (double y = -3.8; y < -2.2; y += 0.05)
      darkest = std::fmin(darkest, rho(x, y, 1)), brightest = std::fmax(brightest, rho(x, y, 1));
  EXPECT_LT(darkest, 0.1);
  EXPECT_GT(brightest, 0.28);
}

TEST_F(MapGallery, OnlyWhatTheSensorsSeeIsLoaded) {
  EXPECT_THAT(render_.err, HasSubstr("temperatures         read"));
  // Without the thermal camera the temperatures go.
  std::string sim = read_text(*folder_ / "sim.yaml");
  sim.resize(sim.find("  - kind: frame_camera\n    name: tir"));
  write_file(*folder_ / "visible.yaml", std::string_view(sim));
  const CommandResult r = run("dirsig-render visible.yaml -o visible --paths 1 --set output=null");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("temperatures         left out"));
  EXPECT_THAT(r.err, HasSubstr("they glow in no window"));
  // And the picture is the same to the last bit but one: a material without a temperature knows its weight as a number,
  // with one as a product (until throughputs became few factors both rounded alike, and all bits were the same).
  ASSERT_EQ(run("dirsig-render sim.yaml -o both --paths 1").code, 0);
  const auto alone = EnviImage(*folder_ / "visible/vnir.img").read_all(),
             both = EnviImage(*folder_ / "both/vnir.img").read_all();
  ASSERT_EQ(alone.size(), both.size());
  for (size_t i = 0; i < alone.size(); ++i)
    ASSERT_FLOAT_EQ(static_cast<float>(alone[i]), static_cast<float>(both[i])) << i;
  EXPECT_THAT(run("dirsig-render --explain temperatures").out, HasSubstr("1e-9 W/(m2 sr um)"));
  EXPECT_EQ(run("scene-prep --explain temperture").code, 1);
}

}  // namespace suite::map_gallery_test
