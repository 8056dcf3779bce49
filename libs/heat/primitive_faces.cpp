#include "heat/primitive_faces.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

double share(double value, double low, double high) { return std::clamp((value - low) / (high - low), 0.0, 1.0); }

// A share of a turn, as rays find it.
double turn_of(Vec3 p) {
  const double phi = std::atan2(p.y, p.x) / (2 * kPi);
  return phi < 0 ? phi + 1 : phi;
}

Vec3 around(double radius, double turn, double z) {
  return {radius * std::cos(2 * kPi * turn), radius * std::sin(2 * kPi * turn), z};
}

}  // namespace

void PrimitiveFaces::add(double area, double along_a, double along_b) {
  areas_.push_back(area);
  lengths_.push_back({along_a, along_b});
}

PrimitiveFaces::PrimitiveFaces(const Primitive& primitive, const Box3& reach)
    : kind_(primitive.kind), p_(primitive.parameters), reach_(reach) {
  switch (kind_) {
    case PrimitiveKind::plane:
      endless_ = p_[0] == 0;
      if (!endless_) reach_ = {{-p_[0] / 2, -p_[1] / 2, 0}, {p_[0] / 2, p_[1] / 2, 0}};
      break;
    case PrimitiveKind::box:
      endless_ = is_layer(p_);
      break;
    case PrimitiveKind::sinusoid:
      reach_ = {{-p_[0] / 2, -p_[1] / 2, 0}, {p_[0] / 2, p_[1] / 2, 0}};
      break;
    default:
      break;
  }
  const Vec3 size = reach_.size();
  switch (kind_) {
    case PrimitiveKind::plane:
      add(size.x * size.y, size.x, size.y);
      break;
    case PrimitiveKind::disk:
      add(kPi * (p_[0] * p_[0] - p_[1] * p_[1]), kPi * (p_[0] + p_[1]), p_[0] - p_[1]);
      break;
    case PrimitiveKind::box:
      if (endless_) {
        add(size.x * size.y, size.x, size.y), add(size.x * size.y, size.x, size.y);
        break;
      }
      for (size_t axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          const size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
          add((p_[3 + b] - p_[b]) * (p_[3 + c] - p_[c]), p_[3 + b] - p_[b], p_[3 + c] - p_[c]);
        }
      break;
    case PrimitiveKind::sphere:
      add(4 * kPi * p_[0] * p_[0], 2 * kPi * p_[0], kPi * p_[0]);
      break;
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder: {
      const bool cone = kind_ == PrimitiveKind::cone;
      const double r0 = p_[0], r1 = cone ? p_[1] : p_[0], h = p_[cone ? 2 : 1], slant = std::hypot(r1 - r0, h);
      add(kPi * (r0 + r1) * slant, kPi * (r0 + r1), slant);
      if (p_[cone ? 3 : 2] == 0) break;
      add(kPi * r0 * r0, kPi * r0, r0);
      if (r1 > 0) add(kPi * r1 * r1, kPi * r1, r1);
      break;
    }
    case PrimitiveKind::sinusoid:
      add_sinusoid();
      break;
  }
}

void PrimitiveFaces::add_sinusoid() {
  double slope = 0;
  for (size_t i = 2; i < p_.size(); i += 4) slope += std::fabs(p_[i]) * std::hypot(p_[i + 1], p_[i + 2]);
  most_stretch_ = std::sqrt(1 + slope * slope);
  const Vec3 size = reach_.size();
  add(size.x * size.y, size.x, size.y);
  double mean = 0;
  constexpr int kPoints = 64;
  for (int i = 0; i < kPoints * kPoints; ++i)
    mean += point(0, (i % kPoints + 0.5) / kPoints, (i / kPoints + 0.5) / kPoints).stretch;
  areas_[0] *= mean / (kPoints * kPoints);
}

double PrimitiveFaces::cone_radius(double z) const {
  return kind_ == PrimitiveKind::cylinder ? p_[0] : p_[0] + (p_[1] - p_[0]) * z / p_[2];
}

// b is the share of the side's area below: with r0 + (r1 - r0) t its root in t.
PrimitiveFaces::Point PrimitiveFaces::on_cone(size_t face, double a, double b) const {
  const bool cone = kind_ == PrimitiveKind::cone;
  const double r0 = p_[0], r1 = cone ? p_[1] : p_[0], h = p_[cone ? 2 : 1];
  if (face > 0) {
    const double r = face == 1 ? r0 : r1, root = std::sqrt(b);
    return {around(root * r, a, face == 1 ? 0 : h), {0, 0, face == 1 ? -1.0 : 1.0}, {root, a}};
  }
  const double whole = (r0 + r1) / 2 * b;
  const double t = std::min(1.0, 2 * whole / (r0 + std::sqrt(std::max(0.0, r0 * r0 + 2 * (r1 - r0) * whole)) + 1e-300));
  const Vec3 out = around(1, a, -(r1 - r0) / h);
  return {around(cone_radius(t * h), a, t * h), normalized(out), {a, t}};
}

