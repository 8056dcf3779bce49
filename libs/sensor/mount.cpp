#include "sensor/mount.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

Dir axis_named(const Params& p) {
  const auto axis = p.find("axis");
  switch (axis ? axis->as_choice({"across", "along", "vertical"}) : 0) {
    case 0:
      return {0, 1, 0};  // turning about the forward axis sweeps the view across the track
    case 1:
      return {1, 0, 0};
    default:
      return {0, 0, 1};
  }
}

struct Fixed final : Mount {
  Quat at(double, const Pose&) const override { return rotation; }
  Quat rotation;
};

// Back and forth: sine or triangle.
struct Whisk final : Mount {
  Quat at(double t, const Pose&) const override {
    const double phase = rate * (t - start) + offset, turn = phase - std::floor(phase);
    const double swing = sine          ? std::sin(2 * kPi * turn)
                         : turn < 0.25 ? 4 * turn
                         : turn < 0.75 ? 2 - 4 * turn
                                       : 4 * turn - 4;
    return quat_about(axis, center + amplitude * swing);
  }
  Dir axis;
  double amplitude = 0, center = 0, rate = 1, offset = 0, start = 0;
  bool sine = true;
};

// One way at constant rate, again and again.
struct LineScan final : Mount {
  Quat at(double t, const Pose&) const override {
    const double since = t - start, within = period > 0 ? since - period * std::floor(since / period) : since;
    return quat_about(axis, begin + rate * within);
  }
  Dir axis;
  double begin = 0, rate = 0, period = 0, start = 0;
};

struct Tabulated final : Mount {
  Quat at(double t, const Pose&) const override {
    const size_t i = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
    if (i == 0) return rotations.front();
    if (i == times.size()) return rotations.back();
    const double s = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return sclerp({rotations[i - 1], {}}, {rotations[i], {}}, s).rotation;
  }
  TimeSpan covered() const override { return {times.front(), times.back()}; }
  std::vector<double> times;
  std::vector<Quat> rotations;
};

struct LookAt final : Mount {
  Quat at(double t, const Pose& carrier) const override {
    const Vec3 to = target->at(t).translation - carrier.translation;
    if (!(length(to) > 0)) throw Error("a mount's target is in the mount's own place", "give another target");
    const Dir z = -normalized(to);
    // The picture's top is as nearly up as it can be; looking straight down it is the carrier's forward axis.
    const bool down = std::fabs(z.z) > 1 - 1e-9;
    const Vec3 up = down ? carrier.vector({0, 1, 0}) : Vec3{0, 0, 1};
    const Dir x = normalized(cross(up, z)), y = cross(z, x);
    const Affine3 world{{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}, {}};
    return carrier.rotation.conjugate() * quat_from_matrix(world);
  }
  TimeSpan covered() const override { return target->covered(); }
  TrackPtr target;
};

Quat rotation_of(const std::array<double, 3>& deg) {
  return quat_about({0, 0, 1}, deg[2] * kDegree) * quat_about({0, 1, 0}, deg[1] * kDegree) *
         quat_about({1, 0, 0}, deg[0] * kDegree);
}

std::unique_ptr<Mount> read_tabulated(const Params& m) {
  auto t = std::make_unique<Tabulated>();
  t->times = m.at("times_s").as_numbers();
  const std::vector<Params> rows = m.at("rotate_deg").items();
  if (t->times.empty() || rows.size() != t->times.size())
    throw m.error("a tabulated mount needs as many rotations as times", "rotate_deg: [[x, y, z], ...]");
  for (size_t i = 1; i < t->times.size(); ++i)
    if (!(t->times[i] > t->times[i - 1])) throw m.at("times_s").error("the times do not ascend");
  for (const Params& r : rows) t->rotations.push_back(rotation_of(r.as_vec3()));
  return t;
}

}  // namespace

TimeSpan Mount::covered() const { return {-kForever, kForever}; }

std::unique_ptr<Mount> read_mount(const Params& params, const SensorContext& context) {
  const auto m = params.find("mount");
  if (!m) return nullptr;
  switch (m->at("kind").as_choice({"static", "whisk", "line_scan", "tabulated", "look_at"})) {
    case 0: {
      auto fixed = std::make_unique<Fixed>();
      if (const auto r = m->find("rotate_deg")) fixed->rotation = rotation_of(r->as_vec3());
      return fixed;
    }
    case 1: {
      auto w = std::make_unique<Whisk>();
      w->axis = axis_named(*m);
      w->amplitude = m->number_in("amplitude_deg", 0, 180, "degrees") * kDegree;
      w->center = m->number_in("center_deg", -180, 180, "degrees", 0) * kDegree;
      w->rate = m->number_in("rate_hz", 1e-9, 1e9, "Hz");
      w->offset = m->number_in("phase_deg", -360, 360, "degrees", 0) / 360;
      w->start = m->number("start_s", 0);
      const auto shape = m->find("shape");
      w->sine = !shape || shape->as_choice({"sine", "triangle"}) == 0;
      return w;
    }
    case 2: {
      auto s = std::make_unique<LineScan>();
      s->axis = axis_named(*m);
      s->begin = m->number_in("start_deg", -360, 360, "degrees") * kDegree;
      s->rate = m->number_in("rate_deg_s", -1e6, 1e6, "degrees/s") * kDegree;
      s->period = m->number_in("period_s", 0, 1e6, "s", 0);
      s->start = m->number("start_s", 0);
      return s;
    }
    case 3:
      return read_tabulated(*m);
    default: {
      if (!context.track) throw m->error("motions cannot be read here");
      auto l = std::make_unique<LookAt>();
      const Params target = m->at("target");
      l->target = target.has("kind") ? context.track(target) : static_track({{}, context.position(target)});
      return l;
    }
  }
}

Pose Attachment::at(double t, const Pose& carrier, const JitterWindow* table) const {
  Pose pose = carrier * fixed;
  if (mount) pose.rotation = pose.rotation * mount->at(t, pose);
  if (table)
    pose = pose * table->pose(t);
  else if (jitter)
    pose = pose * jitter->pose(t);
  return pose;
}

Attachment read_attachment(const Params& p, const SensorContext& context, uint64_t seed) {
  Attachment a;
  if (const auto offset = p.find("offset_m")) {
    const auto [x, y, z] = offset->as_vec3();
    a.fixed.translation = {x, y, z};
  }
  if (const auto r = p.find("rotate_deg")) a.fixed.rotation = rotation_of(r->as_vec3());
  a.mount = read_mount(p, context);
  if (const auto j = p.find("jitter")) {
    if (!context.jitter) throw j->error("jitter cannot be read here");
    auto jitter = std::make_shared<Jitter>(context.jitter(*j, seed));
    if (!jitter->still()) a.jitter = std::move(jitter);
  }
  return a;
}

}  // namespace suite
