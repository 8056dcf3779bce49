// CZML: the packets that have a position, as Cesium reads them.
//
// Assumes: geodetic samples are interpolated as places in space, as Cesium does; outside of its samples a thing is not
// there (extrapolation NONE, the default). HERMITE without velocities is LAGRANGE, and LINEAR has no degree, as in
// Cesium. A body's axes there are x forward, y left, z up. Based on: Analytical Graphics, "CZML Guide", packet,
// Position and Orientation, https://github.com/AnalyticalGraphicsInc/czml-writer/wiki/CZML-Guide
#include <algorithm>
#include <cmath>
#include <set>

#include "formats/motion/track_files.h"

namespace suite {

namespace {

class CzmlReader {
 public:
  explicit CzmlReader(const TrackFileOptions& options) : frame_(*options.motion.frame), clock_(*options.motion.clock) {}

  std::vector<MovingThing> run(const Params& file) {
    if (file.kind() != Params::Kind::list) throw file.error("this is no list of packets");
    for (const Params& packet : file.items()) take(packet);
    if (things_.empty()) throw file.error("nothing moves in it");
    return std::move(things_);
  }

 private:
  struct Sample {
    double time;
    std::array<double, 6> value;
  };

  Error fault(const Params& at, const std::string& what, const std::string& hint = {}) const {
    return at.error("packet '" + id_ + "': " + what, hint);
  }
  double date(const Params& at, std::string_view text) const {
    try {
      return clock_.seconds(parse_iso8601(text));
    } catch (const Error& e) {
      throw fault(at, e.message(), e.hint());
    }
  }

  // Intervals "BEGIN/END" of a text or a list of them; all times where there is none.
  std::vector<TimeSpan> intervals(const Params& of, const char* key) const {
    const auto given = of.find(key);
    if (!given) return {{-INFINITY, INFINITY}};
    std::vector<TimeSpan> made;
    for (const Params& one : given->items()) {
      const std::string text = one.as_text();
      const size_t slash = text.find('/');
      if (slash == std::string::npos)
        throw fault(one, "'" + text + "' is no interval", "two dates with / between them");
      made.push_back(
          {date(one, std::string_view(text).substr(0, slash)), date(one, std::string_view(text).substr(slash + 1))});
      if (!(made.back().begin <= made.back().end)) throw fault(one, "an interval ends before it begins");
    }
    // Those that touch or overlap are one.
    std::sort(made.begin(), made.end(), [](const TimeSpan& a, const TimeSpan& b) { return a.begin < b.begin; });
    std::vector<TimeSpan> apart;
    for (const TimeSpan& one : made)
      if (apart.empty() || one.begin > apart.back().end)
        apart.push_back(one);
      else
        apart.back().end = std::max(apart.back().end, one.end);
    return apart;
  }

  // One value without times, or samples of time and value.
  std::vector<Sample> samples(const Params& property, const Params& list, size_t width) const {
    const std::vector<Params> items = list.items();
    std::vector<Sample> made;
    if (items.size() == width) {
      Sample s{-INFINITY, {}};
      for (size_t k = 0; k < width; ++k) s.value[k] = items[k].as_number();
      return {s};
    }
    if (items.empty() || items.size() % (width + 1))
      throw fault(list, strf("%zu numbers are no samples of a time and %zu numbers", items.size(), width));
    const auto epoch = property.find("epoch");
    const double zero = epoch ? date(*epoch, epoch->as_text()) : 0;
    for (size_t i = 0; i < items.size(); i += width + 1) {
      const std::string text = items[i].as_text();
      const bool dated = text.find('-', 1) != std::string::npos && text.find('T') != std::string::npos;
      if (!dated && !epoch) throw fault(list, "times in seconds without an epoch");
      Sample s{dated ? date(items[i], text) : zero + items[i].as_number(), {}};
      for (size_t k = 0; k < width; ++k) s.value[k] = items[i + 1 + k].as_number();
      if (!made.empty() && !(s.time > made.back().time)) throw fault(list, "the times do not ascend");
      made.push_back(s);
    }
    return made;
  }

