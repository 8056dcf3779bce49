// One interface for everything that shines. A light is asked for a direction towards it from a place (sample), and for
// what it sends along a ray that met it by chance (met_outside, met_surface), with the density with which the first
// would have drawn what the second met: whoever asks can combine both by multiple importance sampling. What a light is
// (LightNature) says which of these are worth asking; nothing follows from its place in a list.
//
// Assumes: spectra belong to the bins of the state that a light was baked for; radiance is W/(m2 sr um), irradiance
// W/(m2 um). A light can be asked by many threads at once.
// Based on: Veach, "Robust Monte Carlo methods for light transport simulation", 1997, chapter 9; Pharr, Jakob &
// Humphreys, "Physically based rendering", 4th ed. 2023, chapter 12.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "light/light_receiver.h"
#include "math/mueller.h"
#include "math/vec.h"
#include "trace/tracer.h"

namespace suite {

struct FarPoints;  // far_points.h

// What a light is. Heuristics and special cases follow from this alone, never from its place in a list.
struct LightNature {
  bool far = false;    // stands at infinity: rays that leave the scene meet it
  bool delta = false;  // nothing meets it by chance: collimated, points
  // Small and even: its samples hardly vary by themselves, so that what continuations find counts little beside them.
  bool disk = false;
  bool wide = false;    // fills much of the sphere (skies): continuations find it by themselves
  bool drawn = true;    // sample() is worth asking; false = met by chance only (uniform skies)
  bool moves = false;   // what it sends depends on the time of the ray
  bool placed = false;  // stands in the scene, and draw_place() finds it
  bool above = false;   // sensors above the air may see it on their way to what their rays meet (add_from_above)
  int numbers = 2;      // random numbers that sample() uses, 2 or 4
  int draws = 1;        // samples of it that the first node of a path may take (lamps: kMostDraws, one: 1)
  static constexpr int kMostDraws = 4;
};

// Of a source within a light whose light is not polarised; of others Light::stokes tells.
inline constexpr uint32_t kUnpolarised = 0xffffffff;

struct LightSample {
  Dir direction;                                              // unit, from the place that asks
  double distance = std::numeric_limits<double>::infinity();  // m, of the visibility ray
  Vec3 end;            // m, of the visibility ray where distance is finite: just in front of the lamp
  double density = 0;  // 1/sr, every choice included; 0 = the only direction there is
  // scale * spectrum[k] = radiance, or, with density 0, irradiance over the probability of the choice. Positive.
  double scale = 0;
  // Per bin; null = the shape differs with direction: scale times what Light::add adds.
  const float* spectrum = nullptr;
  uint32_t source = kUnpolarised;  // for Light::stokes
};

// A place on a light that stands in the scene, for light that is bent on its way from it.
struct LightPlace {
  Vec3 place;          // m, ENU
  bool point = false;  // else on a surface that shines
  double density = 0;  // 1/m2 of places on surfaces, or the probability of a point
  size_t member = 0;   // whose it is, for sample_member
};

// What far lights draw.
struct DirectionSample {
  Dir direction;
  double density = 0;  // 1/sr; 0 = the only direction of a collimated source
};

// Met by chance.
struct LightMet {
  double scale = 0;                 // radiance = scale * spectrum
  const float* spectrum = nullptr;  // per bin; null: scale times what Light::add adds
  double density = 0;               // 1/sr, with which sample() draws it from the place; 0 = never
  uint32_t source = kUnpolarised;   // for Light::stokes
};

// A beam from outside that the air scatters.
struct Beam {
  Dir direction;                      // towards its source
  const float* irradiance = nullptr;  // per bin, above the atmosphere
};

class Light {
 public:
  virtual ~Light() = default;
  // Constant during a light's life.
  const LightNature& nature() const { return nature_; }

