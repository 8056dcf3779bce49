// Seeded mutations of the readers of motion: whatever comes in, the answer is a result or an Error with a place.
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/motion/motion.h"
#include "formats/tle/tle.h"
#include "tests/support/fuzz.h"

namespace suite::format_motion_motion_test {
namespace {

std::string_view text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }

std::string three_sets() {
  const std::string all = read_text(SUITE_TEST_DATA "/motion/SGP4-VER.TLE");
  return all.substr(0, all.find("#   MOLNIYA 2-14"));
}

MotionContext somewhere() {
  return {SceneFrame({10, 20, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0,
          [](const std::string& path, const std::string& satellite) { return read_tle_of(path, satellite).elements; }};
}

TEST(MotionFuzz, ElementSets) {
  const std::string text = three_sets();
  test::fuzz(test::bytes_of(text),
             [](std::span<const std::byte> b) { parse_tle(text_of(b), "f.tle", TleChecksum::ignored); });
}

// Whatever a set with wild elements is, propagating it ends, with finite numbers or with an Error that names it.
TEST(MotionFuzz, WildElementsPropagateOrAreRefused) {
  const std::string text = three_sets();
  test::Mutator mutate(7, {"99999", "00000", "-9", "1.0", "9999999"});
  size_t states = 0, refused = 0;
  const size_t count = test::mutations(test::kMutations);
  for (size_t i = 0; i < count; ++i) {
    const test::Bytes b = mutate(test::bytes_of(text));
    try {
      for (const TleEntry& e : parse_tle(text_of(b), "f.tle", TleChecksum::ignored))
        for (const double minutes : {0.0, -700.0, 5000.0}) {
          const OrbitState s = Sgp4(e.elements).at_minutes(minutes);
          ASSERT_TRUE(finite(s.position) && finite(s.velocity));
          ++states;
        }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(20 * states, count);
  EXPECT_GT(20 * refused, count);
}

TEST(MotionFuzz, PoseTables) {
  const MotionContext context = somewhere();
  test::fuzz(test::bytes_of("utc,utm_zone,easting_m,northing_m,height_m,heading_deg,pitch_deg\n"
                            "2024-01-01T00:00:01Z,33N,5e5,1e6,10,0,1\n2024-01-01T00:00:02Z,33N,500010,1e6,10,2,3\n"
                            "2024-01-01T00:00:03.5Z,33N,500020,1e6,12,4,5\n"),
             [&](std::span<const std::byte> b) { keyframe_track(parse_pose_keys(text_of(b), "f.csv", context)); }, 2,
             test::kMutations, {"qw", "time_s", "1e999", "-0", "latitude_deg", "99N", ",", "\n"});
}

TEST(MotionFuzz, Tracks) {
  const MotionContext context = somewhere();
  test::fuzz(
      test::bytes_of("kind: composed\n"
                     "outer: {kind: circle, position_m: [0, 0, 120], radius_m: 150, speed_m_s: 12, pointing: nadir}\n"
                     "inner:\n  kind: keyframes\n  keys:\n    - {time_s: 0, position_m: [0, 1, 2], heading_deg: 5}\n"
                     "    - {time_s: 3, position_m: [0, 1, 2], quaternion: [1, 0, 0, 0]}\n"),
      [&](std::span<const std::byte> b) {
        const Params p = Params::parse_text(text_of(b), "f.yaml");
        track_from(p, context)->covered();
        p.reject_unread();
      },
      3, test::kMutations,
      {"static", "spin", "straight", "orbit", "look_at: ", "tle: ", "axis: [0, 0, 1]", "speed_m_s: ", "-1", "[", "{",
       "1e300"});
}

TEST(MotionFuzz, Jitter) {
  test::fuzz(
      test::bytes_of("{seed: 3, components: 16, x: {sigma_m: 0.1, mean_m: 2}, rotate_z: {psd: {frequency_hz: [1, 10], "
                     "density_rad2_hz: [1e-4, 1e-5], between: linear}}}"),
      [](std::span<const std::byte> b) {
        const Params p = Params::parse_text(text_of(b), "f.yaml");
        jitter_from(p, 1).at(0.5);
        p.reject_unread();
      },
      4, test::kMutations, {"log_log", "1e300", "1e-300", "0", "-1", "rotate_x: ", "psd: ", "file: "});
}

}  // namespace
}  // namespace suite::format_motion_motion_test
