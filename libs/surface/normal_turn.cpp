#include "surface/normal_turn.h"

#include <algorithm>
#include <cmath>

#include "surface/tangents.h"

namespace suite {

namespace {

// Local normal (any length) of an exact surface at a local place, and its change over a local step.
struct LocalTurn {
  Vec3 n, dn;
};

LocalTurn turn_of_cone(double r0, double slope, Vec3 p, Vec3 step) {
  return {{p.x, p.y, -slope * (r0 + slope * p.z)}, {step.x, step.y, -slope * slope * step.z}};
}

LocalTurn turn_of_sinusoid(const std::vector<double>& a, Vec3 p, Vec3 step) {
  LocalTurn turn{{0, 0, 1}, {}};
  for (size_t i = 2; i < a.size(); i += 4) {
    const double phase = a[i + 1] * p.x + a[i + 2] * p.y + a[i + 3], c = a[i] * std::cos(phase),
                 s = a[i] * std::sin(phase) * (a[i + 1] * step.x + a[i + 2] * step.y);
    turn.n.x -= c * a[i + 1], turn.n.y -= c * a[i + 2];
    turn.dn.x += s * a[i + 1], turn.dn.y += s * a[i + 2];
  }
  return turn;
}

// local_normal: of the hit, to tell a cone's side from its caps.
LocalTurn local_turn(const Primitive& primitive, Vec3 p, Vec3 step, Dir local_normal) {
  const std::vector<double>& a = primitive.parameters;
  switch (primitive.kind) {
    case PrimitiveKind::sphere:
      return {p, step};
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder:
      if (std::fabs(local_normal.z) > 1 - 1e-12) return {};
      if (primitive.kind == PrimitiveKind::cylinder) return turn_of_cone(a[0], 0, p, step);
      return turn_of_cone(a[0], (a[1] - a[0]) / a[2], p, step);
    case PrimitiveKind::sinusoid:
      return turn_of_sinusoid(a, p, step);
    case PrimitiveKind::plane:
    case PrimitiveKind::disk:
    case PrimitiveKind::box:
      return {};
  }
  return {};
}

Vec3 turn_of_exact(const Primitive& primitive, const Affine3& place, const Hit& hit, Vec3 step) {
  const Vec3 r0{place.a[0], place.a[1], place.a[2]}, r1{place.a[3], place.a[4], place.a[5]},
      r2{place.a[6], place.a[7], place.a[8]};
  const Vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  const double det = dot(r0, c0);
  if (det == 0) return {};
  const auto inverse = [&](Vec3 v) { return (c0 * v.x + c1 * v.y + c2 * v.z) / det; };
  const Dir upright = normalized(r0 * hit.normal.x + r1 * hit.normal.y + r2 * hit.normal.z);
  const LocalTurn turn = local_turn(primitive, inverse(hit.position - place.b), inverse(step), upright);
  const Vec3 n = place.normal(turn.n), dn = place.normal(turn.dn);
  const double len = length(n);
  if (!(len > 0)) return {};
  const Dir unit = n / len;
  return (dn - unit * dot(unit, dn)) * ((dot(unit, hit.normal) < 0 ? -1 : 1) / len);
}

// Change of position per unit of Hit::u and of Hit::v, m.
struct Moves {
  Vec3 du, dv;
};

Moves moves_in(const Mesh& mesh, const Affine3& place, uint32_t triangle) {
  const uint32_t* i = &mesh.indices[3 * size_t{triangle}];
  const auto vertex = [&](uint32_t k) {
    const float* p = &mesh.positions[3 * size_t{k}];
    return Vec3{double{p[0]}, double{p[1]}, double{p[2]}};
  };
  return {place.vector(vertex(i[1]) - vertex(i[0])), place.vector(vertex(i[2]) - vertex(i[0]))};
}

// Of interpolated normals of vertices that nothing else bends; false where the normal at the hit is another one.
bool turn_of_vertices(const Mesh& mesh, const Affine3& place, const Hit& hit, const Interaction& at, const Moves& moves,
                      NormalTurn& turn) {
  const uint32_t* i = &mesh.indices[3 * size_t{hit.triangle}];
  const Vec3 n0 = oct_decode(mesh.normals[i[0]]), du = oct_decode(mesh.normals[i[1]]) - n0,
             dv = oct_decode(mesh.normals[i[2]]) - n0;
  const Vec3 n = place.normal(n0 + du * double{hit.u} + dv * double{hit.v});
  const double len = length(n), along = length(moves.du), across = length(moves.dv);
  if (!(len > 0) || !(along > 0) || !(across > 0)) return false;
  const double sign = dot(n, hit.normal) < 0 ? -1 : 1;
  const Dir unit = n * (sign / len);
  if (length(unit - at.frame.z) > 1e-12) return false;
  const auto change = [&](Vec3 by, double over) {
    const Vec3 d = place.normal(by) * (sign / (len * over));
    return d - unit * dot(unit, d);
  };
  turn.tangent[0] = moves.du / along, turn.tangent[1] = moves.dv / across;
  turn.per_m[0] = change(du, along), turn.per_m[1] = change(dv, across);
  return true;
}

// Shares of two vectors in a third one of their plane.
Vec2 shares(Vec3 a, Vec3 b, Vec3 of) {
  const double e = dot(a, a), f = dot(a, b), g = dot(b, b), det = e * g - f * f;
  if (!(det > 0)) return {0, 0};
  const double x = dot(of, a), y = dot(of, b);
  return {(g * x - f * y) / det, (e * y - f * x) / det};
}

// m, small beside what the normal changes over: an edge of a triangle, a pixel of a map.
double small_step(const Moves& moves, bool mesh, const MaterialMaps* maps, const SurfaceTangents& tangents) {
  constexpr double kOfEdge = 1e-3, kOfPixel = 0.02;
  double step = mesh ? kOfEdge * std::min(length(moves.du), length(moves.dv)) : INFINITY;
  for (const PropertyMap* map : {maps ? maps->bump : nullptr, maps ? maps->normal : nullptr}) {
    if (!map) continue;
    const double pixel = map->projection == Projection::drape
                             ? std::min(map->drape.gsd_x, map->drape.gsd_y)
                             : std::min(length(tangents.dpdu) / map->width, length(tangents.dpdv) / map->height);
    step = std::min(step, kOfPixel * pixel);
  }
  return step;
}

}  // namespace

Vec3 NormalTurn::over(Vec3 step) const {
  const Vec2 s = shares(tangent[0], tangent[1], step);
  return per_m[0] * s.x + per_m[1] * s.y;
}

NormalTurn normal_turn(const Surface& surface, const Hit& hit, Dir out, const Interaction& at, Interaction& beside) {
  const Tracer& tracer = surface.tracer();
  const Scene& scene = tracer.scene();
  const TracedObject object = tracer.object(hit.object);
  const bool mesh = object.mesh != kNone;
  const MaterialMaps* maps = at.baked && at.baked->maps && at.baked->maps->bends() ? at.baked->maps.get() : nullptr;
  NormalTurn turn;
  const Frame frame = Frame::around(hit.normal);
  turn.tangent[0] = frame.x, turn.tangent[1] = frame.y;
  if (mesh && !maps && scene.meshes[object.mesh].normals.empty()) return turn;
  const Affine3 place = tracer.to_world(hit);
  const auto exact = [&](Vec3 step) {
    return mesh ? Vec3{} : turn_of_exact(scene.primitives[object.primitive], place, hit, step);
  };
  if (!mesh && !maps) {
    for (int i : {0, 1}) turn.per_m[i] = exact(turn.tangent[i]);
    return turn;
  }
  const SurfaceTangents tangents = maps ? tangents_at(scene, place, object, hit) : SurfaceTangents{};
  const Moves moves =
      mesh ? moves_in(scene.meshes[object.mesh], place, hit.triangle) : Moves{tangents.dpdu, tangents.dpdv};
  if (mesh && !maps && turn_of_vertices(scene.meshes[object.mesh], place, hit, at, moves, turn)) return turn;
  const double step = small_step(moves, mesh, maps, tangents);
  for (int i : {0, 1}) {
    const Vec2 share = shares(moves.du, moves.dv, turn.tangent[i] * step);
    Vec3 normal[2], moved[2];
    for (int side : {0, 1}) {
      Hit there = hit;
      there.u = static_cast<float>(hit.u + (side ? share.x : -share.x));
      there.v = static_cast<float>(hit.v + (side ? share.y : -share.y));
      moved[side] = moves.du * (double{there.u} - double{hit.u}) + moves.dv * (double{there.v} - double{hit.v});
      there.position = hit.position + moved[side];
      there.normal = normalized(hit.normal + exact(moved[side]));
      surface.interact(there, out, beside);
      normal[side] = beside.frame.z;
    }
    const Vec3 way = moved[1] - moved[0];
    const double len = length(way);
    if (!(len > 0)) return NormalTurn{{frame.x, frame.y}, {}};
    turn.tangent[i] = way / len;
    turn.per_m[i] = (normal[1] - normal[0]) / len;
  }
  return turn;
}

}  // namespace suite
