// What moves in a time window: poses at keys, boxes over time, tiles.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/placed.h"
#include "motion/track.h"
#include "trace/arrange.h"
#include "trace/embree_internal.h"

namespace suite {

double motion_bound(double radius) { return std::clamp(1e-5 * radius, 1e-12, 1e-4); }

Affine3 MovingPart::Keys::at(double time) const {
  if (poses.size() == 1) return poses.front();
  const Stretch* s = &stretches.front();
  if (stretches.size() > 1) {
    const auto after = std::upper_bound(stretches.begin(), stretches.end(), time,
                                        [](double t, const Stretch& x) { return t < x.begin; });
    s = &*(after == stretches.begin() ? after : after - 1);
  }
  if (s->count == 1) return poses[s->first];
  const double segments = static_cast<double>(s->count - 1);
  const double x = std::clamp((time - s->begin) / (s->end - s->begin) * segments, 0.0, segments);
  const size_t i = std::min(static_cast<size_t>(x), s->count - 2);
  const double w = x - static_cast<double>(i), v = 1 - w;
  const Affine3 &a = poses[s->first + i], &b = poses[s->first + i + 1];
  Affine3 r;
  for (size_t k = 0; k < 9; ++k) r.a[k] = a.a[k] * v + b.a[k] * w;
  r.b = a.b * v + b.b * w;
  return r;
}

float MovingPart::fraction(double time) const {
  return window.end > window.begin
             ? static_cast<float>(std::clamp((time - window.begin) / (window.end - window.begin), 0.0, 1.0))
             : 0.0f;
}

bool MovingPart::there(uint32_t object, double time) const {
  return world.there(world.flat.objects[object].node, std::clamp(time, window.begin, window.end));
}

namespace {

// Error: more than can be held, with the motion's name, which says where it is written.
size_t steps_of(const World& world, uint32_t node, const MovingFrame& frame, TimeSpan span, double radius,
                double bound) {
  try {
    return time_steps_for(frame, {}, span, radius, bound);
  } catch (const Error& e) {
    std::string names;
    for (uint32_t n = node; n != kNone; n = world.flat.nodes[n].parent)
      if (const uint32_t track = world.flat.nodes[n].track; track != kNone)
        names += (names.empty() ? "" : " in that of ") + world.scene->tracks[track].name;
    throw placed(e, {}, "the motion of " + names + ": ");
  }
}

}  // namespace

MovingPart::Keys MovingPart::keys_of(const World& world, TimeSpan whole, uint32_t node, double radius) {
  Keys keys;
  keys.radius = radius;
  keys.used = true;
  // Poses are known while it is there; before and after, rays do not meet it wherever it is.
  const Presence present = world.presence_of(node, whole);
  if (!present.any) return keys;
  keys.partly = !present.all;
  const TimeSpan window = present.hull;
  // Double cannot place far things better than this.
  const double bound = motion_bound(radius) + 1e-13 * length(world.pose(node, window.begin).b);
  if (window.end > window.begin) keys.bound = bound;
  std::vector<double> times{window.begin};
  for (uint32_t n = node; n != kNone; n = world.flat.nodes[n].parent)
    if (const uint32_t track = world.flat.nodes[n].track; track != kNone)
      for (const double t : world.scene->tracks[track].track->kinks(window)) times.push_back(t);
  times.push_back(window.end);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const MovingFrame frame = [&](double t) { return world.pose(node, t); };
  for (size_t i = 0; i + 1 < std::max<size_t>(times.size(), 2); ++i) {
    const TimeSpan span{times[i], times[std::min(i + 1, times.size() - 1)]};
    const std::vector<Affine3> poses = time_keys(frame, span, steps_of(world, node, frame, span, radius, bound));
    keys.stretches.push_back({span.begin, span.end, keys.poses.size(), poses.size()});
    keys.poses.insert(keys.poses.end(), poses.begin(), poses.end());
  }
  // At rest after all: one pose.
  if (std::all_of(keys.poses.begin(), keys.poses.end(), [&](const Affine3& a) { return a == keys.poses.front(); })) {
    keys.poses.resize(1);
    keys.stretches = {{window.begin, window.end, 0, 1}};
  }
  return keys;
}

std::vector<Box3> boxes_over(const MovingPart::Keys& keys, TimeSpan window, const Box3& box) {
  // The box at a time is exact at keys and at the times asked for; between them the corners run straight.
  std::vector<double> knots;
  for (const MovingPart::Stretch& s : keys.stretches)
    for (size_t i = 0; i < s.count; ++i)
      knots.push_back(s.count == 1
                          ? s.begin
                          : s.begin + (s.end - s.begin) * static_cast<double>(i) / static_cast<double>(s.count - 1));
  const auto at = [&](double t) { return enlarged(transformed(box, keys.at(t)), keys.bound); };
  std::vector<Box3> boxes{at(window.begin)};
  if (keys.at_rest() || window.begin == window.end) return boxes;
  const double size = length(boxes[0].size());
  double way = 0;  // how far the middle goes
  for (size_t i = 1; i < knots.size(); ++i) way += length(at(knots[i]).center() - at(knots[i - 1]).center());
  for (const size_t times : {1, 2, 5, 17, 65}) {
    const double segments = std::max(1.0, static_cast<double>(times - 1));
    boxes.clear();
    for (size_t k = 0; k < times; ++k)
      boxes.push_back(at(window.begin + (window.end - window.begin) * static_cast<double>(k) / segments));
    double excess = 0;
    Box3 all;
    for (const double t : knots) {
      const Box3 b = at(t);
      all.grow(b);
      const double x = std::clamp((t - window.begin) / (window.end - window.begin) * segments, 0.0, segments);
      const size_t i = std::min(static_cast<size_t>(x), boxes.size() - (times > 1 ? 2 : 1));
      const Box3 &c = boxes[i], &d = boxes[times > 1 ? i + 1 : i];
      const double w = times > 1 ? x - static_cast<double>(i) : 0;
      const Vec3 low = c.low * (1 - w) + d.low * w - b.low, high = b.high - c.high * (1 - w) - d.high * w;
      excess = std::max({excess, low.x, low.y, low.z, high.x, high.y, high.z});
    }
    if (times == 1) {
      if (length(all.size()) > 1.5 * size) continue;
      all.grow(at(window.end));
      return {all};
    }
    if (excess > 0.25 * size && times < 65) continue;
    // The ray's time is a float fraction of the window.
    for (Box3& b : boxes) b = enlarged(b, excess + 2.4e-7 * (way + size));
    break;
  }
  return boxes;
}

MovingPart::MovingPart(const World& w, TimeSpan span) : world(w), window(span) {
  const size_t first = w.flat.fixed, count = w.flat.objects.size() - first;
  check_motion(*w.scene, span.begin, span.end, {});
  std::vector<double> radius(w.flat.nodes.size(), -1);  // of what hangs on a node itself; negative: nothing does
  std::vector<Box3> own(count);                         // in the axes of the node
  for (size_t i = 0; i < count; ++i) {
    const PlacedObject& o = w.flat.objects[first + i];
    own[i] = transformed(w.local_box(w.flat, first + i), *o.place);
    if (own[i].empty())
      radius[o.node] = std::max(radius[o.node], 10.0);  // without bounds: motion_bound is at its largest
    if (own[i].empty()) continue;
    const Vec3 a = own[i].low, b = own[i].high;
    radius[o.node] =
        std::max(radius[o.node], length(Vec3{std::fmax(-a.x, b.x), std::fmax(-a.y, b.y), std::fmax(-a.z, b.z)}));
  }
  nodes.resize(w.flat.nodes.size());
  parallel_for(0, nodes.size(), 16, [&](size_t b, size_t e) {
    for (size_t n = b; n < e; ++n)
      if (radius[n] >= 0) nodes[n] = keys_of(w, span, static_cast<uint32_t>(n), radius[n]);
  });
  std::vector<std::vector<Box3>> over(count);
  std::vector<Box3> whole(count);
  parallel_for(0, count, 64, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) {
      if (own[i].empty() || nodes[w.flat.objects[first + i].node].absent()) continue;
      over[i] = boxes_over(nodes[w.flat.objects[first + i].node], window, own[i]);
      for (const Box3& box : over[i]) whole[i].grow(box);
    }
  });
  std::vector<uint32_t> members;
  for (uint32_t i = 0; i < count; ++i) {
    if (nodes[w.flat.objects[first + i].node].absent()) continue;
    bounds.grow(whole[i]);
    if (!over[i].empty())
      members.push_back(i);
    else if (w.flat.objects[first + i].primitive != kNone)
      unbounded.push_back(static_cast<uint32_t>(first) + i);
  }
  const auto heavy = [](uint32_t) { return false; };
  arrange(tiles, members, whole, heavy, [&](Tile& tile, std::span<const uint32_t> mine) { fill(tile, mine, over); });
  for (const auto& tile : tiles.tiles)
    for (const auto& set : tile->sets)
      for (Box3& b : set->boxes) b = enlarged(b, tile->slack());
  tiles.close(world);
}

