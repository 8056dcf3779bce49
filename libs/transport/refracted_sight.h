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
// Assumes: at most kMostEvents interfaces; longer ways, those that begin with a reflection and rough interfaces are
// left to continuations that meet a light by chance. What longer ways bring is estimated (unfound, lost_light.h).
// Based on: J. Hanika, M. Droske, L. Fascione, "Manifold next event estimation", EGSR 2015; T. Zeltner, I. Georgiev,
// W. Jakob, "Specular manifold sampling for rendering high-frequency caustics and glints", ACM TOG 39(4), 2020.
#pragma once
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "math/sampling.h"
#include "transport/refracted_ray.h"
#include "transport/refracting_sheet.h"

namespace suite {

// A smooth interface on a way.
struct RefractedEvent {
  Hit hit;
  double length = 0;  // m from the place before
  Dir out, in;        // back towards the node, on towards the light
  Dir out_local;      // `out` in the shading frame
  uint32_t material = kNone;
  const ScatterModel* model = nullptr;
  bool reflected = false;
};

// What ways lead to: a light at infinity, or a place on a lamp.
struct WayEnd {
  Dir direction;  // far; unit
  Vec3 place;     // else; m, ENU
  bool far = true;
  bool surface = false;  // the place is one of a surface
};

struct RefractedWay {
  static constexpr int kMostEvents = 10;
  Vec3 origin;    // of the ray that leaves the node
  Dir direction;  // from the node
  int events = 0;
  RefractedEvent at[kMostEvents];
  Vec3 last;                                                // place of the last of them
  Dir to;                                                   // towards the light from there
  double length = std::numeric_limits<double>::infinity();  // m, to a lamp from there
  Hit lamp;                                                 // of a lamp's surface
  double spreading = 0;  // solid angle at the node over that at the light; over 1 m2 across the way at a lamp, 1/m2
  double trials = 1;     // the estimated reciprocal of the probability with which it was found
  bool doubtful = false;
  // A bit for each event that reflects.
  uint32_t mirrors() const;
};

class RefractedSight {
 public:
  static constexpr int kMostTrials = 4096;

  // Keeps references. Whether any ray can be asked for: interfaces().any().
  RefractedSight(const Surface& surface, const Optics& optics);
  const SmoothInterfaces& interfaces() const { return interfaces_; }

  // Where a way starts.
  struct Node {
    Vec3 place;
    const Hit* hit = nullptr;  // of a surface; null = in a medium
    Dir side = {};             // an opaque surface takes light only from the half space of this direction; 0 = all
    double time = 0;           // s
    uint32_t draw = 0;         // Ray::draw
  };
  // Ways from the node to a light, for the wavelengths of a knot: none, one or two. seed: of the
  // random numbers. In the mean over seeds all ways count. What is returned lives until the next call.
  std::span<const RefractedWay> find(const Node& node, const WayEnd& end, size_t knot, uint64_t seed);
  // How much of a light no way of find() brings from where a straight ray towards it leads, m: what interfaces pass or
  // reflect to and fro in more than kMostEvents meetings, as if they were parallel; at the first knot, and 0 below
  // kNothing. Nothing where something else is in its way: then it is not asked for there.
  static constexpr double kNothing = 1e-5;
  std::optional<double> unfound(Ray ray, double distance);
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
  // The way through it to a far light in direction `to` that Newton's method finds from there: none or one, and always
  // the same of a place and a direction, however many there are; none where waves focus its light to more than four
  // times what flat water makes of it, and none through bodies of other matter behind it. And whether it is the one
  // that leaves in a direction.
  std::span<const RefractedWay> first_through_sheet(const Node& node, Dir to, size_t knot);
  bool is_first_through_sheet(const Node& node, Dir from, Dir to, size_t knot);
  TraceStatistics take_statistics() { return std::exchange(statistics_, {}); }

 private:
  static constexpr double kNearEnough = 2e-5;  // rad: where float places of meshes leave no better
  static constexpr double kSame = 1e-4;        // rad at the light: ways as near as this are one
  struct Search {                              // what is looked for
    const Node& node;
    const WayEnd& end;
    Dir straight;     // towards the light from the node
    double distance;  // m, of a lamp
    size_t knot;
  };
  struct Chain {
    uint32_t mirrors = 0;  // a bit for each interface that reflects
    int events = 0;        // how many of them; 0 = as many as the ray meets
    bool blind = false;    // nothing is asked about what lies behind the last of them
  };
  struct Traced {
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
  bool hit_any(const Ray& ray, Hit& hit);
  bool hit_next(Ray& ray, Hit& hit, bool* passed = nullptr);
  bool trace(const Search& s, Dir direction, const Chain& chain, Traced& traced);
  static void arrive(const Search& s, const Hit& hit, bool last, Traced& traced);
  bool pass(const Search& s, const Hit& hit, uint32_t material, bool reflected, Traced& traced);
  bool walk(const Search& s, const Traced& start, const Chain& chain, Traced& found);
  bool guess(const Search& s, Dir& direction);
  bool try_once(const Search& s, bool mirrored, Traced& found);
  bool find(const Search& s, bool mirrored, RefractedWay& way);
  void set_sheet(const Optics& optics, uint32_t number);
  enum class Found : uint8_t { none, one, unknown };
  Found find_only(const Search& s, RefractedWay& way);
  bool walk_through_sheet(const Search& s, Traced& found);
  bool find_first(const Node& node, Dir to, size_t knot, Traced& found);
  static void set_way(const Search& s, const Traced& found, RefractedWay& way);
  double share(const RefractedWay& way, size_t knot);
  Dir draw_start(const Node& node);
  Dir draw_at_object(const Node& node);
  bool choose_end(const Search& s, Dir direction, Chain& chain, Traced& probe);
  double reflectance(const Hit& hit, const Ray& ray);
  static void aim(const Search& s, Traced& traced, const Frame& start);
  double random() { return unit_double(mix64(seed_ + counter_++)); }

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
  TraceStatistics statistics_;
  uint64_t seed_ = 0, counter_ = 0;
  std::optional<Dir> guessed_;
  std::vector<float> shares_;  // per knot
  std::vector<Hit> crossed_;   // scratch
  RefractedWay found_[2];
};

}  // namespace suite
