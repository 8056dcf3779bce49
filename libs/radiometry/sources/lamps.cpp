#include "radiometry/sources/lamps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "math/warps.h"

namespace suite {

// What a lamp looks like from outside.
struct Lamps::Shape {
  enum class Kind : uint8_t { point, triangle, parallelogram, disk, sphere } kind = Kind::point;
  uint8_t both_sides = 0;
  uint32_t emission = 0;  // spectrum
  uint32_t light = 0;     // spec of a point
  uint32_t object = kNone;
  Vec3 origin, a, b;  // corner and edges; centre and half axes of a disk; centre and (radius, 0, 0)
  double area = 0;
  Dir normal;  // flat ones, front side
};

struct Lamps::Core {
  const Tracer& tracer;
  std::vector<LampSpec> specs;
  std::vector<Frame> frames;  // of the specs
  std::vector<std::vector<float>> spectra;
  std::vector<Shape> shapes;  // as numbered in the tree
  std::unique_ptr<LightTree> tree;
  // Per object: first shape of its triangles or of its exact surface, kNone = not in the tree. Triangles that do not
  // glow have no shape: shape_of_triangle maps those of objects that glow in parts only.
  std::unordered_map<uint32_t, std::vector<uint32_t>> shape_of_triangle;
  std::vector<const float*> front, back;  // per material
};

namespace {

double mean_of(const std::vector<float>& v) {
  double sum = 0;
  for (const float x : v) sum += static_cast<double>(x);
  return sum / static_cast<double>(v.size());
}

// Relative intensity of a point lamp into a direction of its frame.
double relative_intensity(const LampSpec& s, Dir local) {
  double value = 1;
  if (s.kind == LampSpec::Kind::spot) {
    const double cos_inner = std::cos(s.inner), cos_outer = std::cos(s.outer);
    if (local.z <= cos_outer && s.outer < kPi) return 0;
    if (local.z < cos_inner) {
      const double t = (local.z - cos_outer) / (cos_inner - cos_outer);
      value = t * t * (3 - 2 * t);
    }
  }
  if (!s.table) return value;
  const IntensityTable& t = *s.table;
  if (t.sqt) {
    double sum = 0;
    for (size_t c = 0; c < t.sqt->channels(); ++c) sum += t.sqt->value({0, 0, 1}, local, c);
    return value * sum / static_cast<double>(t.sqt->channels());
  }
  const double row = polar_angle(local) / kPi * static_cast<double>(t.polars - 1);
  double phi = azimuth(local) / (2 * kPi);
  phi -= std::floor(phi);
  const double column = phi * static_cast<double>(t.azimuths);
  const size_t r = std::min(t.polars - 2, static_cast<size_t>(row)),
               c = std::min(t.azimuths - 1, static_cast<size_t>(column)), n = (c + 1) % t.azimuths;
  const double fr = row - static_cast<double>(r), fc = column - static_cast<double>(c);
  auto at = [&](size_t i, size_t j) { return t.value[i * t.azimuths + j]; };
  return value *
         ((1 - fr) * ((1 - fc) * at(r, c) + fc * at(r, n)) + fr * ((1 - fc) * at(r + 1, c) + fc * at(r + 1, n)));
}

// The profile of a point lamp: means over 32 azimuths and 9 places within each step, its edges included. A table may
// have light between these, so none of its steps counts as dark.
LightProfile profile_of(const LampSpec& s) {
  LightProfile profile{};
  for (int step = 0; step < 32; ++step) {
    double sum = 0;
    for (int k = 0; k <= 8; ++k) {
      const double z = std::clamp(-1 + (step + k / 8.0) / 16, -1.0, 1.0), r = std::sqrt(std::max(0.0, 1 - z * z));
      for (int a = 0; a < 32; ++a) {
        const double phi = 2 * kPi * (a + 0.5) / 32;
        sum += relative_intensity(s, {r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    profile[static_cast<size_t>(step)] = static_cast<float>(sum / (9 * 32));
  }
  // A spot's rim may lie between two places as well.
  const float least = 1e-3f * *std::max_element(profile.begin(), profile.end());
  for (float& p : profile) p = std::max(p, least);
  return profile;
}

void check(const LampSpec& s) {
  const auto fail = [&](const std::string& what) { throw Error(s.where, "lamp '" + s.name + "': " + what); };
  if (s.kind == LampSpec::Kind::surface) {
    if (s.radiance.min() < 0) fail("the radiance is negative");
    return;
  }
  if (s.intensity.min() < 0) fail("the intensity is negative");
  if (s.positions.empty()) fail("no position");
  for (const Vec3& p : s.positions)
    if (!finite(p)) fail("a position is not finite");
  if (!(s.inner >= 0 && s.inner <= s.outer && s.outer <= kPi))
    fail("the cone needs 0 <= inner <= outer <= 180 degrees");
  if (!s.table || s.table->sqt) return;
  if (s.table->polars < 2 || s.table->azimuths < 1 || s.table->value.size() != s.table->polars * s.table->azimuths)
    fail("the table of the intensity has the wrong size");
  for (const double v : s.table->value)
    if (!(v >= 0) || !std::isfinite(v)) fail("the table of the intensity holds a negative or infinite value");
}

}  // namespace

Lamps::~Lamps() = default;
size_t Lamps::size() const { return core_->shapes.size(); }

namespace {

// Glowing pieces of one object as shapes; `add` receives them with the triangle they stand for (0 for exact surfaces).
template <class Shape, class Add>
void shapes_of_primitive(const Primitive& primitive, const Affine3& m, Add add) {
  const std::vector<double>& q = primitive.parameters;
  Shape s;
  auto flat = [&](Vec3 corner, Vec3 a, Vec3 b, Vec3 normal, typename Shape::Kind kind) {
    s.kind = kind;
    s.origin = m.point(corner), s.a = m.vector(a), s.b = m.vector(b);
    s.area = length(cross(s.a, s.b)) * (kind == Shape::Kind::disk ? kPi : 1);
    s.normal = normalized(m.normal(normal));
    // A mirrored placement keeps its front side (Affine3::normal turns with the determinant).
    if (m.determinant() < 0) s.normal = -s.normal;
    add(s, 0u);
  };
  switch (primitive.kind) {
    case PrimitiveKind::plane:
      if (q[0] > 0) flat({-q[0] / 2, -q[1] / 2, 0}, {q[0], 0, 0}, {0, q[1], 0}, {0, 0, 1}, Shape::Kind::parallelogram);
      return;
    case PrimitiveKind::disk:
      if (q[1] == 0) flat({0, 0, 0}, {q[0], 0, 0}, {0, q[0], 0}, {0, 0, 1}, Shape::Kind::disk);
      return;
    case PrimitiveKind::sphere: {
      // Only scaled equally along all axes: an ellipsoid is met by chance.
      const Vec3 x = m.vector({1, 0, 0}), y = m.vector({0, 1, 0}), z = m.vector({0, 0, 1});
      const double scale = length(x), slack = 1e-9 * scale * scale;
      if (std::fabs(length(y) - scale) > slack / scale || std::fabs(length(z) - scale) > slack / scale ||
          std::fabs(dot(x, y)) > slack || std::fabs(dot(y, z)) > slack || std::fabs(dot(z, x)) > slack)
        return;
      s.kind = Shape::Kind::sphere;
      s.origin = m.point({});
      s.a = {q[0] * scale, 0, 0};
      s.area = 4 * kPi * s.a.x * s.a.x;
      add(s, 0u);
      return;
    }
    default:
      return;
  }
}

}  // namespace

Lamps::Lamps(std::span<const LampSpec> specs, const Tracer& tracer, const SpectralState& state)
    : core_(new Core{tracer, {specs.begin(), specs.end()}, {}, {}, {}, {}, {}, {}, {}}) {
  const Scene& scene = tracer.scene();
  Core& core = *core_;
  core.front.assign(scene.materials.size(), nullptr);
  core.back = core.front;
  std::vector<uint32_t> spec_of_material(scene.materials.size(), kNone);
  std::vector<LightBounds> bounds;
  std::vector<LightProfile> profiles;
  auto add = [&](Shape shape, LightBounds b, uint32_t spec) {
    b.power *= mean_of(core.spectra[spec]);
    if (!(b.power > 0)) return kNone;
    shape.emission = spec;
    core.shapes.push_back(shape);
    bounds.push_back(b);
    return static_cast<uint32_t>(core.shapes.size() - 1);
  };
  for (uint32_t i = 0; i < specs.size(); ++i) {
    const LampSpec& s = specs[i];
    check(s);
    const bool surface = s.kind == LampSpec::Kind::surface;
    core.spectra.push_back(state.sample(surface ? s.radiance : s.intensity));
    core.frames.push_back(Frame::with_tangent(normalized(s.axis), {1, 0, 0}));
    if (surface) {
      std::vector<std::string> names;
      uint32_t found = kNone;
      for (uint32_t m = 0; m < scene.materials.size(); ++m) {
        names.push_back(scene.materials[m].id);
        if (scene.materials[m].id == s.material) found = m;
      }
      if (found == kNone)
        throw Error(s.where, "lamp '" + s.name + "': the scene has no material '" + s.material + "'",
                    name_hint(s.material, names));
      for (const MapBinding& b : scene.map_bindings)
        if (b.material == found)
          throw Error(s.where, "lamp '" + s.name + "': the material '" + s.material + "' is decided by a map",
                      "name a material that geometry carries itself");
      if (spec_of_material[found] != kNone)
        throw Error(s.where, "two lamps make the material '" + s.material + "' glow");
      spec_of_material[found] = i;
      continue;
    }
    // Points: all their light leaves within the cone, or wherever the table has any.
    double widest = s.kind == LampSpec::Kind::spot ? s.outer : kPi;
    if (s.table && !s.table->sqt) {
      size_t last = 0;
      for (size_t v = 0; v < s.table->value.size(); ++v)
        if (s.table->value[v] > 0) last = std::max(last, v / s.table->azimuths + 1);
      widest = std::min(widest, kPi * static_cast<double>(last) / static_cast<double>(s.table->polars - 1));
    }
    // Lamps of one kind share a profile, whatever their spectra.
    const LightProfile profile = profile_of(s);
    const auto index = static_cast<int>(std::find(profiles.begin(), profiles.end(), profile) - profiles.begin());
    if (index == static_cast<int>(profiles.size())) profiles.push_back(profile);
    Shape shape;
    shape.light = i;
    for (const Vec3& p : s.positions) {
      shape.origin = p;
      add(shape, {{p, p}, core.frames[i].z, widest, 0.01, kPi, false, index}, i);
    }
  }
  for (uint32_t m = 0; m < spec_of_material.size(); ++m)
    if (const uint32_t s = spec_of_material[m]; s != kNone) {
      core.front[m] = core.spectra[s].data();
      if (specs[s].both_sides) core.back[m] = core.spectra[s].data();
    }
  // Glowing geometry.
  const std::span<const TracedObject> objects = tracer.objects();
  for (uint32_t o = 0; o < objects.size(); ++o) {
    const TracedObject& object = objects[o];
    if (object.node != kNone) continue;  // what moves has no one place to aim at; paths meet its glow by chance
    const Affine3 to_world = tracer.to_world(object, 0);
    auto spec_of = [&](uint32_t material) { return material == kNone ? kNone : spec_of_material[material]; };
    auto add_flat = [&](Shape shape, uint32_t spec) {
      Box3 box;
      const bool disk = shape.kind == Shape::Kind::disk;
      for (int c = 0; c < 4; ++c) {
        if (shape.kind == Shape::Kind::triangle && c == 3) continue;
        const double x = disk ? (c & 1 ? 1 : -1) : (c & 1), y = disk ? (c & 2 ? 1 : -1) : (c >> 1);
        box.grow(shape.origin + shape.a * x + shape.b * y);
      }
      shape.object = o;
      shape.both_sides = specs[spec].both_sides;
      return add(shape,
                 {box, shape.normal, 0, kPi / 2, kPi * shape.area * (shape.both_sides ? 2 : 1), shape.both_sides != 0},
                 spec);
    };
    if (object.primitive != kNone) {
      const Primitive& primitive = scene.primitives[object.primitive];
      const uint32_t spec = spec_of(object.material_override != kNone ? object.material_override : primitive.material);
      if (spec == kNone) continue;
      shapes_of_primitive<Shape>(primitive, to_world, [&](Shape shape, uint32_t) {
        uint32_t index = kNone;
        if (shape.kind == Shape::Kind::sphere) {
          const Vec3 r{shape.a.x, shape.a.x, shape.a.x};
          shape.object = o;
          shape.both_sides = specs[spec].both_sides;
          index = add(shape, {{shape.origin - r, shape.origin + r}, {0, 0, 1}, kPi, kPi / 2, kPi * shape.area, false},
                      spec);
        } else {
          index = add_flat(shape, spec);
        }
        core.shape_of_triangle[o] = {index};
      });
      continue;
    }
    const Mesh& mesh = scene.meshes[object.mesh];
    for (const Part& part : mesh.parts) {
      const uint32_t spec = spec_of(object.material_override != kNone ? object.material_override : part.material);
      if (spec == kNone) continue;
      std::vector<uint32_t>& map = core.shape_of_triangle[o];
      map.resize(mesh.triangle_count(), kNone);
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
        Vec3 v[3];
        for (int k = 0; k < 3; ++k) {
          const float* x = &mesh.positions[3 * size_t{mesh.indices[3 * size_t{t} + static_cast<size_t>(k)]}];
          v[k] = to_world.point(
              mesh.origin + Vec3{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])});
        }
        Shape shape;
        shape.kind = Shape::Kind::triangle;
        shape.origin = v[0], shape.a = v[1] - v[0], shape.b = v[2] - v[0];
        const Vec3 n = cross(shape.a, shape.b) * (to_world.determinant() < 0 ? -1.0 : 1.0);
        shape.area = 0.5 * length(n);
        if (!(shape.area > 0)) continue;
        shape.normal = n / (2 * shape.area);
        map[t] = add_flat(shape, spec);
      }
    }
  }
  any_ = !core.shapes.empty() ||
         std::any_of(core.front.begin(), core.front.end(), [](const float* f) { return f != nullptr; });
  if (!bounds.empty()) core.tree = std::make_unique<LightTree>(bounds, std::move(profiles));
}

const float* Lamps::glow(uint32_t material, bool front) const {
  if (material == kNone) return nullptr;
  return front ? core_->front[material] : core_->back[material];
}

std::optional<LampSample> Lamps::sample(const LightReceiver& at, double choice, Vec2 u) const {
  if (!core_->tree) return std::nullopt;
  const auto chosen = core_->tree->sample(at, choice);
  if (!chosen) return std::nullopt;
  const Shape& s = core_->shapes[chosen->light];
  LampSample r;
  r.spectrum = core_->spectra[s.emission].data();
  if (s.kind == Shape::Kind::point) {
    const Vec3 to = s.origin - at.position;
    r.distance = length(to);
    if (!(r.distance > 0)) return std::nullopt;
    r.direction = to / r.distance;
    r.end = s.origin;
    r.scale = relative_intensity(core_->specs[s.light], core_->frames[s.light].to_local(-r.direction)) /
              (r.distance * r.distance * chosen->probability);
    if (!(r.scale > 0)) return std::nullopt;
    return r;
  }
  Hit hit;
  hit.object = s.object;
  hit.normal = s.normal;
  double density = 0;
  if (s.kind == Shape::Kind::sphere) {
    const Vec3 to = s.origin - at.position;
    const double radius = s.a.x, d2 = dot(to, to);
    if (d2 > radius * radius) {
      // Uniform in the cone that the sphere fills; the point on the near side in that direction.
      const double sin2 = radius * radius / d2, drop = sin2 / (1 + std::sqrt(1 - sin2));
      r.direction = Frame::around(to / std::sqrt(d2)).to_world(uniform_cone(u, drop));
      const double along = dot(to, r.direction), off2 = std::max(0.0, radius * radius - (d2 - along * along));
      hit.normal = normalized(at.position + r.direction * (along - std::sqrt(off2)) - s.origin);
      density = 1 / (2 * kPi * drop);
    } else {
      hit.normal = uniform_sphere(u);
    }
    hit.position = s.origin + hit.normal * radius;
  } else if (s.kind == Shape::Kind::disk) {
    const Vec2 d = disk_from_square(u);
    hit.position = s.origin + s.a * d.x + s.b * d.y;
  } else {
    // Square root warp of the triangle (Turk 1990).
    if (s.kind == Shape::Kind::triangle) {
      const double root = std::sqrt(u.x);
      u = {root * (1 - u.y), root * u.y};
    }
    hit.position = s.origin + s.a * u.x + s.b * u.y;
  }
  const Vec3 to = hit.position - at.position;
  const double d2 = dot(to, to);
  if (!(d2 > 0)) return std::nullopt;
  r.direction = to / std::sqrt(d2);
  const double cosine = -dot(r.direction, hit.normal);
  if (cosine == 0 || (cosine < 0 && !s.both_sides)) return std::nullopt;
  if (density == 0) density = d2 / (std::fabs(cosine) * s.area);
  r.density = density * chosen->probability;
  r.scale = 1;
  r.end = core_->tracer.leave(hit, -r.direction);
  r.distance = std::sqrt(d2);
  return r;
}

double Lamps::density(const LightReceiver& at, const Hit& hit, double distance, double cosine) const {
  const auto of_object = core_->shape_of_triangle.find(hit.object);
  if (of_object == core_->shape_of_triangle.end()) return 0;
  const uint32_t index = of_object->second[core_->tracer.objects()[hit.object].primitive != kNone ? 0 : hit.triangle];
  if (index == kNone) return 0;
  const Shape& s = core_->shapes[index];
  const double probability = core_->tree->probability(at, index);
  if (s.kind == Shape::Kind::sphere) {
    const Vec3 to = s.origin - at.position;
    const double radius2 = s.a.x * s.a.x, d2 = dot(to, to);
    if (d2 > radius2) {
      const double sin2 = radius2 / d2;
      return probability / (2 * kPi * (sin2 / (1 + std::sqrt(1 - sin2))));
    }
  }
  return probability * distance * distance / (std::max(std::fabs(cosine), 1e-12) * s.area);
}

}  // namespace suite
