// STK's ephemerides (.e): one vehicle in axes that are fixed to the Earth.
//
// Assumes: without InterpolationMethod and -Order it is Lagrange's of order 5, as STK has it; velocities are left to
// the interpolation of places. Based on: AGI (Ansys), "STK Help: Ephemeris File Format (*.e)".
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/text_lines.h"
#include "formats/motion/track_files.h"

namespace suite {

namespace {

std::string lower(std::string_view text) {
  std::string r(text);
  std::transform(r.begin(), r.end(), r.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return r;
}

class StkReader {
 public:
  StkReader(const std::string& text, const std::string& name, const TrackFileOptions& options)
      : lines_(text, name), name_(name), frame_(*options.motion.frame), clock_(*options.motion.clock) {}

  std::vector<MovingThing> run() {
    lines_.next();  // stk.v.N, which the row knew it by
    if (!lines_.next() || lower(word(0)) != "begin" || lower(word(1)) != "ephemeris")
      throw lines_.error_at_end("'BEGIN Ephemeris' does not follow the version");
    const Where begin = lines_.where();
    while (columns_ == 0) {
      if (!lines_.next()) throw lines_.error_at_end("there is no table of ephemeris points");
      take_key(lower(word(0)));
    }
    if (!epoch_) throw Error(begin, "there is no ScenarioEpoch");
    if (!fixed_) throw Error(begin, "there is no CoordinateSystem", "export it with 'CoordinateSystem Fixed'");
    while (lines_.next() && lower(word(0)) != "end") take_point();
    if (motion_.keys.empty()) throw lines_.error_at_end("nothing moves in it");
    if (points_ >= 0 && static_cast<size_t>(points_) != motion_.keys.size())
      throw lines_.error(0, strf("%lld points are announced, there are %zu", points_, motion_.keys.size()));
    motion_.covered = {motion_.keys.front().time, motion_.keys.back().time};
    return {{std::filesystem::path(name_).stem().string(), "", begin, interpolated_track(std::move(motion_))}};
  }

 private:
  std::string_view word(size_t i) const { return i < lines_.words() ? lines_.word(i) : std::string_view{}; }
  void expect(const char* key, std::initializer_list<const char*> known, const char* hint) const {
    const std::string value = lower(word(1));
    if (std::none_of(known.begin(), known.end(), [&](const char* k) { return value == k; }))
      throw lines_.error(1, std::string(key) + " is '" + std::string(word(1)) + "'", hint);
  }

  void take_key(const std::string& key) {
    if (key == "scenarioepoch") {
      epoch_ = date();
    } else if (key == "numberofephemerispoints") {
      points_ = lines_.integer(1, "the number of points", 0, 1LL << 40);
    } else if (key == "interpolationmethod") {
      expect("the interpolation", {"lagrange"}, "Lagrange is understood");
    } else if (key == "interpolationorder" || key == "interpolationsamplesm1") {
      motion_.degree = static_cast<size_t>(lines_.integer(1, "the order", 1, 15));
    } else if (key == "centralbody") {
      expect("the central body", {"earth"}, "Earth is understood");
    } else if (key == "coordinatesystem") {
      expect("the coordinate system", {"fixed"},
             "only axes that turn with the Earth are understood: export it with 'CoordinateSystem Fixed'");
      fixed_ = true;
    } else if (key == "distanceunit") {
      expect("the unit", {"meters", "kilometers"}, "Meters or Kilometers");
      metres_ = lower(word(1)) == "meters" ? 1 : 1000;
    } else if (key == "ephemeristimepos") {
      columns_ = 4;
    } else if (key == "ephemeristimeposvel") {
      columns_ = 7;
    } else if (key == "ephemerisllatimepos") {
      columns_ = 4, geodetic_ = true;
    } else if (key == "ephemerisllatimeposvel") {
      columns_ = 7, geodetic_ = true;
    } else {
      throw lines_.error(
          0, "'" + std::string(word(0)) + "' is not understood",
          "ScenarioEpoch, NumberOfEphemerisPoints, InterpolationMethod, InterpolationOrder, CentralBody, "
          "CoordinateSystem, DistanceUnit, EphemerisTimePos, EphemerisTimePosVel, EphemerisLLATimePos, "
          "EphemerisLLATimePosVel");
    }
  }

  // "1 Jul 2020 00:00:00.000"
  double date() const {
    constexpr std::array<const char*, 12> months{"jan", "feb", "mar", "apr", "may", "jun",
                                                 "jul", "aug", "sep", "oct", "nov", "dec"};
    const auto month = std::find(months.begin(), months.end(), lower(word(2)));
    if (month == months.end() || lines_.words() != 5) throw lines_.error(1, "no date such as 1 Jul 2020 00:00:00.000");
    const auto day = lines_.integer(1, "the day", 1, 31), year = lines_.integer(3, "the year", 1972, 2199);
    try {
      return clock_.seconds(
          parse_iso8601(strf("%04lld-%02d-%02lldT%sZ", year, static_cast<int>(month - months.begin()) + 1, day,
                             std::string(word(4)).c_str())));
    } catch (const Error& e) {
      throw lines_.error(1, e.message(), e.hint());
    }
  }

  void take_point() {
    if (lines_.words() != columns_)
      throw lines_.error(0, strf("a point of %zu numbers", lines_.words()), strf("%zu of them", columns_));
    const double time = *epoch_ + lines_.number(0, "the time");
    if (!motion_.keys.empty() && !(time > motion_.keys.back().time))
      throw lines_.error(0, "the times do not ascend", "each point later than the one before");
    const double a = lines_.number(1, "x"), b = lines_.number(2, "y"), c = lines_.number(3, "z") * metres_;
    for (size_t i = 4; i < columns_; ++i) lines_.number(i, "the velocity");
    try {
      const Vec3 place = geodetic_ ? ecef_from_geodetic({a, b, c}) : Vec3{a * metres_, b * metres_, c};
      motion_.keys.push_back({time, track_file::northward(frame_, place)});
    } catch (const Error& e) {
      throw lines_.error(1, e.message(), e.hint());
    }
  }

  TextLines lines_;
  const std::string& name_;
  const SceneFrame& frame_;
  const Clock& clock_;
  InterpolatedMotion motion_{{}, 5, {}};
  std::optional<double> epoch_;  // s of the scene
  bool fixed_ = false, geodetic_ = false;
  double metres_ = 1;
  long long points_ = -1;
  size_t columns_ = 0;
};

}  // namespace

TrackFileRow track_file::stk_row() {
  return {{"stk", "STK's ephemerides (.e)", "",
           [](const std::string& text, const std::string& name, const TrackFileOptions& options) {
             require_earth(options, name);
             return StkReader(text, name, options).run();
           }},
          [](std::string_view head) { return head.starts_with("stk.v."); }};
}

}  // namespace suite
