// A fitted quad-tree is asked beyond its wavelengths.
#include "optics/stored_range.h"

#include <gtest/gtest.h>

#include "optics/models.h"
#include "optics/phase_function.h"
#include "support/sqt_examples.h"

namespace suite::stored_range_test {
namespace {

ModelSpec fitted(std::vector<double> um, const std::string& rule) {
  test::Analytic function = test::glossy(0.4, um.size());
  function.info().wavelength_um = std::move(um);
  ModelSpec spec{"sqt", {}, {}, {{"file", "gloss.sqt"}}, sqt::make_bundle(test::small_fit(function).data)};
  if (!rule.empty()) spec.texts["outside"] = rule;
  check_model(spec);
  return spec;
}
std::unique_ptr<const ScatterModel> seen(const ModelSpec& spec, double center_um) {
  return bake(spec, make_state(std::vector<Band>{Band::rectangular("b", center_um, 0.01)}, 0.01));
}
float total(const ScatterModel& model) {
  std::vector<float> W(1);
  model.total({0, 0, 1}, W);
  return W[0];
}

TEST(StoredRange, ReachesHalfASpacingBeyondTheOutermostChannels) {
  const StoredRange three = stored_range(fitted({0.65, 0.55, 0.43}, ""));
  EXPECT_NEAR(three.low_um, 0.37, 1e-12);
  EXPECT_NEAR(three.high_um, 0.70, 1e-12);
  const StoredRange alone = stored_range(fitted({0.55}, ""));
  EXPECT_NEAR(alone.low_um, 0.5225, 1e-12);
  EXPECT_NEAR(alone.high_um, 0.5775, 1e-12);
}

TEST(StoredRange, NothingIsHeldUnasked) {
  // Regression: data in three colours held their last channel from 0.3 to 10 um without a word.
  for (const char* rule : {"", "error"}) {
    const ModelSpec spec = fitted({0.65, 0.55, 0.45}, rule);
    EXPECT_NO_THROW(seen(spec, 0.69));
    EXPECT_NO_THROW(seen(spec, 0.41));
    for (const double um : {0.39, 0.71, 2.2, 10.0}) EXPECT_THROW(seen(spec, um), Error) << um;
  }
  EXPECT_THROW(stored_range(fitted({0.65, 0.55}, "clamp")), Error);
}

TEST(StoredRange, WhatIsDeclaredHolds) {
  const std::vector<double> um{0.65, 0.55, 0.45};
  const float red = total(*seen(fitted(um, "hold"), 0.65));
  EXPECT_GT(red, 0.01f);
  EXPECT_EQ(total(*seen(fitted(um, "hold"), 2.2)), red);
  EXPECT_EQ(total(*seen(fitted(um, "zero"), 2.2)), 0);
  EXPECT_EQ(total(*seen(fitted(um, "zero"), 0.65)), red);
}

TEST(StoredRange, PhaseFunctionsLikewise) {
  test::Analytic haze([](Dir out, Dir in) { return test::henyey_greenstein(-dot(out, in), 0.5); }, 1,
                      sqt::Domain::sphere, sqt::Quantity::phase);
  haze.info().wavelength_um = {0.55};
  ModelSpec spec{"sqt", {}, {}, {{"file", "haze.sqt"}}, sqt::make_bundle(test::small_fit(haze).data)};
  const auto at = [&](double um) {
    return bake_phase(spec, make_state(std::vector<Band>{Band::rectangular("b", um, 0.01)}, 0.01));
  };
  EXPECT_NO_THROW(at(0.56));
  EXPECT_THROW(at(0.7), Error);
  spec.texts["outside"] = "hold";
  EXPECT_NO_THROW(at(0.7));
  spec.texts["outside"] = "zero";
  EXPECT_THROW(at(0.7), Error);
}

}  // namespace
}  // namespace suite::stored_range_test
