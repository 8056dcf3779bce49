#include "scene/endless_media.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

constexpr double kMany = 100;         // scatterings; fewer cost little
constexpr size_t kMostReported = 64;  // surfaces without end that are looked at
constexpr double kBeyond = 1e-9;      // m

// A face without end of a primitive that is placed.
struct Face {
  const Primitive* primitive;
  const Material* material;
  Vec3 point;
  Dir normal;
};

class Faces {
 public:
  explicit Faces(const Scene& scene) : scene_(scene), holds_(scene.groups.size()) {
    for (const Primitive& p : scene.primitives) endless_.push_back(primitive_box(p).empty());
    // Children come after parents.
    for (size_t g = scene.groups.size(); g-- > 0;)
      for (const Placement& p : scene.groups[g].placements) holds_[g] = holds_[g] || leads(p);
    if (!holds_.empty() && holds_[0]) visit(0, {}, kNone);
  }
  std::vector<Face> all;

 private:
  bool leads(const Placement& p) const {
    return p.kind == TargetKind::primitive ? endless_[p.target] : p.kind == TargetKind::group && holds_[p.target];
  }
  void visit(uint32_t group, const Affine3& to_world, uint32_t override_by) {
    for (const Placement& p : scene_.groups[group].placements) {
      if (all.size() >= kMostReported) return;
      if (!leads(p)) continue;
      const Affine3 here = to_world * p.to_parent;
      const uint32_t material = override_by == kNone ? p.material_override : override_by;
      if (p.kind == TargetKind::group)
        visit(p.target, here, material);
      else
        add(scene_.primitives[p.target], here, material);
    }
  }
  void add(const Primitive& p, const Affine3& here, uint32_t override_by) {
    const uint32_t m = override_by == kNone ? p.material : override_by;
    if (m == kNone) return;
    const Material* material = &scene_.materials[m];
    const auto face = [&](double z, double up) {
      all.push_back({&p, material, here.point({0, 0, z}), normalized(here.normal({0, 0, up}))});
    };
    if (p.kind == PrimitiveKind::plane) return face(0, 1);
    face(p.parameters[2], -1), face(p.parameters[5], 1);
  }
  const Scene& scene_;
  std::vector<bool> endless_;  // each primitive
  std::vector<bool> holds_;    // each group: one of them, on some level
};

// Does something end the half-space that begins at `from` and goes on along `onward`?
bool ended(const Scene& scene, const std::vector<Face>& faces, const Face& from, Dir onward, uint32_t medium) {
  for (const Face& f : faces) {
    if (dot(onward, f.point - from.point) <= kBeyond && std::fabs(dot(onward, f.normal)) > 1 - kBeyond) continue;
    const bool behind = dot(onward, f.normal) < 0;
    const uint32_t beyond = behind ? f.material->inside : f.material->outside;
    // Leaving one body of the medium does not lead out of another.
    if (!f.material->is_boundary() || (behind && beyond != medium)) return true;
  }
  const Box3& box = scene.bounds;
  if (box.empty()) return false;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                 corner & 4 ? box.high.z : box.low.z};
    if (dot(onward, p - from.point) > kBeyond) return true;
  }
  return false;
}

EndlessMedium worst(const Medium& m, std::span<const SpectralWindow> windows) {
  std::vector<double> um;
  for (const Curve* c : {&m.absorption, &m.scattering})
    if (!c->is_constant()) um.insert(um.end(), c->wavelength_um().begin(), c->wavelength_um().end());
  for (const SpectralWindow& w : windows) um.push_back(w.low_um), um.push_back(w.high_um);
  const auto matters = [&](double w) {
    return windows.empty() ||
           std::any_of(windows.begin(), windows.end(), [&](auto& r) { return w >= r.low_um && w <= r.high_um; });
  };
  const bool alike = m.absorption.is_constant() && m.scattering.is_constant();
  EndlessMedium out{m.id, "", 0, 0};
  for (const double w : alike ? std::vector<double>{1} : um) {
    if ((!alike && !matters(w)) || !m.absorption.covers(w, w) || !m.scattering.covers(w, w)) continue;
    const double a = m.absorption.at(w), s = m.scattering.at(w), n = s > 0 ? (a + s) / a : 0;
    if (n > out.scatterings) out.scatterings = n, out.at_um = alike ? 0 : w;
  }
  return out;
}

}  // namespace

std::vector<EndlessMedium> endless_media(const Scene& scene, std::span<const SpectralWindow> windows) {
  std::vector<EndlessMedium> found;
  if (scene.ambient != kNone)
    if (EndlessMedium one = worst(scene.media[scene.ambient], windows); one.scatterings >= kMany)
      found.push_back(std::move(one));
  const Faces faces(scene);
  for (const Face& f : faces.all) {
    if (f.primitive->kind != PrimitiveKind::plane) continue;
    for (const bool behind : {true, false}) {
      const uint32_t medium = behind ? f.material->inside : f.material->outside;
      if (medium == kNone) continue;
      EndlessMedium one = worst(scene.media[medium], windows);
      if (one.scatterings < kMany || ended(scene, faces.all, f, behind ? -f.normal : f.normal, medium)) continue;
      one.surface = f.primitive->name;
      found.push_back(std::move(one));
    }
  }
  return found;
}

}  // namespace suite
