// What a light is before it is baked for a spectral state: as a text or a program asks for it. Nothing outside a kind's
// own file knows which kind it is; what others need to know of it is asked here. A spec never changes and is shared:
// what time or other lights make of it is another spec, and a spec that is still the same needs no new bake.
//
// Assumes: directions are scene ENU; seconds count from second 0 of the simulation, whose date a dated spec gives.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "light/light.h"
#include "scene/scene.h"
#include "spectral/curve.h"
#include "spectral/state.h"

namespace suite {

struct SourceSpecs;
class LightSpec;
using LightSpecPtr = std::shared_ptr<const LightSpec>;

// A date from which direction, distance and size of a body follow.
struct SourceTime {
  std::string utc;  // ISO 8601, as parse_iso8601 accepts it
  Where where;
};

// A far disk of uniform radiance, or a collimated beam.
struct FarDisk {
  Dir direction{0, 0, 1};       // towards it, ENU
  double half_angle = 0.00465;  // rad; 0 = collimated
  Curve irradiance;             // W/(m2 um) on a plane facing it
};

// Spectra that a light sends, made together. Each is >= 0 and constant factors do not matter.
struct LightSpectra {
  std::vector<std::string> names;  // "the sun"
  // Means over the bins of a state, one row a name.
  std::function<std::vector<std::vector<float>>(const SpectralState&)> over;
};
// Adds a curve, also one that is constant; not one that is empty. It is kept by reference.
void add_curve(std::string name, const Curve& curve, std::vector<LightSpectra>& to);

// When a light is resolved, and where.
struct LightMoment {
  const Scene& scene;
  double seconds;                  // after the dates
  double dut1;                     // s, UT1 - UTC
  std::vector<std::string>& said;  // receives a sentence about what followed from a date
};

class LightSpec {
 public:
  virtual ~LightSpec() = default;
  // Under which texts give it, and the feature that it is: "sun".
  virtual std::string key() const = 0;
  // What a text would have to say in how many entries.
  virtual size_t entries() const { return 1; }

  // The light of a state. Only of specs that nothing more is to be made of. Error: values that no such light can have.
  virtual std::shared_ptr<const Light> bake(const Tracer& tracer, const SpectralState& state) const = 0;

  // ---- time and other lights; null = stays what it is
  // The date that direction or spectrum follow from; null = none.
  virtual const SourceTime* date() const { return nullptr; }
  // What a moment makes of it. Error: a date without a geodetic origin of the scene.
  virtual LightSpecPtr resolved(const LightMoment&) const { return nullptr; }
  // Stands for a dated one at all times, as if the sun were at this angle from the zenith (rad).
  virtual LightSpecPtr standing(double) const { return nullptr; }
  // Lights that are made from others: puts what it becomes in its place (own), and in theirs. All are resolved.
  // said: receives a sentence. Error: as check_beside.
  virtual void settle(SourceSpecs& all, size_t own, std::vector<std::string>& said) const;
  // Error, located, when it cannot stand beside the others.
  virtual void check_beside(const SourceSpecs&) const {}
  // What it is, in words, when it cannot be without the sun above the horizon: "a clear sky". Empty = it can.
  virtual std::string needs_sun_up() const { return {}; }
  // One light in the place of this one and of those of the others that it is one with, which are taken (set to null).
  virtual LightSpecPtr joined(std::span<LightSpecPtr>) const { return nullptr; }

  // ---- what it is
  // Whether it stands in the scene, so that what is baked belongs to a tracer; else it is far.
  virtual bool in_scene() const { return true; }
  // Resolved when dated: direction and irradiance. Null = no far disk.
  virtual const FarDisk* disk() const { return nullptr; }
  // The light that truth calls the sun.
  virtual bool is_sun() const { return false; }
  // Whether it may send anything at these wavelengths, um.
  virtual bool shines(double low_um, double high_um) const = 0;
  // Whether some of it is polarised.
  virtual bool polarised() const { return false; }
  // Adds what it sends. Keeps references to this.
  virtual void add_spectra(std::vector<LightSpectra>& to) const = 0;
  // Its parts, in words, that are met by chance too rarely by a path that is scattered evenly over a hemisphere: with a
  // probability below `enough`. Asking for them is then the only way to find them.
  virtual std::vector<std::string> hardly_met(double enough) const = 0;
};

// Whether a curve may be more than 0 somewhere between.
inline bool shines_between(const Curve& curve, double low_um, double high_um) {
  return !curve.covers(low_um, high_um) || curve.integral(low_um, high_um) > 0;
}

}  // namespace suite
