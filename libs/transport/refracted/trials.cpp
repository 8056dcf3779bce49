// Random starts of refracted/sight.h, until one finds the same way again.
#include <bit>
#include <cmath>
#include <limits>

#include "transport/refracted/sight.h"

namespace suite {

namespace {

// Most nodes have no way, and pay for a whole trial to know it: a walk is dear, a start that meets no interface is not.
constexpr int kMostStarts = 8;          // of a trial
constexpr int kMostMirroredStarts = 2;  // the same, of ways with reflections: they are weak
constexpr int kMostWalks = 1;           // of these: that pass an interface and run towards the light

}  // namespace

// A start from the straight line towards the light: itself where it leaves a second interface, else what a flat
// interface where it meets the first one would make of it. None where it meets none.
auto RefractedSight::look_straight(RefractedSearch& s) -> Turn {
  s.at = At::straight;
  s.guessed.reset();
  const Dir to = s.straight;
  s.leg.begin(s.node.hit ? surface_.tracer().leave(*s.node.hit, to) : s.node.place, to, s.node.time, s.node.draw);
  return Turn::waits;
}

auto RefractedSight::met_straight(RefractedSearch& s, const Hit& hit) -> Turn {
  if (!hit.hit() || hit.distance >= s.distance || !interfaces_.has(surface_.material(hit))) return look_for(s, false);
  s.met = hit;
  s.guessed = s.straight;
  return shoot(s, At::through, s.straight, {}, Role::probe);
}

auto RefractedSight::bend_straight(RefractedSearch& s, bool through) -> Turn {
  if (through && s.of(Role::probe).way.events > 1) return look_for(s, false);
  const Dir to = s.straight;
  surface_.interact(s.met, -to, at_, s.node.time);
  const double index = interfaces_.index(surface_.material(s.met), s.knot);
  // Met from behind: the light comes from the front, and the node lies in what is behind.
  const auto inside = unbent(to, at_.frame.z, dot(to, s.met.normal) > 0 ? 1 / index : index);
  if (inside) s.guessed = inside;
  return look_for(s, false);
}

Dir RefractedSight::draw_at_object(RefractedSearch& s) const {
  const WayStart& node = s.node;
  const auto which = static_cast<size_t>(random(s) * static_cast<double>(objects_.size()));
  const Refractor& object = objects_[std::min(which, objects_.size() - 1)];
  const Box3 box =
      object.moves == kNone ? object.box : placed(object.box, surface_.tracer().to_world(object.moves, node.time));
  const double how = random(s), u = random(s), v = random(s), w = random(s);
  const auto evenly = [&](Dir axis, double least) {  // over a cone
    const double c = 1 - u * (1 - least), r = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * v;
    return Frame::around(axis).to_world({r * std::cos(phi), r * std::sin(phi), c});
  };
  if (box.empty()) return evenly({0, 0, 1}, -1);
  const Vec3 size = box.size();
  if (how < 0.5) {
    const Vec3 way = box.low + Vec3{u * size.x, v * size.y, w * size.z} - node.place;
    const double len = length(way);
    if (len > 0) return way / len;
  }
  const Vec3 middle = box.center() - node.place;
  const double far = length(middle), radius = 0.5 * length(size);
  if (!(far > radius)) return evenly({0, 0, 1}, -1);
  return evenly(middle / far, std::sqrt(1 - (radius / far) * (radius / far)));
}

Dir RefractedSight::draw_start(RefractedSearch& s) const {
  constexpr double kAsGuessed = 0.2, kAboutIt = 0.75, kDecades = 2;
  const double how = random(s);
  if (!s.guessed || how > kAboutIt) return draw_at_object(s);
  if (how < kAsGuessed) return *s.guessed;
  const double width = std::pow(10.0, -kDecades * random(s)), r = width * std::sqrt(-2 * std::log(1 - random(s))),
               phi = 2 * kPi * random(s);
  const Frame about = Frame::around(*s.guessed);
  return normalized(about.z + about.x * (r * std::cos(phi)) + about.y * (r * std::sin(phi)));
}

// Of the ways with or without reflections.
auto RefractedSight::look_for(RefractedSearch& s, bool mirrored) -> Turn {
  s.mirrored = mirrored;
  s.found = Role::first;
  s.starts = s.walks = 0;
  return next_start(s);
}

// A trial: the way that one of a few random starts leads to.
auto RefractedSight::next_start(RefractedSearch& s) -> Turn {
  constexpr double kReflects = 0.4;
  if (s.starts == (s.mirrored ? kMostMirroredStarts : kMostStarts) || s.walks == kMostWalks) return tried(s, false);
  ++s.starts;
  s.start = draw_start(s);
  s.sought = {};
  for (int i = 1; s.mirrored && i < RefractedWay::kMostEvents; ++i)
    s.sought.mirrors |= uint32_t{random(s) < kReflects} << i;
  return shoot(s, At::start, s.start, s.sought, Role::probe);
}

// Chooses behind which interface the lamp comes.
auto RefractedSight::choose_end(RefractedSearch& s) -> Turn {
  const TracedWay& probe = s.of(Role::probe);
  int left = static_cast<int>(random(s) * std::popcount(probe.may_end)), events = 0;
  for (int i = 1; i <= RefractedWay::kMostEvents && events == 0; ++i)
    if (probe.may_end >> i & 1 && left-- == 0) events = i;
  if (events == 0) return next_start(s);
  s.sought.events = events;
  return events == probe.way.events ? started(s) : shoot(s, At::behind, s.start, s.sought, Role::probe);
}

// The probe has come to where it may be walked from.
auto RefractedSight::started(RefractedSearch& s) -> Turn {
  const TracedWay& probe = s.of(Role::probe);
  if (s.mirrored && probe.way.mirrors() == 0) return tried(s, false);
  if (s.end.far && probe.off > 1) return next_start(s);  // runs away
  ++s.walks;
  return walk(s, s.found);
}

auto RefractedSight::walked(RefractedSearch& s, bool found) -> Turn {
  if (s.sheet) return walked_through_sheet(s, found);
  return found && (s.of(s.found).way.mirrors() != 0) == s.mirrored ? tried(s, true) : next_start(s);
}

// The share of the light that the interfaces send along a way.
double RefractedSight::share(const RefractedWay& way, size_t knot) {
  double all = 1;
  for (int i = 0; i < way.events; ++i) {
    const RefractedEvent& at = way.at[i];
    at.model->delta_probability(at.out_local, interfaces_.lobe(at.material, at.reflected), static_cast<int>(knot),
                                shares_);
    all *= double{shares_[knot]};
  }
  return all;
}

// A trial has ended: the first one, or one of those that are to find the same again.
auto RefractedSight::tried(RefractedSearch& s, bool found) -> Turn {
  constexpr double kWorthIt = 0.01;  // less light is followed up as rarely as it is weaker
  const TracedWay &first = s.of(Role::first), &again = s.of(Role::again);
  const auto over = [&] { return s.mirrored ? Turn::ended : look_for(s, true); };
  RefractedWay& way = s.way[s.ways];
  if (s.found == Role::first) {
    if (!found) return over();
    s.kept = s.mirrored ? std::min(1.0, share(first.way, s.knot) / kWorthIt) : 1;
    if (s.kept < 1 && !(random(s) < s.kept)) return over();
    set_way(s, first, way);
    s.found = Role::again;
  } else {
    const auto same = [&] {
      const double near = std::max(kSame, 100 * (first.off + again.off)) * std::max(first.inverse, again.inverse);
      return again.way.events == way.events && again.way.mirrors() == way.mirrors() && again.det * first.det > 0 &&
             length(again.way.direction - way.direction) <= near;
    };
    const bool is_same = found && same();
    if (!is_same) way.doubtful = ++way.trials >= kMostTrials;
    if (is_same || way.doubtful) {
      way.trials /= s.kept;
      ++s.ways;
      return over();
    }
  }
  s.starts = s.walks = 0;
  return next_start(s);
}

}  // namespace suite
