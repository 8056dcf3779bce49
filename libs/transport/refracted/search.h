// The state of one search for ways through smooth interfaces (refracted/sight.h): what it looks for, how far it has
// come, and the ray that it waits for. Plain data, so that many searches wait for their rays beside each other and are
// used again; RefractedSight::step() takes one on when its ray has been answered.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "transport/refracted/way.h"
#include "transport/refracted_ray.h"

namespace suite {

// Through which interfaces a ray is taken.
struct InterfaceChain {
  uint32_t mirrors = 0;  // a bit for each interface that reflects
  int events = 0;        // how many of them; 0 = as many as the ray meets
  bool blind = false;    // nothing is asked about what lies behind the last of them
};

// A ray from a node that has been taken through interfaces.
struct TracedWay {
  RefractedWay way;
  BentRay end;
  bool open = false;     // nothing between the last interface and the light
  bool veiled = false;   // but what boundaries part from the rest
  uint32_t may_end = 0;  // a bit for each number of interfaces behind which a lamp may come
  double det = 0;        // of the change of the end with the direction of the start
  double off = 0;        // how far the end is off: sine of its direction from the light's, 2 - sine where it runs
                         // away from it; of a lamp m over the distance of that, 2 where it lies behind
  Dir next;              // Newton's next direction
  double inverse = 0;    // norm of the inverse of the change
};

// A straight piece of a ray, through boundaries that bend nothing.
struct StraightLeg {
  Ray ray;             // to be traced
  double before = 0;   // m, from where the leg began to the origin of `ray`
  int boundaries = 0;  // passed so far
  void begin(Vec3 from, Dir direction, double time, uint32_t draw) {
    ray.set(from, direction, time, draw);
    before = 0, boundaries = 0;
  }
};

struct RefractedSearch {
  // What is looked for: all ways, or the one that Newton's method finds first from where flat water would have it.
  enum class For : uint8_t { all, first } what = For::all;
  WayStart node;
  WayEnd end;
  Dir straight;         // towards the light from the node
  double distance = 0;  // m, of a lamp
  size_t knot = 0;
  bool sheet = false;  // it walks through the scene's only refracting surface

  // Which question the ray under way answers.
  enum class At : uint8_t {
    sheet,     // where flat water would have the way leave: Newton's first ray through a sheet
    straight,  // what the straight line towards the light meets first
    through,   // what the straight line comes to when interfaces bend it
    start,     // a random start
    behind,    // the same, with its end behind another interface
    step,      // a step of Newton's method
    whole,     // what lies behind the last interface of where it has arrived
    done
  } at = At::done;
  StraightLeg leg;
  InterfaceChain chain;  // that the ray under way is taken through
  Frame across;          // of its start

  // Rays that have been taken through interfaces, each in one of four places that change their roles.
  enum class Role : uint8_t { first, again, probe, next };
  std::array<TracedWay, 4> traced;
  std::array<uint8_t, 4> place{0, 1, 2, 3};  // [role]
  TracedWay& of(Role r) { return traced[place[static_cast<size_t>(r)]]; }
  const TracedWay& of(Role r) const { return traced[place[static_cast<size_t>(r)]]; }
  void exchange(Role a, Role b) { std::swap(place[static_cast<size_t>(a)], place[static_cast<size_t>(b)]); }
  Role into = Role::probe;  // of the ray under way

  // Newton's method.
  Role found = Role::first;  // what it starts from, and then has found
  InterfaceChain on;         // that its rays are taken through
  int steps = 0, halvings = 0;
  double share = 1;  // of a step
  Dir from;          // of the step under way
  bool stepped = false;

  // Random starts.
  uint64_t seed = 0, counter = 0;
  std::optional<Dir> guessed;  // a start from the straight line
  Hit met;                     // first on that line
  bool mirrored = false;       // ways with reflections are looked for
  int starts = 0, walks = 0;   // of the trial under way
  Dir start;                   // the last one
  InterfaceChain sought;       // that it is to be taken through
  double kept = 1;             // the probability with which what was found first is followed up

  // What has been found.
  std::array<RefractedWay, 2> way;
  size_t ways = 0;
  std::span<const RefractedWay> all() const { return std::span(way).first(ways); }
};

}  // namespace suite
