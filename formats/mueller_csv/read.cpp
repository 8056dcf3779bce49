#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "base/text_lines.h"
#include "formats/mueller_csv/mueller_csv.h"
#include "sqt_fit/whole_circle.h"

namespace suite {

namespace {

enum Column : size_t { kThetaH, kThetaD, kPhiD, kWavelength, kFirstElement, kColumns = kFirstElement + 16 };

const std::vector<std::string>& column_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> n{"theta_h_deg", "theta_d_deg", "phi_d_deg", "wavelength_um"};
    for (int i = 1; i <= 4; ++i)
      for (int j = 1; j <= 4; ++j) n.push_back(strf("m%d%d", i, j));
    return n;
  }();
  return names;
}

struct Row {
  std::array<double, 4> at;  // theta_h, theta_d, phi_d in rad, wavelength in um
  Mueller m;
};

struct Head {
  std::array<size_t, kColumns> place{};  // of a column in a row
  std::string name;
  const StokesConvention* convention = &kStokesConventions[0];
};

std::vector<std::string> convention_names() {
  std::vector<std::string> names;
  for (const StokesConvention& c : kStokesConventions) names.emplace_back(c.name);
  return names;
}

void read_directive(const TextLines& lines, Head& head) {
  const std::string_view c = lines.comment();
  const size_t colon = c.find(':');
  if (colon == std::string_view::npos) return;
  const auto bare = [](std::string_view s) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
    return std::string(s);
  };
  const std::string key = bare(c.substr(0, colon)), value = bare(c.substr(colon + 1));
  if (key == "name") head.name = value;
  if (key != "convention") return;
  const auto found = std::find_if(std::begin(kStokesConventions), std::end(kStokesConventions),
                                  [&](const StokesConvention& s) { return s.name == value; });
  if (found == std::end(kStokesConventions))
    throw lines.error(0, "unknown convention '" + value + "'", name_hint(value, convention_names()));
  head.convention = found;
}

void read_columns(const TextLines& lines, Head& head) {
  const std::vector<std::string>& names = column_names();
  std::array<bool, kColumns> seen{};
  for (size_t w = 0; w < lines.words(); ++w) {
    std::string name(lines.word(w));
    std::erase(name, '"');
    const size_t c = static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (c == names.size()) throw lines.error(w, "unknown column '" + name + "'", name_hint(name, names));
    if (seen[c]) throw lines.error(w, "column '" + name + "' is given twice");
    seen[c] = true;
    head.place[c] = w;
  }
  for (size_t c = 0; c < kColumns; ++c)
    if (!seen[c]) throw lines.error(lines.words(), "column '" + names[c] + "' is missing");
}

Row read_row(const TextLines& lines, const Head& head) {
  if (lines.words() != kColumns)
    throw lines.error(0, strf("the line has %zu values, %zu are wanted", lines.words(), static_cast<size_t>(kColumns)),
                      "three angles in degrees, the wavelength in um, m11 to m44 by rows; nan marks a missing matrix");
  Row row{};
  row.at[0] = lines.number_in(head.place[kThetaH], "theta_h in degrees", 0, 90) * kDegree;
  row.at[1] = lines.number_in(head.place[kThetaD], "theta_d in degrees", 0, 90) * kDegree;
  row.at[2] = lines.number_in(head.place[kPhiD], "phi_d in degrees", -360, 360) * kDegree;
  row.at[3] = lines.number_in(head.place[kWavelength], "the wavelength in um", 0.01, 1000);
  for (size_t e = 0; e < 16; ++e) {
    const double x = lines.number(head.place[kFirstElement + e], "an element", true);
    row.m.m[e] = std::isfinite(x) ? x : std::numeric_limits<double>::quiet_NaN();
  }
  for (const double x : row.m.m)
    if (std::isnan(x)) row.m.m[0] = x;  // a matrix is there as a whole
  return row;
}