  std::vector<Sample> places(const Params& position) const {
    if (position.kind() != Params::Kind::map) throw fault(position, "a position that is no map");
    const std::string axes = position.text("referenceFrame", "FIXED");
    if (axes != "FIXED")
      throw fault(position, "its axes are '" + axes + "'",
                  "only axes that turn with the Earth are understood: write it with referenceFrame FIXED");
    for (const char* key : {"forwardExtrapolationType", "backwardExtrapolationType"})
      if (position.text(key, "NONE") != "NONE") throw fault(position, std::string(key) + " is not NONE");
    if (const auto list = position.find("cartesian")) return samples(position, *list, 3);
    if (const auto list = position.find("cartesianVelocity")) return samples(position, *list, 6);
    const auto degrees = position.find("cartographicDegrees"), radians = position.find("cartographicRadians");
    if (!degrees && !radians)
      throw fault(position, "a position in another form",
                  "cartesian, cartesianVelocity, cartographicDegrees or cartographicRadians");
    std::vector<Sample> made = samples(position, degrees ? *degrees : *radians, 3);
    const double unit = degrees ? 1 : 1 / kDegree;
    for (Sample& s : made) {
      try {
        const Vec3 place = ecef_from_geodetic({s.value[1] * unit, s.value[0] * unit, s.value[2]});
        s.value = {place.x, place.y, place.z, 0, 0, 0};
      } catch (const Error& e) {
        throw fault(position, e.message(), e.hint());
      }
    }
    return made;
  }

  // How the thing is turned at each of its places. along: it points along its velocity.
  void turn(const std::optional<Params>& orientation, const std::vector<Sample>& at, std::vector<PoseKey>& keys,
            bool& along) const {
    if (!orientation) return;
    if (const auto reference = orientation->find("velocityReference")) {
      if (reference->as_text() != "#position") throw fault(*reference, "a velocity that is not its own");
      along = true;
      return;
    }
    const auto list = orientation->find("unitQuaternion");
    if (!list) throw fault(*orientation, "an orientation in another form", "unitQuaternion or velocityReference");
    const std::vector<Sample> turned = samples(*orientation, *list, 4);
    const bool constant = turned.size() == 1;
    if (!constant && (turned.size() != at.size() || !std::equal(at.begin(), at.end(), turned.begin(),
                                                                [](auto& a, auto& b) { return a.time == b.time; })))
      throw fault(*orientation, "it is turned at other times than it has places", "samples at the same times");
    for (size_t i = 0; i < keys.size(); ++i) {
      const auto& v = turned[constant ? 0 : i].value;
      const Quat q{v[3], v[0], v[1], v[2]};
      if (!(std::fabs(dot(q, q) - 1) < 1e-3)) throw fault(*list, "a quaternion whose length is not 1");
      // Their x is our y, their y our -x.
      const Quat ours = normalized(q) * quat_about({0, 0, 1}, -kPi / 2);
      const Vec3 ecef{at[i % at.size()].value[0], at[i % at.size()].value[1], at[i % at.size()].value[2]};
      keys[i].pose = pose_from_ecef(frame_, ecef, ours);
    }
  }

  void take(const Params& packet) {
    if (packet.kind() != Params::Kind::map) throw packet.error("a packet that is no map");
    id_ = packet.text("id", "");
    const auto position = packet.find("position");
    if (!position) return;
    if (id_.empty()) throw packet.error("a packet with a position and without an id");
    if (!known_.insert(id_).second) throw fault(packet, "there are two of this id");
    const auto orientation = packet.find("orientation");
    const bool by_intervals = orientation && orientation->kind() == Params::Kind::list;
    std::vector<Piece> pieces;
    for (const Params& one : position->items())
      take(packet, one, by_intervals ? of_interval(*orientation, one) : orientation, pieces);
    // Where one ends as the next begins it is the next that is there.
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece& a, const Piece& b) { return a.there.begin < b.there.begin; });
    for (size_t i = 0; i < pieces.size(); ++i) {
      if (i + 1 < pieces.size() && !(pieces[i].there.end < pieces[i + 1].there.begin)) {
        if (pieces[i].there.end > pieces[i + 1].there.begin)
          throw fault(*position, "it has two places at one time", "intervals that do not overlap");
        pieces[i].there.end = std::nextafter(pieces[i].there.end, -INFINITY);
      }
      add(packet, pieces[i]);
    }
  }

  // The orientation whose interval is written as that of a position.
  std::optional<Params> of_interval(const Params& orientation, const Params& position) const {
    const std::string mine = position.text("interval", "");
    for (const Params& one : orientation.items())
      if (one.kind() == Params::Kind::map && one.text("interval", "") == mine) return one;
    throw fault(orientation, "it is turned by other intervals than it has places", "the same intervals for both");
  }

