// Control tables: what holds from which time on, in YAML or as a table.
#include "base/files.h"
#include "formats/motion/fields.h"

namespace suite {

namespace {

// A row of either kind: the cells it has, by name, and its time.
struct Row {
  double time;
  TimedRow row;
};

Row row_of(const Params& p, const MotionContext& context, std::span<const char* const> columns) {
  Row made{time_from(p, context), {p.where(), {}}};
  for (const char* name : columns)
    if (const auto cell = p.find(name)) made.row.cells[name] = {cell->as_text(), cell->where()};
  return made;
}

}  // namespace

bool TimedCell::truth() const {
  if (text != "true" && text != "false") throw Error(where, "'" + text + "' is neither true nor false");
  return text == "true";
}

double TimedCell::number_in(double low, double high, const char* unit) const {
  const auto value = finite_number(text);
  if (!value || !(*value >= low && *value <= high))
    throw Error(where, "'" + text + "' is no number from " + strf("%g to %g %s", low, high, unit));
  return *value;
}

TimedTable timetable_from(const Params& node, const MotionContext& context, std::span<const char* const> columns) {
  TimedTable made;
  std::vector<Row> rows;
  const bool map = node.kind() == Params::Kind::map;
  if (map) made.when.period = node.number_in("period_s", 1e-6, 1e12, "s", 0);
  if (const auto file = map ? node.find("file") : std::nullopt) {
    const std::string path = motion_file(*file, context);
    std::vector<const char*> names{"time_s", "utc"};
    names.insert(names.end(), columns.begin(), columns.end());
    for_each_row(read_text(path), path, names, [&](const TableRow& row) {
      rows.push_back({row.time(context), {row.where, {}}});
      for (const char* name : columns)
        if (const auto c = row.find(name); c && !row.cells[*c].empty())
          rows.back().row.cells[name] = {std::string(row.cells[*c]), row.where};
    });
  } else {
    for (const Params& p : (map ? node.at("rows") : node).items()) rows.push_back(row_of(p, context, columns));
    if (rows.empty()) throw node.error("a schedule without a row");
  }
  for (Row& row : rows) {
    if (!made.when.times.empty() && !(row.time > made.when.times.back()))
      throw Error(row.row.where, "the times do not ascend", "each row later than the one before");
    made.when.times.push_back(row.time);
    made.rows.push_back(std::move(row.row));
  }
  if (const std::string why = made.when.fault(); !why.empty()) throw node.error(why);
  return made;
}

}  // namespace suite
