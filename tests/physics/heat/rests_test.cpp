// Things that rest here, then there: their elements exchange, shade and are shaded where they stand, and what stood in
// their shade is another thing as soon as they have left.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "math/stats.h"
#include "support/heated_scene_kit.h"

namespace suite::rests_test {
namespace {

using namespace test;

constexpr TimeSpan kDay{0, 86400};
constexpr size_t kSteps = 144;

TrackPtr from_to(const Affine3& first, double leaves, double arrives, const Affine3& then) {
  const auto pose = [](const Affine3& a) { return Pose{quat_from_matrix(a), a.b}; };
  return keyframe_track({{0, pose(first)}, {leaves, pose(first)}, {arrives, pose(then)}, {86400, pose(then)}});
}

TemperatureSpec asphalt() {
  return heat(
      {{"thickness_m", 0.3}, {"density_kg_m3", 2240}, {"specific_heat_j_kg_k", 920}, {"conductivity_w_m_k", 1.2}});
}

HeatSpec spec_of(uint32_t paths) {
  HeatSpec spec;
  spec.span = kDay, spec.step = kDay.end / kSteps, spec.paths = paths;
  return spec;
}

// A black patch of asphalt, 0.5 m wide, 2 cm under a black car of 4 x 4 m that is held at 310 K, until it drives far
// away in two seconds around noon; sun and sky stay as they are.
constexpr double kLeaves = 43199, kArrives = 43201;
StillWeather still() {
  StillWeather w;
  w.direct = 500, w.diffuse = 80, w.longwave = 330;
  return w;
}
HeatResult under_a_car(double least, size_t budget = 2) {
  HeatedScene s;
  s.plane(0.5, 0.5, s.heated(1, asphalt()));
  s.plane(4, 4, s.heated(1, held_at(310)), upside_down({}));
  s.moves(from_to(shifted({0, 0, 0.02}), kLeaves, kArrives, shifted({3000, 0, 0.02})));
  const HeatKit kit(std::move(s), budget, kDay, {}, least);
  return kit.solve(still_loads(still(), kDay, kSteps), spec_of(256));
}

// The patch alone: what the car sends before noon, sun and sky after it; the moment of noon has half of both.
std::vector<double> joined_by_hand() {
  ExchangeMatrix matrix(1, 1);
  matrix.add_row(std::vector<ExchangeMatrix::Entry>{{1, 1}});
  SurfaceGroup ground;
  ground.layers = heated_material(asphalt()).layers;
  ground.front.emissivity = 1, ground.front_rows = {0};
  const StillWeather w = still();
  SurfaceLoads loads;
  loads.steps.assign(kSteps, kDay.end / kSteps);
  loads.air = {{0, kDay.end}, {300, 300}, {0, 0}, {0, 0}, true};
  std::vector<float> absorbed;
  for (size_t k = 0; k <= kSteps; ++k) {
    const double left = k < kSteps / 2 ? 0 : k == kSteps / 2 ? 0.5 : 1;
    absorbed.push_back(static_cast<float>(left * (w.direct + w.diffuse)));
    loads.outside.push_back((1 - left) * black(310) + left * w.longwave);
  }
  loads.absorbed = CompactRows(absorbed, absorbed.size());
  CoupledSurfaces surfaces({ground}, matrix);
  surfaces.start(300);
  SurfaceOptions options;
  options.past.tolerance = options.coupling.tolerance = 1e-3;
  return surfaces.solve(loads, options).kelvin.values();
}

double worst(const HeatResult& r, const std::vector<double>& hand) {
  double most = 0;
  for (size_t k = 0; k <= kSteps; ++k) most = std::fmax(most, std::fabs(double{r.kelvin[k]} - hand[k]));
  return most;
}

TEST(Rests, TheGroundUnderACarIsThatOfTwoDaysJoinedByHand) {
  const std::vector<double> hand = joined_by_hand();
  const HeatResult r = under_a_car(600);
  double error = 0;
  for (size_t p = 0; p < kHeatParts; ++p) error = std::fmax(error, double{r.path_error[p]});
  const double off = worst(r, hand);
  std::printf(
      "ground under a car: %.2f K before it leaves, %.2f K three hours later, by hand %.2f and %.2f; at most "
      "%.3f K apart, error by the paths %.3f K\n",
      double{r.kelvin[70]}, double{r.kelvin[90]}, hand[70], hand[90], off, error);
  EXPECT_GT(hand[90] - hand[70], 10);
  EXPECT_LT(off, 0.1 + 3 * error);
  // Negative control: without intervals the car has no elements and is as warm as the air, half of the day.
  EXPECT_GT(worst(under_a_car(0), hand), 2);
}

TEST(Rests, TheCarIsInTheExchangeWhereItStands) {
  const HeatResult r = under_a_car(600);
  // Its face looks down: on the patch, then on nothing but ground beyond the scene, as warm as the air.
  const auto received = [&](size_t k) { return double{r.received[1 * r.moments + k]}; };
  EXPECT_NEAR(received(100), black(300), 1);
  ASSERT_EQ(r.notes.empty(), false);
  bool told = false;
  for (const std::string& note : r.notes) told = told || note.find("'mover' moves (43199 to 43201 s)") != note.npos;
  EXPECT_TRUE(told);
}

// A panel that faces the sun overhead until noon, and is turned by 60 degrees within ten seconds.
TEST(Rests, APanelThatTurnsTakesTheSunByItsTilt) {
  HeatedScene s;
  s.plane(50, 50, s.heated(1, held_at(300)));
  s.plane(1, 1, s.heated(1, held_at(300)));
  const double c = 0.5, sine = std::sqrt(0.75);
  s.moves(from_to(shifted({0, 0, 8}), 43195, 43205, with_axes({1, 0, 0}, {0, c, sine}, {0, 0, 8})));
  const HeatKit kit(std::move(s), 2, kDay, {}, 600);
  ASSERT_EQ(kit.elements->rests().size(), 2u);
  StillWeather w;
  w.direct = 800, w.longwave = 300;
  HeatSpec spec = spec_of(64);
  spec.ground_albedo = 0;
  const HeatResult r = kit.solve(still_loads(w, kDay, kSteps), spec);
  size_t panel = 0;
  while ((*kit.elements)[panel].area > 2) ++panel;
  for (const size_t k : {size_t{10}, size_t{70}}) EXPECT_NEAR(double{r.absorbed[panel * r.moments + k]}, 800, 0.1) << k;
  for (const size_t k : {size_t{74}, size_t{140}})
    EXPECT_NEAR(double{r.absorbed[panel * r.moments + k]}, 400, 0.1) << k;
  EXPECT_NEAR(double{r.sun_hours[panel]}, 24, 0.01);
  // Infrared from above: all of the sky, then (1 + cos 60)/2 of it and else the ground (of 50 m, which is nearly all).
  const auto received = [&](size_t k) { return double{r.received[panel * r.moments + k]}; };
  EXPECT_NEAR(received(20), 300, 1);
  EXPECT_NEAR(received(120), 0.75 * 300 + 0.25 * black(300), 6);
}

// Random walks that look at the scene at their own times, and know neither elements nor intervals: ground below a plate
// of 350 K that is there by day, in the afternoon.
TEST(Rests, AnAuditSeesPlacesOfTheirTimes) {
  const auto too_warm = [](double least) {
    HeatedScene s;
    TemperatureSpec ground = asphalt();
    ground.numbers["thickness_m"] = 0.1, ground.texts["convection"] = "mcadams";
    s.plane(1, 1, s.heated(1, ground));
    s.plane(1, 1, s.heated(1, held_at(350)), upside_down({0, 0, 0.5}));
    s.there({21600, 64800});
    const HeatKit kit(std::move(s), 2, kDay, {}, least);
    StillWeather w;
    w.longwave = 200;
    HeatSpec spec = spec_of(4096);
    spec.audit = 8000;
    const HeatAudit audit = kit.solve(still_loads(w, kDay, kSteps), spec).audit.value();
    RunningStats off;
    for (const AuditProbe& probe : audit.probes)
      if (probe.face == 0 && probe.time > 43200 && probe.time < 64800) off.add(-(probe.more[0] + probe.more[1]) / 2);
    std::printf("afternoon's ground %s intervals: %+.2f +- %.2f K too warm\n", least > 0 ? "with" : "without",
                off.mean(), off.stderr_of_mean());
    return off;
  };
  const RunningStats with = too_warm(600), without = too_warm(0);
  EXPECT_LT(std::fabs(with.mean()), 3 * with.stderr_of_mean());  // significance 0.3 %
  EXPECT_LT(without.mean() + 3 * without.stderr_of_mean(), 0);   // negative control
  EXPECT_LT(without.mean() + 3, with.mean());
}

TEST(Rests, BitsAreTheSameForAnyNumberOfThreads) {
  std::vector<float> found[2];
  for (const int n : {1, 4}) {
    set_threads(n);
    found[n == 1 ? 0 : 1] = under_a_car(600, 40).kelvin;
  }
  set_threads(0);
  EXPECT_EQ(found[0], found[1]);
}

// What never rests as long as a step has no elements, and gives no intervals.
TEST(Rests, ShortStopsAreNoRests) {
  for (const double stop : {300.0, 3000.0}) {
    HeatedScene s;
    s.plane(5, 5, s.heated(1, held_at(300)));
    s.plane(1, 1, s.heated(1, held_at(300)));
    const Pose a{{}, {0, 0, 3}}, b{{}, {10, 0, 3}}, c{{}, {20, 0, 3}};
    s.moves(keyframe_track({{0, a}, {40000, b}, {40000 + stop, b}, {86400, c}}));
    const HeatKit kit(std::move(s), 2, kDay, {}, 600);
    EXPECT_EQ(kit.elements->rests().size(), stop < 600 ? 0u : 3u) << stop;
    EXPECT_EQ(kit.elements->moving(), stop < 600 ? 1u : 0u) << stop;
    EXPECT_EQ(kit.elements->resting(), stop < 600 ? 0u : 1u) << stop;
  }
}

TEST(Rests, SharesOfMomentsKeepIntegrals) {
  const std::vector<RestInterval> rests{
      {{0, 1300}, {0, 1300}}, {{1300, 1500}, {1300, 1500}}, {{1500, 6000}, {1500, 6000}}};
  const std::vector<double> moments = evenly({0, 6000}, 10);
  const auto shares = interval_shares(rests, moments);
  for (size_t k = 0; k < rests.size(); ++k) {
    double length = 0;
    for (size_t m = 0; m < moments.size(); ++m) length += double{shares[k][m]} * (m == 0 || m == 10 ? 300 : 600);
    EXPECT_NEAR(length, rests[k].span.end - rests[k].span.begin, 1e-3) << k;
  }
  for (size_t m = 0; m < moments.size(); ++m) EXPECT_NEAR(shares[0][m] + shares[1][m] + shares[2][m], 1, 1e-6);
}

}  // namespace
}  // namespace suite::rests_test
