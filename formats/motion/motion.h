// Motion as users write it: tracks and jitter in YAML, timed poses in CSV or blank-separated text. FORMAT.md has the
// grammar; every key and column wears its unit.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "motion/jitter.h"
#include "motion/track.h"

namespace suite {

// What a description may refer to. Without an origin on the Earth only scene ENU is understood; without a clock only
// seconds.
struct MotionContext {
  std::optional<SceneFrame> frame;
  std::optional<Clock> clock;
  double dut1 = 0;  // s
  // Mean elements of a satellite (catalogue number or title) from a file; the application passes the reader of
  // formats/tle.
  std::function<OrbitElements(const std::string& path, const std::string& satellite)> satellites;
  // The path of a file that a node names; null: relative to the text.
  std::function<std::string(const Params&)> resolve = nullptr;
};

// The track a node describes. Marks what it reads; the caller rejects unread keys. Error, located: see FORMAT.md.
TrackPtr track_from(const Params& node, const MotionContext& context);
// The position of a node in scene ENU, m (the position keys of FORMAT.md only).
Vec3 position_from(const Params& node, const MotionContext& context);
// The pose of a node in scene ENU (position and orientation keys).
Pose pose_from(const Params& node, const MotionContext& context);
// The jitter a node describes; `seed` is mixed with its own seed.
Jitter jitter_from(const Params& node, uint64_t seed);
// Seconds of simulation time from `time_s` or `utc` of a node.
double time_from(const Params& node, const MotionContext& context);

// Timed poses from a table, in scene ENU.
std::vector<PoseKey> read_pose_keys(const std::string& path, const MotionContext& context);
std::vector<PoseKey> parse_pose_keys(std::string_view text, const std::string& file_name, const MotionContext& context);

// A power spectral density from a table with columns frequency_hz and `density_column`.
Psd read_psd(const std::string& path, const std::string& density_column, Psd::Between between);

// Writes poses as CSV with quaternions, in the columns of one frame. Error: a frame other than ENU without an origin.
enum class PoseColumns { enu, ecef, geodetic, utm };
std::string pose_keys_text(std::span<const PoseKey> keys, PoseColumns columns, const MotionContext& context);
void write_pose_keys(const std::string& path, std::span<const PoseKey> keys, PoseColumns columns,
                     const MotionContext& context);

}  // namespace suite
