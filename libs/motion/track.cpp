#include "motion/track.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "motion/track_record.h"
#include "motion/ut1.h"

namespace suite {

namespace {

void need_finite(bool ok, const char* what) {
  if (!ok) throw Error(std::string("a track's ") + what + " is not finite");
}

bool finite(const Quat& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

void check_pose(const Pose& p, const char* what) {
  need_finite(finite(p.translation) && finite(p.rotation), what);
  if (!(std::fabs(dot(p.rotation, p.rotation) - 1) < 1e-6))
    throw Error(std::string("a track's ") + what + " has a rotation that is no unit quaternion");
}

// The rotation whose columns are the given right-handed orthonormal axes.
Quat rotation_of(Vec3 x, Vec3 y, Vec3 z) {
  return quat_from_matrix({{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}, {}});
}

class Static final : public Track {
 public:
  explicit Static(const Pose& pose) : pose_(pose) { check_pose(pose, "pose"); }
  Pose at(double) const override { return pose_; }
  Vec3 velocity(double) const override { return {}; }
  TrackRecord record() const override {
    TrackRecord r;
    record::put(r.numbers, pose_);
    return r;
  }

 private:
  Pose pose_;
};

class Keyframes final : public Track {
 public:
  explicit Keyframes(std::vector<PoseKey> keys) : keys_(std::move(keys)) {
    if (keys_.empty()) throw Error("a track without a single keyframe", "give at least one time and pose");
    for (size_t i = 0; i < keys_.size(); ++i) {
      need_finite(std::isfinite(keys_[i].time), "time");
      check_pose(keys_[i].pose, "pose");
      keys_[i].pose.rotation = normalized(keys_[i].pose.rotation);
      if (i > 0 && !(keys_[i].time > keys_[i - 1].time))
        throw Error(strf("keyframe %zu at %.9g s does not come after the one at %.9g s", i + 1, keys_[i].time,
                         keys_[i - 1].time),
                    "times must ascend");
    }
  }
  Pose at(double t) const override {
    check_time(t);
    const auto after =
        std::upper_bound(keys_.begin(), keys_.end(), t, [](double x, const PoseKey& k) { return x < k.time; });
    if (after == keys_.end()) return keys_.back().pose;
    const PoseKey &b = *after, &a = *(after - 1);
    return sclerp(a.pose, b.pose, (t - a.time) / (b.time - a.time));
  }
  TimeSpan covered() const override { return {keys_.front().time, keys_.back().time}; }
  std::vector<double> kinks(TimeSpan span) const override {
    std::vector<double> times;
    for (const PoseKey& k : keys_)
      if (k.time > span.begin && k.time < span.end) times.push_back(k.time);
    return times;
  }
  TrackRecord record() const override {
    TrackRecord r{TrackRecord::Kind::keyframes, {}, {}, {}};
    for (const PoseKey& k : keys_) r.numbers.push_back(k.time), record::put(r.numbers, k.pose);
    return r;
  }

 private:
  std::vector<PoseKey> keys_;
};

class Straight final : public Track {
 public:
  explicit Straight(const StraightMotion& m) : m_(m) {
    need_finite(finite(m.start) && std::isfinite(m.azimuth) && std::isfinite(m.t0), "start");
    if (!(m.speed >= 0 && m.speed <= 1e6))
      throw Error(strf("a speed of %g m/s is outside its range", m.speed), "0 to 1e6 m/s");
    if (!(std::fabs(m.climb) <= kPi / 2))
      throw Error(strf("a climb of %g rad is outside its range", m.climb), "within a right angle");
    direction_ =
        Vec3{std::cos(m.climb) * std::cos(m.azimuth), std::cos(m.climb) * std::sin(m.azimuth), std::sin(m.climb)};
    rotation_ = platform_rotation(m.azimuth, m.climb, 0);
    if (m.curved) {
      frame_.emplace(*m.curved);
      local_.emplace(m.curved->geodetic_from_enu(m.start));
      to_scene_ = m.curved->to_ecef().inverse() * local_->to_ecef();
      to_scene_.translation = m.start;  // what it is, without the round trip through the Earth's centre
    }
    m_.curved = nullptr;
  }
  Pose at(double t) const override {
    const Vec3 way = direction_ * (m_.speed * (t - m_.t0));
    if (!local_) return {rotation_, m_.start + way};
    return to_scene_ * Pose{local_->curved_rotation(way) * rotation_, local_->curved(way)};
  }
  Vec3 velocity(double t) const override { return local_ ? Track::velocity(t) : direction_ * m_.speed; }
  TrackRecord record() const override {
    TrackRecord r{TrackRecord::Kind::straight,
                  {m_.start.x, m_.start.y, m_.start.z, m_.azimuth, m_.climb, m_.speed, m_.t0},
                  {},
                  {}};
    if (frame_) record::put(r.numbers, *frame_);
    return r;
  }

 private:
  StraightMotion m_;
  Vec3 direction_;
  Quat rotation_;
  std::optional<SceneFrame> frame_, local_;  // of the scene; of the start
  Pose to_scene_;
};

class Circle final : public Track {
 public:
  explicit Circle(const CircleMotion& m) : m_(m), turn_(m.clockwise ? -1 : 1) {
    need_finite(finite(m.center) && std::isfinite(m.azimuth) && std::isfinite(m.bank) && std::isfinite(m.t0), "circle");
    if (!(m.radius > 0 && m.radius <= 1e8))
      throw Error(strf("a circle of radius %g m", m.radius), "more than 0, at most 1e8 m");
    if (!(m.speed > 0 && m.speed <= 1e6))
      throw Error(strf("a circling speed of %g m/s", m.speed), "more than 0, at most 1e6 m/s");
  }
  Pose at(double t) const override {
    const double a = angle(t);
    // The right side goes down in a clockwise turn, the left one in the other.
    return {platform_rotation(a + turn_ * kPi / 2, 0, -turn_ * m_.bank),
            m_.center + Vec3{std::cos(a), std::sin(a), 0} * m_.radius};
  }
  Vec3 velocity(double t) const override {
    const double a = angle(t);
    return Vec3{-std::sin(a), std::cos(a), 0} * (turn_ * m_.speed);
  }
  TrackRecord record() const override {
    const double clockwise = m_.clockwise ? 1 : 0;
    return {TrackRecord::Kind::circle,
            {m_.center.x, m_.center.y, m_.center.z, m_.radius, m_.speed, m_.azimuth, m_.bank, m_.t0, clockwise},
            {},
            {}};
  }

 private:
  double angle(double t) const { return m_.azimuth + turn_ * m_.speed / m_.radius * (t - m_.t0); }
  CircleMotion m_;
  double turn_;
};

class Spin final : public Track {
 public:
  explicit Spin(const SpinMotion& m) : m_(m) {
    check_pose(m.base, "base pose");
    need_finite(finite(m.through) && std::isfinite(m.rate) && std::isfinite(m.t0), "spin");
    if (!(length(m.axis) > 0) || !finite(m.axis))
      throw Error("a track turns about an axis of no direction", "give a vector that is not 0");
    m_.axis = normalized(m.axis);
  }
  Pose at(double t) const override {
    const Quat q = turned(t);
    return m_.base * Pose{q, m_.through - rotate(q, m_.through)};
  }
  Vec3 velocity(double t) const override {
    return m_.base.vector(cross(m_.axis * m_.rate, rotate(turned(t), -m_.through)));
  }
  TrackRecord record() const override {
    TrackRecord r{TrackRecord::Kind::spin, {}, {}, {}};
    record::put(r.numbers, m_.base);
    for (const double x : {m_.axis.x, m_.axis.y, m_.axis.z, m_.through.x, m_.through.y, m_.through.z, m_.rate, m_.t0})
      r.numbers.push_back(x);
    return r;
  }

 private:
  // Whole turns are taken off first, so that long times keep their digits.
  Quat turned(double t) const { return quat_about(m_.axis, std::remainder(m_.rate * (t - m_.t0), 2 * kPi)); }
  SpinMotion m_;
};

class Orbit final : public Track {
 public:
  Orbit(std::shared_ptr<const Sgp4> orbit, const SceneFrame& frame, const Clock& clock, double dut1)
      : orbit_(std::move(orbit)), frame_(frame), clock_(clock), dut1_(dut1) {
    SUITE_CHECK(orbit_ != nullptr);
    if (!(std::fabs(dut1) <= 0.9)) throw Error(strf("dut1 = %g s is outside its range", dut1), "give -0.9 to 0.9 s");
  }
  Pose at(double t) const override {
    const OrbitState s = state(t);
    const Vec3 up = frame_.local_axes(s.position).z;
    const Frame f = Frame::with_tangent(up, s.velocity);  // x along the track
    return {rotation_of(-f.y, f.x, f.z), s.position};
  }
  Vec3 velocity(double t) const override { return state(t).velocity; }

  TrackRecord record() const override {
    const OrbitElements& e = orbit_->elements();
    TrackRecord r{TrackRecord::Kind::orbit, {}, e.satellite, {}};
    record::put(r.numbers, e.epoch);
    for (const double x :
         {e.inclination, e.ascending_node, e.eccentricity, e.perigee_argument, e.mean_anomaly, e.mean_motion, e.drag})
      r.numbers.push_back(x);
    record::put(r.numbers, frame_);
    record::put(r.numbers, clock_.utc(0));
    r.numbers.push_back(dut1_);
    return r;
  }

 private:
  OrbitState state(double t) const {
    const Instant instant = clock_.at(t);
    const OrbitState s = earth_fixed_from_teme(orbit_->at(instant), instant, dut1_at(instant, clock_.at(0), dut1_));
    return {frame_.enu_from_ecef(s.position), frame_.enu_direction(s.velocity)};
  }
  std::shared_ptr<const Sgp4> orbit_;
  SceneFrame frame_;
  Clock clock_;
  double dut1_;
};

class Pointed final : public Track {
 public:
  Pointed(TrackPtr place, const PointingRule& rule) : place_(std::move(place)), kind_(rule.kind), target_(rule.target) {
    SUITE_CHECK(place_ != nullptr);
    if (kind_ == Pointing::look_at && !target_)
      throw Error("look-at without a target", "give the place or track to look at");
    if (rule.frame) frame_.emplace(*rule.frame);
  }
  Pose at(double t) const override {
    const Vec3 here = place_->at(t).translation;
    const Frame local = frame_ ? frame_->local_axes(here) : Frame{};
    switch (kind_) {
      case Pointing::look_at:
        return {looking(target_->at(t).translation - here, local), here};
      case Pointing::nadir:
        return {downwards(place_->velocity(t), local), here};
      case Pointing::velocity:
        return {forwards(place_->velocity(t), local, t), here};
    }
    throw_bug(__FILE__, __LINE__, "a pointing that does not exist", "");
  }
  Vec3 velocity(double t) const override { return place_->velocity(t); }
  TimeSpan covered() const override {
    const TimeSpan a = place_->covered();
    if (!target_) return a;
    const TimeSpan b = target_->covered();
    return {std::fmax(a.begin, b.begin), std::fmin(a.end, b.end)};
  }
  std::vector<double> kinks(TimeSpan span) const override {
    std::vector<double> times = place_->kinks(span), all;
    const std::vector<double> more = target_ ? target_->kinks(span) : std::vector<double>{};
    std::merge(times.begin(), times.end(), more.begin(), more.end(), std::back_inserter(all));
    return all;
  }

  TrackRecord record() const override {
    TrackRecord r{TrackRecord::Kind::pointed, {static_cast<double>(kind_)}, {}, {place_->record()}};
    if (target_) r.parts.push_back(target_->record());
    if (frame_) record::put(r.numbers, *frame_);
    return r;
  }

 private:
  static Quat looking(Vec3 to, const Frame& local) {
    const double distance = length(to);
    if (!(distance > 0)) throw Error("a track looks at a target in its own place");
    const Vec3 z = to / -distance;
    // y as nearly up as it can be; north takes the place of up when the view is vertical.
    Vec3 y = local.z - z * dot(local.z, z);
    if (!(length(y) > 1e-9)) y = local.y - z * dot(local.y, z);
    y = normalized(y);
    return rotation_of(cross(y, z), y, z);
  }
  static Quat downwards(Vec3 velocity, const Frame& local) {
    Vec3 y = velocity - local.z * dot(velocity, local.z);
    y = length(y) > 1e-9 * length(velocity) && length(y) > 0 ? normalized(y) : local.y;
    return rotation_of(cross(y, local.z), y, local.z);
  }
  static Quat forwards(Vec3 velocity, const Frame& local, double t) {
    const double speed = length(velocity);
    if (!(speed > 0)) throw Error(strf("a track is to point along its velocity but is at rest at %g s", t));
    const Vec3 y = velocity / speed;
    Vec3 z = local.z - y * dot(local.z, y);
    if (!(length(z) > 1e-9)) z = local.y - y * dot(local.y, y);
    z = normalized(z);
    return rotation_of(cross(y, z), y, z);
  }
  TrackPtr place_;
  Pointing kind_;
  TrackPtr target_;
  std::optional<SceneFrame> frame_;
};

}  // namespace

Vec3 Track::velocity(double t) const {
  check_time(t);
  const TimeSpan c = covered();
  const double h = std::fmin(1e-3, (c.end - c.begin) / 4);
  if (!(h > 0)) return {};
  auto place = [&](double k) { return at(std::clamp(t + k * h, c.begin, c.end)).translation; };
  const double side = t - c.begin < 2 * h ? 1 : c.end - t < 2 * h ? -1 : 0;
  if (side == 0) return (place(-2) - place(-1) * 8 + place(1) * 8 - place(2)) / (12 * h);
  const Vec3 p0 = place(0);
  return ((place(side) - p0) * 48 - (place(2 * side) - p0) * 36 + (place(3 * side) - p0) * 16 -
          (place(4 * side) - p0) * 3) /
         (12 * h * side);
}

TimeSpan Track::covered() const {
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

std::vector<double> Track::kinks(TimeSpan) const { return {}; }

TrackRecord Track::record() const { throw Error("this kind of motion cannot be stored"); }

void Track::check_time(double t) const {
  const TimeSpan c = covered();
  if (!c.contains(t))
    throw Error(strf("a motion is asked for at %.9g s", t), strf("it covers %.9g to %.9g s", c.begin, c.end));
}

TrackPtr static_track(const Pose& pose) { return std::make_shared<Static>(pose); }
TrackPtr keyframe_track(std::vector<PoseKey> keys) { return std::make_shared<Keyframes>(std::move(keys)); }
TrackPtr straight_track(const StraightMotion& motion) { return std::make_shared<Straight>(motion); }
TrackPtr circle_track(const CircleMotion& motion) { return std::make_shared<Circle>(motion); }
TrackPtr spin_track(const SpinMotion& motion) { return std::make_shared<Spin>(motion); }
TrackPtr orbit_track(std::shared_ptr<const Sgp4> orbit, const SceneFrame& frame, const Clock& clock, double dut1) {
  return std::make_shared<Orbit>(std::move(orbit), frame, clock, dut1);
}
TrackPtr pointed_track(TrackPtr place, const PointingRule& rule) {
  return std::make_shared<Pointed>(std::move(place), rule);
}

}  // namespace suite
