#include "correction/lut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace suite::lut_test {
namespace {

using ::testing::HasSubstr;

AirSpec summer() {
  AirSpec air;
  air.profile = standard_profile("midlatitude_summer");
  air.gases = shared_builtin_gases();
  air.aerosol.emplace();
  air.streams = 8;
  return air;
}

std::vector<double>& values(LutAxes& axes, LutAxisOf axis) { return axes[static_cast<size_t>(axis)].values; }

LutAxes axes(std::vector<double> suns) {
  LutAxes a = lut_axes();
  values(a, LutAxisOf::sun_zenith) = std::move(suns);
  return a;
}

const std::vector<Band> kBands{Band::gaussian("red", 0.65, 0.01), Band::gaussian("water", 0.94, 0.01),
                               Band::gaussian("blue", 0.45, 0.01)};

std::string message(const AirSpec& air, const LutAxes& a) {
  try {
    make_lut(air, kBands, a);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Lut, AxesAreCompletedAndChecked) {
  LutAxes a = axes({30});
  const LutTable table = make_lut(summer(), kBands, a);
  EXPECT_EQ(table.states(), 1u);
  EXPECT_EQ(table.views(), 1u);
  EXPECT_EQ(table.bands[0].name, "blue");          // by wavelength
  EXPECT_NEAR(table.axes[0].values[0], 2.9, 0.1);  // AFGL: 2.92 g/cm2
  EXPECT_THAT(message(summer(), lut_axes()), HasSubstr("solar_zenith"));
  values(a, LutAxisOf::water) = {1, 0.5};
  EXPECT_THAT(message(summer(), a), HasSubstr("H2OSTR has 0.5 after 1"));
  values(a, LutAxisOf::water) = {30};
  EXPECT_THAT(message(summer(), a), HasSubstr("from 0.001 to 20 g/cm2"));
  a = axes({30});
  values(a, LutAxisOf::height) = {1}, values(a, LutAxisOf::elevation) = {0, 2};
  EXPECT_THAT(message(summer(), a), HasSubstr("is not above the ground at surface_elevation_km 2"));
  a = axes({30});
  values(a, LutAxisOf::water) = {1, 12}, values(a, LutAxisOf::elevation) = {0, 4};
  EXPECT_THAT(message(summer(), a), HasSubstr("no air has H2OSTR 12, "));
  EXPECT_THAT(message(summer(), a), HasSubstr("its gases sum to"));
  AirSpec clean = summer();
  clean.aerosol.reset();
  a = axes({30});
  values(a, LutAxisOf::aerosol) = {0.1};
  EXPECT_THAT(message(clean, a), HasSubstr("without aerosol"));
}

TEST(Lut, ColumnsOfAStateAreThoseAboveItsGround) {
  LutAxes a = axes({30});
  values(a, LutAxisOf::water) = {0.5, 2}, values(a, LutAxisOf::elevation) = {0, 2.5};
  values(a, LutAxisOf::aerosol) = {0.1, 0.3};
  const LutTable table = make_lut(summer(), kBands, a);
  ASSERT_EQ(table.states(), 8u);
  EXPECT_EQ(table.name_of(7).substr(0, 24), "H2OSTR 2, AOT550 0.3, O3");
  const AirSpec air = air_of_state(summer(), table, 7);
  EXPECT_NEAR(precipitable_water(air.profile), 20, 1e-9);
  EXPECT_NEAR(air.profile.levels[0].height, 2500, 1e-9);
  EXPECT_NEAR(air.aerosol->profile.depth(), 0.3, 1e-9);
  EXPECT_EQ(air.height_of_ground(), 2500);
}

TEST(Lut, MoreOfAnythingLetsLessThrough) {
  LutAxes a = axes({30, 60});
  values(a, LutAxisOf::water) = {0.5, 4}, values(a, LutAxisOf::aerosol) = {0.02, 0.5};
  const LutTable table = make_lut(summer(), kBands, a);
  const LutFineness coarse{0, 8, 4};
  std::vector<LutState> states;
  for (size_t k = 0; k < table.states(); ++k) states.push_back(lut_state(summer(), table, k, coarse));
  const auto of = [&](size_t water, size_t haze, size_t sun, LutKey key, size_t band) {
    return states[2 * water + haze][sun][static_cast<size_t>(key)][band];
  };
  constexpr size_t kBlue = 0, kRed = 1, kWater = 2;
  const LutKey both = LutKey::direct_direct;
  EXPECT_LT(of(1, 0, 0, both, kWater), 0.7 * of(0, 0, 0, both, kWater));
  EXPECT_NEAR(of(1, 0, 0, both, kBlue) / of(0, 0, 0, both, kBlue), 1, 0.01);  // the control: no water there
  EXPECT_LT(of(0, 1, 0, both, kRed), 0.6 * of(0, 0, 0, both, kRed));
  EXPECT_GT(of(0, 1, 0, LutKey::path_reflectance, kRed), 2 * of(0, 0, 0, LutKey::path_reflectance, kRed));
  EXPECT_LT(of(0, 0, 1, LutKey::down_direct, kBlue), of(0, 0, 0, LutKey::down_direct, kBlue));
  EXPECT_EQ(of(0, 0, 1, LutKey::up_direct, kWater), of(0, 0, 0, LutKey::up_direct, kWater));
  // In a band of lines the product of means is less than the mean of products.
  const double down = of(1, 0, 0, LutKey::down_direct, kWater), up = of(1, 0, 0, LutKey::up_direct, kWater);
  EXPECT_GT(of(1, 0, 0, both, kWater), 1.02 * down * up);
  EXPECT_LE(lut_difference(states[0], states[0])[0][kRed], 0);
  EXPECT_GT(lut_difference(states[0], states[1])[0][kRed], 0.01);
}

}  // namespace
}  // namespace suite::lut_test
