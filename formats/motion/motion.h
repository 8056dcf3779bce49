// Motion as users write it: tracks and jitter in YAML, timed poses in CSV or blank-separated text. FORMAT.md has the
// grammar; every key and column wears its unit.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "motion/jitter.h"
#include "motion/timetable.h"
#include "motion/track.h"

namespace suite {

// What a description may refer to. Without an origin on the Earth only scene ENU is understood; without a clock only
// seconds.
struct MotionContext {
  std::optional<SceneFrame> frame;
  std::optional<Clock> clock;
  double dut1 = 0;  // s, UT1 - UTC at second 0
  // Mean elements of a satellite (catalogue number or title) from a file; the application passes the reader of
  // formats/tle.
  std::function<OrbitElements(const std::string& path, const std::string& satellite)> satellites;
  // The same from the two lines themselves.
  std::function<OrbitElements(const std::string& lines, const std::string& file)> satellite_lines = nullptr;
  // The path of a file that a node names; null: relative to the text.
  std::function<std::string(const Params&)> resolve = nullptr;
  // What moves may be absent outside the times that its track covers (key `outside`).
  bool may_end = false;
  bool dut1_given = false;  // else a satellite's track says what that may cost
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

// Seconds of simulation time from one value: a number of them, or a date in UTC.
double time_value(const Params& value, const MotionContext& context);
// Keys `appears` and `disappears`, times from which and until just before which something is there; without end where
// they are absent. Error SP412 when it ends before it begins.
TimeSpan read_life(const Params& p, const MotionContext& context);

// A control table: what holds from which time on. `columns` are what its rows may say beside their time.
struct TimedCell {
  std::string text;
  Where where;
  bool truth() const;  // Error, located, unless it is true or false
  double number_in(double low, double high, const char* unit) const;
};
struct TimedRow {
  Where where;
  std::map<std::string, TimedCell> cells;  // by column; those that were given
};
struct TimedTable {
  Timetable when;
  std::vector<TimedRow> rows;
};
// From a list of rows, or from a map of `rows` or `file` (a table) and `period_s`.
TimedTable timetable_from(const Params& node, const MotionContext& context, std::span<const char* const> columns);

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
