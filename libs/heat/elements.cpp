#include "heat/elements.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "heat/made_of.h"
#include "scene/primitives.h"

namespace suite {

namespace {

constexpr double kFewer = 4;

// What an area grows by under a transform.
double stretch_of(const Affine3& m, Vec3 unit_normal) { return length(m.normal(unit_normal)); }

// Place along a curve that keeps neighbours together (Morton 1966).
uint64_t along_curve(Vec3 p, const Box3& box) {
  uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::max(box.high[axis] - box.low[axis], 1e-300);
    const auto k = static_cast<uint64_t>(std::clamp((p[axis] - box.low[axis]) / size, 0.0, 1.0) * 2097151);
    for (int bit = 0; bit < 21; ++bit) code |= (k >> bit & 1) << (3 * bit + axis);
  }
  return code;
}

}  // namespace

namespace {

// Of a surface without end: around all that has one, half of its size further on each side, at least 100 m.
Box3 reach_of(const Primitive& primitive, const Affine3& to_local, const Box3& bounds) {
  Box3 reach = primitive_box(primitive);
  if (!reach.empty()) return reach;
  const Box3 world = bounds.empty() ? Box3{{0, 0, 0}, {0, 0, 0}} : bounds;
  const double more = std::max(100.0, 0.5 * length(world.size()));
  for (int corner = 0; corner < 8; ++corner)
    reach.grow(to_local.point({corner & 1 ? world.high.x + more : world.low.x - more,
                               corner & 2 ? world.high.y + more : world.low.y - more,
                               corner & 4 ? world.high.z : world.low.z}));
  return reach;
}

}  // namespace

double Elements::size_of(const Affine3& m) { return std::pow(std::fabs(m.determinant()), 2.0 / 3); }

// What the scene has of the materials.
struct Elements::Seen {
  struct Kind {  // instances of one mesh with one override
    uint32_t mesh = kNone, override = kNone;
    std::vector<uint32_t> material_of_part;
    double local_area = 0;
    std::vector<Slot> slots;
    std::vector<double> areas;
  };
  std::map<std::array<uint32_t, 3>, Kind> kinds;  // what moves is of its own
  std::vector<std::pair<Slot, uint32_t>> exact;   // with the primitive
  double area = 0;
};

Elements::Elements(const Tracer& tracer, const std::vector<bool>& heated, size_t budget, double time, const DaySun* sun,
                   std::span<const CellSplit> known, std::span<const RestInterval> rests)
    : tracer_(tracer), budget_(budget), time_(time), lookup_(tracer.scene()), rests_(rests.begin(), rests.end()) {
  SUITE_CHECK(budget > 0 && heated.size() == tracer.scene().materials.size());
  if (!rests_.empty()) changing_ = std::make_unique<const ChangingRoom>(tracer, rests_);
  Seen seen;
  gather(seen, heated);
  if (seen.kinds.empty() && seen.exact.empty())
    throw Error("no surface at rest has a temperature that the heat balance is to find",
                "give a material in view 'temperature: {model: heat}'");
  // Cells that are cut where the sun differs begin as fewer.
  const double even = seen.area / static_cast<double>(budget), target = even * (sun ? kFewer : 1);
  std::vector<Planned> planned;
  group_meshes(seen, even, target, planned);
  for (const auto& [slot, primitive] : seen.exact)
    planned.push_back({{slot}, nullptr, make_grid(slot, tracer.scene().primitives[primitive], target)});
  if (sun) refine(planned, *sun, known);
  for (Planned& p : planned) add_group(std::move(p));
  make_elements(heated);
}

