// Groups of a prepared scene with their placements, and the tags these have.
#include "formats/scene_hdf/internal.h"

namespace suite {

void write_table(h5::Writer& w, const Scene& s, GroupTable) {
  w.put_names("/groups/name", pick(s.groups, [](const Group& g) { return g.name; }));
  w.put("/groups/placements", pick(s.groups, [](const Group& g) { return uint64_t{g.placements.size()}; }), "1");
  std::vector<double> transform;
  std::vector<uint8_t> kind;
  std::vector<uint32_t> target, material, tag, track;
  for (const Group& g : s.groups)
    for (const Placement& p : g.placements) {
      const auto t = numbers_of(p.to_parent);
      transform.insert(transform.end(), t.begin(), t.end());
      kind.push_back(static_cast<uint8_t>(p.kind));
      target.push_back(p.target);
      material.push_back(p.material_override);
      tag.push_back(p.tag);
      track.push_back(p.track);
    }
  w.put("/placements/to_parent", transform, "m", 12);
  w.put("/placements/kind", kind, "1");
  w.put("/placements/target", target, "1");
  w.put("/placements/material", material, "1");
  w.put("/placements/tag", tag, "1");
  w.put("/placements/track", track, "1");
}

void read_table(h5::Reader& r, Scene& s, Loading&, GroupTable) {
  const std::vector<std::string> groups = r.get_names("/groups/name");
  const auto placements = r.get<uint64_t>("/groups/placements", "1", 1, static_cast<long long>(groups.size()));
  const auto transform = r.get<double>("/placements/to_parent", "m", 12);
  const auto rows = static_cast<long long>(transform.size() / 12);
  const auto what = r.get<uint8_t>("/placements/kind", "1", 1, rows);
  const auto target = r.get<uint32_t>("/placements/target", "1", 1, rows),
             override_ = r.get<uint32_t>("/placements/material", "1", 1, rows);
  const auto tag = r.get<uint32_t>("/placements/tag", "1", 1, rows),
             track = r.get<uint32_t>("/placements/track", "1", 1, rows);
  size_t at = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (placements[g] > target.size() - at) r.fail("group '" + groups[g] + "' declares more placements than there are");
    Group group{groups[g], {}};
    group.placements.reserve(placements[g]);
    for (uint64_t q = 0; q < placements[g]; ++q, ++at) {
      if (what[at] > static_cast<uint8_t>(TargetKind::primitive)) r.fail("a placement is of an unknown kind");
      group.placements.push_back({transform_of(&transform[12 * at]), static_cast<TargetKind>(what[at]), target[at],
                                  override_[at], tag[at], track[at], kNone});
    }
    s.groups.push_back(std::move(group));
  }
  if (at != target.size()) r.fail("there are placements of no group");
}

void write_table(h5::Writer& w, const Scene& s, TagTable) { w.put_names("/tags", s.tags); }
void read_table(h5::Reader& r, Scene& s, Loading&, TagTable) { s.tags = r.get_names("/tags"); }

}  // namespace suite
