// CZML: the packets that have a position, as Cesium reads them.
//
// Assumes: geodetic samples are interpolated as places in space, as Cesium does; outside of its samples a thing is not
// there (extrapolation NONE, the default). A body's axes there are x forward, y left, z up.
// Based on: Analytical Graphics, "CZML Guide", packet, Position and Orientation,
// https://github.com/AnalyticalGraphicsInc/czml-writer/wiki/CZML-Guide
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
    std::array<double, 4> value;
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
    return made;
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
    if (position.kind() != Params::Kind::map)
      throw fault(position, "a position by intervals", "one 'position' with samples is understood");
    const std::string axes = position.text("referenceFrame", "FIXED");
    if (axes != "FIXED")
      throw fault(position, "its axes are '" + axes + "'",
                  "only axes that turn with the Earth are understood: write it with referenceFrame FIXED");
    for (const char* key : {"forwardExtrapolationType", "backwardExtrapolationType"})
      if (position.text(key, "NONE") != "NONE") throw fault(position, std::string(key) + " is not NONE");
    if (const auto list = position.find("cartesian")) return samples(position, *list, 3);
    const auto degrees = position.find("cartographicDegrees"), radians = position.find("cartographicRadians");
    if (!degrees && !radians)
      throw fault(position, "a position in another form", "cartesian, cartographicDegrees or cartographicRadians");
    std::vector<Sample> made = samples(position, degrees ? *degrees : *radians, 3);
    const double unit = degrees ? 1 : 1 / kDegree;
    for (Sample& s : made) {
      try {
        const Vec3 place = ecef_from_geodetic({s.value[1] * unit, s.value[0] * unit, s.value[2]});
        s.value = {place.x, place.y, place.z};
      } catch (const Error& e) {
        throw fault(position, e.message(), e.hint());
      }
    }
    return made;
  }

  // How the thing is turned at each of its places. along: it points along its velocity.
  void turn(const Params& packet, const std::vector<Sample>& at, std::vector<PoseKey>& keys, bool& along) const {
    const auto orientation = packet.find("orientation");
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
    std::vector<Sample> at = places(*position);
    const bool rests = at.size() == 1;
    const std::string how = position->text("interpolationAlgorithm", "LINEAR");
    if (how != "LINEAR" && how != "LAGRANGE")
      throw fault(*position, "'" + how + "' interpolation", "LINEAR or LAGRANGE");
    InterpolatedMotion motion;
    motion.degree = static_cast<size_t>(position->integer("interpolationDegree", 1, 15, 1));
    for (const Sample& s : at) {
      const Vec3 ecef{s.value[0], s.value[1], s.value[2]};
      try {
        motion.keys.push_back({s.time, track_file::northward(frame_, ecef)});
      } catch (const Error& e) {
        throw fault(*position, e.message(), e.hint());
      }
    }
    bool along = false;
    turn(packet, at, motion.keys, along);
    for (size_t i = 0; along && i < at.size(); ++i)
      if (rests || (i > 0 && at[i].value == at[i - 1].value))
        throw fault(packet, "it points along its velocity and rests", "give it a unitQuaternion");
    for (const TimeSpan& there : intervals(packet, "availability"))
      for (const TimeSpan& known : intervals(*position, "interval"))
        add(packet, motion, rests, along, {std::max(there.begin, known.begin), std::min(there.end, known.end)});
  }

  void add(const Params& packet, InterpolatedMotion& motion, bool rests, bool along, TimeSpan there) {
    TrackPtr track;
    if (!(there.begin <= there.end)) return;
    if (rests && std::isinf(there.begin)) {
      track = static_track(motion.keys.front().pose);
    } else {
      if (rests) {
        const Pose pose = motion.keys.front().pose;
        motion.keys = {{there.begin, pose}};
        if (there.end > there.begin) motion.keys.push_back({there.end, pose});
      }
      motion.covered = {std::max(there.begin, motion.keys.front().time), std::min(there.end, motion.keys.back().time)};
      if (!(motion.covered.begin <= motion.covered.end)) return;  // it has no samples while it is available
      // Only the keys that have a part in it: there may be many intervals.
      const auto margin = static_cast<std::ptrdiff_t>(motion.degree) + 1;
      const auto time = [](const PoseKey& k, double t) { return k.time < t; };
      const auto first = motion.keys.begin(), last = motion.keys.end();
      const auto from = std::lower_bound(first, last, motion.covered.begin, time),
                 to = std::lower_bound(first, last, motion.covered.end, time);
      InterpolatedMotion part{
          {from - std::min(margin, from - first), to + std::min(margin, last - to)}, motion.degree, motion.covered};
      try {
        track = interpolated_track(std::move(part));
      } catch (const Error& e) {
        throw fault(packet, e.message(), e.hint());
      }
    }
    PointingRule rule;
    rule.kind = Pointing::velocity, rule.frame = &frame_;
    if (along) track = pointed_track(track, rule);
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
