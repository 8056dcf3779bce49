// When placements are there and what they are made of. Scenes in which nothing comes and goes have none of these
// datasets.
#include "formats/scene_hdf/internal.h"

namespace suite {

namespace {
const std::string kTable = "/schedules";
}

void write_table(h5::Writer& w, const Scene& s, ScheduleTable) {
  if (s.schedules.empty()) return;
  std::vector<uint64_t> rows;
  std::vector<double> span, time;
  std::vector<uint8_t> there;
  std::vector<uint32_t> material;
  for (const Schedule& one : s.schedules) {
    span.insert(span.end(), {one.life.begin, one.life.end, one.when.period});
    rows.push_back(one.when.times.size());
    time.insert(time.end(), one.when.times.begin(), one.when.times.end());
    there.insert(there.end(), one.there.begin(), one.there.end());
    material.insert(material.end(), one.material.begin(), one.material.end());
  }
  w.put_names(kTable + "/name", pick(s.schedules, [](const Schedule& one) { return one.name; }));
  w.put(kTable + "/span", span, "s", 3);
  w.put(kTable + "/rows", rows, "1");
  w.put(kTable + "/time", time, "s");
  w.put(kTable + "/there", there, "1");
  w.put(kTable + "/material", material, "1");
  std::vector<uint32_t> of;
  for (const Group& g : s.groups)
    for (const Placement& p : g.placements) of.push_back(p.schedule);
  w.put("/placements/schedule", of, "1");
}

void read_table(h5::Reader& r, Scene& s, Loading&, ScheduleTable) {
  if (!r.has(kTable + "/name")) return;
  const std::vector<std::string> names = r.get_names(kTable + "/name");
  const auto n = static_cast<long long>(names.size());
  const auto span = r.get<double>(kTable + "/span", "s", 3, n);
  const auto rows = r.get<uint64_t>(kTable + "/rows", "1", 1, n);
  Stretch<double> time(r, kTable + "/time", "s");
  Stretch<uint8_t> there(r, kTable + "/there", "1");
  Stretch<uint32_t> material(r, kTable + "/material", "1");
  for (size_t k = 0; k < names.size(); ++k) {
    Schedule one;
    one.name = names[k];
    one.life = {span[3 * k], span[3 * k + 1]};
    one.when.period = span[3 * k + 2];
    one.when.times = time.next(rows[k]);
    one.there = there.next(rows[k]);
    one.material = material.next(rows[k]);
    s.schedules.push_back(std::move(one));
  }
  time.finish(), there.finish(), material.finish();
  size_t placements = 0, at = 0;
  for (const Group& g : s.groups) placements += g.placements.size();
  const auto of = r.get<uint32_t>("/placements/schedule", "1", 1, static_cast<long long>(placements));
  for (Group& g : s.groups)
    for (Placement& p : g.placements) p.schedule = of[at++];
}

}  // namespace suite