void Elements::gather(Seen& seen, const std::vector<bool>& heated) {
  const Scene& scene = tracer_.scene();
  // Materials that are heated, or that a class map may turn into one.
  const std::vector<bool> wanted = with_class_maps(scene, heated);
  const auto is_wanted = [&](uint32_t m) { return m != kNone && wanted[m]; };
  tracer_.each("surfaces whose temperatures are to be found", made_of(scene, wanted),
               [&](uint32_t number, const TracedObject& o) {
                 if (slot_of_.contains(o.instance)) return;
                 const std::optional<Slot> found = slot_for(number, o);
                 if (!found) {
                   ++moving_;
                   return;
                 }
                 slot_of_[o.instance] = 0;
                 const Slot slot = *found;
                 const Affine3& place = slot.to_world;
                 if (o.primitive != kNone) {
                   seen.exact.emplace_back(slot, o.primitive);
                   const Primitive& primitive = scene.primitives[o.primitive];
                   const PrimitiveFaces faces(primitive, reach_of(primitive, slot.to_local, tracer_.bounds()));
                   for (size_t f = 0; f < faces.size(); ++f) seen.area += faces.area(f) * size_of(place);
                   return;
                 }
                 Seen::Kind& kind = seen.kinds[{o.mesh, o.material_override, slot.places}];
                 const Mesh& mesh = scene.meshes[o.mesh];
                 if (kind.slots.empty()) {
                   mesh.require();
                   kind.mesh = o.mesh, kind.override = o.material_override;
                   for (const Part& p : mesh.parts) {
                     const uint32_t m = o.material_override != kNone ? o.material_override : p.material;
                     kind.material_of_part.push_back(is_wanted(m) ? m : kNone);
                   }
                   kind.local_area = MeshCells(mesh, kind.material_of_part, 1).total_area();
                 }
                 kind.slots.push_back(slot);
                 kind.areas.push_back(kind.local_area * size_of(place));
                 seen.area += kind.areas.back();
               });
}

void Elements::add_group(Planned planned) {
  auto& [slots, mesh, grid] = planned;
  const size_t cells = mesh ? mesh->size() : grids_[grid].cells.size();
  Group group;
  group.first_slot = static_cast<uint32_t>(slots_.size()), group.slots = static_cast<uint32_t>(slots.size());
  group.first_cell = static_cast<uint32_t>(group_of_cell_.size());
  group.mesh = mesh, group.grid = grid;
  double sum = 0;
  for (Slot& s : slots) {
    s.group = static_cast<uint32_t>(groups_.size());
    slot_of_[s.instance] = static_cast<uint32_t>(slots_.size());
    slots_.push_back(s);
    if (slots.size() > 1) group.until.push_back(sum += size_of(s.to_world));
  }
  group_of_cell_.insert(group_of_cell_.end(), cells, static_cast<uint32_t>(groups_.size()));
  groups_.push_back(std::move(group));
}

void Elements::group_meshes(Seen& seen, double together_below, double target, std::vector<Planned>& planned) {
  for (auto& [key, kind] : seen.kinds) {
    const Mesh& mesh = tracer_.scene().meshes[kind.mesh];
    std::map<int, MeshCells*> by_size;
    const auto cells_for = [&](double wanted) {
      const int power = std::max(0, static_cast<int>(std::lround(std::log2(std::max(wanted, 1.0)))));
      MeshCells*& cells = by_size[power];
      if (!cells) {
        meshes_.push_back(std::make_unique<MeshCells>(
            mesh, kind.material_of_part,
            kind.slots.size() == 1 ? std::max(wanted, 1.0) : std::exp2(static_cast<double>(power))));
        cells = meshes_.back().get();
      }
      return cells;
    };
    std::vector<size_t> small;
    for (size_t i = 0; i < kind.slots.size(); ++i) {
      if (kind.areas[i] < together_below / 2) {
        small.push_back(i);
        continue;
      }
      planned.push_back({{kind.slots[i]}, cells_for(kind.areas[i] / target), kNone});
    }
    if (small.empty()) continue;
    MeshCells* whole = cells_for(1);
    std::vector<std::pair<uint64_t, size_t>> order;
    for (const size_t i : small) order.emplace_back(along_curve(kind.slots[i].to_world.b, tracer_.bounds()), i);
    std::sort(order.begin(), order.end());
    std::vector<Slot> together;
    double area = 0;
    for (size_t k = 0; k < order.size(); ++k) {
      together.push_back(kind.slots[order[k].second]);
      area += kind.areas[order[k].second];
      if (area < together_below && k + 1 < order.size()) continue;
      planned.push_back({std::move(together), whole, kNone});
      together.clear(), area = 0;
    }
  }
}

