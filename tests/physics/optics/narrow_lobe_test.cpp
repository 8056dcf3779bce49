// A fitted lobe narrower than the Sun's disk (its cells are, too): what a surface shows around the mirror direction
// against the integral of its own function over the disk, with the sun asked explicitly, and met by chance only.
#include <gtest/gtest.h>

#include <cmath>

#include "sqt_fit/aligned_fit.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::narrow_lobe_test {
namespace {

constexpr double kSun = 0.00465, kWidth = 0.0012;  // rad: half angle of the disk, width in the half vector's slope

class NarrowLobe final : public sqt::Function {
 public:
  NarrowLobe() {
    info_.name = "polished";
    info_.wavelength_um = {0.55};
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    if (!(out.z > 0) || !(in.z > 0)) {
      f[0] = std::nan("");
      return;
    }
    const Dir h = normalized(out + in);
    const double slope2 = (1 - h.z * h.z) / (h.z * h.z);
    // Ward's lobe with a bounded grazing factor: half of the light, whatever the view.
    f[0] = 0.5 * std::exp(-slope2 / (kWidth * kWidth)) / (4 * kPi * kWidth * kWidth * dot(out, h) * dot(out, h));
  }

 private:
  Info info_;
};

TEST(NarrowLobe, SeesThePartOfTheDiskThatItReflects) {
  sqt::AlignedSource::Options options;
  options.views = 5;
  options.max_order = 10;
  const std::shared_ptr<const sqt::Bundle> bundle =
      sqt::make_bundle(sqt::encode_aligned(sqt::AlignedSource(NarrowLobe(), options), 0.05).data);
  ASSERT_FALSE(bundle->info().has_delta()) << "the lobe should have stayed in the cells";
  const auto scene = scene_of({quad(5, 0, 0)}, {material("m", {"sqt", {}, {}, {{"file", "polished.sqt"}}, bundle})});
  const double zenith = 0.5, irradiance = 1000;
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(zenith, 0), kSun, Curve::constant(irradiance)});
  const Frame disk = Frame::around(sources.sun()->disk()->direction);
  double middle = 0;
  for (const double off : {0.0, 0.002, 0.005, 0.008}) {
    const Dir out = dir_from_angles(zenith + off, kPi);
    double expected = 0, area = 0;
    for (int r = 0; r < 400; ++r)
      for (int a = 0; a < 200; ++a) {
        const double rho = kSun * std::sqrt((r + 0.5) / 400);
        area += 1;
        expected += bundle->eval(out, disk.to_world(dir_from_angles(rho, 2 * kPi * (a + 0.5) / 200)), 0);
      }
    // The mean over the disk; its irradiance is seen at the disk's middle.
    expected *= irradiance / area;
    for (const bool explicit_sources : {true, false}) {
      PipelineOptions pipeline;
      pipeline.explicit_sources = explicit_sources;
      const auto run = render(
          scene, sources, std::make_unique<RaySensor>(std::vector<Ray>(16, Ray{out * 9.0, -out, 0}), one_band(), 1024),
          pipeline);
      double mean = 0, square = 0;
      for (size_t i = 0; i < 16; ++i)
        mean += run.result.radiance[i] / 16, square += std::pow(run.result.standard_error[i] / 16, 2);
      EXPECT_NEAR(mean, expected, 4.5 * std::sqrt(square) + 2e-3 * expected) << off << explicit_sources;
      EXPECT_LT(4.5 * std::sqrt(square), 0.05 * expected + 0.01 * middle) << off << ": 5 % would not be seen";
    }
    if (off == 0) {
      middle = expected;
      // The part of the lobe that the disk covers, 1 - exp(-(slope of its rim / width)^2) of half of the sun's
      // radiance; the finest cells are nearly as wide as the lobe and smooth it.
      const double covered = 1 - std::exp(-std::pow(kSun / 2 / kWidth, 2));
      EXPECT_NEAR(expected, 0.5 * covered * irradiance / (kPi * kSun * kSun), 0.12 * expected);
    }
  }
}

}  // namespace
}  // namespace suite::test::narrow_lobe_test
