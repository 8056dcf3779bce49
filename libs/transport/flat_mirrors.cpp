#include "transport/flat_mirrors.h"

#include <algorithm>

namespace suite {

namespace {

constexpr size_t kMostMirrorTriangles = 65536, kMostObjects = size_t{1} << 20;
constexpr double kParallel = 1e-6;  // rad

Vec3 placed_vertex(const Mesh& mesh, const Affine3& place, uint32_t i) {
  const float* p = &mesh.positions[3 * size_t{i}];
  return place.point(mesh.origin + Vec3{double{p[0]}, double{p[1]}, double{p[2]}});
}

}  // namespace

FlatMirrors::FlatMirrors(const Tracer& tracer, const Optics& optics) {
  const Scene& scene = tracer.scene();
  if (tracer.periodic() || tracer.object_count() > kMostObjects) return;
  std::vector<uint8_t> smooth;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const BakedMaterial& m = optics.material(i);
    smooth.push_back(m.model && m.model->has_delta() && !(m.maps && m.maps->bends()));
  }
  const auto is_smooth = [&](uint32_t material) { return material != kNone && smooth[material]; };
  const auto wanted = [&](const TracedObject& o) {
    if (o.node != kNone) return false;
    if (o.material_override != kNone) return is_smooth(o.material_override);
    if (o.primitive != kNone) return is_smooth(scene.primitives[o.primitive].material);
    const auto& parts = scene.meshes[o.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return is_smooth(p.material); });
  };
  tracer.each("smooth surfaces", wanted, [&](uint32_t number, const TracedObject& object) {
    any_ = true;
    const std::vector<Dir> before = normals_;
    if (!add(tracer, number, object)) {
      normals_ = before;
      return;
    }
    if (flat_.size() <= number) flat_.resize(number + 1, 0);
    flat_[number] = 1;
  });
}

bool FlatMirrors::add(const Tracer& tracer, uint32_t number, const TracedObject& object) {
  const Scene& scene = tracer.scene();
  const Affine3 place = tracer.place(number);
  if (object.primitive != kNone) {
    const PrimitiveKind kind = scene.primitives[object.primitive].kind;
    const bool level = kind == PrimitiveKind::plane || kind == PrimitiveKind::disk;
    if (!level && kind != PrimitiveKind::box) return false;
    if (!add_normal(normalized(place.normal({0, 0, 1})))) return false;
    return level ||
           (add_normal(normalized(place.normal({1, 0, 0}))) && add_normal(normalized(place.normal({0, 1, 0}))));
  }
  const Mesh& mesh = scene.meshes[object.mesh];
  if (mesh.triangle_count() > kMostMirrorTriangles) return false;
  mesh.require();
  if (!mesh.normals.empty()) return false;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* i = &mesh.indices[3 * t];
    const Vec3 a = placed_vertex(mesh, place, i[0]);
    const Vec3 n = cross(placed_vertex(mesh, place, i[1]) - a, placed_vertex(mesh, place, i[2]) - a);
    if (length(n) > 0 && !add_normal(normalized(n))) return false;
  }
  return true;
}

bool FlatMirrors::add_normal(Dir normal) {
  for (const Dir& n : normals_)
    if (length(cross(n, normal)) < kParallel) return true;
  if (normals_.size() == kMost) return false;
  normals_.push_back(normal);
  return true;
}

}  // namespace suite
