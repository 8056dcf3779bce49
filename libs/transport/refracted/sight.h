// Specular connections through smooth interfaces, for manifold next-event estimation (MNEE). They lead from a node to
// a far light or a place on a lamp, pass the first interface that they meet, and pass or are reflected by the next.
//
// From a node rays are shot that smooth interfaces bend; Newton's method turns a start until its end runs towards the
// light (manifold walk). Which starts find which way is not known; so when a random start has found one, starts are
// repeated until one finds the same again: the number of them is an unbiased estimate of the reciprocal of the
// probability with which it was found, whatever the surfaces look like. All ways together count right in the mean, and
// the number of starts to be expected is that of the ways. Ways after more than kMostTrials such starts count as that
// many and are said to be doubtful.
// Starts: the straight line, or what flat water at its first interface would make of it; directions about that; points
// and directions of the refracting objects. Every direction that meets one has a chance. Ways that are only passed on
// and ways with reflections are looked for one after the other, so that the rare second ones make no noise in the
// first; which interfaces reflect is drawn with the start. Where the scene's only refractor can tell that there is one
// way at most (refracting_sheet.h), it is walked to from where flat water would have it.
// No ray is traced here: a search (refracted/search.h) names the ray that it needs, and is taken on when somebody has
// answered it.
// Assumes: at most kMostEvents interfaces; longer ways, those that begin with a reflection and rough interfaces are
// left to continuations that meet a light by chance. What longer ways bring is estimated (refracted/unfound.h).
// Based on: J. Hanika, M. Droske, L. Fascione, "Manifold next event estimation", EGSR 2015; T. Zeltner, I. Georgiev,
// W. Jakob, "Specular manifold sampling for rendering high-frequency caustics and glints", ACM TOG 39(4), 2020.
#pragma once
#include <optional>
#include <vector>

#include "math/sampling.h"
#include "transport/refracted/search.h"
#include "transport/refracting_sheet.h"

namespace suite {

class RefractedSight {
 public:
  static constexpr int kMostTrials = 12288;  // of one walk each

  // Keeps references. Whether any ray can be asked for: interfaces().any().
  RefractedSight(const Surface& surface, const Optics& optics);
  const SmoothInterfaces& interfaces() const { return interfaces_; }

  // Begins the search for ways from the node to a light, for the wavelengths of a knot: none, one or two. seed: of the
  // random numbers. In the mean over seeds all ways count. The node's hit must stay until it has ended. True: the ray
  // s.leg.ray is to be traced to the nearest hit, which step() takes; false: the search has ended with s.all().
  bool begin(RefractedSearch& s, const WayStart& node, const WayEnd& end, size_t knot, uint64_t seed);
  // The same of the way through the only refracting surface to a far light in direction `to` that Newton's method finds
  // from where flat water would have it: none or one, and always the same of a place and a direction, however many
  // there are; none where waves focus its light to more than four times what flat water makes of it, and none through
  // bodies of other matter behind it. Requires has_sheet().
  bool begin_first(RefractedSearch& s, const WayStart& node, Dir to, size_t knot);
  bool step(RefractedSearch& s, Hit& hit);
  // Of a search by begin_first() that has ended: whether there is a way and it leaves in a direction.
  static bool leaves_along(const RefractedSearch& s, Dir from);

  // Of the scene's only refracting surface, where it is a sheet (refracting_sheet.h): whether it is; how far a place
  // lies below it, m, 0 elsewhere; where flat water would have one leave a place below; the cosine of a direction to
  // its axis; the axis, towards its front.
  bool has_sheet() const { return sheet_.has_value(); }
  double below_sheet(Vec3 place) const { return sheet_ ? sheet_->deep(place) : 0; }
  std::optional<Dir> sheet_guess(Dir to, size_t knot) const {
    return sheet_->guess(to, interfaces_.index(sheet_material_, knot));
  }
  double steepness(Dir direction) const { return sheet_->steepness(direction); }
  Dir sheet_axis() const { return sheet_->axis(); }

