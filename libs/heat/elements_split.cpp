// Cells are cut where the sun of the day differs within them, until the budget is used.
//
// Method: a few points of each cell tell how much direct sun differs there, as the variance through the day. The cells
// where area times variance is largest are cut in two, their halves are asked again, and so on. Without any difference
// area alone decides.
#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "base/parallel.h"
#include "heat/elements.h"

namespace suite {

namespace {

constexpr uint64_t kPurpose = 0x73706c74;
constexpr uint32_t kPoints = 8, kGroups = 4;  // of a cell; of instances that share it, at most
constexpr double kEven = 3;                   // W/m2, as if all cells differed by that: area counts where nothing does
constexpr size_t kAtOnce = 8;                 // of so many cells one is cut before all are compared again

}  // namespace

// Across the longer side.
void Elements::Grid::split(uint32_t cell) {
  const auto other = static_cast<uint32_t>(cells.size());
  Cell kept = cells[cell], rest = kept;
  const auto [along_a, along_b] = faces.lengths(kept.face);
  if ((kept.high.x - kept.low.x) * along_a >= (kept.high.y - kept.low.y) * along_b) {
    kept.high.x = rest.low.x = (kept.low.x + kept.high.x) / 2;
    cuts.add(cell, {kept.high.x, 0}, {kept.high.x, 1}, other);
  } else {
    kept.high.y = rest.low.y = (kept.low.y + kept.high.y) / 2;
    cuts.add(cell, {1, kept.high.y}, {0, kept.high.y}, other);
  }
  cells[cell] = kept;
  cells.push_back(rest);
}

class Elements::Refinement {
 public:
  Refinement(Elements& elements, const std::vector<Planned>& planned, const DaySun& sun) : e_(elements), sun_(sun) {
    std::map<std::pair<const void*, uint32_t>, size_t> known;
    for (const Planned& p : planned) {
      const auto [at, fresh] = known.emplace(std::pair{static_cast<const void*>(p.mesh), p.grid}, units_.size());
      if (fresh) units_.push_back({p.mesh, p.grid, {}, 0});
      Unit& unit = units_[at->second];
      unit.groups.push_back(&p.slots);
      for (const Slot& s : p.slots) unit.scale += size_of(s.to_world);
    }
    for (uint32_t u = 0; u < units_.size(); ++u) {
      const size_t cells = size(units_[u]);
      made_ += cells * units_[u].groups.size();
      for (uint32_t c = 0; c < cells; ++c) fresh_.push_back({u, c});
    }
  }

  void replay(std::span<const CellSplit> known) {
    for (const CellSplit& s : known) {
      if (s.unit >= units_.size() || s.cell >= size(units_[s.unit]) ||
          made_ + units_[s.unit].groups.size() > e_.budget_)
        throw Error("elements of another scene: they were cut where there is nothing", "find the temperatures again");
      split(s);
    }
  }

  void run() {
    for (uint32_t turn = 0;; ++turn) {
      judge(turn);
      const size_t budget = e_.budget_, most = std::max<size_t>(1, made_ / kAtOnce);
      size_t cut = 0;
      while (cut < most && !worst_.empty()) {
        const Judged next = worst_.top();
        worst_.pop();
        const Unit& unit = units_[next.unit];
        if (made_ + unit.groups.size() > budget || !(next.score > 0)) continue;
        fresh_.push_back({next.unit, next.cell}), fresh_.push_back({next.unit, static_cast<uint32_t>(size(unit))});
        split({next.unit, next.cell}), ++cut;
      }
      if (fresh_.empty()) return;
    }
  }

 private:
  struct Unit {  // what is cut at once: a mesh's cells, or those of an exact surface
    MeshCells* mesh;
    uint32_t grid;
    std::vector<const std::vector<Slot>*> groups;
    double scale;  // of areas, all instances together
  };
  struct Judged {
    uint32_t unit, cell;
    double score = 0;
    bool operator<(const Judged& o) const {
      return score != o.score ? score < o.score : std::pair{unit, cell} > std::pair{o.unit, o.cell};
    }
  };
  size_t size(const Unit& u) const { return u.mesh ? u.mesh->size() : e_.grids_[u.grid].cells.size(); }

  void split(CellSplit which) {
    Unit& unit = units_[which.unit];
    unit.mesh ? unit.mesh->split(which.cell) : e_.grids_[unit.grid].split(which.cell);
    made_ += unit.groups.size();
    e_.splits_.push_back(which);
  }

  void judge(uint32_t turn) {
    parallel_for(0, fresh_.size(), 64, [&](size_t begin, size_t end) {
      const std::span<Judged> some{&fresh_[begin], end - begin};
      std::vector<Hit> places;
      for (const Judged& j : some) add_places(j, turn, places);
      std::vector<float> sun(places.size() * sun_.numbers);
      sun_.at(places, sun);
      const float* from = sun.data();
      for (Judged& j : some) j.score = score(j, from);
    });
    for (const Judged& j : fresh_) worst_.push(j);
    fresh_.clear();
  }

  size_t groups_asked(const Unit& unit) const { return std::min<size_t>(unit.groups.size(), kGroups); }

  void add_places(const Judged& j, uint32_t turn, std::vector<Hit>& places) const {
    const Unit& unit = units_[j.unit];
    Group group;
    group.mesh = unit.mesh, group.grid = unit.grid;
    const size_t asked = groups_asked(unit);
    for (size_t g = 0; g < asked; ++g) {
      const std::vector<Slot>& slots = *unit.groups[g * unit.groups.size() / asked];
      const SampleStream numbers(hash_of(kPurpose, j.unit, g), turn, j.cell);
      for (uint32_t k = 0; k < kPoints; ++k) {
        const auto slot = static_cast<size_t>(numbers.hashed(k, 1) * static_cast<double>(slots.size()));
        const Local p = e_.local_point(group, j.cell, numbers.draw(k, 0));
        const uint32_t object = slots[slot].object;
        const double time = e_.time_of(slots[slot]);
        places.push_back(unit.mesh ? e_.tracer_.on_triangle(object, p.triangle, p.u, p.v, time)
                                   : e_.tracer_.on_exact(object, p.position, p.normal, p.uv, time));
      }
    }
  }

  // m2 (W/m2)2 an element.
  double score(const Judged& j, const float*& sun) const {
    const Unit& unit = units_[j.unit];
    const size_t asked = groups_asked(unit), n = sun_.numbers;
    double variance = 0;
    for (size_t g = 0; g < asked; ++g, sun += kPoints * n)
      for (size_t i = 0; i < n; ++i) {
        double sum = 0, squares = 0;
        for (size_t k = 0; k < kPoints; ++k) {
          const double v = double{sun[k * n + i]};
          sum += v, squares += v * v;
        }
        variance += std::max(0.0, squares - sum * sum / kPoints) / (kPoints - 1);
      }
    variance /= static_cast<double>(asked * std::max<size_t>(n, 1));
    const double local = unit.mesh ? unit.mesh->area(j.cell) : e_.grids_[unit.grid].area(j.cell);
    return local * unit.scale * (variance + kEven * kEven) / static_cast<double>(unit.groups.size());
  }

  Elements& e_;
  const DaySun& sun_;
  std::vector<Unit> units_;
  std::vector<Judged> fresh_;
  std::priority_queue<Judged> worst_;
  size_t made_ = 0;
};

void Elements::refine(const std::vector<Planned>& planned, const DaySun& sun, std::span<const CellSplit> known) {
  Refinement refinement(*this, planned, sun);
  known.empty() ? refinement.run() : refinement.replay(known);
}

}  // namespace suite