  // One position with one orientation, and when they hold.
  struct Piece {
    InterpolatedMotion motion;
    bool rests, along;
    TimeSpan there;
  };

  void take(const Params& packet, const Params& position, const std::optional<Params>& orientation,
            std::vector<Piece>& pieces) const {
    std::vector<Sample> at = places(position);
    const bool rests = at.size() == 1;
    const std::string how = position.text("interpolationAlgorithm", "LINEAR");
    if (how != "LINEAR" && how != "LAGRANGE" && how != "HERMITE")
      throw fault(position, "'" + how + "' interpolation", "LINEAR, LAGRANGE or HERMITE");
    InterpolatedMotion motion;
    const long long degree = position.integer("interpolationDegree", 1, 15, 1);
    motion.degree = how == "LINEAR" ? 1 : static_cast<size_t>(degree);
    const bool turns = how == "HERMITE" && position.has("cartesianVelocity") && !rests;
    for (const Sample& s : at) {
      const Vec3 ecef{s.value[0], s.value[1], s.value[2]};
      try {
        motion.keys.push_back({s.time, track_file::northward(frame_, ecef)});
      } catch (const Error& e) {
        throw fault(position, e.message(), e.hint());
      }
      if (turns) motion.velocities.push_back(frame_.enu_direction({s.value[3], s.value[4], s.value[5]}));
    }
    bool along = false;
    turn(orientation, at, motion.keys, along);
    for (size_t i = 0; along && i < at.size(); ++i)
      if (rests || (i > 0 && at[i].value == at[i - 1].value))
        throw fault(packet, "it points along its velocity and rests", "give it a unitQuaternion");
    for (const TimeSpan& there : intervals(packet, "availability"))
      for (const TimeSpan& known : intervals(position, "interval")) {
        TimeSpan both{std::max(there.begin, known.begin), std::min(there.end, known.end)};
        if (!rests) both = {std::max(both.begin, at.front().time), std::min(both.end, at.back().time)};
        if (both.begin <= both.end) pieces.push_back({motion, rests, along, both});
      }
  }

  void add(const Params& packet, Piece& piece) {
    InterpolatedMotion& motion = piece.motion;
    const TimeSpan there = piece.there;
    TrackPtr track;
    if (piece.rests && std::isinf(there.begin)) {
      track = static_track(motion.keys.front().pose);
    } else {
      if (piece.rests) {
        const Pose pose = motion.keys.front().pose;
        motion.keys = {{there.begin, pose}};
        if (there.end > there.begin) motion.keys.push_back({there.end, pose});
      }
      motion.covered = there;
      // Only the keys that have a part in it: there may be many intervals.
      const auto margin = static_cast<std::ptrdiff_t>(motion.degree) + 1;
      const auto time = [](const PoseKey& k, double t) { return k.time < t; };
      const auto first = motion.keys.begin(), last = motion.keys.end();
      const auto from = std::lower_bound(first, last, there.begin, time),
                 to = std::lower_bound(first, last, there.end, time);
      const auto low = from - first - std::min(margin, from - first), high = to - first + std::min(margin, last - to);
      InterpolatedMotion part{{first + low, first + high}, motion.degree, there, {}};
      if (!motion.velocities.empty())
        part.velocities = {motion.velocities.begin() + low, motion.velocities.begin() + high};
      try {
        track = interpolated_track(std::move(part));
      } catch (const Error& e) {
        throw fault(packet, e.message(), e.hint());
      }
    }
    PointingRule rule;
    rule.kind = Pointing::velocity, rule.frame = &frame_;
    if (piece.along) track = pointed_track(track, rule);
    things_.push_back({id_, "", packet.where(), std::move(track)});
  }

  const SceneFrame& frame_;
  const Clock& clock_;
  std::string id_;
  std::set<std::string> known_;
  std::vector<MovingThing> things_;
};

}  // namespace

TrackFileRow track_file::czml_row() {
  return {{"czml", "CZML (JSON)", "",
           [](const std::string& text, const std::string& name, const TrackFileOptions& options) {
             require_earth(options, name);
             return CzmlReader(options).run(Params::parse_json(text, name));
           }},
          [](std::string_view head) {
            const size_t first = head.find_first_not_of(" \t\r\n");
            return first != std::string_view::npos && head[first] == '[' &&
                   head.find("\"document\"") != std::string_view::npos;
          }};
}

}  // namespace suite
