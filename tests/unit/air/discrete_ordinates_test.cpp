// What the solver refuses, and that one solver may serve many problems.
#include "air/discrete_ordinates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/message_of.h"

namespace suite::discrete_ordinates_test {
namespace {

using testing::HasSubstr;

const std::vector<double> kForward{1, 0.6, 0.3};

// One layer and a sun; `change` spoils them.
template <class Change>
std::string refusal(const Change& change) {
  std::vector<DiffuseLayer> layers{{.depth = 0.1, .albedo = 0.5, .moments = kForward},
                                   {.depth = 0.1, .albedo = 0.5, .moments = kForward}};
  DiffuseProblem problem;
  problem.beam.irradiance = 1;
  problem.beam.cosine = 0.5;
  problem.layers = layers;
  change(problem, layers[1]);
  return message_of([&] { DiscreteOrdinates(4).solve(problem); });
}

TEST(DiscreteOrdinates, RefusesWhatIsOutOfRange) {
  EXPECT_EQ(refusal([](DiffuseProblem&, DiffuseLayer&) {}), "no error");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.1, 2e9, nan})
    EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.depth = bad; }),
                HasSubstr("layer 1 of the air: its depth is out of range"));
  for (const double bad : {-1e-8, 1 + 1e-8, nan})  // 1e-9 is rounding (math/share.h)
    EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.albedo = bad; }), HasSubstr("its albedo"));
  EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.planck_top = nan; }), HasSubstr("emission"));
  for (const double bad : {nan, -2000.0}) {
    const double secants[2] = {1, bad};
    EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.beam.secants = secants; }),
                HasSubstr("layer 1 of the air: its secant"));
  }
  const double tops[2] = {-1, 1.5};
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.beam.tops = tops; }), HasSubstr("transmittance"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.beam.cosine = -0.1; }), HasSubstr("without secants"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.beam.cosine = 1.1; }), HasSubstr("cosine"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.beam.irradiance = -1; }), HasSubstr("beam"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.top_radiance = -1; }), HasSubstr("above"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.ground_albedo = 1.01; }), HasSubstr("albedo 1.01"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.ground_emission = -1; }), HasSubstr("emission"));
  EXPECT_THAT(refusal([&](DiffuseProblem& p, DiffuseLayer&) { p.layers = {}; }), HasSubstr("without layers"));
  for (const int streams : {2, 5, 66})
    EXPECT_THAT(message_of([&] { DiscreteOrdinates{streams}; }), HasSubstr("streams"));
}

TEST(DiscreteOrdinates, RefusesMomentsOfNoPhaseFunction) {
  const std::vector<double> not_one{0.9}, large{1, 1.2}, needle{1, 1, 1, 0.99};
  EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.moments = not_one; }), HasSubstr("chi_0 = 1"));
  EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.moments = large; }), HasSubstr("a moment"));
  // All forward, but with an end: negative light elsewhere.
  EXPECT_THAT(refusal([&](DiffuseProblem&, DiffuseLayer& l) { l.albedo = 1, l.moments = needle; }),
              HasSubstr("layer 1 of the air: its moments are of no phase function"));
}

TEST(DiscreteOrdinates, RefusesPlacesAndDirectionsThatAreNone) {
  const std::vector<DiffuseLayer> layers(1);
  DiscreteOrdinates solver(4);
  DiffuseProblem problem;
  problem.layers = layers;
  solver.solve(problem);
  for (const DiffusePlace place : {DiffusePlace{-1, 0}, {1, 0}, {0, 1.1}, {0, -0.1}}) {
    EXPECT_THAT(message_of([&] { solver.fluxes(place); }), HasSubstr("air with 1 layers"));
    EXPECT_THAT(message_of([&] { solver.source(place, 0, 0); }), HasSubstr("air with 1 layers"));
    EXPECT_THAT(message_of([&] { solver.radiance(place, 1, 0, {}); }), HasSubstr("air with 1 layers"));
  }
  for (const double mu : {0.0, 1e-9, 1.1})
    EXPECT_THAT(message_of([&] { solver.radiance({0, 0}, mu, 0, {}); }), HasSubstr("a direction of cosine"));
  EXPECT_THAT(message_of([&] { solver.source({0, 0}, -1.1, 0); }), HasSubstr("a direction of cosine -1.1"));
  const double beyond[2] = {1, 1.1};
  EXPECT_THAT(message_of([&] { SourceAngles(4, beyond); }), HasSubstr("a direction of cosine 1.1"));
  EXPECT_THAT(message_of([&] { solver.set_ground(-0.1, 0); }), HasSubstr("albedo"));
}

// Nothing of an earlier problem with more layers, orders and light stays behind.
TEST(DiscreteOrdinates, ForgetsTheLastProblem) {
  const std::vector<DiffuseLayer> bright(5, {.depth = 1, .albedo = 0.9, .moments = kForward, .planck_top = 3}),
      dim(2, {.depth = 0.3, .albedo = 0.4, .moments = kForward});
  DiffuseProblem first, second;
  first.layers = bright;
  first.beam.irradiance = 3;
  first.beam.cosine = 0.3;
  first.ground_albedo = 1;
  second.layers = dim;
  second.top_radiance = 1;
  DiscreteOrdinates used(8), fresh(8);
  used.solve(first);
  EXPECT_EQ(used.orders(), 3);
  used.solve(second);
  fresh.solve(second);
  EXPECT_EQ(used.orders(), 1);
  EXPECT_EQ(used.layers(), 2);
  EXPECT_EQ(used.fluxes({1, 0.5}).up, fresh.fluxes({1, 0.5}).up);
  EXPECT_EQ(used.radiance({1, 0.5}, -0.3, 2, {}), fresh.radiance({1, 0.5}, -0.3, 2, {}));
  EXPECT_EQ(used.source({1, 0.5}, -0.3, 2), fresh.source({1, 0.5}, -0.3, 2));
}

TEST(DiscreteOrdinates, EndsOrdersWhenTheyNoLongerCount) {
  std::vector<double> chi;
  for (int l = 0; l < 40; ++l) chi.push_back(std::pow(0.7, l));
  const DiffuseLayer layer{.depth = 0.5, .albedo = 0.9, .moments = chi};
  DiffuseProblem problem;
  problem.layers = {&layer, 1};
  problem.beam.irradiance = 1;
  problem.beam.cosine = 0.9;
  DiscreteOrdinates all(32), some(32);
  problem.azimuth_tolerance = 0;
  all.solve(problem);
  problem.azimuth_tolerance = 1e-3;
  some.solve(problem);
  EXPECT_EQ(all.orders(), 32);
  EXPECT_LT(some.orders(), 20);
  EXPECT_NEAR(some.source({0, 0.5}, 0.3, 0), all.source({0, 0.5}, 0.3, 0), 2e-3 * all.source({0, 0.5}, 0.3, 0));
  EXPECT_NE(some.source({0, 0.5}, 0.3, 0), all.source({0, 0.5}, 0.3, 0));
}

}  // namespace
}  // namespace suite::discrete_ordinates_test
