// Convergence criteria of single problems, chips and bands, from the sensor through the scheduler to the paths that
// run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/message_of.h"
#include "support/platform_kit.h"

namespace suite::goals_test {
namespace {

using test::PlatformKit;
using testing::HasSubstr;

// Noisy everywhere: a floor beside a wall under a uniform sky.
std::shared_ptr<Scene> corner() {
  return test::scene_of({test::quad(40, 0, 0), test::box({-20, 1, 0}, {20, 2, 30}, 0, true)},
                        {test::material("grey", test::lambert(0.5))});
}
SourceSpecs sky() {
  SourceSpecs s;
  s.add(test::uniform_sky(1, false));
  return s;
}

// Looks straight down at places that are alike; problem i may take goals[i].
class Picky final : public test::RaySensor {
 public:
  explicit Picky(std::vector<Convergence> goals)
      : RaySensor(std::vector<Ray>(goals.size(), Ray{{0, 0, 10}, {0, 0, -1}, 0}), test::one_band(), 8),
        goals_(std::move(goals)),
        own_(RaySensor::tasks().begin(), RaySensor::tasks().end()) {
    own_[0].captures[0].own_convergence = true;
  }
  std::span<const Task> tasks() const override { return own_; }
  Convergence convergence(const Capture&, size_t problem) const override { return goals_[problem]; }

