// Lamps in the scene: points, spots and lamps with a tabulated distribution of intensity, and surfaces that glow. One
// of them is drawn at every node of a path, by a light tree; surfaces may also be met by chance.
//
// What rides on a placement (headlights) goes where it goes, is as large as it, and shines while it is there. A
// schedule switches and dims lamps in time; rays find them as they are at their time.
//
// Assumes: points are seen by nothing but the explicit sample; glowing surfaces glow equally in all directions of their
// side, those with a map as bright as it says where they are. Glowing triangles, disks, bounded planes and
// spheres are drawn; other exact surfaces that glow are met by chance only. In a scene that repeats itself every lamp
// stands in every cell: an image of the cell is drawn first (lamp_images.h), then one of its lamps. Based on: Pharr,
// Jakob & Humphreys, "Physically based rendering", 4th ed. 2023, chapter 12; cones towards spheres after section 6.2.4
// there.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light/intensity_table.h"
#include "light/lamp_map.h"
#include "light/lamp_schedule.h"
#include "light/light_spec.h"
#include "light/light_tree.h"
#include "trace/tracer.h"

namespace suite {

struct LampSpec {
  enum class Kind { point, spot, surface } kind = Kind::point;
  std::string name;
  Where where;
  std::shared_ptr<const LampSchedule> schedule;  // null: always as it is
  // point, spot
  std::string ride;             // what it rides on, by tag or by the name of what is placed; empty = nothing
  std::vector<Vec3> positions;  // m, ENU, or in the axes of what it rides on: one lamp each, on each placement
  Dir axis{0, 0, -1};           // where the middle of the light goes
  Curve intensity;              // W/(sr um), times the distribution
  double inner = kPi,
         outer = kPi;  // spot: full within `inner`, nothing beyond `outer` of the axis, rad; smooth between
  std::shared_ptr<const IntensityTable> table;
  // Of all light that it sends, over its intensity, in frames whose first axis lies as near to `stokes_axis` as it can
  // be across the light's way (frame_about): a direction in the axes of what it rides on, else of the scene. None: the
  // x axis that `distribution` counts azimuths from.
  std::optional<Stokes> stokes;
  std::optional<Dir> stokes_axis;
  // surface: everything with this material glows, on top of what it scatters and emits as a warm body
  std::string material;
  Curve radiance;                           // W/(m2 sr um)
  bool both_sides = false;                  // else the front only
  std::shared_ptr<const LampMap> map = {};  // times the radiance, by place; null = alike everywhere
};

// All lamps of an environment become one light.
LightSpecPtr make_light(LampSpec lamp);
LightSpecPtr make_light(std::vector<LampSpec> lamps);

// The lamps of a scene baked for a state: one light, of which every lamp in the tree is a member.
class Lamps final : public Light {
 public:
  // Error: unknown or mapped material, negative spectra, cones that are not 0 <= inner <= outer <= pi, empty or
  // negative tables; a map in a scene without an origin or one that repeats itself; a lamp that rides on what the scene
  // does not place, or what LampCarriers refuses, or in a scene that repeats itself.
  Lamps(std::span<const LampSpec> specs, const Tracer& tracer, const SpectralState& state);
  ~Lamps();
  // u: the choice of the lamp, two for the place on it, and one for the choice among its images, unused where the scene
  // does not repeat itself.
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  void sample_all(const LightReceiver& at, std::span<const std::array<double, 4>> u, double time,
                  std::span<std::optional<LightSample>> drawn) const override;
  std::optional<LightMet> met_surface(const LightReceiver& from, const Hit& hit, uint32_t material, Dir direction,
                                      double distance, double cosine, double time) const override;
  size_t members() const override { return size(); }
  bool is_point(size_t member) const override;
  std::optional<Vec3> point_of(size_t member, double time) const override;
  std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;

  std::optional<LightPlace> draw_place(const LightReceiver& at, const std::array<double, 4>& u,
                                       double time) const override;
  bool draws(const Hit& hit) const override;
  // Radiance that a surface with this material sends to the side of its normal (front) or to its back; null = none.
  const float* glow(uint32_t material, bool front) const;
  Stokes stokes(uint32_t source, Dir k, double time) const override;
  // Density, 1/sr, with which sample() draws the direction from `at` towards the point `hit` of a glowing surface,
  // met after `distance` (m) at an angle of the given cosine; 0 when that surface is met by chance only.
  double density(const LightReceiver& at, const Hit& hit, Dir direction, double distance, double cosine) const;
  size_t size() const;  // lamps in the tree, of one cell

 private:
  std::optional<LightSample> sample_here(uint32_t lamp, double probability, Vec3 from, Vec2 u, double time) const;
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace suite
