// A path on its way: what the kernel must remember of it from one event to the next.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "light/light.h"
#include "math/sampling.h"
#include "optics/scatter_model.h"
#include "surface/surface.h"
#include "transport/contribution.h"
#include "transport/path/claims.h"
#include "transport/path/hero.h"

namespace suite {

// Which of two ways to the next scattering a path is on that has come from an event with two branches.
enum class Branch : uint8_t {
  none,    // there is one
  open,    // as it comes: scattered on the next flight or not
  forced,  // guided, and scattered on the next flight for certain
};

// m, from a surface to where a ray that leaves it starts (Tracer::leave), along the ray: arrivals count it.
inline double step_along(const Hit& hit, Dir in) { return double{hit.step} * std::fabs(dot(in, hit.normal)); }

// K: knots at most.
template <int K>
struct Lane {
  static constexpr int kKnots = K;
  SampleStream stream{0, 0, 0};
  uint32_t sample = 0;
  uint32_t draw = 0;  // Ray::draw
  Vec3 origin;        // of the next segment
  Dir direction;
  double time = 0;            // s
  std::array<double, 4> u;    // numbers of the current node
  double length = 0;          // m so far
  double arrival = 0;         // m so far, times the group index
  HeroDensities<K> relative;  // r_k (shares.h)
  double throughput[K];       // at the knots, for roulette
  double before = 1;          // A before the last event over A after it
  // r_k, with the density of the other way in which the last event's branches draw a scattering
  // (techniques/splitting.h). Or that of a side flight having come from the last event to here
  // (techniques/side_vertex.h), where `sided`.
  HeroDensities<K> other;
  Branch branch = Branch::none;
  bool sided = false;
  PathClaims claims;
  double last_density = 0;    // p_h of the last event, without roulette; 0 after a Dirac event or none
  int knot = 0;               // whose shapes draw this path
  double share = 1;           // of a path's light, where it goes on in parts
  uint32_t surfaces = 0;      // met so far, the receiver included
  uint32_t scatterings = 0;   // in media so far
  uint32_t smooth = 0;        // smooth surfaces so far, of those met
  uint32_t flights = 0;       // through media so far
  uint8_t events = 0;         // EventKind so far
  uint8_t received = 0;       // 1: starts at a receiver
  bool points_apart = false;  // SensorRay::points_apart; and the path is not known to see them otherwise
  bool mirrored = false;      // by one flat mirror (flat_mirrors.h)
  std::array<float, 3> line;  // of sight, likewise
  WaterSeen water = WaterSeen::nothing;
  uint32_t order() const { return surfaces + scatterings; }
  // Nothing has happened yet; claims apart, which only techniques read.
  void begin(size_t heroes) {
    length = arrival = last_density = 0;
    before = share = 1;
    surfaces = scatterings = smooth = flights = 0, events = 0;
    branch = Branch::none, sided = false;
    water = WaterSeen::nothing, knot = 0;
    relative.start(heroes);
    std::fill_n(throughput, heroes, 1.0);
  }
};

// The last place of a path that asked for light; kept where surfaces shine.
struct LastAsked {
  LightReceiver at;
  double length = 0;  // m from the sensor
  int draws = 1;      // samples of a light that it took at most
};

enum class PathEnd : uint8_t { escaped, absorbed, roulette, max_nodes };

// What remains of a path when it has ended.
struct PathRecord {
  double time = 0;  // s, of the sensor's ray
  PathEnd end = PathEnd::absorbed;
  Dir escape;  // direction in which it left the scene
  // Throughput at the reference that was cut at the maximum number of nodes, for light in air: times the squared index.
  double truncated = 0;
  double leaked = 0;             // likewise, that left bodies of media where they have no surface
  uint32_t size = 0;             // nodes: surfaces, the receiver included
  bool received = false;         // node 0 is the sensor's own receiver, no surface
  bool scattered_first = false;  // a medium scattered it before it met anything
  bool met = false;              // `first` holds something
};

// The first surface that a path met; kept where truth is asked for.
struct FirstMeeting {
  uint32_t object = kNone;  // as Tracer::object() has it; kNone: the Earth under the scene
  Dir out;                  // back along the ray, ENU
  double distance = 0;      // m from the sensor, all segments
  bool sunlit = false;      // the explicit sample of the sun arrived
  const Interaction* at = nullptr;
};

}  // namespace suite