  // Takes a straight leg on from what its ray has met: false = it goes on behind a boundary, and its new ray is to be
  // traced. Else hit is what ends it, with its distance from the beginning of the leg. veiled: is set where a boundary
  // has been passed; may be null.
  bool ends(StraightLeg& leg, Hit& hit, bool* veiled) const;
  // The material at a hit; kNone where there is none.
  uint32_t material(const Hit& hit) const { return hit.hit() ? surface_.material(hit) : kNone; }
  // Where a ray that leaves a hit to the side of `direction` starts.
  Vec3 leave(const Hit& hit, Dir direction) const { return surface_.tracer().leave(hit, direction); }
  // Of an interface, at the first knot, from its thinner side, which the straight ray runs in as the light comes.
  double reflectance(const Hit& hit, const Ray& ray);

 private:
  static constexpr double kNearEnough = 2e-5;  // rad: where float places of meshes leave no better
  static constexpr double kSame = 1e-4;        // rad at the light: ways as near as this are one
  using At = RefractedSearch::At;
  using Role = RefractedSearch::Role;
  // What becomes of a search: it waits for its ray; its ray came through the interfaces, or not; it has ended.
  enum class Turn : uint8_t { waits, through, stopped, ended };
  bool run(RefractedSearch& s, Turn turn);
  Turn go_on(RefractedSearch& s, bool through);

  // sight.cpp: one ray from the node through a chain of interfaces.
  Turn shoot(RefractedSearch& s, At at, Dir direction, const InterfaceChain& chain, Role into);
  Turn met(RefractedSearch& s, const Hit& hit);
  static void arrive(const RefractedSearch& s, const Hit& hit, bool last, TracedWay& traced);
  bool pass(const RefractedSearch& s, const Hit& hit, uint32_t material, bool reflected, TracedWay& traced);
  static void aim(const RefractedSearch& s, TracedWay& traced);
  // walk.cpp: Newton's method.
  Turn walk(RefractedSearch& s, Role found);
  Turn next_step(RefractedSearch& s);
  Turn shoot_step(RefractedSearch& s);
  Turn stepped(RefractedSearch& s, bool through);
  Turn arrived(RefractedSearch& s);
  Turn walked(RefractedSearch& s, bool found);
  // trials.cpp: random starts until one finds the same way again.
  Turn look_straight(RefractedSearch& s);
  Turn met_straight(RefractedSearch& s, const Hit& hit);
  Turn bend_straight(RefractedSearch& s, bool through);
  Turn look_for(RefractedSearch& s, bool mirrored);
  Turn next_start(RefractedSearch& s);
  Turn started(RefractedSearch& s);
  Turn choose_end(RefractedSearch& s);
  Turn tried(RefractedSearch& s, bool found);
  static Box3 placed(const Box3& box, const Affine3& place);
  double share(const RefractedWay& way, size_t knot);
  Dir draw_start(RefractedSearch& s) const;
  Dir draw_at_object(RefractedSearch& s) const;
  static double random(RefractedSearch& s) { return unit_double(mix64(s.seed + s.counter++)); }
  // only.cpp: through the scene's only refracting surface.
  void set_sheet(const Optics& optics, uint32_t number);
  Turn look_through_sheet(RefractedSearch& s);
  Turn walk_through_sheet(RefractedSearch& s);
  Turn miss_sheet(RefractedSearch& s);
  Turn walked_through_sheet(RefractedSearch& s, bool found);
  static void set_way(const RefractedSearch& s, const TracedWay& found, RefractedWay& way);

  const Surface& surface_;
  SmoothInterfaces interfaces_;
  std::vector<uint8_t> passes_;  // per material: bounds a medium and bends nothing
  struct Refractor {
    Box3 box;                // empty = it has no bounds
    uint32_t moves = kNone;  // the object whose frame the box is in; kNone = ENU
  };
  std::vector<Refractor> objects_;
  std::optional<RefractingSheet> sheet_;  // the only one of them, where it can tell how many ways there are
  uint32_t sheet_material_ = kNone;
  Interaction at_, beside_;
  std::vector<float> shares_;  // per knot
};

}  // namespace suite
