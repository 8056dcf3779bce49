#include "light/kinds/lamp_carriers.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "scene/presence.h"

namespace suite {

namespace {

constexpr size_t kMostCarriers = size_t{1} << 20;
constexpr double kEven = 1e-6;  // relative, of scales that count as equal

// A transform that turns, moves and scales evenly; nothing for others.
struct Similarity {
  Pose pose;
  double scale;
};
std::optional<Similarity> similarity(const Affine3& m) {
  const double determinant = m.determinant();
  if (!(determinant > 0)) return std::nullopt;
  const double scale = std::cbrt(determinant);
  Affine3 turn = m;
  for (double& a : turn.a) a /= scale;
  turn.b = {};
  for (int i = 0; i < 3; ++i) {
    Vec3 axis;
    axis[i] = 1;
    const Vec3 image = turn.vector(axis);
    for (int j = 0; j < 3; ++j) {
      Vec3 other;
      other[j] = 1;
      if (std::fabs(dot(image, turn.vector(other)) - (i == j ? 1 : 0)) > kEven) return std::nullopt;
    }
  }
  return Similarity{{normalized(quat_from_matrix(turn)), m.b}, scale};
}

}  // namespace

bool LampCarriers::has_name(const Placement& p, const std::string& name) const {
  if (p.tag != kNone && scene_.tags[p.tag] == name) return true;
  switch (p.kind) {
    case TargetKind::mesh:
      return scene_.meshes[p.target].name == name;
    case TargetKind::group:
      return scene_.groups[p.target].name == name;
    case TargetKind::primitive:
      return scene_.primitives[p.target].name == name;
  }
  return false;
}

void LampCarriers::walk(uint32_t group, const Carrier& above, const std::string& name, const Where& where,
                        std::vector<uint32_t>& found) {
  for (const Placement& p : scene_.groups[group].placements) {
    const bool named = has_name(p, name);
    if (!named && p.kind != TargetKind::group) continue;
    Carrier here = above;
    if (p.track != kNone || p.schedule != kNone) {
      here.steps.push_back({here.last, p.track, p.schedule});
      here.last = {};
    }
    const auto own = similarity(p.to_parent);
    if (named && (!own || std::fabs(above.scale - 1) > kEven))
      throw Error(where, "'" + name + "', on which a lamp rides, is mirrored, stretched or in a group that is scaled",
                  "turn and move it, or scale it evenly and by itself");
    if (named) {
      if (carriers_.size() >= kMostCarriers)
        throw Error(where, strf("lamps ride on more than %zu placements", kMostCarriers));
      found.push_back(static_cast<uint32_t>(carriers_.size()));
      carriers_.push_back(here);
      carriers_.back().last = here.last * own->pose;
      carriers_.back().scale = own->scale;
    }
    if (p.kind != TargetKind::group) continue;
    // Below what is not just turned and moved nothing carries lamps.
    here.scale *= own ? own->scale : 2;
    if (own) here.last = here.last * own->pose;
    walk(p.target, here, name, where, found);
  }
}

std::vector<uint32_t> LampCarriers::find(const std::string& name, const Where& where) {
  std::vector<uint32_t> found;
  walk(0, {}, name, where, found);
  if (!found.empty()) return found;
  std::set<std::string> known(scene_.tags.begin(), scene_.tags.end());
  for (const Group& g : scene_.groups) known.insert(g.name);
  for (const Mesh& m : scene_.meshes) known.insert(m.name);
  for (const Primitive& p : scene_.primitives) known.insert(p.name);
  throw Error(where, "a lamp rides on '" + name + "', which the scene does not place",
              name_hint(name, std::vector<std::string>(known.begin(), known.end())));
}

std::optional<Pose> LampCarriers::at(uint32_t carrier, double time) const {
  const Carrier& c = carriers_[carrier];
  for (const Step& s : c.steps)
    if (!made_at(scene_, s.track, s.schedule, time)) return std::nullopt;
  Pose pose;
  for (const Step& s : c.steps) {
    pose = pose * s.before;
    if (s.track != kNone) pose = pose * scene_.tracks[s.track].track->at(time);
  }
  return pose * c.last;
}

std::optional<LampCarriers::Sweep> LampCarriers::over(uint32_t carrier, Vec3 point, Dir axis, TimeSpan span) const {
  constexpr int kBetween = 16;
  std::vector<double> times;
  const auto note = [&](TimeSpan s) {
    for (int k = 0; k <= kBetween; ++k) times.push_back(s.begin + (s.end - s.begin) * k / kBetween);
  };
  note(span);
  for (const Step& s : carriers_[carrier].steps) {
    const Presence there = presence(scene_, s.track, s.schedule, {}, span);
    if (!there.any) return std::nullopt;
    if (!there.all) note(there.hull);
    if (s.track == kNone) continue;
    const std::vector<double> kinks = scene_.tracks[s.track].track->kinks(span);
    times.insert(times.end(), kinks.begin(), kinks.end());
  }
  std::sort(times.begin(), times.end());
  Sweep sweep;
  std::optional<Vec3> last;
  std::vector<Dir> axes;
  double gap = 0, between = 0;
  for (const double t : times) {
    const auto pose = at(carrier, t);
    if (!pose) continue;
    const Vec3 here = pose->point(point);
    const Dir towards = pose->vector(axis);
    if (last)
      gap = std::max(gap, length(here - *last)), between = std::max(between, angle_between(axes.back(), towards));
    last = here;
    axes.push_back(towards);
    sweep.box.grow(here);
  }
  if (axes.empty()) return std::nullopt;
  sweep.axis = axes[axes.size() / 2];
  for (const Dir& a : axes) sweep.turn = std::max(sweep.turn, angle_between(a, sweep.axis));
  sweep.turn += between;
  sweep.box.low -= {gap, gap, gap};
  sweep.box.high += {gap, gap, gap};
  return sweep;
}

}  // namespace suite