uint32_t Elements::make_grid(const Slot& slot, const Primitive& primitive, double target) {
  Grid grid{PrimitiveFaces(primitive, reach_of(primitive, slot.to_local, tracer_.bounds())), {}};
  const double scale = size_of(slot.to_world);
  for (size_t f = 0; f < grid.faces.size(); ++f) {
    const auto [along_a, along_b] = grid.faces.lengths(f);
    const double wanted = std::max(1.0, grid.faces.area(f) * scale / target);
    const double columns = std::sqrt(wanted * along_a / along_b);
    Grid::Face part;
    part.columns = static_cast<uint32_t>(std::clamp(std::lround(std::min(columns, wanted)), 1L, 10000L));
    part.rows = static_cast<uint32_t>(std::clamp(std::lround(wanted / part.columns), 1L, 10000L));
    part.first = static_cast<uint32_t>(grid.cells.size());
    for (uint32_t k = 0; k < part.columns * part.rows; ++k) {
      const double column = k % part.columns, row = k / part.columns;
      grid.cells.push_back({static_cast<uint32_t>(f),
                            {column / part.columns, row / part.rows},
                            {(column + 1) / part.columns, (row + 1) / part.rows}});
    }
    grid.parts.push_back(part);
  }
  grids_.push_back(std::move(grid));
  return static_cast<uint32_t>(grids_.size() - 1);
}

namespace {

// What of a cell is of one material, from the points that were looked at.
struct Found {
  uint32_t material = kNone;
  double area = 0;  // m2, or points that stand for equal ones
  Vec3 centre, normal;
};

}  // namespace

// The middle of every piece of a triangle with its area, where that tells all; else points that stand for equal areas.
// Returns the cell's local area, m2, over the weights' sum.
double Elements::look_over(uint32_t cell, const std::function<void(const Hit&, double weight)>& look) const {
  const Group& group = groups_[group_of_cell_[cell]];
  const uint32_t inside = cell - group.first_cell, object = slots_[group.first_slot].object;
  if (group.mesh && group.slots == 1 && group.mesh->triangles(inside) <= kLooks) {
    const uint32_t triangle = group.mesh->point(inside, 0, 0, 0).triangle;
    if (!lookup_.is_mapped(lookup_.plain(tracer_.object(object), triangle))) {
      group.mesh->each_piece(inside, [&](const MeshCells::Point& p, double area) {
        look(tracer_.on_triangle(object, p.triangle, p.u, p.v, time_of(slots_[group.first_slot])), area);
      });
      return 1;
    }
  }
  const SampleStream stream(0x68656174, 0, cell);
  for (uint32_t k = 0; k < kLooks; ++k) {
    uint32_t attempt = 0;
    look(cell_point(cell, {stream, k, 0}, attempt), 1);
  }
  return (group.mesh ? group.mesh->area(inside) : grids_[group.grid].area(inside)) / kLooks;
}

void Elements::make_elements(const std::vector<bool>& heated) {
  const size_t cells = group_of_cell_.size();
  std::vector<std::vector<Found>> found(cells);
  std::vector<double> areas(cells), weights(cells);
  parallel_for(0, cells, 256, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) {
      const Group& group = groups_[group_of_cell_[c]];
      double stretched = 0;
      const double local = look_over(static_cast<uint32_t>(c), [&](const Hit& hit, double weight) {
        const TracedObject object = tracer_.object(hit.object);
        const Slot& slot = slots_[slot_of_.at(object.instance)];
        stretched += weight * stretch_of(slot.to_world, normalized(slot.to_local.normal(hit.normal)));
        weights[c] += weight;
        const uint32_t m = lookup_.at(object, hit);
        auto at = std::ranges::find(found[c], m, &Found::material);
        if (at == found[c].end()) at = found[c].insert(at, Found{m, 0, {}, {}});
        at->area += weight, at->centre += weight * hit.position, at->normal += weight * hit.normal;
      });
      areas[c] = local * (group.slots > 1 ? weights[c] * group.until.back() : stretched);
    }
  });
  first_element_.push_back(0);
  for (size_t c = 0; c < cells; ++c) {
    for (const Found& f : found[c]) {
      if (f.material == kNone || !heated[f.material]) continue;
      HeatElement e;
      e.material = f.material, e.cell = static_cast<uint32_t>(c);
      e.share = f.area / weights[c];
      e.area = areas[c] * e.share;
      e.centre = f.centre / f.area;
      const double facing = length(f.normal);
      e.normal = facing > 1e-6 * f.area ? f.normal / facing : Dir{0, 0, 1};
      elements_.push_back(e);
      total_area_ += e.area;
    }
    first_element_.push_back(static_cast<uint32_t>(elements_.size()));
    shared_cells_ += found[c].size() > 1;
  }
}

