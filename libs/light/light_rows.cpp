#include "light/light_rows.h"

#include <algorithm>

#include "light/kinds/rows.h"

namespace suite {

Registry<LightRow>& light_rows() {
  static Registry<LightRow> table(
      "light", "",
      {sun_row(), moon_row(), sky_table_row(), sky_clear_row(), sky_image_row(), sky_thermal_row(), night_sky_row(),
       lamp_point_row(), lamp_spot_row(), lamp_surface_row()});
  return table;
}

std::vector<const LightRow*> light_keys() {
  std::vector<const LightRow*> first;
  for (const LightRow& row : light_rows())
    if (std::none_of(first.begin(), first.end(), [&](const LightRow* r) { return r->key() == row.key(); }))
      first.push_back(&row);
  return first;
}

LightSpecPtr make_light(const LightRow& first, const Params& p, const LightContext& context) {
  std::vector<const LightRow*> rows;
  std::vector<std::string> kinds;
  for (const LightRow& row : light_rows())
    if (row.key() == first.key()) rows.push_back(&row), kinds.push_back(row.kind());
  if (rows.size() == 1 && kinds[0].empty()) return first.make(p, context);
  const auto kind = first.list ? p.at("kind") : p.find("kind");
  return rows[kind ? kind->as_choice(kinds) : 0]->make(p, context);
}

Curve LightContext::positive(const Params& p, const char* what, const char* unit) const {
  Curve c = curve(p);
  if (c.min() < 0) throw p.error(std::string("the ") + what + " is negative", std::string(unit) + ", at least 0");
  asked->push_back({p.where(), what, c});
  return c;
}

Curve LightContext::builtin(const Params& entry, const char* what, const char* key, const Curve& given) const {
  asked->push_back({entry.where(), what, given, "bands within " + given.range_text() + strf(", or '%s: FILE'", key)});
  return given;
}

Stokes read_stokes(const Params& p) {
  const std::vector<double> v = p.as_numbers();
  if (v.size() != 4 || !(v[0] == 1) || !(v[1] * v[1] + v[2] * v[2] + v[3] * v[3] <= 1 + 1e-12))
    throw p.error("'stokes' is no light of intensity 1", "[1, Q, U, V] with Q2 + U2 + V2 at most 1");
  return {v[0], v[1], v[2], v[3]};
}

void read_rows(const Params& table, size_t& rows, size_t& columns, std::vector<double>& values, const char* what,
               TableSigns signs) {
  for (const Params& row : table.items()) {
    const std::vector<double> v = row.as_numbers();
    if (v.empty() || (rows && v.size() != columns))
      throw row.error(std::string("the rows of ") + what + " must be equally long and not empty");
    for (const double x : v)
      if (x < 0 && signs == TableSigns::positive) throw row.error(std::string(what) + " holds a negative value");
    columns = v.size();
    ++rows;
    values.insert(values.end(), v.begin(), v.end());
  }
}

}  // namespace suite
