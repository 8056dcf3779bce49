#include "formats/tape7/cards.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "math/vec.h"

namespace suite {

namespace {

// A number alone in columns first to first + length - 1, counted from 0.
std::optional<double> field(const std::string& line, size_t first, size_t length) {
  if (first >= line.size()) return std::nullopt;
  std::string_view f = std::string_view(line).substr(first, length);
  f.remove_prefix(std::min(f.find_first_not_of(' '), f.size()));
  f = f.substr(0, f.find_last_not_of(' ') + 1);
  double value = 0;
  const auto [stop, code] = std::from_chars(f.data(), f.data() + f.size(), value);
  if (f.empty() || code != std::errc() || stop != f.data() + f.size() || !(std::fabs(value) < 1e9)) return std::nullopt;
  return value;
}

std::optional<int> whole(const std::string& line, size_t first, size_t length, int low, int high) {
  const auto v = field(line, first, length);
  if (!v || *v != std::floor(*v) || *v < low || *v > high) return std::nullopt;
  return static_cast<int>(*v);
}

// Card 2C: the number and name of the profile, the line before card 3.
bool names_a_profile(const std::string& line) {
  return line.size() > 5 && whole(line, 0, 5, 0, 999) && line.find('!') == std::string::npos &&
         std::any_of(line.begin() + 5, line.end(), [](char c) { return std::isalpha(static_cast<unsigned char>(c)); });
}

// Cards 3A1 and 3A2 where the Sun is given by its angles.
void read_sun(const std::string& first, const std::string& second, Tape7Geometry& g) {
  const auto kind = whole(first, 0, 5, 0, 12);
  const auto azimuth = field(second, 0, 10), zenith = field(second, 10, 10);
  if ((kind != 2 && kind != 12) || !azimuth || !zenith || !(*zenith >= 0 && *zenith <= 180)) return;
  g.relative_azimuth = *azimuth * kDegree;
  g.solar_zenith = *zenith * kDegree;
}

std::optional<Tape7Geometry> geometry_of(const std::vector<std::string>& lines, size_t at, int type, int mode) {
  const auto h1 = field(lines[at], 0, 10), h2 = field(lines[at], 10, 10), angle = field(lines[at], 20, 10);
  if (!h1 || !h2 || !angle || !(*angle >= 0 && *angle <= 180)) return std::nullopt;
  Tape7Geometry g{type, *h1 * 1e3, *h2 * 1e3, *angle * kDegree, {}, {}, {}};
  if (mode == 3) return g;  // its card 3 has the day of the year where the others have the range
  if (const auto range = field(lines[at], 30, 10); range && *range > 0) g.range = *range * 1e3;
  if (at + 2 < lines.size()) read_sun(lines[at + 1], lines[at + 2], g);
  return g;
}

}  // namespace

Tape7Cards tape7_cards(const std::vector<std::string>& lines, double first, double last) {
  Tape7Cards cards;
  if (lines.empty()) return cards;
  const auto type = whole(lines[0], 5, 5, 1, 4);
  cards.mode = whole(lines[0], 10, 5, 0, 3);
  cards.multiple = whole(lines[0], 15, 5, -1, 1);
  if (!type || !cards.mode) return {};
  for (size_t i = 1; i + 1 < lines.size(); ++i) {
    if (!names_a_profile(lines[i])) continue;
    // Card 4, one to three lines below card 3, must have the wavenumbers of the run: else these are not the cards.
    for (size_t k = i + 2; k < std::min(i + 5, lines.size()); ++k) {
      const auto v1 = field(lines[k], 0, 10), v2 = field(lines[k], 10, 10), step = field(lines[k], 20, 10);
      if (!v1 || !v2 || !step || std::fabs(*v1 - first) > 1 + *step || last > *v2 + 1 + *step) continue;
      cards.geometry = geometry_of(lines, i + 1, *type, *cards.mode);
      return cards;
    }
  }
  return cards;
}

}  // namespace suite