uint32_t Elements::Grid::cell_at(const PrimitiveFaces::Place& p) const {
  const Face& part = parts[p.face];
  const auto column = std::min(part.columns - 1, static_cast<uint32_t>(p.a * part.columns));
  const auto row = std::min(part.rows - 1, static_cast<uint32_t>(p.b * part.rows));
  return cuts.find(part.first + row * part.columns + column, {p.a, p.b});
}

std::optional<uint32_t> Elements::cell_at(const HeatedPlace& place, double time) const {
  const auto found = slot_of_.find(place.instance);
  if (found == slot_of_.end() || slots_.empty()) return std::nullopt;
  const Slot& slot = slots_[found->second];
  const Group& group = groups_[slot.group];
  if (group.mesh) {
    const uint32_t inside = group.mesh->whole(place.triangle)
                                ? group.mesh->cell_of(place.triangle, {})
                                : group.mesh->cell_of(place.triangle, to_local_at(slot, time).point(place.position));
    if (inside == kNone) return std::nullopt;
    return group.first_cell + inside;
  }
  const Grid& grid = grids_[group.grid];
  return group.first_cell + grid.cell_at(grid.faces.place(to_local_at(slot, time).point(place.position)));
}

bool Elements::covers(const Hit& hit) const {
  const auto found = slot_of_.find(tracer_.object(hit.object).instance);
  if (found == slot_of_.end()) return false;
  const Slot& slot = slots_[found->second];
  const Group& group = groups_[slot.group];
  if (group.mesh) return true;
  const PrimitiveFaces& faces = grids_[group.grid].faces;
  const Vec3 local = to_local_at(slot, hit.time).point(hit.position);
  const PrimitiveFaces::Place p = faces.place(local);
  return length(faces.point(p.face, p.a, p.b).position - local) <= 1e-3 * (1 + length(local));
}

std::optional<uint32_t> Elements::at(const HeatedPlace& place, uint32_t material, double time) const {
  const std::optional<uint32_t> cell = cell_at(place, time);
  if (!cell) return std::nullopt;
  std::optional<uint32_t> best;
  for (uint32_t e = first_element_[*cell]; e < first_element_[*cell + 1]; ++e) {
    if (elements_[e].material == material) return e;
    if (!best || elements_[e].area > elements_[*best].area) best = e;
  }
  // Elements ascend with their cells, and so do those that were left out.
  const auto of_cell = std::ranges::equal_range(left_out_, *cell, {}, &LeftOut::cell);
  if (std::ranges::find(of_cell, material, &LeftOut::material) != of_cell.end()) return std::nullopt;
  return best;
}

std::optional<uint32_t> Elements::at(const Hit& hit, uint32_t material) const {
  return at(HeatedPlace{hit.position, hit.normal, tracer_.object(hit.object).instance, hit.triangle}, material,
            hit.time);
}

double Elements::largest() const {
  double most = 0;
  for (const HeatElement& e : elements_) most = std::fmax(most, e.area);
  return most;
}

uint64_t Elements::fingerprint() const {
  uint64_t key = mix64(elements_.size());
  for (const HeatElement& e : elements_)
    key = hash_of(key, e.material, std::bit_cast<uint64_t>(e.area),
                  std::bit_cast<uint64_t>(e.centre.x + 3 * e.centre.y + 7 * e.centre.z));
  return key;
}

}  // namespace suite
