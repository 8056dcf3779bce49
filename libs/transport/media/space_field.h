// Space that media fill: flights, scattering events between surfaces, index-matched boundaries on the way, and the air
// along it. One of the answers to "what fills space" that the path kernel is made for.
//
// With v the sum over the contents of density x scattering x phase function and q_k = v_k / (scattering coefficient)
// the density of directions at knot k, a scattering event is to the kernel what a surface is: v for w, q for its
// density. Flights, and what reaches a light of the continuations that are drawn towards it, are in media/flight.h.
#pragma once
#include <vector>

#include "transport/media/media_sight.h"
#include "transport/space_nothing.h"
#include "transport/surfaces_any.h"

namespace suite {

class FieldSpace {
 public:
  static constexpr bool kScatters = true, kMedia = true, kFills = true, kGoesBack = false;
  static constexpr uint32_t kDense = 2;
  static constexpr uint16_t kEmitter = kFromMatter;
  using Sight = MediaSight;
  using Around = MediumStack;
  explicit FieldSpace(const SpaceContext& context);

  void begin_wave() { seen_.forget(); }
  // Puts a new path into the bodies around its origin.
  void start(uint32_t p, const LivePath& live);
  Vec3 ray_from(uint32_t p, const LivePath& live) const { return ways_[p].gap > 0 ? ways_[p].from : live.origin; }
  // One flight of path p towards `hit`, which `ray` found, over `length` m at most. through, emitted: memory for
  // spectra.
  // ends: light from the end of the way is to come through it.
  Flight fly(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, const Ray& ray, double length, bool ends,
             std::span<float> through, std::span<float> emitted);
  double index(uint32_t p) const { return index_of(stacks_[p].medium(ambient_)); }
  double delay(uint32_t p) const { return delay_of(stacks_[p].medium(ambient_)); }
  // Times the squared index (Planck's law in matter, as of the media themselves).
  void emit_within(uint32_t p, std::span<float> emission) const;
  // Flights bring all light of the air: media on the way dim it in parts.
  const Light* sky() const { return nullptr; }
  // That of air without media in it, of which matter hides all but what smooth interfaces pass; null: none.
  const SkyThroughWater* hidden_sky() const { return plain_air_ ? air_->sky_through_water() : nullptr; }
  // What comes along a ray from there; scratch and memory for spectra.
  const float* sky_behind(const Ray& ray, std::span<float> scratch, std::span<float> radiance) const {
    return air_->sky_radiance(ray.origin, ray.direction, scratch, radiance);
  }
  double sky_density(Dir) const { return 0; }
  const float* sky_radiance(const Ray&, std::span<float>, std::span<float>) const { return nullptr; }
  // The path goes through a surface to the other side.
  void cross(uint32_t p, const Hit& hit, uint32_t material, Dir in) {
    bodies_.transmit(stacks_[p], hit, material, in, statistics_);
  }

  // The bodies around path p where it leaves a surface or an event, and a path that is put there again.
  const Around& around(uint32_t p) const { return stacks_[p]; }
  void put(uint32_t p, const Around& around) {
    stacks_[p] = around;
    ways_[p] = {};
  }
  bool scatters_around(uint32_t p) const {
    const uint32_t medium = stacks_[p].medium(ambient_);
    return medium != kNone && optics_.media()[medium].scatters();
  }
  // Single-scattering albedo of the medium around, at a knot.
  double albedo_around(uint32_t p, size_t knot) const;

  // Whether it is a medium that is the same everywhere, and so are all that boundaries part from it.
  bool even_around(uint32_t p) const { return scatters_around(p) && !field_.has_grids() && !optics_.air(); }

  // The same of a path that leaves an event or a surface, not a boundary on its way. And 1/m of scattering there.
  bool starts_in_even_matter(uint32_t p) const { return !(ways_[p].gap > 0) && even_around(p); }
  double scattering_around(uint32_t p, size_t knot) const { return scattering_in(stacks_[p].medium(ambient_), knot); }

