// What quality_heavy_tail promises, measured: of the problems whose true error exceeds kTailFactor times the reported
// standard error by more than kTailShare of the radiance, how many are flagged where rare events carry the light; how
// many are flagged without that in quiet scenes; and whether the others keep to Student's distribution. The truth is a
// closed form or a long run with another seed. Negative controls: the rule by ratios of variances that came before,
// which flags much of a picture without noise, and standard errors that are too small.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "light/kinds/sun.h"
#include "math/stats.h"
#include "sensor/quality.h"
#include "tests/support/area_kit.h"

namespace suite::test::tail_flags_test {
namespace {

constexpr uint32_t kPaths = 64;

SourceSpecs sun_and_sky(double half_angle) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(0.7, 1), half_angle, Curve::constant(50)});
  s.add(uniform_sky(10, false));
  return s;
}
SourceSpecs full_sky() {
  SourceSpecs s;
  s.add(uniform_sky(10, true));
  return s;
}

// Tiles of five reflectances, 5.3 m wide and askew to the problems: flat, so nothing but their edges is noisy.
std::shared_ptr<Scene> tiles() {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  for (uint32_t m = 0; m < 5; ++m) materials.push_back(material("tile " + std::to_string(m), lambert(0.02 + 0.2 * m)));
  const double c = std::cos(0.2), s = std::sin(0.2), w = 5.3;
  for (int j = -2; j < 14; ++j)
    for (int i = -4; i < 14; ++i) {
      auto corner = [&](int a, int b) { return Vec3{w * (c * a - s * b), w * (s * a + c * b), 0}; };
      meshes.push_back(mesh_of({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)},
                               {0, 1, 2, 0, 2, 3}, static_cast<uint32_t>((i + 2 * j + 20) % 5)));
    }
  return scene_of(std::move(meshes), std::move(materials));
}

struct Case {
  std::string name;
  std::shared_ptr<Scene> scene;
  SourceSpecs sources;
  bool from_below = false;
  double truth = NAN;  // of every problem; NaN: a long run
};

CaptureResult run(const Case& c, uint32_t paths, uint64_t seed, bool neighbours = true) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<AreaSensor>(c.from_below ? -5 : 20, Dir{0, 0, c.from_below ? 1.0 : -1.0}, kEdge,
                                                 Convergence{paths, paths, 0, 0}, neighbours));
  JobOptions job;
  job.progress = false;
  job.pipeline.seed = seed;
  run_job(c.scene, c.sources, sensors, job);
  return std::move(static_cast<AreaSensor&>(*sensors[0]).result);
}

// The rule before: a problem's variance below a fortieth of the mean of its 24 neighbours'.
std::vector<uint8_t> flags_by_ratio(const CaptureResult& r) {
  std::vector<uint8_t> flags(r.problems());
  const auto edge = static_cast<long>(kEdge);
  for (long y = 0; y < edge; ++y)
    for (long x = 0; x < edge; ++x) {
      RunningStats around;
      for (long v = std::max(0L, y - 2); v <= std::min(edge - 1, y + 2); ++v)
        for (long u = std::max(0L, x - 2); u <= std::min(edge - 1, x + 2); ++u)
          if (u != x || v != y) around.add(std::pow(r.standard_error[static_cast<size_t>(v * edge + u)], 2));
      const auto i = static_cast<size_t>(y * edge + x);
      flags[i] = std::pow(r.standard_error[i], 2) < around.mean() / 40;
    }
  return flags;
}

struct Count {
  double problems = 0, flagged = 0, exceeding = 0, found = 0;
  double false_share() const { return (flagged - found) / problems; }
  double missed_share() const { return (exceeding - found) / (problems - flagged); }  // of the unflagged
  // The most that Student's distribution leaves to the unflagged with four scrambles, at 3 sigma of their count.
  double most_missed() const {
    const double t = kTailFactor / std::sqrt(3.0), p = 1 - 2 / kPi * (t / (1 + t * t) + std::atan(t));
    return p + 3 * std::sqrt(p * (1 - p) / (problems - flagged));
  }
};
// shrink: what standard errors are multiplied by before they are judged.
void count(const CaptureResult& r, const std::vector<uint8_t>& flags, const Case& c, const CaptureResult& reference,
           Count& to, double shrink = 1) {
  for (size_t i = 0; i < r.problems(); ++i) {
    const bool exact = !std::isnan(c.truth);
    const double truth = exact ? c.truth : reference.radiance[i], open = exact ? 0 : reference.standard_error[i];
    const bool exceeds =
        std::fabs(r.radiance[i] - truth) > kTailFactor * shrink * r.standard_error[i] + kTailShare * truth + 2 * open;
    to.problems += 1, to.flagged += flags[i], to.exceeding += exceeds, to.found += exceeds && flags[i];
  }
}
std::vector<uint8_t> flags_of(const CaptureResult& r) {
  std::vector<uint8_t> flags = r.quality;
  for (uint8_t& f : flags) f = f & quality_heavy_tail ? 1 : 0;
  return flags;
}
void print(const std::string& name, const Count& n) {
  std::printf("%-34s flagged %6.2f %%, beyond the promise %5.2f %%, of these flagged %6.2f %%, false %5.2f %%\n",
              name.c_str(), 100 * n.flagged / n.problems, 100 * n.exceeding / n.problems,
              n.exceeding > 0 ? 100 * n.found / n.exceeding : 100, 100 * n.false_share());
}

