#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text_lines.h"
#include "formats/star_catalogue/star_catalogue.h"

namespace suite {

namespace {

enum Column { name, ra, dec, epoch, pm_ra, pm_dec, v, b_v, temperature, type, column_count };
const std::vector<std::string> kNames{"name",       "ra_deg", "dec_deg", "epoch",         "pm_ra_mas",
                                      "pm_dec_mas", "v_mag",  "b_v",     "temperature_k", "type"};

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (size_t at = 0; at <= line.size();) {
    const size_t end = std::min(line.find(',', at), line.size());
    std::string_view cell = line.substr(at, end - at);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    cells.push_back(cell);
    at = end + 1;
  }
  return cells;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : lines_(text, file) {}

  std::vector<CatalogueStar> read() {
    std::vector<CatalogueStar> stars;
    while (lines_.next_raw()) {
      const std::string_view line = lines_.line();
      const size_t first = line.find_first_not_of(" \t");
      if (first == line.npos || line[first] == '#') continue;
      lines_.set_words(cells_of(line));
      if (columns_ == 0) {
        header();
        continue;
      }
      if (lines_.words() != columns_)
        throw lines_.error(0, strf("%zu cells, the header names %zu columns", lines_.words(), columns_),
                           "one cell a column, which may be empty; names hold no commas");
      if (stars.size() >= kMostStars) throw lines_.error(0, strf("more than %zu stars", kMostStars));
      stars.push_back(star(stars.size() + 1));
    }
    if (columns_ == 0)
      throw lines_.error_at_end("is empty", "a header line with 'ra_deg,dec_deg,v_mag,...' is expected");
    if (stars.empty()) throw lines_.error_at_end("has no stars", "a row each below the header");
    return stars;
  }

 private:
  bool has(Column c) const { return at_[c] && !lines_.word(*at_[c]).empty(); }
  double number(Column c, double low, double high, double missing) const {
    return has(c) ? lines_.number_in(*at_[c], kNames[c].c_str(), low, high) : missing;
  }

  void header() {
    columns_ = lines_.words();
    for (size_t i = 0; i < columns_; ++i) {
      const std::string word(lines_.word(i));
      const auto found = std::find(kNames.begin(), kNames.end(), word);
      if (found == kNames.end()) throw lines_.error(i, "unknown column '" + word + "'", name_hint(word, kNames));
      auto& at = at_[static_cast<size_t>(found - kNames.begin())];
      if (at) throw lines_.error(i, "column '" + word + "' is given twice");
      at = i;
    }
    for (const Column c : {ra, dec, v})
      if (!at_[c]) throw lines_.error(0, "the column '" + kNames[c] + "' is missing");
    if (!at_[b_v] && !at_[temperature] && !at_[type])
      throw lines_.error(0, "no column says how the stars are coloured", "'b_v', 'temperature_k' or 'type'");
  }

  CatalogueStar star(size_t number_of_row) const {
    CatalogueStar s;
    s.name = has(name) ? std::string(lines_.word(*at_[name])) : std::to_string(number_of_row);
    if (s.name.size() > 100) throw lines_.error(*at_[name], "a name of more than 100 bytes");
    for (const Column c : {ra, dec, v})
      if (!has(c)) throw lines_.error(*at_[c], "'" + kNames[c] + "' is empty", "every star has one");
    s.place = place();
    s.v = number(v, -30, 40, 0);
    color(s);
    return s;
  }

  // The place at 2000.0: along a great circle, as motion without a radial part goes.
  CatalogPlace place() const {
    constexpr double kMas = kDegree / 3.6e6;
    const double alpha = number(ra, -360, 360, 0) * kDegree, delta = number(dec, -90, 90, 0) * kDegree,
                 years = 2000 - number(epoch, 1000, 3000, 2000);
    const Vec3 at{std::cos(delta) * std::cos(alpha), std::cos(delta) * std::sin(alpha), std::sin(delta)},
        east{-std::sin(alpha), std::cos(alpha), 0}, north = cross(at, east);
    const Vec3 motion = (east * number(pm_ra, -1e6, 1e6, 0) + north * number(pm_dec, -1e6, 1e6, 0)) * kMas;  // a year
    const double rate = length(motion);
    Vec3 then = at, moving = motion;
    if (rate > 0 && years != 0) {
      const Vec3 along = motion / rate;
      then = at * std::cos(rate * years) + along * std::sin(rate * years);
      moving = (along * std::cos(rate * years) - at * std::sin(rate * years)) * rate;
    }
    CatalogPlace p;
    p.right_ascension = std::atan2(then.y, then.x);
    p.declination = std::atan2(then.z, std::hypot(then.x, then.y));
    const double cosine = std::max(1e-9, std::cos(p.declination));
    const Vec3 east_then{-std::sin(p.right_ascension), std::cos(p.right_ascension), 0};
    p.motion_right_ascension = dot(moving, east_then) / cosine;
    p.motion_declination = dot(moving, cross(then, east_then));
    return p;
  }

  // The first that a row has of temperature, B-V and type.
  void color(CatalogueStar& s) const {
    if (has(temperature)) {
      s.kelvin = number(temperature, 500, 500000, 0);
    } else if (has(b_v)) {
      s.kelvin = star_temperature(number(b_v, -1, 10, 0));
    } else if (has(type)) {
      const std::string text(lines_.word(*at_[type]));
      const auto colour = colour_of_type(text);
      if (!colour)
        throw lines_.error(*at_[type], "unknown spectral type '" + text + "'",
                           "a class from O, B, A, F, G, K, M and a subclass, as in G2V; else a temperature_k or b_v");
      s.kelvin = star_temperature(*colour);
    } else {
      throw lines_.error(0, "nothing says how the star is coloured", "a cell of 'b_v', 'temperature_k' or 'type'");
    }
  }

  TextLines lines_;
  size_t columns_ = 0;
  std::array<std::optional<size_t>, column_count> at_{};
};

}  // namespace

std::optional<double> colour_of_type(std::string_view type) {
  constexpr std::string_view kClasses = "OBAFGKM";
  constexpr std::pair<double, double> kColours[] = {{5, -0.33}, {10, -0.30}, {15, -0.17}, {20, -0.02}, {25, 0.15},
                                                    {30, 0.30}, {35, 0.44},  {40, 0.58},  {45, 0.68},  {50, 0.81},
                                                    {55, 1.15}, {60, 1.40},  {65, 1.64}};
  const size_t main = type.empty() ? type.npos : kClasses.find(type.front());
  if (main == type.npos) return std::nullopt;
  double sub = 5;
  const size_t digits = type.find_first_not_of("0123456789.", 1), end = std::min(digits, type.size());
  if (end > 1) {
    const auto [after, code] = std::from_chars(type.data() + 1, type.data() + end, sub);
    if (code != std::errc() || after != type.data() + end || !(sub < 10)) return std::nullopt;
  }
  const double at = 10 * static_cast<double>(main) + sub;
  const auto* upper = std::find_if(std::begin(kColours), std::end(kColours), [&](auto& c) { return c.first >= at; });
  if (upper == std::begin(kColours)) return upper->second;
  if (upper == std::end(kColours)) return std::end(kColours)[-1].second;
  const auto* lower = upper - 1;
  return lower->second + (at - lower->first) / (upper->first - lower->first) * (upper->second - lower->second);
}

std::vector<CatalogueStar> parse_star_catalogue(std::string_view text, const std::string& file) {
  return Reader(text, file).read();
}

std::vector<CatalogueStar> read_star_catalogue(const std::string& path) {
  return parse_star_catalogue(read_text(path, size_t{4} << 30), path);
}

}  // namespace suite