// One set for what rests in this window, and one for each number of times; others for what is there only partly.
void MovingPart::fill(Tile& tile, std::span<const uint32_t> members, std::span<const std::vector<Box3>> boxes) {
  std::map<std::tuple<bool, bool, size_t>, std::unique_ptr<PlacedSet>> sets;
  for (const uint32_t i : members) {
    const uint32_t object = static_cast<uint32_t>(world.flat.fixed) + i;
    const Keys& keys = nodes[world.flat.objects[object].node];
    const bool group = world.flat.shared_of(object) != kNone;
    std::unique_ptr<PlacedSet>& set = sets[{group, keys.partly, keys.at_rest() ? 0 : boxes[i].size()}];
    if (!set) {
      set = std::make_unique<PlacedSet>();
      set->world = &world, set->frame = &world.flat, set->groups = group;
      set->moving = this;
      set->partly = keys.partly;
      set->origin = tile.origin;
      set->times = static_cast<unsigned>(boxes[i].size());
    }
    set->objects.push_back(object);
    set->boxes.insert(set->boxes.end(), boxes[i].begin(), boxes[i].end());
  }
  for (auto& [kind, set] : sets) {
    if (std::get<2>(kind) == 0) set->fill_inverse();
    tile.sets.push_back(std::move(set));
  }
}

}  // namespace suite
