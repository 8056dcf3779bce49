#include "transport/refracting_sheet.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "transport/refracted_ray.h"

namespace suite {

namespace {

constexpr size_t kMostTriangles = size_t{1} << 24;

Vec3 vertex(const Mesh& mesh, const Affine3& place, uint32_t i) {
  const float* p = &mesh.positions[3 * size_t{i}];
  return place.point(mesh.origin + Vec3{double{p[0]}, double{p[1]}, double{p[2]}});
}

}  // namespace

std::optional<RefractingSheet> RefractingSheet::of(const Tracer& tracer, uint32_t number, const TracedObject& object) {
  if (object.node != kNone || tracer.periodic()) return std::nullopt;
  RefractingSheet sheet;
  const Affine3 place = tracer.place(number);
  if (object.primitive != kNone) {
    if (tracer.scene().primitives[object.primitive].kind != PrimitiveKind::plane) return std::nullopt;
    sheet.axis_ = normalized(place.normal({0, 0, 1}));
    sheet.low_ = sheet.high_ = dot(sheet.axis_, place.point({0, 0, 0}));
    return sheet;
  }
  const Mesh& mesh = tracer.scene().meshes[object.mesh];
  if (mesh.normals.empty() || mesh.triangle_count() > kMostTriangles) return std::nullopt;
  mesh.require();
  if (!sheet.add(mesh, place)) return std::nullopt;
  return sheet;
}

// Heights, and how much normals turn.
bool RefractingSheet::add(const Mesh& mesh, const Affine3& place) {
  Vec3 sum;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* i = &mesh.indices[3 * t];
    const Vec3 a = vertex(mesh, place, i[0]);
    sum += cross(vertex(mesh, place, i[1]) - a, vertex(mesh, place, i[2]) - a);
  }
  if (!(length(sum) > 0)) return false;
  axis_ = normalized(sum);
  low_ = INFINITY, high_ = -INFINITY;
  const Frame across = Frame::around(axis_);
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    Vec3 p[3], n[3];
    for (int k : {0, 1, 2}) {
      const uint32_t i = mesh.indices[3 * t + static_cast<size_t>(k)];
      p[k] = across.to_local(vertex(mesh, place, i));
      n[k] = normalized(across.to_local(place.normal(oct_decode(mesh.normals[i]))));
      low_ = std::min(low_, p[k].z), high_ = std::max(high_, p[k].z);
      least_cosine_ = std::min(least_cosine_, n[k].z);
    }
    const Vec3 e = p[1] - p[0], f = p[2] - p[0], normal = cross(e, f);
    if (!(normal.z > 0)) return false;
    least_cosine_ = std::min(least_cosine_, normal.z / length(normal));
    // Interpolated normals are at least as long as the cosine of half the angle between the vertices'.
    const Vec3 de = n[1] - n[0], df = n[2] - n[0];
    const Vec3 dx = (de * f.y - df * e.y) / normal.z, dy = (df * e.x - de * f.x) / normal.z;
    const double shortest = std::min({dot(n[0], n[1]), dot(n[0], n[2]), dot(n[1], n[2])});
    if (!(shortest > 0.5)) return false;
    turn_ = std::max(turn_, std::sqrt(dot(dx, dx) + dot(dy, dy)) / std::sqrt(0.5 * (1 + shortest)));
  }
  return least_cosine_ > 0.5 && lies_once(mesh, place);
}

// All triangles face along the axis; they do not lie over each other if together they cover the rectangle around them
// once, and have no edges of their own but on its sides: a hash of all directed edges inside it, of which opposite ones
// cancel, is 0.
bool RefractingSheet::lies_once(const Mesh& mesh, const Affine3& place) const {
  constexpr double kNear = 1e-6;  // of the rectangle's sides
  const Frame across = Frame::around(axis_);
  std::vector<Vec3> flat(mesh.vertex_count());
  Box3 box;
  for (size_t i = 0; i < flat.size(); ++i) {
    flat[i] = across.to_local(vertex(mesh, place, static_cast<uint32_t>(i)));
    flat[i].z = 0;
    box.grow(flat[i]);
  }
  const Vec3 size = box.size();
  const auto on_side = [&](Vec3 a, Vec3 b) {
    const auto near = [](double x, double y, double to, double side) {
      return std::fabs(x - to) <= kNear * side && std::fabs(y - to) <= kNear * side;
    };
    return near(a.x, b.x, box.low.x, size.x) || near(a.x, b.x, box.high.x, size.x) ||
           near(a.y, b.y, box.low.y, size.y) || near(a.y, b.y, box.high.y, size.y);
  };
  double area = 0;
  uint64_t open = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* i = &mesh.indices[3 * t];
    area += 0.5 * cross(flat[i[1]] - flat[i[0]], flat[i[2]] - flat[i[0]]).z;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = i[k], b = i[(k + 1) % 3];
      if (on_side(flat[a], flat[b])) continue;
      const uint64_t edge = hash_of(std::min(a, b), std::max(a, b));
      open += a < b ? edge : 0 - edge;
    }
  }
  return open == 0 && std::fabs(area - size.x * size.y) <= 1e-3 * area;
}

std::optional<Dir> RefractingSheet::guess(Dir to, double index) const {
  return unbent(to, axis_, dot(to, axis_) > 0 ? 1 / index : index);
}

RefractingSheet::Ways RefractingSheet::ways(Vec3 place, Dir to, double index) const {
  constexpr double kSafe = 0.9, kFlattest = 1.4;  // of the Lipschitz constant; rad from the axis
  const bool front = dot(to, axis_) > 0;
  const double cosine = std::min(1.0, std::fabs(dot(to, axis_))), here = dot(place, axis_);
  const double tilt = std::acos(std::min(1.0, least_cosine_)), incidence = std::acos(cosine);
  const double ratio = front ? 1 / index : index;  // of the index beyond over that of the place
  if (!(kPi / 2 - incidence > 3 * tilt) || !(ratio < std::cos(2 * tilt))) return Ways::unknown;
  // Heights against the light.
  if (front ? here > high_ : here < low_) return Ways::none;
  if (front ? here >= low_ : here <= high_) return Ways::unknown;
  const double deep = front ? high_ - here : here - low_;
  const double steepest = std::min(kPi / 2, incidence + tilt), least = std::max(0.0, incidence - tilt);
  const double bent = std::asin(ratio * std::sin(steepest)) + tilt;
  if (!(bent < kFlattest)) return Ways::unknown;
  double shift = 0, swing = 0;  // of the bent direction along and across the normal, as the normal turns
  for (const double c : {std::cos(steepest), std::cos(least)}) {
    const double inside = std::sqrt(1 - ratio * ratio * (1 - c * c));
    shift = std::max(shift, std::fabs(ratio * c - inside));
    swing = std::max(swing, std::fabs(ratio - ratio * ratio * c / inside));
  }
  const double far = std::tan(bent), per_turn = (shift + swing) / std::cos(bent) * (1 + far);
  return std::tan(tilt) * far + deep * per_turn * turn_ < kSafe ? Ways::one : Ways::unknown;
}

RefractingSheet::Ways RefractingSheet::ways_between(Vec3 one, Vec3 other) const {
  const double a = dot(one, axis_) - low_, b = dot(other, axis_) - low_;
  if (low_ != high_ || turn_ != 0 || least_cosine_ != 1 || a == 0 || b == 0) return Ways::unknown;
  return (a > 0) == (b > 0) ? Ways::none : Ways::one;
}

}  // namespace suite
