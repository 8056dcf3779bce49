// What the numbers of a record are, kind by kind, is what track_of takes from them in order; each track's record()
// puts them in the same order.
#include "motion/track_record.h"

#include <cmath>

#include "base/error.h"

namespace suite {

namespace record {

void put(std::vector<double>& n, const Pose& p) {
  n.insert(n.end(),
           {p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z, p.translation.x, p.translation.y, p.translation.z});
}
void put(std::vector<double>& n, const SceneFrame& frame) {
  const Geodetic& g = frame.origin();
  n.insert(n.end(), {g.latitude_deg, g.longitude_deg, g.height_m});
}
void put(std::vector<double>& n, const Utc& u) {
  for (const int part : {u.year, u.month, u.day, u.hour, u.minute}) n.push_back(part);
  n.push_back(u.second);
}

}  // namespace record

namespace {

constexpr int kDeepest = 64;

// Takes the numbers one by one.
class Numbers {
 public:
  explicit Numbers(const TrackRecord& r) : r_(r) {
    for (const double x : r.numbers)
      if (!std::isfinite(x)) throw Error("a stored motion holds a number that is not finite");
  }
  double next() {
    if (at_ >= r_.numbers.size()) throw Error("a stored motion has too few numbers");
    return r_.numbers[at_++];
  }
  Vec3 vec() {
    const double x = next(), y = next();
    return {x, y, next()};
  }
  Pose pose() {
    Quat q;
    q.w = next(), q.x = next(), q.y = next(), q.z = next();
    return {q, vec()};
  }
  SceneFrame frame() {
    const Vec3 v = vec();
    return SceneFrame({v.x, v.y, v.z});
  }
  int whole() {
    const double x = next();
    if (!(std::fabs(x) <= 1e6) || x != std::floor(x)) throw Error("a stored motion holds a date that is none");
    return static_cast<int>(x);
  }
  Utc utc() {
    Utc u;
    u.year = whole(), u.month = whole(), u.day = whole(), u.hour = whole(), u.minute = whole();
    u.second = next();
    return u;
  }
  bool more() const { return at_ < r_.numbers.size(); }

 private:
  const TrackRecord& r_;
  size_t at_ = 0;
};

TrackPtr make(const TrackRecord& r, int depth);

TrackPtr make_keyframes(Numbers& n) {
  std::vector<PoseKey> keys;
  while (n.more()) {
    const double time = n.next();
    keys.push_back({time, n.pose()});
  }
  return keyframe_track(std::move(keys));
}

TrackPtr make_interpolated(Numbers& n, bool with_velocities) {
  InterpolatedMotion m;
  const int degree = n.whole();
  m.degree = degree < 0 ? 0 : static_cast<size_t>(degree);
  m.covered.begin = n.next(), m.covered.end = n.next();
  while (n.more()) {
    const double time = n.next();
    m.keys.push_back({time, n.pose()});
    if (with_velocities) m.velocities.push_back(n.vec());
  }
  return interpolated_track(std::move(m));
}

TrackPtr make_straight(Numbers& n) {
  StraightMotion m;
  m.start = n.vec();
  m.azimuth = n.next(), m.climb = n.next(), m.speed = n.next(), m.t0 = n.next();
  if (!n.more()) return straight_track(m);
  const SceneFrame frame = n.frame();
  m.curved = &frame;
  return straight_track(m);
}

TrackPtr make_circle(Numbers& n) {
  CircleMotion m;
  m.center = n.vec();
  m.radius = n.next(), m.speed = n.next(), m.azimuth = n.next(), m.bank = n.next(), m.t0 = n.next();
  m.clockwise = n.next() != 0;
  return circle_track(m);
}

TrackPtr make_spin(Numbers& n) {
  SpinMotion m;
  m.base = n.pose();
  m.axis = n.vec();
  m.through = n.vec();
  m.rate = n.next(), m.t0 = n.next();
  return spin_track(m);
}

TrackPtr make_orbit(Numbers& n, const std::string& satellite) {
  OrbitElements e;
  e.satellite = satellite;
  e.epoch = n.utc();
  e.inclination = n.next(), e.ascending_node = n.next(), e.eccentricity = n.next(), e.perigee_argument = n.next();
  e.mean_anomaly = n.next(), e.mean_motion = n.next(), e.drag = n.next();
  const SceneFrame frame = n.frame();
  const Clock clock(n.utc());
  return orbit_track(std::make_shared<const Sgp4>(e), frame, clock, n.next());
}

TrackPtr make_pointed(Numbers& n, const TrackRecord& r, int depth) {
  const double kind = n.next();
  if (kind != 0 && kind != 1 && kind != 2) throw Error("a stored motion points in an unknown way");
  PointingRule rule;
  rule.kind = static_cast<Pointing>(static_cast<int>(kind));
  if (r.parts.size() == 2) rule.target = make(r.parts[1], depth + 1);
  const TrackPtr place = make(r.parts[0], depth + 1);
  if (!n.more()) return pointed_track(place, rule);
  const SceneFrame frame = n.frame();
  rule.frame = &frame;
  return pointed_track(place, rule);
}

TrackPtr make(const TrackRecord& r, int depth) {
  using Kind = TrackRecord::Kind;
  if (depth > kDeepest) throw Error("a stored motion is nested too deeply");
  const size_t parts = r.parts.size();
  const bool right = r.kind == Kind::composed  ? parts == 2
                     : r.kind == Kind::pointed ? parts == 1 || parts == 2
                     : r.kind == Kind::ending  ? parts == 1
                                               : parts == 0;
  if (!right) throw Error("a stored motion has the wrong number of parts");
  Numbers n(r);
  TrackPtr made;
  switch (r.kind) {
    case Kind::fixed:
      made = static_track(n.pose());
      break;
    case Kind::keyframes:
      made = make_keyframes(n);
      break;
    case Kind::straight:
      made = make_straight(n);
      break;
    case Kind::circle:
      made = make_circle(n);
      break;
    case Kind::spin:
      made = make_spin(n);
      break;
    case Kind::composed:
      made = composed_track(make(r.parts[0], depth + 1), make(r.parts[1], depth + 1));
      break;
    case Kind::orbit:
      made = make_orbit(n, r.text);
      break;
    case Kind::pointed:
      made = make_pointed(n, r, depth);
      break;
    case Kind::ending:
      made = ending_track(make(r.parts[0], depth + 1));
      break;
    case Kind::interpolated:
    case Kind::hermite:
      made = make_interpolated(n, r.kind == Kind::hermite);
      break;
    default:
      throw Error("a stored motion is of an unknown kind");
  }
  if (n.more()) throw Error("a stored motion has too many numbers");
  return made;
}

}  // namespace

TrackPtr track_of(const TrackRecord& record) { return make(record, 0); }

}  // namespace suite
