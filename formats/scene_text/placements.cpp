#include <cmath>
#include <utility>

#include "formats/instances/instances.h"
#include "formats/motion/motion.h"
#include "formats/scene_text/reader.h"
#include "formats/scene_text/transform.h"
#include "formats/tle/tle.h"

namespace suite::scene_text {

namespace {

ScatterRule read_scatter(const Params& p) {
  ScatterRule rule;
  rule.density_per_m2 = p.number_in("density_per_m2", 1e-12, 1e6, "1/m2");
  rule.seed = static_cast<uint64_t>(p.integer("seed", 0, 1LL << 53, 1));
  rule.turn = p.boolean("random_heading", true);
  if (const auto scale = p.find("scale")) {
    const std::vector<double> range = scale->as_numbers();
    if (range.size() != 2 || !(range[0] > 0 && range[0] <= range[1]))
      throw scale->error("the scale of a scatter is [low, high], above 0");
    rule.scale_low = range[0], rule.scale_high = range[1];
  }
  if (const auto region = p.find("region")) {
    const std::vector<double> r = region->as_numbers();
    if (r.size() != 4 || !(r[0] < r[2] && r[1] < r[3]))
      throw region->error("a region is [x0, y0, x1, y1], low corner first");
    rule.region = {r[0], r[1], r[2], r[3]};
  }
  return rule;
}

}  // namespace

// Geodetic places mean something in `world` only: groups do not know where they will stand.
MotionContext Reader::motion_context(bool world) {
  MotionContext context;
  if (world && draft_.origin.given)
    context.frame.emplace(
        Geodetic{draft_.origin.latitude_deg, draft_.origin.longitude_deg, draft_.origin.ellipsoid_height_m});
  if (!draft_.epoch.empty()) context.clock.emplace(parse_iso8601(draft_.epoch));
  context.satellites = [](const std::string& path, const std::string& satellite) {
    return read_tle_of(path, satellite).elements;
  };
  context.satellite_lines = [](const std::string& lines, const std::string& file) {
    return parse_tle(lines, file).at(0).elements;
  };
  context.resolve = [this](const Params& file) { return input(file); };
  return context;
}

// A lifetime and a control table; nothing when neither is given.
std::optional<DraftSchedule> Reader::read_schedule(const Params& p, const MotionContext& context) {
  const auto table = p.find("schedule");
  DraftSchedule made;
  made.life = read_life(p, context);
  if (made.life == kAlways && !table) return std::nullopt;
  if (!table) return made;
  constexpr const char* kColumns[] = {"there", "material"};
  const TimedTable rows = timetable_from(*table, context, kColumns);
  made.when = rows.when;
  for (const TimedRow& row : rows.rows) {
    DraftSchedule::Row& to = made.rows.emplace_back();
    if (const auto there = row.cells.find("there"); there != row.cells.end()) to.there = there->second.truth();
    if (const auto m = row.cells.find("material"); m != row.cells.end())
      to.material = {m->second.text, m->second.where};
  }
  return made;
}

DraftPlacement Reader::read_placement(const Params& p, bool world) {
  DraftPlacement made;
  made.where = p.where();
  made.target = reference(p.at("place"));
  if (const auto v = p.find("material")) made.material = reference(*v);
  if (const auto v = p.find("tag")) made.tag = reference(*v);
  if (const auto v = p.find("on")) made.on = reference(*v);
  if (const auto v = p.find("table")) {
    made.table = true;
    made.rows = read_instances(input(*v));
  }
  if (const auto v = p.find("scatter")) {
    if (made.table) throw v->error("'table' and 'scatter' cannot be combined");
    if (!made.on.given()) throw v->error("'scatter' needs 'on', the terrain or mesh to scatter over");
    made.scatter = read_scatter(*v);
  }
  if (const auto v = p.find("motion")) {
    MotionContext context = motion_context(world);
    context.may_end = true;
    made.motion = track_from(*v, context);
    made.motion_where = v->where();
  }
  made.schedule = read_schedule(p, motion_context(world));
  if (const auto t = find_transform(p)) made.to_parent = *t;
  return made;
}

void Reader::read_group(const std::string& name, const Params& p) {
  // Filed even when a placement is wrong, so that names still resolve.
  const size_t slot = draft_.groups.size();
  draft_.groups.push_back({name, p.where(), {}});
  for (const Params& row : p.items())
    item("SP001", row, [&] {
      const bool before = std::exchange(draft_.failed_placements, true);
      std::vector<DraftPlacement>& placements = draft_.groups[slot].placements;
      if (row.has("traffic"))
        read_traffic(row, slot == 0, placements);
      else
        placements.push_back(read_placement(row, slot == 0));
      draft_.failed_placements = before;
    });
}

}  // namespace suite::scene_text
