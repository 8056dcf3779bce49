#include <algorithm>
#include <cmath>
#include <limits>

#include "light/earth.h"
#include "light/kinds/lamp_intensity.h"
#include "light/kinds/lamps_core.h"
#include "math/instrument_frame.h"

namespace suite {

namespace {

using Kind = LampShape::Kind;

double mean_of(const std::vector<float>& v) {
  double sum = 0;
  for (const float x : v) sum += static_cast<double>(x);
  return sum / static_cast<double>(v.size());
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

// The shape that a ray met; kNone = none that can be drawn.
uint32_t Lamps::Core::shape_at(const Hit& hit) const {
  const auto copy = copy_of.find(hit.object);
  const auto shapes_of = shape_of_triangle.find(copy == copy_of.end() ? hit.object : copy->second.first);
  return shapes_of == shape_of_triangle.end() ? kNone : shapes_of->second[hit.triangle];
}

void Lamps::Core::add_map(const LampSpec& s, const Scene& scene) {
  maps.emplace_back();
  if (!s.map) return;
  if (cell) throw Error(s.where, "lamp '" + s.name + "': a map lies over a scene that repeats itself");
  std::optional<SceneFrame> frame;
  if (s.map->system) frame = frame_of(scene, s.where, "the map of a lamp");
  maps.back() = std::make_unique<const PlacedLampMap>(s.map, frame);
  has_maps = true;
}

double Lamps::Core::brightness(uint32_t spec, Vec3 place, double time) const {
  const double dimmed = dimming(specs[spec], time);
  return has_maps && maps[spec] && dimmed > 0 ? dimmed * maps[spec]->at(place) : dimmed;
}

Lamps::~Lamps() = default;
size_t Lamps::size() const { return core_->shapes.size(); }

uint32_t Lamps::Core::add(const LampShape& shape, LightBounds b) {
  b.power *= mean_of(spectra[shape.spec]) * brightest(specs[shape.spec], window);
  if (!(b.power > 0)) return kNone;
  shapes.push_back(shape);
  bounds.push_back(b);
  return static_cast<uint32_t>(shapes.size() - 1);
}

void Lamps::Core::add_points(uint32_t spec, const Tracer& tracer) {
  const LampSpec& s = specs[spec];
  // All their light leaves within the cone, or wherever the table has any.
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
  LampShape shape;
  shape.spec = spec;
  if (!s.ride.empty()) return add_riding(spec, shape, {{}, {}, widest, 0.01, kPi, false, index}, tracer);
  for (Vec3 p : s.positions) {
    if (cell) {
      p.x -= std::floor((p.x - cell->low.x) / cell->size.x) * cell->size.x;
      p.y -= std::floor((p.y - cell->low.y) / cell->size.y) * cell->size.y;
    }
    shape.origin = p;
    add(shape, {{p, p}, frames[spec].z, widest, 0.01, kPi, false, index});
  }
}

// One lamp on each placement, bounded by all places that it has in the tracer's window.
void Lamps::Core::add_riding(uint32_t spec, LampShape shape, const LightBounds& still, const Tracer& tracer) {
  constexpr double kStraight = 0.02;  // rad; what turns further has no one profile
  const LampSpec& s = specs[spec];
  const auto fail = [&](const char* what) { throw Error(s.where, "lamp '" + s.name + "': " + what); };
  if (cell) fail("a lamp rides through a scene that repeats itself");
  for (const uint32_t carrier : carriers.find(s.ride, s.where)) {
    if (carriers.changes(carrier) && !tracer.window()) fail("it rides on what moves and places nothing");
    shape.carrier = carrier;
    for (const Vec3 p : s.positions) {
      shape.origin = p * carriers.scale(carrier);
      const auto sweep = carriers.over(carrier, shape.origin, frames[spec].z, tracer.window().value_or(TimeSpan{}));
      if (!sweep) continue;
      LightBounds b = still;
      b.box = sweep->box, b.axis = sweep->axis;
      b.cone = std::min(kPi, still.cone + sweep->turn);
      if (sweep->turn > kStraight) b.profile = -1;
      add(shape, b);
    }
  }
}

void Lamps::Core::add_material(uint32_t spec, const Scene& scene) {
  const LampSpec& s = specs[spec];
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
  if (spec_of_material[found] != kNone) throw Error(s.where, "two lamps make the material '" + s.material + "' glow");
  spec_of_material[found] = spec;
  front[found] = spectra[spec].data();
  if (s.both_sides) back[found] = spectra[spec].data();
}

// Puts a piece of an object into the tree; its number there, or kNone. middle: of a flat piece, or the center of a
// sphere, as the tracer makes hits without a ray, whose steps are upper bounds.
uint32_t Lamps::Core::add_surface(std::optional<LampShape> shape, uint32_t spec, const Hit& middle,
                                  const Tracer& tracer) {
  if (!shape) return kNone;
  shape->spec = spec;
  shape->both_sides = specs[spec].both_sides;
  LightBounds b = bounds_of(*shape);
  if (maps[spec]) b.power *= maps[spec]->mean_over(b.box);
  if (!(b.power > 0)) return kNone;
  // The tracer knows how far off the surface visibility rays must end: ask it for the surface's middle.
  const Kind kind = shape->kind;
  const Dir n = kind == Kind::sphere ? Dir{0, 0, 1} : shape->normal;
  const Vec3 place = kind == Kind::sphere ? shape->origin + n * shape->a.x : middle.position;
  const Ray ray{place + n * (0.01 * std::sqrt(shape->area)), -n, 0};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
  if (!hit.hit() || tracer.object(hit.object).instance != tracer.object(middle.object).instance) hit = middle;
  shape->step = hit.step, shape->span = hit.span;
  // Corners may lie further from the zero of the floats than the middle. Of exact surfaces only what places them is
  // rounded to float, which matters over their own size.
  const double extent = std::max({length(shape->a), length(shape->b), length(shape->b - shape->a)}),
               infinite = std::numeric_limits<double>::infinity();
  if (kind == Kind::triangle)
    shape->step = static_cast<float>(Tracer::arrive(double{hit.step}, infinite, extent));
  else
    shape->step =
        static_cast<float>(std::min(double{hit.step}, Tracer::arrive(1e-14 * length(place), infinite, 2 * extent)));
  return add(*shape, b);
}

// Glowing geometry at rest; what moves is met by chance.
void Lamps::Core::add_surfaces(const Tracer& tracer) {
  const FlushDenormals flush;
  const Scene& scene = tracer.scene();
  auto spec_of = [&](uint32_t material) { return material == kNone ? kNone : spec_of_material[material]; };
  const auto carried = [&](const TracedObject& o, uint32_t own) {
    return spec_of(o.material_override != kNone ? o.material_override : own);
  };
  const auto glows = [&](const TracedObject& o) {
    if (o.node != kNone) return false;
    if (o.primitive != kNone) return carried(o, scene.primitives[o.primitive].material) != kNone;
    const std::vector<Part>& parts = scene.meshes[o.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return carried(o, p.material) != kNone; });
  };
  std::unordered_map<uint32_t, uint32_t> first;  // object of an instance
  tracer.each("surfaces that glow", glows, [&](uint32_t o, const TracedObject& object) {
    const Affine3 place = tracer.place(o);
    if (const auto [at, is_new] = first.emplace(object.instance, o); !is_new) {
      copy_of[o] = {at->second, tracer.place(at->second).b - place.b};
      return;
    }
    if (object.primitive != kNone) {
      const Primitive& primitive = scene.primitives[object.primitive];
      const uint32_t spec = carried(object, primitive.material);
      shape_of_triangle[o] = {
          add_surface(shape_of(primitive, place), spec, tracer.on_exact(o, {}, {0, 0, 1}, {}, 0), tracer)};
      return;
    }
    const Mesh& mesh = scene.meshes[object.mesh];
    for (const Part& part : mesh.parts) {
      const uint32_t spec = carried(object, part.material);
      if (spec == kNone) continue;
      std::vector<uint32_t>& map = shape_of_triangle[o];
      mesh.require();
      map.resize(mesh.triangle_count(), kNone);
      for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t)
        map[t] = add_surface(shape_of(mesh, t, place), spec, tracer.on_triangle(o, t, 1.0 / 3, 1.0 / 3, 0), tracer);
    }
  });
}

Lamps::Lamps(std::span<const LampSpec> specs, const Tracer& tracer, const SpectralState& state)
    : core_(new Core(tracer)) {
  Core& core = *core_;
  const size_t materials = tracer.scene().materials.size();
  core.specs.assign(specs.begin(), specs.end());
  core.cell = tracer.periodic();
  core.front.assign(materials, nullptr);
  core.back.assign(materials, nullptr);
  core.spec_of_material.assign(materials, kNone);
  bool surfaces = false;
  for (uint32_t i = 0; i < specs.size(); ++i) {
    const LampSpec& s = specs[i];
    const bool surface = s.kind == LampSpec::Kind::surface;
    check(s);
    core.spectra.push_back(state.sample(surface ? s.radiance : s.intensity));
    core.add_map(s, tracer.scene());
    core.frames.push_back(Frame::with_tangent(normalized(s.axis), {1, 0, 0}));
    if (surface)
      core.add_material(i, tracer.scene());
    else
      core.add_points(i, tracer);
    surfaces = surfaces || surface;
    nature_.moves = nature_.moves || !s.ride.empty() || s.schedule;
  }
  if (surfaces) core.add_surfaces(tracer);
  if (core.cell && !core.bounds.empty()) {
    Box3 all;
    for (const LightBounds& b : core.bounds) all.grow(b.box);
    core.images = std::make_unique<LampImages>(*core.cell, all);
  }
  if (!core.bounds.empty()) core.tree = std::make_unique<LightTree>(core.bounds, std::move(core.profiles));
  core.bounds = {};
  nature_.delta = !surfaces;
  nature_.drawn = core.tree != nullptr;
  nature_.placed = core.tree && !core.images;
  nature_.numbers = 4;
  // Two or three, too: that each is among the strata of a choice is more likely with more of them.
  nature_.draws = size() > 1 ? LightNature::kMostDraws : 1;
}

std::optional<LightMet> Lamps::met_surface(const LightReceiver& from, const Hit& hit, uint32_t material, Dir direction,
                                           double distance, double cosine, double time) const {
  const float* const spectrum = glow(material, cosine > 0);
  if (!spectrum) return std::nullopt;
  const double dimmed = core_->brightness(core_->spec_of_material[material], hit.position, time);
  if (!(dimmed > 0)) return std::nullopt;
  const uint32_t spec = core_->spec_of_material[material];
  return LightMet{dimmed, spectrum, density(from, hit, direction, distance, cosine),
                  core_->specs[spec].stokes ? spec : kUnpolarised};
}

Stokes Lamps::stokes(uint32_t source, Dir k, double time) const {
  SUITE_CHECK(source < core_->specs.size() + core_->shapes.size());
  const size_t specs = core_->specs.size();
  const LampShape* const riding = source < specs ? nullptr : &core_->shapes[source - specs];
  const uint32_t spec = riding ? riding->spec : source;
  const LampSpec& s = core_->specs[spec];
  Dir axis = s.stokes_axis.value_or(core_->frames[spec].x);
  if (riding)
    if (const auto carrier = core_->carriers.at(riding->carrier, time)) axis = rotate(carrier->rotation, axis);
  return frame_rotation(frame_about(k, axis), meridian_frame(k).e1) * *s.stokes;
}

const float* Lamps::glow(uint32_t material, bool front) const {
  if (material == kNone) return nullptr;
  return front ? core_->front[material] : core_->back[material];
}

std::optional<LightSample> Lamps::sample(const LightReceiver& at, const std::array<double, 4>& u, double time) const {
  if (!core_->tree) return std::nullopt;
  LightReceiver from = at;
  LampImages::Image drawn{{}, 1};
  if (core_->images) drawn = core_->images->draw(at.position, u[3]), from.position = at.position - drawn.shift;
  const auto chosen = core_->tree->sample(from, u[0]);
  if (!chosen) return std::nullopt;
  auto lamp = sample_here(chosen->light, chosen->probability * drawn.probability, from.position, {u[1], u[2]}, time);
  if (lamp) lamp->end += drawn.shift;
  return lamp;
}

void Lamps::sample_all(const LightReceiver& at, std::span<const std::array<double, 4>> u, double time,
                       std::span<std::optional<LightSample>> drawn) const {
  // Each of the samples may be of another image.
  if (!core_->tree || core_->images || u.size() > LightNature::kMostDraws) return Light::sample_all(at, u, time, drawn);
  std::array<double, LightNature::kMostDraws> numbers;
  std::array<std::optional<LightTree::Choice>, LightNature::kMostDraws> chosen;
  for (size_t k = 0; k < u.size(); ++k) numbers[k] = u[k][0];
  core_->tree->sample(at, std::span(numbers).first(u.size()), chosen);
  for (size_t k = 0; k < u.size(); ++k) {
    drawn[k].reset();
    if (chosen[k])
      drawn[k] = sample_here(chosen[k]->light, chosen[k]->probability, at.position, {u[k][1], u[k][2]}, time);
  }
}

std::optional<LightSample> Lamps::sample_member(size_t member, double probability, const LightReceiver& at,
                                                const std::array<double, 4>& u, double time) const {
  LampImages::Image drawn{{}, 1};
  if (core_->images) drawn = core_->images->draw(at.position, u[3]);
  auto sample = sample_here(static_cast<uint32_t>(member), probability * drawn.probability, at.position - drawn.shift,
                            {u[1], u[2]}, time);
  if (sample) sample->end += drawn.shift;
  return sample;
}

// As seen from a place beside the lamp itself, not an image of it.
std::optional<LightSample> Lamps::sample_here(uint32_t lamp, double probability, Vec3 from, Vec2 u, double time) const {
  const LampShape& s = core_->shapes[lamp];
  const double dimmed = dimming(core_->specs[s.spec], time);
  if (!(dimmed > 0)) return std::nullopt;
  LightSample r;
  r.spectrum = core_->spectra[s.spec].data();
  r.source = core_->source_of(s);
  if (s.kind == Kind::point) {
    std::optional<Pose> carrier;
    if (s.carrier != kNone && !(carrier = core_->carriers.at(s.carrier, time))) return std::nullopt;
    r.end = carrier ? carrier->point(s.origin) : s.origin;
    const Vec3 to = r.end - from;
    r.distance = length(to);
    if (!(r.distance > 0)) return std::nullopt;
    r.direction = to / r.distance;
    const Dir sent = carrier ? rotate(carrier->rotation.conjugate(), -r.direction) : -r.direction;
    r.scale = dimmed * relative_intensity(core_->specs[s.spec], core_->frames[s.spec].to_local(sent)) /
              (r.distance * r.distance * probability);
    if (!(r.scale > 0)) return std::nullopt;
    return r;
  }
  const auto point = draw(s, from, u);
  if (!point) return std::nullopt;
  r.direction = point->direction;
  r.distance = point->distance;
  r.density = point->density * probability;
  r.scale = dimmed;
  if (core_->has_maps && !((r.scale = core_->brightness(s.spec, point->position, time)) > 0)) return std::nullopt;
  const double step = Tracer::arrive(double{s.step}, double{s.span}, r.distance);
  r.end = point->position + point->normal * (point->cosine > 0 ? step : -step);
  return r;
}

bool Lamps::draws(const Hit& hit) const { return core_->shape_at(hit) != kNone; }

double Lamps::density(const LightReceiver& at, const Hit& hit, Dir direction, double distance, double cosine) const {
  const uint32_t index = core_->shape_at(hit);
  if (index == kNone) return 0;
  LightReceiver from = at;
  double image = 1;
  if (core_->images) {
    // From the place on the lamp itself to where the ray really met its image.
    const auto copy = core_->copy_of.find(hit.object);
    const Vec3 own = hit.position + (copy == core_->copy_of.end() ? Vec3{} : copy->second.second);
    const Vec3 shift = core_->images->whole(at.position + direction * distance - own);
    image = core_->images->probability(at.position, shift);
    from.position = at.position - shift;
  }
  return image * core_->tree->probability(from, index) *
         density_of(core_->shapes[index], from.position, distance, cosine);
}

}  // namespace suite