// A long run; of what several tests ask for, once. Its own errors are a quarter of those of kPaths, and count() allows
// for two of them.
const CaptureResult& reference_of(const Case& c) {
  static std::map<std::string, CaptureResult> runs;
  const auto found = runs.find(c.name);
  return found != runs.end() ? found->second : runs.emplace(c.name, run(c, 1024, 1003)).first->second;
}

// The flag and the rule before, two seeds against a long run or the closed form.
void measure(const Case& c, Count& now, Count& before) {
  const CaptureResult reference = std::isnan(c.truth) ? reference_of(c) : CaptureResult{};
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    const CaptureResult r = run(c, kPaths, seed);
    count(r, flags_of(r), c, reference, now);
    count(r, flags_by_ratio(r), c, reference, before);
  }
  print(c.name, now);
  print("  by the ratio of variances", before);
}

TEST(TailFlags, FindWhatRareEventsHide) {
  for (const Place& place : {kGap, kGlint}) {
    const Case c{place.name, squares(place.share, place.holes), full_sky(), place.holes, 10 * place.share};
    Count now, alone;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      const CaptureResult r = run(c, kPaths, seed), by_itself = run(c, kPaths, seed, false);
      count(r, flags_of(r), c, {}, now);
      count(by_itself, flags_of(by_itself), c, {}, alone);
    }
    print(c.name, now);
    print("  without neighbours", alone);
    // The standard errors know from the problems around: 24 and 72 % are beyond what each problem's scrambles alone
    // tell. What is left without a flag is no more than one in a thousand. (The bound was that 99 % of what is beyond
    // be flagged, while standard errors of single problems put 99 and 87 % beyond; of the few glints that now are, it
    // is 55 %.)
    EXPECT_LE(now.exceeding, 5e-3 * now.problems) << c.name;
    EXPECT_LE(now.exceeding - now.found, 1.5e-3 * now.problems) << c.name;
    EXPECT_GT(alone.exceeding, 0.2 * alone.problems) << "errors of their own scrambles: there was something to know";
    EXPECT_LE(now.missed_share(), now.most_missed()) << c.name;
  }
}

TEST(TailFlags, AreSilentInQuietScenes) {
  const std::vector<Case> cases{{"block, sun of 0.05 rad", block(), sun_and_sky(0.05)},
                                {"block, sun of 0.3 rad", block(), sun_and_sky(0.3)},
                                {"court, sun of 0.05 rad", court(), sun_and_sky(0.05)},
                                {"court, sun of 0.3 rad", court(), sun_and_sky(0.3)},
                                {"mirror of the sky", squares(1 - 1e-9, false), full_sky(), false, 10}};
  double by_ratio_most = 0;
  for (const Case& c : cases) {
    Count now, before;
    measure(c, now, before);
    EXPECT_LE(now.false_share(), 0.01) << c.name;
    EXPECT_LE(now.missed_share(), now.most_missed()) << c.name;
    by_ratio_most = std::max(by_ratio_most, before.false_share());
  }
  // 0.05 while errors of single problems scattered more.
  EXPECT_GT(by_ratio_most, 0.02) << "the rule before flags without need, and the test sees it";
}

// Where there is an edge within four problems on every side, of contrasts up to forty, the standard errors know of
// them.
TEST(TailFlags, EdgesOnAllSides) {
  const Case c{"tiles", tiles(), sun_and_sky(0)};
  Count now, before;
  measure(c, now, before);
  EXPECT_LE(now.false_share(), 0.01);
  EXPECT_LE(now.missed_share(), now.most_missed());
  EXPECT_GT(before.false_share(), 0.3) << "the rule before flags most of it, and the test sees it";
}

TEST(TailFlags, StandardErrorsOfAThirdAreNoticed) {
  const Case c{"court, sun of 0.3 rad", court(), sun_and_sky(0.3)};
  const CaptureResult reference = reference_of(c), r = run(c, 16, 1);
  Count honest, shrunk;
  count(r, flags_of(r), c, reference, honest);
  count(r, flags_of(r), c, reference, shrunk, 1.0 / 3);
  print("court, 16 paths", honest);
  print("  with a third of the errors", shrunk);
  EXPECT_LE(honest.missed_share(), honest.most_missed());
  EXPECT_GT(shrunk.missed_share(), shrunk.most_missed());
}

}  // namespace
}  // namespace suite::test::tail_flags_test
