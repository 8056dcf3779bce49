#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "sqt_fit/symmetry.h"

namespace suite {

namespace {

enum Column { theta_o, phi_o, theta_i, phi_i, wavelength, value_, kColumns };

struct Layout {
  size_t at[kColumns] = {0, 1, 2, 3, 4, 5};
  double scale[kColumns] = {1, 1, 1, 1, 1, 1};
};

bool looks_numeric(std::string_view word) {
  return word.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
}

// Column names may come in any order; angles are rad, or degrees when the name says so.
Layout read_header(const TextLines& lines) {
  Layout layout;
  std::array<bool, kColumns> seen{};
  const std::vector<std::string> known{"theta_o", "phi_o",       "theta_i",   "phi_i",       "wavelength_um",
                                       "value",   "theta_o_deg", "phi_o_deg", "theta_i_deg", "phi_i_deg"};
  for (size_t w = 0; w < lines.words(); ++w) {
    std::string name(lines.word(w));
    if (name.find(';') != std::string::npos)
      throw lines.error(w, "';' between the columns", "separate columns by commas, decimals by points");
    std::erase(name, '"');
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw lines.error(w, "unknown column '" + name + "'", name_hint(name, known));
    const size_t index = static_cast<size_t>(found - known.begin()), column = index < 6 ? index : index - 6;
    if (seen[column]) throw lines.error(w, "column '" + name + "' is given twice");
    seen[column] = true;
    layout.at[column] = w;
    layout.scale[column] = index < 6 ? 1 : kDegree;
  }
  for (size_t c = 0; c < kColumns; ++c)
    if (!seen[c]) throw lines.error(lines.words(), "column '" + known[c] + "' is missing");
  return layout;
}

void read_directive(std::string_view comment, const TextLines& lines, sqt::Function::Info& info) {
  auto after = [&](std::string_view key) {
    std::string_view c = comment.substr(std::min(comment.find_first_not_of(" \t"), comment.size()));
    if (!c.starts_with(key)) return std::string{};
    c.remove_prefix(key.size());
    c.remove_prefix(std::min(c.find_first_not_of(" \t"), c.size()));
    return std::string(c.substr(0, c.find_last_not_of(" \t") + 1));
  };
  if (const std::string name = after("name:"); !name.empty()) info.name = name;
  if (const std::string quantity = after("quantity:"); !quantity.empty()) {
    const std::vector<std::string> known{"bsdf", "phase", "intensity"};
    const auto found = std::find(known.begin(), known.end(), quantity);
    if (found == known.end()) throw lines.error(0, "unknown quantity '" + quantity + "'", name_hint(quantity, known));
    info.quantity = static_cast<sqt::Quantity>(found - known.begin());
  }
}

struct Row {
  std::array<double, 4> angle;  // theta_o, phi_o, theta_i, phi_i, rad
  double wavelength_um, value;
};

Row read_row(const TextLines& lines, const Layout& layout, sqt::Quantity quantity) {
  if (lines.words() != kColumns)
    throw lines.error(0, strf("the line has %zu values, %d are wanted", lines.words(), kColumns),
                      "theta_o, phi_o, theta_i, phi_i, wavelength_um, value; nan stands for a missing value");
  Row row{};
  for (size_t a = 0; a < 4; ++a) {
    const bool polar = a % 2 == 0;
    const double most = polar ? kPi : 2 * kPi, x = lines.number(layout.at[a], "an angle") * layout.scale[a];
    if (!(x >= (polar ? 0 : -most) - 1e-6 && x <= most + 1e-6))
      throw lines.error(layout.at[a], strf("the angle is %g rad", x),
                        "angles are rad unless the column's name ends in _deg");
    row.angle[a] = x;
  }
  if (quantity == sqt::Quantity::bsdf && row.angle[0] >= kPi / 2)
    throw lines.error(layout.at[theta_o], "the outgoing direction lies on or below the horizon");
  row.wavelength_um = lines.number_in(layout.at[wavelength], "the wavelength in um", 0.01, 1000);
  const double v = lines.number(layout.at[value_], "the value", true);
  row.value = std::isfinite(v) ? v : std::numeric_limits<double>::quiet_NaN();
  return row;
}

// Rows of single wavelengths -> one sample per pair of directions.
void gather(const std::vector<Row>& rows, const TextLines& lines, sqt::Samples& s) {
  std::map<double, size_t> channel;
  std::map<std::array<double, 4>, size_t> pair;
  for (const Row& r : rows) channel.emplace(r.wavelength_um, 0), pair.emplace(r.angle, 0);
  if (pair.size() > (4 * rows.size() + 1000) / channel.size())
    throw lines.error_at_end(strf("%zu pairs of directions x %zu wavelengths from %zu rows: the table is mostly empty",
                                  pair.size(), channel.size(), rows.size()),
                             "give every pair the same wavelengths");
  for (auto& [w, index] : channel) {
    index = s.info.wavelength_um.size();
    s.info.wavelength_um.push_back(w);
  }
  for (auto& [a, index] : pair) {
    index = s.out.size();
    s.out.push_back(dir_from_angles(a[0], a[1]));
    s.in.push_back(dir_from_angles(a[2], a[3]));
  }
  s.value.assign(pair.size() * channel.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Row& r : rows) s.value[pair[r.angle] * channel.size() + channel[r.wavelength_um]] = r.value;
}

}  // namespace

sqt::Samples parse_brdf_csv(std::string_view text, const std::string& file_name) {
  TextLines lines(text, file_name, true);
  sqt::Samples s;
  s.info.name = std::filesystem::path(file_name).stem().string();
  Layout layout;
  std::vector<Row> rows;
  bool started = false;
  while (lines.next_raw()) {
    if (!lines.comment().empty()) read_directive(lines.comment(), lines, s.info);
    if (lines.words() == 0) continue;
    if (!started && !looks_numeric(lines.word(0)))
      layout = read_header(lines);
    else
      rows.push_back(read_row(lines, layout, s.info.quantity));
    started = true;
  }
  if (rows.empty())
    throw lines.error_at_end("holds no samples", "rows of theta_o, phi_o, theta_i, phi_i, wavelength_um, value");
  gather(rows, lines, s);
  infer_symmetry(s, sqt::Still::out);
  if (s.info.quantity != sqt::Quantity::bsdf) s.info.domain = sqt::Domain::sphere;
  s.info.source = "CSV, value per sr without cosine";
  return s;
}

sqt::Samples read_brdf_csv(const std::string& path) { return parse_brdf_csv(read_text(path), path); }

}  // namespace suite
