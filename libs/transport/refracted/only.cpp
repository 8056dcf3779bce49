// Ways through the scene's only refracting surface (refracting_sheet.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "transport/refracted/sight.h"

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

// Where that is known the only way that there can be, or none; else starts are drawn.
auto RefractedSight::look_through_sheet(RefractedSearch& s) -> Turn {
  s.sheet = false;
  if (!sheet_) return look_straight(s);
  const double index = interfaces_.index(sheet_material_, s.knot);
  const RefractingSheet::Ways ways =
      s.end.far ? sheet_->ways(s.node.place, s.end.direction, index) : sheet_->ways_between(s.node.place, s.end.place);
  if (ways == RefractingSheet::Ways::none) return Turn::ended;
  return ways == RefractingSheet::Ways::one ? walk_through_sheet(s) : look_straight(s);
}

// From where flat water would have the way leave the node.
auto RefractedSight::walk_through_sheet(RefractedSearch& s) -> Turn {
  const auto start = sheet_guess(s.straight, s.knot);
  s.sheet = true;
  s.sought = {.events = 1};
  return start ? shoot(s, At::sheet, *start, s.sought, Role::probe) : miss_sheet(s);
}

auto RefractedSight::miss_sheet(RefractedSearch& s) -> Turn {
  s.sheet = false;
  return s.what == RefractedSearch::For::first ? Turn::ended : look_straight(s);
}

auto RefractedSight::walked_through_sheet(RefractedSearch& s, bool found) -> Turn {
  const TracedWay& to = s.of(Role::first);
  if (!found) return to.off < kNearEnough && !to.open ? Turn::ended : miss_sheet(s);
  if (s.what == RefractedSearch::For::first) {
    // Its light is not focused much more than by flat water, and so makes no noise; and it comes as the sky sends it.
    constexpr double kFocused = 4;
    const double index = interfaces_.index(sheet_material_, s.knot),
                 behind = dot(s.end.direction, sheet_->axis()) > 0 ? index : 1 / index;
    if (to.veiled || !(std::fabs(to.det) * kFocused > behind * behind)) return Turn::ended;
  }
  set_way(s, to, s.way[0]);
  s.ways = 1;
  return Turn::ended;
}

bool RefractedSight::begin_first(RefractedSearch& s, const WayStart& node, Dir to, size_t knot) {
  s.what = RefractedSearch::For::first;
  s.node = node, s.end = {to, {}}, s.straight = to, s.knot = knot;
  s.distance = std::numeric_limits<double>::infinity();
  s.ways = 0;
  return run(s, walk_through_sheet(s));
}

bool RefractedSight::leaves_along(const RefractedSearch& s, Dir from) {
  const TracedWay& found = s.of(Role::first);
  return s.ways > 0 && length(found.way.direction - from) <= std::max(kSame, 100 * found.off) * found.inverse;
}

void RefractedSight::set_way(const RefractedSearch& s, const TracedWay& found, RefractedWay& way) {
  way = found.way;
  way.spreading = 1 / (std::fabs(found.det) * (s.end.far ? 1 : s.distance * s.distance));
  way.trials = 1;
  way.doubtful = false;
}

}  // namespace suite