std::vector<double> values_of(const std::vector<Row>& rows, size_t column) {
  std::vector<double> v;
  for (const Row& r : rows) v.push_back(r.at[column]);
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  return v;
}

size_t index_of(const std::vector<double>& axis, double x) {
  return static_cast<size_t>(std::lower_bound(axis.begin(), axis.end(), x) - axis.begin());
}

sqt::MuellerBrdf::Data gathered(const std::vector<Row>& rows, const Head& head, const TextLines& lines) {
  sqt::MuellerBrdf::Data data;
  data.grid.theta_h = values_of(rows, 0), data.grid.theta_d = values_of(rows, 1);
  data.wavelength_um = values_of(rows, 3);
  const std::vector<double> phi = values_of(rows, 2);
  const std::vector<sqt::CirclePlace> places = sqt::whole_circle(phi);
  const size_t H = data.grid.theta_h.size(), D = data.grid.theta_d.size(), W = data.wavelength_um.size();
  if (phi.size() * D * H * W > 4 * rows.size() + 1000)
    throw lines.error_at_end(strf("%zu x %zu x %zu angles x %zu wavelengths from %zu rows: the table is mostly empty",
                                  H, D, phi.size(), W, rows.size()),
                             "give every combination of theta_h, theta_d, phi_d and wavelength");
  std::vector<const Row*> of(phi.size() * D * H * W, nullptr);
  for (const Row& r : rows) {
    const size_t n =
        (index_of(phi, r.at[2]) * D + index_of(data.grid.theta_d, r.at[1])) * H + index_of(data.grid.theta_h, r.at[0]);
    const Row*& there = of[n * W + index_of(data.wavelength_um, r.at[3])];
    if (there)
      throw lines.error_at_end(strf("theta_h %g, theta_d %g, phi_d %g degrees at %g um are given twice",
                                    r.at[0] / kDegree, r.at[1] / kDegree, r.at[2] / kDegree, r.at[3]));
    there = &r;
  }
  for (const sqt::CirclePlace& place : places) {
    data.grid.phi_d.push_back(place.phi);
    for (size_t i = place.from * D * H * W; i < (place.from + 1) * D * H * W; ++i) {
      Mueller m;
      m.m.fill(std::numeric_limits<double>::quiet_NaN());
      if (of[i]) m = converted(of[i]->m, *head.convention);
      if (place.mirrored) m = sqt::mirror_image(m);
      for (const double x : m.m) data.values.push_back(static_cast<float>(x));
    }
  }
  return data;
}

}  // namespace

bool is_mueller_csv(std::string_view text) {
  TextLines lines(text, {}, true);
  if (!lines.next()) return false;
  for (size_t w = 0; w < lines.words(); ++w)
    if (lines.word(w) == "m11" || lines.word(w) == "\"m11\"") return true;
  return false;
}

std::shared_ptr<const sqt::MuellerBrdf> parse_mueller_csv(std::string_view text, const std::string& file_name) {
  TextLines lines(text, file_name, true);
  Head head;
  head.name = std::filesystem::path(file_name).stem().string();
  std::vector<Row> rows;
  bool started = false;
  while (lines.next_raw()) {
    if (!lines.comment().empty()) read_directive(lines, head);
    if (lines.words() == 0) continue;
    if (!std::exchange(started, true))
      read_columns(lines, head);
    else
      rows.push_back(read_row(lines, head));
  }
  if (rows.empty())
    throw lines.error_at_end("holds no matrices",
                             "columns theta_h_deg, theta_d_deg, phi_d_deg, "
                             "wavelength_um, m11 to m44, then rows");
  try {
    return std::make_shared<const sqt::MuellerBrdf>(
        head.name,
        "CSV of Mueller matrices by half-vector angles, 1/sr, convention " + std::string(head.convention->name),
        gathered(rows, head, lines));
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw lines.error_at_end(e.message(), e.hint());
  }
}

}  // namespace suite
