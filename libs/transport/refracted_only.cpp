// Ways through the scene's only refracting surface (refracting_sheet.h).
#include <cmath>
#include <limits>

#include "transport/refracted_sight.h"

namespace suite {

// The only refracting object, if it is of one material everywhere, of which no map bends the normal.
void RefractedSight::set_sheet(const Optics& optics, uint32_t number) {
  const Tracer& tracer = surface_.tracer();
  const TracedObject o = tracer.object(number);
  std::vector<uint32_t> materials;
  if (o.material_override != kNone)
    materials = {o.material_override};
  else if (o.primitive != kNone)
    materials = {tracer.scene().primitives[o.primitive].material};
  else
    for (const Part& part : tracer.scene().meshes[o.mesh].parts) materials.push_back(part.material);
  for (const uint32_t m : materials) {
    if (m != materials[0] || !interfaces_.has(m)) return;
    if (const auto& maps = optics.material(m).maps; maps && maps->bends()) return;
  }
  sheet_material_ = materials[0];
  sheet_ = RefractingSheet::of(tracer, number, o);
}

void RefractedSight::set_way(const Search& s, const Traced& found, RefractedWay& way) {
  way = found.way;
  way.spreading = 1 / (std::fabs(found.det) * (s.end.far ? 1 : s.distance * s.distance));
  way.trials = 1;
  way.doubtful = false;
}

// The only way that there can be, where that is known; nothing where it is not, or not found at once.
auto RefractedSight::find_only(const Search& s, RefractedWay& way) -> Found {
  if (!sheet_ || !s.end.far) return Found::unknown;
  const double index = interfaces_.index(sheet_material_, s.knot);
  const RefractingSheet::Ways ways = sheet_->ways(s.node.place, s.end.direction, index);
  if (ways == RefractingSheet::Ways::none) return Found::none;
  if (ways == RefractingSheet::Ways::unknown) return Found::unknown;
  Traced found;
  if (!walk_through_sheet(s, found))
    return found.off < kNearEnough && !found.open && found.way.events > 0 ? Found::none : Found::unknown;
  set_way(s, found, way);
  return Found::one;
}

// From where flat water would have the way leave the node.
bool RefractedSight::walk_through_sheet(const Search& s, Traced& found) {
  const auto start = sheet_->guess(s.end.direction, interfaces_.index(sheet_material_, s.knot));
  Chain once;
  once.events = 1;
  Traced probe;
  return start && trace(s, *start, once, probe) && walk(s, probe, once, found);
}

// Its light is not focused much more than by flat water, and so makes no noise; and it comes as the sky sends it.
bool RefractedSight::find_first(const Node& node, Dir to, size_t knot, Traced& found) {
  constexpr double kFocused = 4;
  const WayEnd end{to, {}};
  const Search s{node, end, to, std::numeric_limits<double>::infinity(), knot};
  if (!walk_through_sheet(s, found) || found.veiled) return false;
  const double index = interfaces_.index(sheet_material_, knot),
               behind = dot(to, sheet_->axis()) > 0 ? index : 1 / index;
  return std::fabs(found.det) * kFocused > behind * behind;
}

std::span<const RefractedWay> RefractedSight::first_through_sheet(const Node& node, Dir to, size_t knot) {
  const WayEnd end{to, {}};
  Traced found;
  if (!find_first(node, to, knot, found)) return {};
  set_way({node, end, to, std::numeric_limits<double>::infinity(), knot}, found, found_[0]);
  return std::span(found_).first(1);
}

bool RefractedSight::is_first_through_sheet(const Node& node, Dir from, Dir to, size_t knot) {
  Traced found;
  return find_first(node, to, knot, found) &&
         length(found.way.direction - from) <= std::max(kSame, 100 * found.off) * found.inverse;
}

}  // namespace suite
