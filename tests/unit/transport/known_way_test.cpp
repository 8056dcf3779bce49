// The air on sensors' rays that hardly differ: right in the mean, seldom found, and exact where rays do differ.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "light/stratified_air.h"
#include "transport/known_way.h"

namespace suite::known_way_test {
namespace {

SpectralState some_bins() {
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("infrared", 0.86, 0.01)};
  return make_state(bands, 1);
}

// Hazy air under a sun, of which it is counted how often it is asked. opaque: one bin more lets nothing through.
class CountedAir final : public Atmosphere {
 public:
  explicit CountedAir(bool opaque = false) : state_(some_bins()), sun_(state_.size(), 1), opaque_(opaque) {
    AirSpec spec;
    spec.profile = standard_profile("us_standard");
    spec.aerosol = AirSpec::Aerosol{};
    spec.scattering = AirScattering::single;
    air_ = make_stratified_air(spec, state_, {{sun(), sun_.data()}});
  }
  static Dir sun() { return dir_from_angles(40 * kDegree, 0.3); }
  size_t bins() const { return state_.size() + (opaque_ ? 1 : 0); }
  size_t asked() const { return asked_; }

  void path(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S) const override {
    ++asked_;
    air_->path(from, d, distance, T.first(state_.size()), S.first(state_.size()));
    if (opaque_) T.back() = static_cast<float>(std::exp(-0.05 * distance)), S.back() = 1 - T.back();
  }
  double steepness(Dir d) const override { return air_->steepness(d); }
  void transmittance(Vec3, Dir, double, std::span<float>) const override {}
  const Shells& shells() const override { return air_->shells(); }
  std::span<const float> extinction(size_t layer) const override { return air_->extinction(layer); }
  void source(size_t, Vec3, Dir, std::span<float>) const override {}
  size_t beams() const override { return 1; }
  void beam(size_t, size_t, Vec3, Dir, BeamAlong) const override {}

 private:
  SpectralState state_;
  std::vector<float> sun_;
  std::unique_ptr<const Atmosphere> air_;
  bool opaque_;
  mutable size_t asked_ = 0;
};

struct Way {
  Vec3 from;
  Dir d;
  double length;
};
// Of a pixel 1 mrad wide that looks from a height at even ground; zenith angle of its middle.
std::vector<Way> pixel(size_t count, double height, double zenith_deg) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-5e-4, 5e-4);
  std::vector<Way> ways(count);
  for (Way& w : ways) {
    w.from = {0, 0, height};
    w.d = dir_from_angles(zenith_deg * kDegree + within(random), 1 + within(random));
    w.length = w.d.z < 0 ? -height / w.d.z : std::numeric_limits<double>::infinity();
  }
  return ways;
}

// Sums over ways of what KnownWay says and of what is true, per bin: T, then S.
struct Sums {
  explicit Sums(const CountedAir& air)
      : told(2 * air.bins()), squares(2 * air.bins()), truth(2 * air.bins()), first(2 * air.bins()) {}
  std::vector<double> told, squares, truth, first;  // squares: of told - true
  float least = 1;
};
Sums sums_over(const CountedAir& air, const CountedAir& exact, const std::vector<Way>& ways) {
  const size_t n = air.bins();
  KnownWay known(n);
  Sums sums(air);
  std::vector<float> told(2 * n), truth(2 * n);
  for (size_t k = 0; k < ways.size(); ++k) {
    const auto& [from, d, length] = ways[k];
    known.path(air, from, d, length, std::span(told).first(n), std::span(told).last(n));
    exact.path(from, d, length, std::span(truth).first(n), std::span(truth).last(n));
    for (size_t i = 0; i < 2 * n; ++i) {
      sums.told[i] += told[i], sums.truth[i] += truth[i];
      if (k == 0) sums.first[i] = truth[i];
      const double off = double{told[i]} - double{truth[i]};
      sums.squares[i] += off * off;
      if (i < n) sums.least = std::min(sums.least, told[i]);
    }
  }
  return sums;
}

constexpr double kSigma = 4.5;  // 7e-6 a number, two-sided; some 40 are looked at

