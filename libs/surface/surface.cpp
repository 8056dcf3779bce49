#include "surface/surface.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// Column or row of a map under its extension rule; -1 outside.
long extended(double position, uint32_t size, Drape::Extend rule) {
  const double cell = std::floor(position);
  if (cell >= 0 && cell < size) return static_cast<long>(cell);
  if (!(std::fabs(cell) < 1e15)) return -1;
  switch (rule) {
    case Drape::Extend::clamp: return cell < 0 ? 0 : static_cast<long>(size) - 1;
    case Drape::Extend::repeat: {
      const long r = static_cast<long>(std::fmod(cell, size));
      return r < 0 ? r + static_cast<long>(size) : r;
    }
    case Drape::Extend::none: return -1;
  }
  return -1;
}

}  // namespace

uint32_t class_at(const ClassMap& map, double x, double y) {
  const long column = extended((x - map.drape.origin_x) / map.drape.gsd_x, map.width, map.drape.extend);
  const long row = extended((map.drape.origin_y - y) / map.drape.gsd_y, map.height, map.drape.extend);
  if (column < 0 || row < 0) return kNone;
  return map.classes[static_cast<size_t>(row) * map.width + static_cast<size_t>(column)];
}

Surface::Surface(const Tracer& tracer, const Optics& optics)
    : tracer_(tracer), optics_(optics), map_of_material_(tracer.scene().materials.size(), kNone) {
  for (const MapBinding& b : tracer.scene().map_bindings) map_of_material_[b.material] = b.class_map, any_maps_ = true;
}

uint32_t Surface::mapped(uint32_t material, const Hit& hit) const {
  const uint32_t index = map_of_material_[material];
  if (index == kNone) return material;
  const ClassMap& map = tracer_.scene().class_maps[index];
  uint32_t cls = kNone;
  if (map.projection == Projection::drape) {
    cls = class_at(map, hit.position.x, hit.position.y);
  } else {
    const Vec2 t = uv(hit);  // v runs upwards in texture space, rows run downwards
    const double x = t.x * map.width, y = (1 - t.y) * map.height;
    const long column = extended(x, map.width, map.drape.extend), row = extended(y, map.height, map.drape.extend);
    if (column >= 0 && row >= 0) cls = map.classes[static_cast<size_t>(row) * map.width + static_cast<size_t>(column)];
  }
  return cls == kNone ? material : map.materials[cls];
}

uint32_t Surface::material(const Hit& hit) const {
  const TracedObject& object = tracer_.objects()[hit.object];
  uint32_t material = object.material_override;
  if (material == kNone && object.primitive != kNone) {
    material = tracer_.scene().primitives[object.primitive].material;
  } else if (material == kNone) {
    const Mesh& mesh = tracer_.scene().meshes[object.mesh];
    const auto part = mesh.parts.size() == 1 ? mesh.parts.begin()
                                             : std::upper_bound(mesh.parts.begin(), mesh.parts.end(), hit.triangle,
                                                                [](uint32_t t, const Part& p) { return t < p.first_triangle; }) - 1;
    material = part->material;
  }
  return any_maps_ && material != kNone ? mapped(material, hit) : material;
}

Vec2 Surface::uv(const Hit& hit) const {
  const TracedObject& object = tracer_.objects()[hit.object];
  if (object.primitive != kNone) return {hit.u, hit.v};
  const Mesh& mesh = tracer_.scene().meshes[object.mesh];
  if (mesh.uvs.empty()) return {hit.u, hit.v};
  const uint32_t* i = &mesh.indices[3 * size_t{hit.triangle}];
  const double a = 1.0 - hit.u - hit.v, b = hit.u, c = hit.v;
  return {a * mesh.uvs[2 * size_t{i[0]}] + b * mesh.uvs[2 * size_t{i[1]}] + c * mesh.uvs[2 * size_t{i[2]}],
          a * mesh.uvs[2 * size_t{i[0]} + 1] + b * mesh.uvs[2 * size_t{i[1]} + 1] + c * mesh.uvs[2 * size_t{i[2]} + 1]};
}

void Surface::interact(const Hit& hit, Dir out, Interaction& at) const {
  const TracedObject& object = tracer_.objects()[hit.object];
  at.position = hit.position;
  at.geometric_normal = hit.normal;
  Dir n = hit.normal;
  if (object.mesh != kNone && !tracer_.scene().meshes[object.mesh].normals.empty()) {
    const Mesh& mesh = tracer_.scene().meshes[object.mesh];
    const uint32_t* i = &mesh.indices[3 * size_t{hit.triangle}];
    const Vec3 local = oct_decode(mesh.normals[i[0]]) * (1.0 - hit.u - hit.v) + oct_decode(mesh.normals[i[1]]) * double{hit.u} +
                       oct_decode(mesh.normals[i[2]]) * double{hit.v};
    const Vec3 world = tracer_.to_world(hit).normal(local);
    if (const double len = length(world); len > 0) n = world / len;
    if (dot(n, hit.normal) < 0) n = -n;  // vertex normals against the winding: the winding decides the front
    // A shading normal that turns away from the viewer would make a black edge: bend it back just into view.
    const double side = dot(out, hit.normal) >= 0 ? 1 : -1, seen = side * dot(out, n);
    if (seen < 1e-3) n = normalized(n + out * (side * (1e-3 - seen)));
  }
  at.frame = Frame::around(n);
  at.material = material(hit);
  at.baked = at.material == kNone ? nullptr : &optics_.material(at.material);
}

}  // namespace suite