PrimitiveFaces::Place PrimitiveFaces::of_cone(Vec3 p) const {
  const bool cone = kind_ == PrimitiveKind::cone;
  const double r0 = p_[0], r1 = cone ? p_[1] : p_[0], h = p_[cone ? 2 : 1], r = std::hypot(p.x, p.y);
  const double z = std::clamp(p.z, 0.0, h);
  const double off_side = std::fabs(r - cone_radius(z));
  if (areas_.size() > 1 && std::fabs(p.z) < off_side && std::fabs(p.z) <= std::fabs(p.z - h))
    return {1, turn_of(p), share(r * r, 0, r0 * r0)};
  if (areas_.size() > 2 && std::fabs(p.z - h) < off_side) return {2, turn_of(p), share(r * r, 0, r1 * r1)};
  const double t = z / h;
  return {0, turn_of(p), std::clamp((r0 * t + (r1 - r0) * t * t / 2) / ((r0 + r1) / 2), 0.0, 1.0)};
}

PrimitiveFaces::Point PrimitiveFaces::point(size_t face, double a, double b) const {
  const Vec3 low = reach_.low, size = reach_.size();
  const double x = low.x + a * size.x, y = low.y + b * size.y;
  switch (kind_) {
    case PrimitiveKind::plane:
      return {{x, y, 0}, {0, 0, 1}, endless_ ? Vec2{x, y} : Vec2{a, b}};
    case PrimitiveKind::disk: {
      const double r = std::sqrt(p_[1] * p_[1] + b * (p_[0] * p_[0] - p_[1] * p_[1]));
      return {around(r, a, 0), {0, 0, 1}, {(r - p_[1]) / (p_[0] - p_[1]), a}};
    }
    case PrimitiveKind::box: {
      if (endless_) return {{x, y, p_[face == 0 ? 2 : 5]}, {0, 0, face == 0 ? -1.0 : 1.0}, {x, y}};
      const int axis = static_cast<int>(face / 2), i = (axis + 1) % 3, j = (axis + 2) % 3;
      const auto at = [&](int k, double s) {
        return p_[static_cast<size_t>(k)] + s * (p_[static_cast<size_t>(3 + k)] - p_[static_cast<size_t>(k)]);
      };
      Point out{{}, {}, {a, b}};
      out.position[axis] = at(axis, static_cast<double>(face % 2));
      out.position[i] = at(i, a), out.position[j] = at(j, b);
      out.normal[axis] = face % 2 ? 1 : -1;
      return out;
    }
    case PrimitiveKind::sphere: {
      const double z = 1 - 2 * b;
      const Vec3 n = around(std::sqrt(std::max(0.0, 1 - z * z)), a, z);
      return {n * p_[0], n, {a, polar_angle(n) / kPi}};
    }
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder:
      return on_cone(face, a, b);
    case PrimitiveKind::sinusoid:
      break;
  }
  Point out{{x, y, 0}, {0, 0, 1}, {a, b}};
  for (size_t i = 2; i < p_.size(); i += 4) {
    const double phase = p_[i + 1] * x + p_[i + 2] * y + p_[i + 3], c = p_[i] * std::cos(phase);
    out.position.z += p_[i] * std::sin(phase);
    out.normal.x -= c * p_[i + 1], out.normal.y -= c * p_[i + 2];
  }
  out.stretch = length(out.normal);
  out.normal = out.normal / out.stretch;
  return out;
}

PrimitiveFaces::Place PrimitiveFaces::place(Vec3 p) const {
  const double a = share(p.x, reach_.low.x, reach_.high.x), b = share(p.y, reach_.low.y, reach_.high.y);
  switch (kind_) {
    case PrimitiveKind::plane:
    case PrimitiveKind::sinusoid:
      return {0, a, b};
    case PrimitiveKind::disk:
      return {0, turn_of(p), share(p.x * p.x + p.y * p.y, p_[1] * p_[1], p_[0] * p_[0])};
    case PrimitiveKind::box: {
      if (endless_) return {std::fabs(p.z - p_[2]) <= std::fabs(p.z - p_[5]) ? 0u : 1u, a, b};
      size_t face = 0;
      double nearest = INFINITY;
      for (size_t f = 0; f < 6; ++f)
        if (const double off = std::fabs(p[static_cast<int>(f / 2)] - p_[3 * (f % 2) + f / 2]); off < nearest)
          nearest = off, face = f;
      const size_t i = (face / 2 + 1) % 3, j = (face / 2 + 2) % 3;
      return {face, share(p[static_cast<int>(i)], p_[i], p_[3 + i]), share(p[static_cast<int>(j)], p_[j], p_[3 + j])};
    }
    case PrimitiveKind::sphere:
      return {0, turn_of(p), share(1 - p.z / p_[0], 0, 2)};
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder:
      return of_cone(p);
  }
  return {};
}

}  // namespace suite