  // Makes the place where path p stands at a surface an event of what fills space there, for scatter(), densities().
  void stand(uint32_t p) { stand(events_[p], stacks_[p]); }
  // The event that ended the last flight of path p, or that of stand(). scattering: 1/m, at a knot.
  // Mean cosine of its scattering at the reference, over all that is there; its albedo at a knot.
  double scattering(uint32_t p, size_t knot = 0) const { return events_[p].rate[knot]; }
  double asymmetry(uint32_t p) const;
  double albedo(uint32_t p, size_t knot) const;
  Vec3 place(uint32_t p) const { return events_[p].place; }
  void densities(uint32_t p, Dir out, Dir in, std::span<float> density) const;
  // v; dense: memory for a spectrum.
  Factor evaluate(uint32_t p, double cosine, std::span<float> dense);
  // Mueller matrices over m11 of light from `in`, in the world.
  ScatterModel::Polarised mueller(uint32_t p, Dir out, Dir in, std::span<Mueller> m) const;
  // Draws a direction. who: number that chooses the scatterer. Nothing when nothing scatters.
  bool sample(uint32_t p, const LivePath& live, Vec2 u, double who, std::span<float> dense, Continuation& on);
  // Its direction alone, when seen from `out`; the density is that of densities().
  bool scatter(uint32_t p, Dir out, int knot, Vec2 u, double who, Dir& in) const;

  // A side flight from the event where path p stands, along `live`: whether it is scattered on the way to `hit`, or of
  // `length` m. through: receives what the way does to every bin, times scale. What it comes to is the event side(p).
  bool fly_aside(uint32_t p, LivePath& live, const Hit& hit, double length, Vec2 u, Flight& flight,
                 std::span<float> through);
  uint32_t side(uint32_t p) const { return p + static_cast<uint32_t>(stacks_.size()); }

  void clear_sight() { sight_.clear(); }
  // Names a ray from path p, at the event that ended its flight or else at a surface.
  void see_from_event(uint32_t p) { sight_.add(stacks_[p]); }
  void see_from_side(uint32_t p, const Hit& hit) {
    MediumStack& stack = sight_.add(stacks_[p]);
    if (!hit.hit()) bodies_.leave_scene(stack);
  }
  void see_from_way() { sight_.add(way_); }  // from where a way has come to
  void see_from_surface(uint32_t p, const Hit& hit, uint32_t material, Dir out, Dir in);
  Sight& sight() { return sight_; }
  bool dims(const Ray& ray, double distance, size_t i, std::span<float> transmission, std::span<double> reach);
  // Along ray i, with the index where it starts: boundaries that do not bend it part media of one index.
  double optical_way(uint32_t p, size_t, double distance) const { return delay(p) * distance; }
  void begin_way(uint32_t p, bool event, const Hit& hit, uint32_t material, Dir out, Dir in);
  double follow_way(const Ray& ray, double length, std::span<float> through, std::span<float> scratch);
  // How far a ray from where the way has come to runs, boundaries passed, to a surface: infinity where it meets none in
  // matter that goes on there; else, out of a body with a hole, up to where it is in that for certain.
  double free_way(const Ray& ray);
  // On the first `most` m of that ray, at a knot: scattering depth; the share of the way at which a share of it has
  // been passed; and the reverse, with the change of this by that.
  double depth_of_way(double most, size_t knot) const;
  double share_of_way(double depth, double most, size_t knot) const;
  struct DepthShare {
    double share, change;
  };
  DepthShare share_of_depth(double way, double most, size_t knot) const;
  // Events like those of scatter(): the mean of what fills `length` m of such a ray; what fills the place come to.
  uint32_t mean_of_way(const Ray& ray, double length);
  uint32_t stand_on_way();
  // Where the way has come to, and going back there.
  const MediumStack& way() const { return way_; }
  void resume_way(const MediumStack& way) { way_ = way; }
  void cross_way(const Hit& hit, uint32_t material, Dir in) { bodies_.transmit(way_, hit, material, in, statistics_); }
  TraceStatistics take_statistics();

