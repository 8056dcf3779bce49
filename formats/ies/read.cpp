#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/run_app.h"
#include "base/text_lines.h"
#include "formats/ies/ies.h"
#include "math/vec.h"

namespace suite {

namespace {

// Numbers of a text whose line breaks mean nothing.
class Numbers {
 public:
  explicit Numbers(TextLines& lines) : lines_(lines) {}
  double next(const char* what, double low, double high) {
    while (word_ >= lines_.words()) {
      if (!lines_.next_raw()) throw lines_.error_at_end(strf("the file ends before %s", what));
      word_ = 0;
    }
    return lines_.number_in(word_++, what, low, high);
  }
  long long whole(const char* what, long long low, long long high) {
    const double v = next(what, static_cast<double>(low), static_cast<double>(high));
    if (v != std::floor(v)) throw lines_.error(word_ - 1, strf("%s is no whole number", what));
    return static_cast<long long>(v);
  }
  Error error(const std::string& what, const std::string& hint) const {
    return lines_.error(word_ ? word_ - 1 : 0, what, hint);
  }

 private:
  TextLines& lines_;
  size_t word_ = size_t{1} << 40;  // the line that is open is used up
};

std::vector<double> ascending(Numbers& in, size_t n, const char* what, double low, double high) {
  std::vector<double> list;
  for (size_t i = 0; i < n; ++i) {
    list.push_back(in.next(what, low, high));
    if (i && !(list[i] > list[i - 1]))
      throw in.error(strf("%s do not ascend", what), "from the smallest to the largest");
  }
  return list;
}

bool is(double a, double b) { return std::fabs(a - b) < 1e-3; }

void check_ranges(const IesLuminaire& l, const std::string& file, const Numbers& in) {
  const double v0 = l.vertical.front(), v1 = l.vertical.back(), h0 = l.horizontal.front(), h1 = l.horizontal.back();
  if (l.vertical.size() < 2) throw in.error(strf("one vertical angle, %g deg", v0), "two or more, 0 to 180");
  // Files of cut-off luminaires end where their light does.
  if (!(is(v0, 0) || is(v0, 90)) || !(is(v1, 90) || is(v1, 180)))
    warn(
        strf("%s: vertical angles reach from %g to %g degrees, not from 0 or 90 to 90 or 180; there is no light beyond",
             file.c_str(), v0, v1));
  const bool fits = (is(h0, 0) && (l.horizontal.size() == 1 || is(h1, 90) || is(h1, 180) || is(h1, 360))) ||
                    (is(h0, 90) && is(h1, 270));
  if (!fits)
    throw in.error(strf("horizontal angles reach from %g to %g deg", h0, h1),
                   "0 alone, 0 to 90, 180 or 360, 90 to 270");
}

// The keywords, up to and with TILT.
std::string read_head(TextLines& lines, IesLuminaire& l) {
  while (lines.next_raw()) {
    std::string_view line = lines.line();
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    if (line.starts_with("[LUMINAIRE]") && line.size() > 12) l.name = std::string(line.substr(12));
    if (line.starts_with("TILT=")) return std::string(line.substr(5));
  }
  throw lines.error_at_end("has no line TILT=", "an IES LM-63 file: IESNA:LM-63-2002, keywords, TILT=NONE, numbers");
}

void skip_tilt(const std::string& tilt, TextLines& lines, Numbers& in) {
  if (tilt == "NONE") return;
  if (tilt != "INCLUDE")
    throw lines.error(0, "the factors of tilted lamps are in a file of their own: " + tilt,
                      "TILT=NONE or TILT=INCLUDE");
  in.whole("the lamp's geometry", 1, 3);
  const long long pairs = in.whole("the number of tilt angles", 1, 1000);
  double largest = 0;
  for (long long i = 0; i < pairs; ++i) in.next("a tilt angle", -360, 360);
  for (long long i = 0; i < pairs; ++i) largest = std::max(largest, std::fabs(in.next("a tilt factor", 0, 10) - 1));
  warn(strf("%s: factors for tilted lamps are not applied; they change the light by up to %.3g %%",
            lines.where().file.c_str(), 100 * largest));
}

void note_lumens(const IesLuminaire& l, const std::string& file) {
  const double all = l.lumens();
  if (l.lamp_lumens > 0 && all > 1.05 * l.lamp_lumens)
    warn(strf("%s: the candela make %.4g lm, its lamps have %.4g", file.c_str(), all, l.lamp_lumens));
  if (l.watts > 0 && all > 683 * l.watts)
    warn(strf("%s: %.4g lm from %g W is more than light can be", file.c_str(), all, l.watts));
}

// Azimuth within the range that is stored.
double folded(double h, const std::vector<double>& stored) {
  h -= 360 * std::floor(h / 360);
  const double first = stored.front(), last = stored.back();
  if (stored.size() == 1) return first;
  if (is(first, 90)) return h < 90 ? 180 - h : h > 270 ? 540 - h : h;
  if (is(last, 90)) {
    if (h > 180) h = 360 - h;
    return h > 90 ? 180 - h : h;
  }
  return is(last, 180) && h > 180 ? 360 - h : h;
}

std::pair<size_t, double> bracket(const std::vector<double>& list, double x) {
  if (list.size() == 1) return {0, 0.0};
  const size_t above = static_cast<size_t>(std::upper_bound(list.begin(), list.end(), x) - list.begin());
  const size_t i = std::clamp<size_t>(above, 1, list.size() - 1) - 1;
  return {i, std::clamp((x - list[i]) / (list[i + 1] - list[i]), 0.0, 1.0)};
}

constexpr double kFinest = 0.25;  // deg
// The coarsest step, deg, that divides `whole` and has all of the angles on it, at least kFinest.
double step_of(const std::vector<double>& angles, double whole) {
  for (const double step : {90.0, 45.0, 30.0, 22.5, 15.0, 10.0, 7.5, 5.0, 2.5, 2.0, 1.0, 0.5}) {
    if (whole / step < 2) continue;
    bool all = true;
    for (const double a : angles) all = all && std::fabs(a / step - std::round(a / step)) * step < 1e-3;
    if (all) return step;
  }
  return kFinest;
}

}  // namespace

double IesLuminaire::at(double v, double h) const {
  if (v < vertical.front() - 1e-9 || v > vertical.back() + 1e-9) return 0;
  const auto [i, s] = bracket(vertical, v);
  const auto [j, t] = bracket(horizontal, folded(h, horizontal));
  const size_t n = vertical.size(), k = std::min(j + 1, horizontal.size() - 1);
  return (1 - t) * ((1 - s) * candela[j * n + i] + s * candela[j * n + i + 1]) +
         t * ((1 - s) * candela[k * n + i] + s * candela[k * n + i + 1]);
}

// Linear in the angle between two of them: integrals of candela x sin over vertical angles in closed form; trapezoids,
// which are exact, over horizontal ones.
double IesLuminaire::lumens() const {
  const size_t n = vertical.size();
  auto half_plane = [&](size_t j) {
    double sum = 0;
    for (size_t i = 0; i + 1 < n; ++i) {
      const double a = vertical[i] * kDegree, b = vertical[i + 1] * kDegree, ya = candela[j * n + i],
                   slope = (candela[j * n + i + 1] - ya) / (b - a);
      sum += ya * std::cos(a) - (ya + slope * (b - a)) * std::cos(b) + slope * (std::sin(b) - std::sin(a));
    }
    return sum;
  };
  if (horizontal.size() == 1) return 2 * kPi * half_plane(0);
  double sum = 0;
  for (size_t j = 0; j + 1 < horizontal.size(); ++j)
    sum += 0.5 * (horizontal[j + 1] - horizontal[j]) * kDegree * (half_plane(j) + half_plane(j + 1));
  return sum * 360 / (horizontal.back() - horizontal.front());
}

IesLuminaire parse_ies(std::string_view text, const std::string& file_name) {
  TextLines lines(text, file_name, true);
  IesLuminaire l;
  l.name = std::filesystem::path(file_name).stem().string();
  const std::string tilt = read_head(lines, l);
  Numbers in(lines);
  skip_tilt(tilt, lines, in);
  const double lamps = in.next("the number of lamps", 0, 1e6), lumens = in.next("the lumens of a lamp", -1, 1e9);
  l.lamp_lumens = lumens > 0 ? lamps * lumens : 0;
  double factor = in.next("the multiplier", 0, 1e9);
  const size_t verticals = static_cast<size_t>(in.whole("the number of vertical angles", 2, 10000)),
               horizontals = static_cast<size_t>(in.whole("the number of horizontal angles", 1, 10000));
  if (const long long type = in.whole("the photometric type", 1, 3); type != 1)
    throw in.error(strf("photometry of type %c", type == 2 ? 'B' : 'A'), "type C (1) is read");
  in.whole("the unit of length", 1, 2);
  for (int i = 0; i < 3; ++i) in.next("a dimension of the luminaire", -1e6, 1e6);
  factor *= in.next("the ballast factor", 0, 1e6);
  factor *= in.next("the ballast-lamp factor (1 since 1991)", 0, 1e6);
  l.watts = in.next("the watts", 0, 1e9);
  l.vertical = ascending(in, verticals, "vertical angles", 0, 180.001);
  l.horizontal = ascending(in, horizontals, "horizontal angles", 0, 360.001);
  check_ranges(l, file_name, in);
  for (size_t i = 0; i < verticals * horizontals; ++i) l.candela.push_back(factor * in.next("candela", 0, 1e12));
  note_lumens(l, file_name);
  return l;
}

IesLuminaire read_ies(const std::string& path) { return parse_ies(read_text(path, size_t{1} << 26), path); }

IntensityTable intensity_table(const IesLuminaire& l, double& lost) {
  // Light that ends at an angle at once needs a fine step to end nearly there.
  bool cliff = false;
  for (size_t j = 0; j < l.horizontal.size(); ++j)
    cliff = cliff || (!is(l.vertical.back(), 180) && l.candela[(j + 1) * l.vertical.size() - 1] > 0) ||
            (!is(l.vertical.front(), 0) && l.candela[j * l.vertical.size()] > 0);
  const double dv = cliff ? kFinest : step_of(l.vertical, 180),
               dh = l.horizontal.size() == 1 ? 360 : step_of(l.horizontal, 360);
  IntensityTable t;
  t.polars = static_cast<size_t>(std::lround(180 / dv)) + 1;
  t.azimuths = static_cast<size_t>(std::lround(360 / dh));
  IesLuminaire even;
  for (size_t r = 0; r < t.polars; ++r) even.vertical.push_back(static_cast<double>(r) * dv);
  // The file counts azimuths counter-clockwise as seen from above, a lamp's table about its axis, which points down.
  for (size_t c = 0; c < t.azimuths; ++c) even.horizontal.push_back(static_cast<double>(c) * dh);
  for (const double v : even.vertical)
    for (const double h : even.horizontal) t.value.push_back(l.at(v, 360 - h));
  if (t.azimuths > 1) even.horizontal.push_back(360);
  for (const double h : even.horizontal)
    for (const double v : even.vertical) even.candela.push_back(l.at(v, h));
  const double all = l.lumens();
  lost = all > 0 ? even.lumens() / all - 1 : 0;
  return t;
}

}  // namespace suite
