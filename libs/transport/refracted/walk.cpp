// Newton's method of refracted/sight.h, with halved steps.
#include <cmath>

#include "transport/refracted/sight.h"

namespace suite {

namespace {

// From a start that leads to a way it takes 3 to 6 steps; most starts lead to none, and these limits are what they
// cost.
constexpr int kMostSteps = 12, kMostHalvings = 3;
constexpr double kArrived = 1e-9;  // rad
// rad, that Newton's next step would turn the start. Beside a fold of ways, where there is none, its steps end at small
// distances from the light but with an endless spreading; they would still be long.
constexpr double kSettled = 1e-4;

bool is_settled(const TracedWay& found) { return found.off * found.inverse < kSettled; }

}  // namespace

// From what the probe has come to. It ends in walked().
auto RefractedSight::walk(RefractedSearch& s, Role found) -> Turn {
  s.found = found;
  s.exchange(Role::probe, found);
  // Towards a far light it is enough to look behind the last interface in the end.
  s.on = s.sought;
  if (s.end.far) s.on.events = s.of(found).way.events, s.on.blind = true;
  s.stepped = false, s.steps = 0;
  return next_step(s);
}

auto RefractedSight::next_step(RefractedSearch& s) -> Turn {
  const TracedWay& found = s.of(s.found);
  if (s.steps < kMostSteps && (found.off > kArrived || !is_settled(found))) {
    s.from = found.way.direction, s.share = 1, s.halvings = 0;
    return shoot_step(s);
  }
  return arrived(s);
}

auto RefractedSight::shoot_step(RefractedSearch& s) -> Turn {
  const Dir next = s.of(s.found).next;
  return shoot(s, At::step, normalized(s.from + (next - s.from) * s.share), s.on, Role::next);
}

auto RefractedSight::stepped(RefractedSearch& s, bool through) -> Turn {
  if (through && s.of(Role::next).off < s.of(s.found).off) {
    s.exchange(Role::next, s.found);
    s.stepped = true, ++s.steps;
    return next_step(s);
  }
  s.share *= 0.5;
  return ++s.halvings < kMostHalvings ? shoot_step(s) : arrived(s);
}

// It comes no nearer. Found: it ends at a way that is open.
auto RefractedSight::arrived(RefractedSearch& s) -> Turn {
  const TracedWay& found = s.of(s.found);
  if (s.at != At::whole && s.on.blind && s.stepped && found.off < kNearEnough)
    return shoot(s, At::whole, found.way.direction, s.sought, Role::next);
  return walked(s, found.off < kNearEnough && found.open && std::isfinite(found.inverse) && is_settled(found));
}

}  // namespace suite
