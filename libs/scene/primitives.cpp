#include "scene/primitives.h"

#include <cmath>

namespace suite {

namespace {

constexpr double kMostWaves = 1e5;  // across a sinusoid: a ray along the surface looks at each of them

void check_terms(const Primitive& p, size_t fixed, const Where& where) {
  const auto& a = p.parameters;
  for (size_t i = fixed; i < a.size(); i += 4) {
    const std::string term = strf("sinusoid '%s', term %zu: ", p.name.c_str(), (i - fixed) / 4 + 1);
    const double waves = (std::fabs(a[i + 1]) * a[0] + std::fabs(a[i + 2]) * a[1]) / (2 * kPi);
    if (!(std::fabs(a[i]) <= 1e9)) throw Error(where, term + strf("an amplitude of %g m", a[i]), "at most 1e9 m");
    if (!(waves <= kMostWaves))
      throw Error(where, term + strf("%.3g waves fit across the surface", waves),
                  strf("at most %g: lower kx and ky (1/m), or the extent", kMostWaves));
  }
}

}  // namespace

bool is_layer(std::span<const double> a) { return a[0] == 0 && a[1] == 0 && a[3] == 0 && a[4] == 0; }

std::span<const PrimitiveRow> primitive_rows() {
  constexpr double tiny = 1e-9, huge = 1e9;
  static const std::vector<PrimitiveRow> rows{
      {"plane",
       PrimitiveKind::plane,
       "z = 0, facing up; UV (0, 0) to (1, 1) over the rectangle, metres when infinite",
       {{"width", "m", "extent along x, centred; 0 = infinite", 0, huge, 0.0},
        {"depth", "m", "extent along y, centred; 0 = infinite", 0, huge, 0.0}}},
      {"disk",
       PrimitiveKind::disk,
       "z = 0, facing up; u = radius share, v = azimuth / 2 pi",
       {{"radius", "m", "outer radius", tiny, huge, {}}, {"inner_radius", "m", "radius of the hole", 0, huge, 0.0}}},
      {"box",
       PrimitiveKind::box,
       "axis-aligned; UV (0, 0) to (1, 1) on every face; without x and y a layer without end, UV in metres",
       {{"x0", "m", "low corner", -huge, huge, 0.0},
        {"y0", "m", "low corner", -huge, huge, 0.0},
        {"z0", "m", "low corner", -huge, huge, {}},
        {"x1", "m", "high corner", -huge, huge, 0.0},
        {"y1", "m", "high corner", -huge, huge, 0.0},
        {"z1", "m", "high corner", -huge, huge, {}}}},
      {"sphere",
       PrimitiveKind::sphere,
       "around the origin; u = azimuth / 2 pi, v = polar angle from +z / pi",
       {{"radius", "m", "radius", tiny, huge, {}}}},
      {"cone",
       PrimitiveKind::cone,
       "from z = 0 up; u = azimuth / 2 pi, v = z / height on the side",
       {{"radius", "m", "radius at z = 0", tiny, huge, {}},
        {"top_radius", "m", "radius at z = height (frustum)", 0, huge, 0.0},
        {"height", "m", "height", tiny, huge, {}},
        {"capped", "1", "1 = closed by disks", 0, 1, 1.0}}},
      {"cylinder",
       PrimitiveKind::cylinder,
       "from z = 0 up; u = azimuth / 2 pi, v = z / height on the side",
       {{"radius", "m", "radius", tiny, huge, {}},
        {"height", "m", "height", tiny, huge, {}},
        {"capped", "1", "1 = closed by disks", 0, 1, 1.0}}},
      {"sinusoid",
       PrimitiveKind::sinusoid,
       "height field z = sum of a sin(kx x + ky y + phase) over a rectangle; UV (0, 0) to (1, 1) over it",
       {{"width", "m", "extent along x, centred", tiny, huge, {}},
        {"depth", "m", "extent along y, centred", tiny, huge, {}}}}};
  return rows;
}

void check_primitive(const Primitive& p, const Where& where) {
  const auto index = static_cast<size_t>(p.kind);
  if (index >= primitive_rows().size()) throw Error(where, strf("primitive kind %zu is not known", index));
  const PrimitiveRow& row = primitive_rows()[index];
  const size_t fixed = row.parameters.size();
  const bool terms = p.kind == PrimitiveKind::sinusoid;
  if (terms ? p.parameters.size() < fixed + 4 || (p.parameters.size() - fixed) % 4 : p.parameters.size() != fixed)
    throw Error(where, strf("%s '%s' has %zu parameters", row.name.c_str(), p.name.c_str(), p.parameters.size()),
                terms ? "at least one term of four numbers is needed" : strf("%zu are needed", fixed));
  for (size_t i = 0; i < p.parameters.size(); ++i) {
    const double v = p.parameters[i];
    if (!std::isfinite(v) || (i < fixed && !(v >= row.parameters[i].low && v <= row.parameters[i].high)))
      throw Error(where, strf("%s '%s': %s = %g is out of range", row.name.c_str(), p.name.c_str(),
                              i < fixed ? row.parameters[i].name.c_str() : "a term", v));
  }
  const auto& a = p.parameters;
  if (terms) check_terms(p, fixed, where);
  if (p.kind == PrimitiveKind::plane && (a[0] == 0) != (a[1] == 0))
    throw Error(where, "plane '" + p.name + "': give both width and depth, or neither for an infinite one");
  if (p.kind == PrimitiveKind::box && !(((a[0] < a[3] && a[1] < a[4]) || is_layer(a)) && a[2] < a[5]))
    throw Error(where, "box '" + p.name + "' is empty", "low corner first; only z0 and z1 for a layer without end");
  if (p.kind == PrimitiveKind::disk && !(a[1] < a[0]))
    throw Error(where, "disk '" + p.name + "': the hole is larger than the disk");
}

Box3 primitive_box(const Primitive& p) {
  check_primitive(p, {});
  const auto& a = p.parameters;
  const auto around = [](double x, double y, double z0, double z1) { return Box3{{-x, -y, z0}, {x, y, z1}}; };
  switch (p.kind) {
    case PrimitiveKind::plane:
      return a[0] == 0 ? Box3{} : around(a[0] / 2, a[1] / 2, 0, 0);
    case PrimitiveKind::disk:
      return around(a[0], a[0], 0, 0);
    case PrimitiveKind::box:
      return is_layer(a) ? Box3{} : Box3{{a[0], a[1], a[2]}, {a[3], a[4], a[5]}};
    case PrimitiveKind::sphere:
      return around(a[0], a[0], -a[0], a[0]);
    case PrimitiveKind::cone:
      return around(std::fmax(a[0], a[1]), std::fmax(a[0], a[1]), 0, a[2]);
    case PrimitiveKind::cylinder:
      return around(a[0], a[0], 0, a[1]);
    case PrimitiveKind::sinusoid: {
      double sum = 0;
      for (size_t i = 2; i < a.size(); i += 4) sum += std::fabs(a[i]);
      return around(a[0] / 2, a[1] / 2, -sum, sum);
    }
  }
  return {};
}

}  // namespace suite