struct View {
  double height, zenith_deg;  // m
  double most_asked;          // of its ways, share
};
class APixel : public ::testing::TestWithParam<View> {};

TEST_P(APixel, IsRightInTheMean) {
  constexpr size_t kWays = 20000;
  const CountedAir air, exact;
  const Sums sums = sums_over(air, exact, pixel(kWays, GetParam().height, GetParam().zenith_deg));
  EXPECT_LT(static_cast<double>(air.asked()), GetParam().most_asked * kWays);
  bool first_is_not_the_mean = false;
  for (size_t i = 0; i < sums.told.size(); ++i) {
    const double error = std::sqrt(sums.squares[i]);
    EXPECT_NEAR(sums.told[i], sums.truth[i], kSigma * error + 1e-6 * sums.truth[i]) << i;
    EXPECT_LT(error / std::sqrt(kWays), 0.03 * sums.truth[i] / kWays) << i;  // noise of one, over itself
    first_is_not_the_mean |= std::fabs(kWays * sums.first[i] - sums.truth[i]) > kSigma * error + 1e-6 * sums.truth[i];
  }
  EXPECT_TRUE(first_is_not_the_mean);  // were the first way to count for all, it would be seen
}
// Down slantly a pixel's ways differ in length by much.
INSTANTIATE_TEST_SUITE_P(Views, APixel,
                         ::testing::Values(View{70, 130, 0.14}, View{3000, 170, 0.14}, View{3000, 110, 0.6},
                                           View{3000, 60, 0.14}));

TEST(KnownWay, IsExactWhereWaysDiffer) {
  const CountedAir air;
  KnownWay known(air.bins());
  std::vector<float> T(air.bins()), S(air.bins()), t(air.bins()), s(air.bins());
  const auto expect_exact = [&](Vec3 from, Dir d, double length) {
    known.path(air, from, d, length, T, S);
    air.path(from, d, length, t, s);
    EXPECT_EQ(T, t);
    EXPECT_EQ(S, s);
  };
  const Dir down = dir_from_angles(130 * kDegree, 1), level = dir_from_angles(90 * kDegree, 1);
  const double infinity = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 20; ++repeat) {
    expect_exact({0, 0, 100}, down, 150);
    expect_exact({0, 0, 100}, down, 1500);                                 // it meets something further off
    expect_exact({0, 0, 100}, dir_from_angles(130 * kDegree, 1.01), 150);  // beside
    expect_exact({0, 0, 900}, down, 150);                                  // from elsewhere
    expect_exact({0, 0, 900}, level, infinity);                            // where the air changes at once
    expect_exact({0, 0, 100}, dir_from_angles(130 * kDegree, 1.01), infinity);
    expect_exact({0, 0, 100}, CountedAir::sun(), infinity);  // into the aureole
  }
}

TEST(KnownWay, ForgetsWhenAWaveBegins) {
  const CountedAir air;
  KnownWay known(air.bins());
  std::vector<float> T(air.bins()), S(air.bins());
  for (int wave = 0; wave < 30; ++wave) {
    known.forget();
    const size_t before = air.asked();
    known.path(air, {0, 0, 100}, dir_from_angles(130 * kDegree, 1 + 1e-7 * wave), 150, T, S);
    EXPECT_EQ(air.asked(), before + 1);
  }
}

// Where a bin is all but opaque, ways that differ by little differ by much in it: T stays a transmittance.
TEST(KnownWay, LetsNoLightThroughBeBelowNothing) {
  constexpr size_t kWays = 20000;
  const CountedAir air(true), exact(true);
  const Sums sums = sums_over(air, exact, pixel(kWays, 300, 130));
  EXPECT_LT(air.asked(), kWays);
  EXPECT_GE(sums.least, 0);
  for (size_t i = 0; i < sums.told.size(); ++i)
    EXPECT_NEAR(sums.told[i], sums.truth[i], kSigma * std::sqrt(sums.squares[i]) + 1e-6 * sums.truth[i]) << i;
}

}  // namespace
}  // namespace suite::known_way_test
