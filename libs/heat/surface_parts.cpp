#include "heat/surface_parts.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "heat/surfaces.h"

namespace suite {

namespace {

using Member = SurfacePart::Member;

constexpr size_t kSurfacePartsTogether = 256;

// Sets that are joined pair by pair (R. Tarjan, J. ACM 22, 1975).
class Joined {
 public:
  explicit Joined(size_t n) : up_(n) { std::iota(up_.begin(), up_.end(), 0u); }
  uint32_t root(uint32_t i) {
    while (up_[i] != i) i = up_[i] = up_[up_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a), b = root(b);
    up_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> up_;
};

bool alike(const SlabLayer& a, const SlabLayer& b) {
  return a.thickness == b.thickness && a.density == b.density && a.specific_heat == b.specific_heat &&
         a.conductivity == b.conductivity && a.heat_generation == b.heat_generation &&
         a.contact_resistance == b.contact_resistance && a.intervals == b.intervals;
}

bool alike(const SurfaceGroup& a, const SurfaceGroup& b) {
  return suite::alike(a.layers, b.layers) && a.back_rows.empty() == b.back_rows.empty();
}

// Bodies that touch nothing else, one after the other; small ones of the same layers go together.
class Bodies {
 public:
  Bodies(std::span<const SurfaceGroup> groups, const SurfaceNeighbours& neighbours,
         const std::vector<Member>& member_of)
      : groups_(groups), neighbours_(neighbours), member_of_(member_of), joined_(member_of.size()) {
    for (const auto& c : neighbours_.contacts) join(c);
    std::vector<uint32_t> order;
    for (const auto& c : neighbours_.contacts) order.push_back(c.a), order.push_back(c.b);
    std::ranges::sort(order);
    order.erase(std::unique(order.begin(), order.end()), order.end());
    std::ranges::stable_sort(order, {}, [&](uint32_t row) { return joined_.root(row); });
    place_of_.resize(member_of.size());
    for (size_t k = 0; k < order.size(); ++k)
      put(order[k], k == 0 || joined_.root(order[k]) != joined_.root(order[k - 1]));
  }
  std::vector<SurfacePart> parts() && {
    std::vector<std::vector<SlabNeighbours::Contact>> contacts(parts_.size());
    for (const auto& c : neighbours_.contacts)
      contacts[place_of_[c.a].part].push_back({place_of_[c.a].number, place_of_[c.b].number, c.ratio});
    for (size_t p = 0; p < parts_.size(); ++p)
      parts_[p].neighbours = std::make_shared<const SlabNeighbours>(contacts[p], std::move(areas_[p]));
    return std::move(parts_);
  }

 private:
  struct Place {
    size_t part = 0;
    uint32_t number = 0;
  };
  const SurfaceGroup& group(uint32_t row) const { return groups_[member_of_[row].group]; }

  void join(const SlabNeighbours::Contact& c) {
    SUITE_CHECK(c.a < member_of_.size() && c.b < member_of_.size());
    if (group(c.a).layers.empty() || !alike(group(c.a), group(c.b)))
      throw Error(strf("rows %u and %u of other layers or backs conduct to each other", c.a, c.b), "alike ones");
    joined_.join(c.a, c.b);
  }

  void put(uint32_t row, bool begins) {
    const bool fits = !parts_.empty() && parts_.back().members.size() < kSurfacePartsTogether &&
                      alike(groups_[parts_.back().members.front().group], group(row));
    if (begins && !fits) parts_.emplace_back(), areas_.emplace_back();
    SurfacePart& part = parts_.back();
    place_of_[row] = {parts_.size() - 1, static_cast<uint32_t>(part.members.size())};
    part.members.push_back(member_of_[row]), areas_.back().push_back(neighbours_.areas.at(row));
  }

  std::span<const SurfaceGroup> groups_;
  const SurfaceNeighbours& neighbours_;
  const std::vector<Member>& member_of_;
  Joined joined_;
  std::vector<SurfacePart> parts_;
  std::vector<std::vector<double>> areas_;
  std::vector<Place> place_of_;
};

}  // namespace

bool alike(std::span<const SlabLayer> a, std::span<const SlabLayer> b) {
  return std::ranges::equal(a, b, [](const SlabLayer& x, const SlabLayer& y) { return alike(x, y); });
}

std::vector<SurfacePart> surface_parts(std::span<const SurfaceGroup> groups, size_t rows,
                                       const SurfaceNeighbours& neighbours) {
  std::vector<bool> touches(rows, false);
  std::vector<SurfacePart> parts;
  if (!neighbours.contacts.empty()) {
    std::vector<Member> member_of(rows);
    for (uint32_t g = 0; g < groups.size(); ++g)
      for (uint32_t i = 0; i < groups[g].front_rows.size(); ++i) member_of[groups[g].front_rows[i]] = {g, i};
    parts = Bodies(groups, neighbours, member_of).parts();
    for (const auto& c : neighbours.contacts) touches[c.a] = touches[c.b] = true;
  }
  for (uint32_t g = 0; g < groups.size(); ++g) {
    std::vector<Member> members;
    const auto put = [&] {
      if (!members.empty()) parts.push_back({std::move(members), {}});
      members.clear();
    };
    for (uint32_t i = 0; i < groups[g].front_rows.size(); ++i) {
      if (!touches[groups[g].front_rows[i]]) members.push_back({g, i});
      if (members.size() == kSurfacePartsTogether) put();
    }
    put();
  }
  return parts;
}

}  // namespace suite