 private:
  std::vector<Convergence> goals_;
  std::vector<Task> own_;
};

CaptureResult run(std::vector<Convergence> goals, const Budget& budget = {}) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  auto sensor = std::make_unique<Picky>(std::move(goals));
  Picky* raw = sensor.get();
  sensors.push_back(std::move(sensor));
  JobOptions job;
  job.progress = false;
  job.budget = budget;
  run_job(corner(), sky(), sensors, job);
  return std::move(raw->result);
}

TEST(Goals, ProblemsOfACaptureTakeTheirOwnCounts) {
  EXPECT_EQ(run({{16, 16}, {64, 64}, {300, 300}}).paths, (std::vector<uint32_t>{16, 64, 300}));
}

TEST(Goals, ProblemsReachTheirOwnTargets) {
  const CaptureResult r = run({{64, 1u << 16, 0.02}, {64, 1u << 16, 0.004}, {12, 12}});
  EXPECT_EQ(r.paths[2], 12u);
  // Planned for targets that differ by five: about 25 times the paths. A pilot of 64 knows its variance to a third.
  EXPECT_GT(r.paths[1], 8 * r.paths[0]);
  EXPECT_LT(r.paths[1], 75 * r.paths[0]);
  EXPECT_LT(r.standard_error[0] / r.radiance[0], 0.03);
  EXPECT_LT(r.standard_error[1] / r.radiance[1], 0.006);
}

TEST(Goals, ABudgetHoldsForEachProblem) {
  Budget b;
  b.max_paths = 32;
  EXPECT_EQ(run({{16, 16}, {64, 64}, {16, 300, 0.0001}}, b).paths, (std::vector<uint32_t>{32, 32, 32}));
}

TEST(Goals, ATimeBudgetReplacesTheCountsOfEach) {
  Budget b;
  b.seconds = 1e-6;  // nothing is left after the pilot
  EXPECT_EQ(run({{16, 16}, {640, 640}}, b).paths, (std::vector<uint32_t>{32, 32}));
}

TEST(Goals, ImpossibleOnesAreRefused) {
  EXPECT_THAT(message_of([] { run({{16, 16}, {0, 4}}); }), HasSubstr("0 to 4 paths"));
  EXPECT_THAT(message_of([] { run({{16, 8}}); }), HasSubstr("16 to 8 paths"));
  EXPECT_THAT(message_of([] { run({{16, 16, NAN}}); }), HasSubstr("no negative target"));
}

std::string camera(const std::string& paths, const std::string& chips = "columns: 12") {
  return "kind: platform\nmotion: {kind: straight, position_m: [0, 0, 10], heading_deg: 0, speed_m_s: 0}\ntasks: "
         "[{start: 0}]\ntruth: []\ninstruments:\n  - focal_length_mm: 50\n    arrays:\n      - pitch_um: 5\n        "
         "rows: 8\n        " +
         chips + "\n        paths: " + paths +
         "\n        bands: [{name: a, center_um: 0.6, fwhm_um: 0.02}, {name: b, center_um: 0.8, fwhm_um: 0.02}]\n";
}
double mean_paths(const std::string& yaml) {
  PlatformKit kit;
  kit.render(corner(), sky(), yaml);
  double sum = 0;
  for (const uint32_t n : kit.shots.at(0).result.paths) sum += n;
  return sum / static_cast<double>(kit.shots[0].result.problems());
}

// The bands of a grey scene are equally noisy, so that counts tell which target was followed.
TEST(Goals, BandsHaveTargetsOfTheirOwn) {
  const double strict = mean_paths(camera("{min: 32, max: 65536, relative_error: 0.005}")),
               loose = mean_paths(camera("{min: 32, max: 65536, bands: {a: 0.02}}")),
               both = mean_paths(camera("{min: 32, max: 65536, bands: {a: 0.02, b: 0.005}}"));
  std::printf("paths a pixel: %.0f at 0.5 %%, %.0f with 2 %% in a, %.0f with 0.5 %% in b besides\n", strict, loose,
              both);
  EXPECT_NEAR(both / strict, 1, 0.01);
  EXPECT_GT(strict, 8 * loose);
}

TEST(Goals, ChipsHavePathsOfTheirOwn) {
  PlatformKit kit;
  kit.render(corner(), sky(),
             camera("16", "chips: [{columns: 3, offset_mm: [-1, 0]}, {columns: 2, offset_mm: [1, 0], paths: 64}]"));
  const CaptureResult& r = kit.shots.at(0).result;
  for (uint32_t row = 0; row < 8; ++row)
    for (uint32_t c = 0; c < 5; ++c) EXPECT_EQ(r.paths[row * 5 + c], c < 3 ? 16u : 64u);
}

TEST(Goals, TargetsOfBandsAreChecked) {
  auto message = [](const std::string& paths) { return message_of([&] { PlatformKit().make(camera(paths)); }); };
  EXPECT_THAT(message("{bands: {c: 0.1}}"), testing::AllOf(HasSubstr("sensor.yaml:11:"), HasSubstr("no band 'c'")));
  EXPECT_THAT(message("{bands: {a: -0.1}}"), HasSubstr("sensor.yaml:11:"));
  EXPECT_THAT(message("{bands: {a: 0.1}, relative_error: 0.1}"), HasSubstr("targets for bands already"));
  EXPECT_THAT(message("{bands: [a]}"), HasSubstr("names with relative errors"));
}

// Q and U of a grey floor under an even sky are 0 without noise, so that only radiance has something to reach.
TEST(Goals, TheDegreeOfPolarisationHasATarget) {
  const auto stokes = [](const std::string& paths) { return "stokes: linear\n" + camera(paths); };
  EXPECT_EQ(mean_paths(stokes("{min: 32, max: 65536, dolp_error: 0.005}")), 32);
  const double alone = mean_paths(stokes("{min: 32, max: 65536, relative_error: 0.005}")),
               both = mean_paths(stokes("{min: 32, max: 65536, relative_error: 0.005, dolp_error: 0.001}")),
               band = mean_paths(stokes("{min: 32, max: 65536, bands: {a: 0.005}, dolp_error: 0.001}"));
  EXPECT_EQ(both, alone);
  EXPECT_NEAR(band / alone, 1, 0.05);
}

TEST(Goals, TargetsOfTheDegreeAreChecked) {
  auto message = [](const std::string& text) { return message_of([&] { PlatformKit().make(text); }); };
  EXPECT_THAT(message(camera("{dolp_error: 0.005}")), HasSubstr("does not see Q and U"));
  EXPECT_THAT(message("stokes: linear\n" + camera("{dolp_error: 0}")), HasSubstr("degree of linear polarisation"));
  EXPECT_THAT(message("stokes: linear\n" + camera("{dolp_error: 0.01}",
                                                  "columns: 12\n        time_bins: 2\n        "
                                                  "readout: {kind: global}")),
              HasSubstr("time_bins"));
  EXPECT_THAT(message("stokes: linear\n" +
                      camera("16",
                             "chips: [{columns: 3, offset_mm: [-1, 0]}, {columns: 2, offset_mm: [1, 0], paths: "
                             "{dolp_error: 0.01}}]")),
              HasSubstr("holds for all chips"));
}

}  // namespace
}  // namespace suite::goals_test