  // A direction towards the light. u: numbers in [0, 1), nature().numbers of them used. time: s, of the ray. Nothing
  // where no light comes from what was drawn.
  virtual std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                            double time) const = 0;
  // Several samples from one place, one for each of u: as many calls of sample(), in less time where the light looks at
  // the place as a whole first. drawn: as many as u.
  virtual void sample_all(const LightReceiver& at, std::span<const std::array<double, 4>> u, double time,
                          std::span<std::optional<LightSample>> drawn) const;
  // Of a ray that leaves the scene in a direction (far lights). Nothing where the ray does not meet it.
  virtual std::optional<LightMet> met_outside(Dir direction, double time) const;
  // Of a ray that left `from` and hit a surface of a material (kNone = none): lights that are neither far nor delta.
  // direction: of the ray. distance: m, along it from `from`, through whatever was passed on the way. cosine: of the
  // direction back along the ray with the geometric normal; its sign tells the side. Nothing where it does not glow.
  // The density is that of one sample, however many are drawn.
  virtual std::optional<LightMet> met_surface(const LightReceiver& from, const Hit& hit, uint32_t material,
                                              Dir direction, double distance, double cosine, double time) const;
  // A place on a light that stands in the scene (nature().placed), asked for from elsewhere; every place of it has a
  // chance, whether or not a straight line leads to it. u, time: as sample(), four numbers. Nothing where what was
  // drawn is dark.
  virtual std::optional<LightPlace> draw_place(const LightReceiver& at, const std::array<double, 4>& u,
                                               double time) const;
  // Whether sample() and draw_place() may draw the surface that a ray met.
  virtual bool draws(const Hit&) const { return false; }
  // Adds scale times the radiance from a direction at the time of a ray (s): far lights that give no spectrum above.
  // Bug for others.
  virtual void add(Dir direction, double time, float scale, std::span<float> radiance) const;
  // What a sensor sees of it straight ahead if its far points come by other means (far_points.h): less than add()
  // gives.
  virtual void add_without_points(Dir direction, double time, float scale, std::span<float> radiance) const {
    add(direction, time, scale, radiance);
  }
  // A sensor's own ray that starts above the air, where layers of the upper air shine in front of what it meets and
  // the sky goes on below the horizon. Lights of nature().above alone.
  struct RayFromAbove {
    Vec3 from;  // m, ENU
    Dir direction;
    double length = 0;                // m, to what it meets; infinite: nothing
    std::span<const float> air = {};  // what the air leaves of light from behind, per bin, likewise; empty = all
    bool points_apart = false;        // points come by other means
  };
  // Whether sensors at a place see it so; add() is then not asked for their own rays.
  virtual bool is_below(Vec3) const { return false; }
  virtual void add_from_above(const RayFromAbove&, std::span<float>) const {}
  // The Stokes vector, over its intensity, of light that leaves one of its sources along k, in the meridian frame of k,
  // at the time of a ray (s). Bug where the source is kUnpolarised.
  virtual Stokes stokes(uint32_t source, Dir k, double time) const;
  // Those points; null = none. They live as long as the light.
  virtual const FarPoints* points() const { return nullptr; }
  // The beam that the air scatters (Sun, Moon). Its spectrum lives as long as the light.
  virtual std::optional<Beam> beam() const { return std::nullopt; }

  // For estimators that choose one light out of all: how many there are in here to choose from (0 = such estimators
  // leave it to chance), and a sample of one of them (0 .. members() - 1) that was chosen with a probability, which the
  // sample includes. u[0] is not used: it has chosen. Bug when there are none.
  virtual size_t members() const { return 1; }
  virtual bool is_point(size_t) const { return false; }
  // Where such a member shines from, in the scene, m, ENU, at a time (s); nothing while it is dark.
  virtual std::optional<Vec3> point_of(size_t member, double time) const;
  virtual std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                                   const std::array<double, 4>& u, double time) const = 0;

 protected:
  Light() = default;
  Light(const Light&) = default;
  Light& operator=(const Light&) = default;
  LightNature nature_;  // set by constructors
};

}  // namespace suite
