#include "heat/mirror_places.h"

#include <algorithm>
#include <cmath>

#include "heat/made_of.h"
#include "scene/primitives.h"

namespace suite {

namespace {

// A surface without end sends nothing to itself.
void grow_by_faces(const Elements& elements, uint32_t object, Box3& box) {
  for (size_t e = 0; e < elements.size(); ++e) {
    if (elements.point(e, {SampleStream(0, 0, 0), 0, 0}).object == object) continue;
    const Dir n = elements[e].normal;
    const double side = std::sqrt(elements[e].area);
    const auto along = [&](double facing) { return side * std::sqrt(std::max(0.0, 1 - facing * facing)); };
    const Vec3 around{along(n.x), along(n.y), along(n.z)};
    box.grow(elements[e].centre + around);
    box.grow(elements[e].centre - around);
  }
}

}  // namespace

MirrorPlaces::MirrorPlaces(const Tracer& tracer, const Elements& elements, const std::vector<bool>& mirrors,
                           double time)
    : tracer_(tracer), time_(time) {
  const Scene& scene = tracer.scene();
  const std::vector<bool> all = with_class_maps(scene, mirrors);
  std::vector<bool> bounded = mirrors;
  size_t finite = 0;
  tracer.each("surfaces that mirror", made_of(scene, all), [&](uint32_t number, const TracedObject& o) {
    if (o.node != kNone && !stays_put(tracer, number))
      ++moving_;
    else if (o.primitive != kNone && primitive_box(scene.primitives[o.primitive]).empty())
      endless_.push_back({number, tracer.bounds()});
    else
      ++finite;
  });
  for (Endless& place : endless_) grow_by_faces(elements, place.object, place.wanted);
  if (finite == 0) return;
  const double mean = elements.total_area() / static_cast<double>(elements.size());
  const double area = Elements(tracer, mirrors, 1, time).total_area();
  mirrors_.emplace(tracer, mirrors, std::clamp<size_t>(static_cast<size_t>(area / mean), 1, elements.budget()), time);
}

MirrorPlaces::Patch MirrorPlaces::patch(size_t place, Dir sun) const {
  Patch out;
  if (!is_endless(place)) {
    out.element = static_cast<uint32_t>(place);
    const TracedObject object = tracer_.object(mirrors_->point(place, {SampleStream(0, 0, 0), 0, 0}).object);
    const bool endless =
        object.primitive != kNone && primitive_box(tracer_.scene().primitives[object.primitive]).empty();
    out.area = endless ? 0 : (*mirrors_)[place].area;
    return out;
  }
  constexpr double kLowest = 1e-3;  // rad, of a sun over the surface
  out.object = endless_[place - finite()].object;
  const Box3& wanted = endless_[place - finite()].wanted;
  const Affine3 to_world = tracer_.to_world(out.object, time_), to_local = to_world.inverse();
  const Primitive& primitive = tracer_.scene().primitives[tracer_.object(out.object).primitive];
  const Vec3 towards = to_local.vector(sun);
  if (wanted.empty() || !(std::fabs(towards.z) > kLowest * length(towards))) return out;
  std::vector<double> levels{0};
  if (primitive.kind == PrimitiveKind::box) levels = {primitive.parameters[2], primitive.parameters[5]};
  // Light that gets to a point by one reflection, or straight through, comes from between the point's foot and where
  // its shadow would fall turned about; refracted light from nearer to the foot.
  Box3 from;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = to_local.point({corner & 1 ? wanted.high.x : wanted.low.x, corner & 2 ? wanted.high.y : wanted.low.y,
                                   corner & 4 ? wanted.high.z : wanted.low.z});
    for (const double level : levels) {
      const double far = std::fabs(p.z - level) / std::fabs(towards.z);
      from.grow(Vec3{p.x, p.y, 0});
      from.grow(Vec3{p.x + far * towards.x, p.y + far * towards.y, 0});
    }
  }
  out.part.emplace(primitive, from);
  const Vec3 x = to_world.vector({1, 0, 0}), y = to_world.vector({0, 1, 0});
  for (size_t f = 0; f < out.part->size(); ++f) out.area += out.part->area(f) * length(cross(x, y));
  return out;
}

Hit MirrorPlaces::point(const Patch& patch, const PointDraw& draw) const {
  if (patch.element != kNone) return mirrors_->point(patch.element, draw);
  const std::array<double, 4> u = draw.stream.draw(draw.sample, draw.first_block);
  const PrimitiveFaces& part = *patch.part;
  const size_t face = std::min(part.size() - 1, static_cast<size_t>(u[2] * static_cast<double>(part.size())));
  const PrimitiveFaces::Point p = part.point(face, u[0], u[1]);
  return tracer_.on_exact(patch.object, p.position, p.normal, p.uv, time_);
}

}  // namespace suite
