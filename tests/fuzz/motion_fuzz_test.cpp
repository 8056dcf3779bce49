// Seeded mutations of the readers of motion: whatever comes in, the answer is a result or an Error.
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "formats/motion/motion.h"
#include "formats/tle/tle.h"
#include "math/sampling.h"

namespace suite {
namespace {

// Flips bytes, cuts, doubles pieces, swaps in digits and separators.
std::string mutate(std::string text, Pcg32& rng) {
  const int changes = 1 + static_cast<int>(rng.next() % 4);
  for (int i = 0; i < changes && !text.empty(); ++i) {
    const size_t at = rng.next() % text.size();
    switch (rng.next() % 6) {
      case 0:
        text[at] = static_cast<char>(rng.next());
        break;
      case 1:
        text.resize(at);
        break;
      case 2:
        text.insert(at, text.substr(rng.next() % text.size(), rng.next() % 40));
        break;
      case 3:
        text.erase(at, rng.next() % 20);
        break;
      case 4:
        text[at] = "0123456789-+.,eE:{}[]\n #"[rng.next() % 24];
        break;
      default:
        text.insert(at, "99999999999999999999");
        break;
    }
  }
  return text;
}

// Counts how many mutations were read and how many refused; anything but an Error escapes and fails the test.
template <class F>
void campaign(const std::string& text, uint64_t seed, F read) {
  Pcg32 rng(seed);
  int good = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    try {
      read(mutate(text, rng));
      ++good;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(good, 100);
  EXPECT_GT(refused, 1000);
}

TEST(MotionFuzz, ElementSets) {
  const std::string text = read_text(SUITE_TEST_DATA "/motion/SGP4-VER.TLE").substr(0, 700);
  campaign(text, 1, [](const std::string& t) {
    for (const TleEntry& e : parse_tle(t, "f.tle", TleChecksum::ignored)) Sgp4(e.elements).at_minutes(100);
  });
}

TEST(MotionFuzz, PoseTables) {
  const MotionContext context{SceneFrame({10, 20, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0};
  campaign(
      "utc,utm_zone,easting_m,northing_m,height_m,heading_deg,pitch_deg\n2024-01-01T00:00:01Z,33N,5e5,1e6,10,0,1\n"
      "2024-01-01T00:00:02Z,33N,500010,1e6,10,2,3\n2024-01-01T00:00:03.5Z,33N,500020,1e6,12,4,5\n",
      2, [&](const std::string& t) { keyframe_track(parse_pose_keys(t, "f.csv", context)); });
}

TEST(MotionFuzz, Tracks) {
  const MotionContext context{SceneFrame({10, 20, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0};
  campaign(
      "kind: composed\nouter: {kind: circle, position_m: [0, 0, 120], radius_m: 150, speed_m_s: 12, pointing: nadir}\n"
      "inner:\n  kind: keyframes\n  keys:\n    - {time_s: 0, position_m: [0, 1, 2], heading_deg: 5}\n"
      "    - {time_s: 3, position_m: [0, 1, 2], quaternion: [1, 0, 0, 0]}\n",
      3, [&](const std::string& t) {
        const Params p = Params::parse_text(t, "f.yaml");
        track_from(p, context)->at(1);
        p.reject_unread();
      });
}

}  // namespace
}  // namespace suite