 protected:
  // A flight of path p begins: settles what its ray has met, and puts it into the bodies around. gap: m, from its
  // origin to where the ray began. Returns how far it goes at most, m.
  double begin_flight(uint32_t p, const LivePath& live, PathRecord& record, Hit& hit, const Ray& ray, double length,
                      double& gap);
  // The same flight once begun.
  Flight fly_on(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length, double gap, bool ends,
                std::span<float> through, std::span<float> emitted);
  // It has come to its end, unscattered: passes boundaries that bend nothing.
  void end_flight(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double gap, Flight& flight);
  uint32_t medium_around(uint32_t p) const { return stacks_[p].medium(ambient_); }
  // Matter that is denser than the air, such as water, holds none of it.
  bool is_airless(uint32_t medium) const { return index_of(medium) != 1; }
  double delay_of(uint32_t medium) const { return medium == kNone || delay_.empty() ? 1 : delay_[medium]; }
  // Density of each medium, integrated over `length` m from a path's origin in a medium; and the depth of scattering.
  std::span<const double> depths_of(const LivePath& live, double length, uint32_t medium);
  double scattering_depth(std::span<const double> depths, size_t knot) const;

  const Surface& surface_;
  const Optics& optics_;
  const Atmosphere* air_;
  uint32_t ambient_;
  VolumeField field_;
  Bodies bodies_;
  Flights flights_;
  MediaSight sight_;

 private:
  struct Way {       // of the next ray of a path
    Vec3 from;       // where it begins
    double gap = 0;  // m from the path's origin to there; 0 = at it
  };
  struct ScatterPlace {
    Vec3 place;
    std::vector<Constituent> contents;
    double rate[kMaxKnots];  // scattering coefficient
  };
  void leave_scene(uint32_t p, const LivePath& live, PathRecord& record);
  void remember(uint32_t event, Vec3 place);
  void stand(ScatterPlace& e, const MediumStack& stack) const;
  // Runs through boundaries, in `stack`, over `length` m or until it meets a surface, where that counts. Calls
  // stretch(ray, m) for each medium, which is then around `stack`. Returns m in all.
  template <class Stretch>
  double run(MediumStack& stack, Ray ray, double length, bool to_surface, const Stretch& stretch);
  struct Layer {
    double length;  // m
    uint32_t medium;
  };
  double scattering_in(uint32_t medium, size_t knot) const {  // 1/m
    return medium == kNone ? 0 : double{optics_.media()[medium].scattering[optics_.state().knots[knot]]};
  }
  uint32_t mean_event() const { return 2 * static_cast<uint32_t>(stacks_.size()); }
  void set_rates(ScatterPlace& e) const;
  double index_of(uint32_t medium) const { return medium == kNone || index_.empty() ? 1 : index_[medium]; }

  const bool plain_air_;            // outside bodies there is nothing but air that does not scatter paths
  KnownWay seen_;                   // of sensors' rays in it
  std::vector<double> index_;       // of refraction at the reference, per medium
  std::vector<double> delay_;       // group index there
  std::vector<double> asymmetry_;   // mean cosine of scattering there
  std::vector<uint8_t> one_phase_;  // the same phase function at all wavelengths, per medium
  std::vector<MediumStack> stacks_;
  std::vector<Way> ways_;
  std::vector<ScatterPlace> events_;  // of paths, of their side flights, and two of the way
  std::vector<float> phase_;
  MediumStack way_;            // that interfaces bend, as it stands
  std::vector<Layer> layers_;  // on the last free_way()
  std::vector<double> depths_;
  TraceStatistics statistics_;  // of short rays at boundaries
};

}  // namespace suite
