// Based on: the HITRAN format of 2004, L. S. Rothman et al., J. Quant. Spectrosc. Radiat. Transfer 96, 2005, table 1.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/hitran/hitran.h"

namespace suite {

namespace {

constexpr size_t kMostBytes = size_t{2} << 30, kMostRows = 1'000'000;

std::optional<Gas> gas_of_molecule(int molecule) {
  constexpr Gas gases[] = {Gas::h2o, Gas::co2, Gas::o3,  Gas::n2o, Gas::co,  Gas::ch4,
                           Gas::o2,  Gas::no,  Gas::so2, Gas::no2, Gas::nh3, Gas::hno3};
  if (molecule >= 1 && molecule <= static_cast<int>(std::size(gases))) return gases[molecule - 1];
  if (molecule == 22) return Gas::n2;
  return std::nullopt;
}

// The number in columns `from` to `to` (from 1) of a line, within low and high.
double field(const TextLines& lines, size_t from, size_t to, const char* what, double low, double high) {
  std::string_view text = lines.line().substr(from - 1, to - from + 1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = code == std::errc() && stop == text.data() + text.size() && !text.empty();
  if (number && value >= low && value <= high) return value;
  Where where = lines.where();
  where.column = static_cast<int>(from);
  throw Error(where, std::string(what) + " '" + std::string(text) + "'", strf("a number from %g to %g", low, high));
}

int isotopologue_of(const TextLines& lines) {
  const char c = lines.line()[2];
  if (c >= '1' && c <= '9') return c - '0';
  if (c == '0') return 10;
  if (c >= 'A' && c <= 'Z') return 11 + (c - 'A');
  Where where = lines.where();
  where.column = 3;
  throw Error(where, std::string("an isotopologue '") + c + "'", "1 to 9, 0 or A to Z");
}

}  // namespace

std::vector<LineGas> parse_hitran(std::string_view text, const std::string& file) {
  TextLines lines(text, file);
  std::vector<LineGas> out;
  while (lines.next_raw()) {
    if (lines.line().find_first_not_of(" \r") == std::string_view::npos) continue;
    if (lines.line().size() < 67)
      throw lines.error(0, strf("a line of %zu characters", lines.line().size()), "HITRAN's have 160, 67 are needed");
    const std::optional<Gas> gas = gas_of_molecule(static_cast<int>(field(lines, 1, 2, "molecule", 1, 99)));
    if (!gas) continue;
    SpectralLine line;
    line.isotopologue = isotopologue_of(lines);
    line.wavenumber_cm = field(lines, 4, 15, "wavenumber", 1e-6, 1e6);
    line.intensity = field(lines, 16, 25, "intensity", 0, 1);
    line.air_width_cm = field(lines, 36, 40, "width in air", 0, 10);
    line.self_width_cm = field(lines, 41, 45, "width of its own", 0, 10);
    line.lower_energy_cm = field(lines, 46, 55, "energy", -10, 1e6);
    line.exponent = field(lines, 56, 59, "exponent", -10, 10);
    line.shift_cm = field(lines, 60, 67, "shift", -10, 10);
    auto mine = std::find_if(out.begin(), out.end(), [&](const LineGas& g) { return g.gas == *gas; });
    if (mine == out.end()) mine = out.insert(out.end(), LineGas{*gas, {}, {}});
    mine->lines.push_back(line);
  }
  if (out.empty()) throw Error(Where{file, 0, 0, {}, -1}, "holds no line of a gas that is known here");
  for (LineGas& gas : out)
    std::stable_sort(gas.lines.begin(), gas.lines.end(),
                     [](const SpectralLine& a, const SpectralLine& b) { return a.wavenumber_cm < b.wavenumber_cm; });
  return out;
}

std::vector<LineGas> read_hitran(const std::string& path) { return parse_hitran(read_text(path, kMostBytes), path); }

std::function<double(double)> parse_partition_sum(std::string_view text, const std::string& file) {
  TextLines lines(text, file, true);
  std::vector<double> kelvin, sum;
  while (lines.next()) {
    if (kelvin.size() == kMostRows) throw lines.error(0, strf("more than %zu rows", kMostRows));
    kelvin.push_back(lines.number_in(0, "temperature", 0.01, 1e5));
    sum.push_back(lines.number_in(1, "partition sum", 1e-6, 1e20));
    if (kelvin.size() > 1 && !(kelvin.back() > kelvin[kelvin.size() - 2]))
      throw lines.error(0, strf("%g K follow %g K", kelvin.back(), kelvin[kelvin.size() - 2]), "temperatures ascend");
  }
  const Where where{file, 0, 0, {}, -1};
  if (kelvin.empty() || kelvin.front() > 296 || kelvin.back() < 296)
    throw Error(where, "its temperatures do not reach 296 K", "partition sums are relative to that");
  const auto at = [kelvin = std::move(kelvin), sum = std::move(sum), where](double t) {
    if (!(t >= kelvin.front() && t <= kelvin.back()))
      throw Error(where, strf("%g K are asked for", t),
                  strf("it reaches from %g to %g K", kelvin.front(), kelvin.back()));
    const auto i = static_cast<size_t>(std::upper_bound(kelvin.begin(), kelvin.end(), t) - kelvin.begin());
    if (i == kelvin.size()) return sum.back();
    return sum[i - 1] + (t - kelvin[i - 1]) / (kelvin[i] - kelvin[i - 1]) * (sum[i] - sum[i - 1]);
  };
  return [at, reference = at(296)](double t) { return at(t) / reference; };
}

std::function<double(double)> read_partition_sum(const std::string& path) {
  return parse_partition_sum(read_text(path, size_t{64} << 20), path);
}

WaterContinuum parse_water_continuum(std::string_view text, const std::string& file) {
  constexpr std::string_view names[] = {"wavenumber_cm", "self", "foreign", "self_exponent"};
  TextLines lines(text, file, true);
  if (!lines.next()) throw lines.error_at_end("holds no continuum", "wavenumber_cm,self,foreign,self_exponent");
  for (size_t i = 0; i < 4; ++i)
    if (lines.words() != 4 || lines.word(i) != names[i])
      throw lines.error(0, "other columns than a continuum's", "wavenumber_cm,self,foreign,self_exponent");
  WaterContinuum out;
  while (lines.next()) {
    const double v = lines.number_in(0, "wavenumber", -1000, 1e6);
    if (out.self.size() == kMostRows) throw lines.error(0, strf("more than %zu rows", kMostRows));
    if (out.self.empty()) out.first_cm = v;
    if (out.self.size() == 1) out.step_cm = v - out.first_cm;
    const double expected = out.first_cm + out.step_cm * static_cast<double>(out.self.size());
    if (out.self.size() >= 1 && !(out.step_cm > 0 && std::abs(v - expected) < 1e-3 * out.step_cm))
      throw lines.error(0, strf("wavenumber %g", v), "evenly spaced and ascending");
    out.self.push_back(lines.number_in(1, "self coefficient", 0, 1e-15));
    out.foreign.push_back(lines.number_in(2, "foreign coefficient", 0, 1e-15));
    out.exponent.push_back(lines.number_in(3, "exponent", -100, 100));
  }
  if (out.self.size() < 2) throw lines.error_at_end("a continuum of fewer than two wavenumbers");
  return out;
}

WaterContinuum read_water_continuum(const std::string& path) {
  return parse_water_continuum(read_text(path, size_t{256} << 20), path);
}

}  // namespace suite
