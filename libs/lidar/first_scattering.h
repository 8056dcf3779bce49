// Light that comes back after one scattering in what fills space, as an integral along the first ray of a path. Half of
// its places stand evenly over the part of the ray from which light arrives within the gate, so that every range bin
// has its share of them however thin the matter is; the others fall off with what is left of the light on both ways, so
// that dense matter has its share. Both are stratified and joined by the balance heuristic. It takes the place of the
// kernel's own single scattering there (order 1, by a medium), whose places are drawn by free flights. With s the
// scattering coefficient, P the phase function, S the strength of the other end at x (ends.h) and T what is left on
// either way,
//   integral of T(ray, x) s(x) P(x) T(x, end) S(x) dx.
//
// Where the way back is the way out (the end lies within kSameWay of the ray as seen from x) it is not asked a second
// time, and leaves that fill space as matter (phase function `leaves`) are passed once: what leaves let in they let
// out, exp(-t) in place of exp(-2 t). So they are on the way to the first surface. Other matter is passed twice.
// Based on: A. Kuusk, "The hot spot effect in plant canopy reflectance", in "Photon-vegetation interactions", 1991
// (correlation of both ways); stratification: M. Pharr et al., "Physically based rendering", 4th ed., section 8.2.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "lidar/ends.h"
#include "lidar/line_kit.h"
#include "lidar/pulse_at_work.h"
#include "transport/media/media_sight.h"

namespace suite {

class FirstScattering {
 public:
  static constexpr double kSameWay = 1e-4;  // rad

  // Keeps references. end: what places ask for. laser: the same end, where polarisation is asked for; else null.
  FirstScattering(const LineKit& kit, const Light& end, const LaserEnd* laser = nullptr);
  ~FirstScattering();
  // Whether anything scatters in the scene, bodies and air alike.
  static bool any(const LineKit& kit);

  struct Scattered {
    double arrival;         // m
    double light;           // as a contribution's product, without `spectrum`
    const float* spectrum;  // of the end
    // Over its intensity, in the meridian frame of the way to the ray's beginning.
    Stokes stokes{1, 0, 0, 0};
  };
  // Which of the strata of the ray's samples these are: number `index` of `count` paths, each with `samples`.
  struct Strata {
    uint32_t index, count, samples;
    uint64_t key;  // of the random numbers within strata
  };
  // gate: m of arrival. Replaces what is in `to`.
  struct Gate {
    double start, stop;
  };
  void trace(const Ray& ray, Vec3 end_place, const Gate& gate, const Strata& strata, std::vector<Scattered>& to);
  // Where a path that is scattered for certain begins its second flight, for all further orders: the place is drawn by
  // scattering alone on the last ray, up to where light may still arrive within the gate, the direction by the phase
  // function; where that has a mean cosine above kForwardScattering, half of the paths by the same about the direction
  // of the last ray's end, both with the density of the mixture (techniques/end_guide.h says why). u: in [0, 1), the
  // place, the direction (two), by whom. Nothing where matter is so dense that paths are scattered anyway, or nothing
  // scatters.
  struct Onward {
    Ray ray;
    double weight, arrival;                   // arrival: m up to there
    Mueller scattered = Mueller::identity();  // over its m11, where polarisation is asked for
  };
  enum class Directions { by_scattering, towards_end };
  std::optional<Onward> go_on(const Ray& ray, const std::array<double, 4>& u, Directions directions);
  // Of the last ray: by what the light of the first surface, scattered once there, is more for leaves on the way.
  double surface_share() const { return surface_share_; }
  TraceStatistics take_statistics() { return std::exchange(statistics_, {}); }

 private:
  struct Stretch {
    double begin, end;          // m along the ray
    double extinction, rate;    // 1/m; rate: of scattering
    double leaves;              // extinction by leaves, 1/m
    double depth, leaf_depth;   // up to begin
    double fall, fall_depth;    // extinction that places follow, and its depth up to begin
    double media, media_depth;  // scattering by media alone
    size_t contents, count;     // in contents_
    size_t leg, layer;
  };
  struct Leg {                          // between two boundaries
    double begin, arrival, delay, air;  // air: transmittance up to begin
    bool airless;
    MediumStack stack;
  };
  struct Waiting {  // for a ray towards the end
    Scattered what;
    Ray ray;
    double distance;
    size_t leg;
  };
  void walk(const Ray& ray);
  void walk_leg(const Ray& ray, double begin, double length);
  void add_stretch(double begin, double end);
  double phase(const Stretch& s, double cosine);
  Mueller mueller(const Stretch& s, Dir out, Dir in) const;
  double air(Vec3 from, Dir direction, double length);
  // The part of a ray that places stand on, and how.
  struct Span {
    double low, high;        // m
    double before;           // depth of fall up to low
    double all;              // 1 - exp(-2 depth) from there to high
    double evenly, by_fall;  // places of either kind
  };
  Span span(const Vec3& origin, Vec3 end_place, const Gate& gate) const;
  double fall_to(double t) const;
  double at_fall(double depth) const;
  const Stretch* stretch_at(double t) const;
  double air_up_to(const Ray& ray, const Leg& leg, double t);
  struct DrawnDirection {
    Dir in;
    double weight;  // phase function over the density
  };
  DrawnDirection direction(Dir along, Vec3 place, const BakedMedium& by, Vec2 u, Directions directions) const;
  void place(const Ray& ray, Vec3 end_place, const Gate& gate, double t, const Span& span, std::vector<Scattered>& to);
  void answer(std::vector<Scattered>& to);

  const LineKit& kit_;
  const Light& end_;
  const LaserEnd* laser_;
  const Atmosphere* air_;
  const double knot_[1] = {1};
  VolumeField field_;
  Bodies bodies_;
  Flights flights_;
  MediaSight sight_;
  FieldWalk walk_;
  Vec3 end_place_;               // of the last ray
  std::vector<uint8_t> leaves_;  // per medium
  std::vector<double> delay_, index_;
  std::vector<Stretch> stretches_;
  std::vector<Leg> legs_;
  std::vector<Constituent> contents_;
  std::vector<Waiting> waiting_;
  SightRays rays_;
  double depth_ = 0, leaf_depth_ = 0, fall_depth_ = 0, media_depth_ = 0, reach_ = 0, surface_share_ = 1,
         surface_at_ = 0;
  TraceStatistics statistics_;
};

}  // namespace suite
