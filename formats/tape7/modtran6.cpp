#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/params.h"
#include "formats/tape7/modtran6.h"
#include "formats/tape7/units.h"
#include "math/vec.h"

namespace suite {

namespace {

// As tape7 has them.
std::string tape7_name(const std::string& name) {
  if (name == "SOL_AT_OBS") return "SOL@OBS";
  if (name == "TOA_RAD") return "TOA_SUN";
  if (name == "BBODY_TK") return "BBODY_T[K]";
  return name;
}

std::vector<double> numbers(const Params& list) {
  for (const Params& item : list.items())
    if (item.kind() != Params::Kind::scalar)
      throw item.error("a list within a list of values", "cases of one line of sight each");
  return list.as_numbers();
}

// The wavenumbers among the columns, or those the case was asked for.
std::vector<double> wavenumbers(const Params& spectra, const std::optional<Params>& input, size_t rows) {
  for (const char* name : {"FREQ", "FREQUENCY", "WAVENUMBER"})
    if (const auto list = spectra.find(name)) return numbers(*list);
  if (const auto asked = input ? input->find("SPECTRAL") : std::nullopt)
    if (asked->has("V1") && asked->has("V2") && asked->has("DV")) {
      const double v1 = asked->number("V1"), step = asked->number_in("DV", 1e-6, 1e6, "1/cm");
      if (std::fabs((asked->number("V2") - v1) / step + 1 - static_cast<double>(rows)) < 0.5) {
        std::vector<double> list(rows);
        for (size_t i = 0; i < rows; ++i) list[i] = v1 + step * static_cast<double>(i);
        return list;
      }
    }
  throw spectra.error("no wavenumbers beside the spectra", "a list FREQ, or SPECTRAL of the input with V1, V2 and DV");
}

std::optional<double> number_of(const Params& map, const char* key, double low, double high) {
  const auto value = map.find(key);
  return value ? std::optional(value->as_number_in(low, high, "as documented")) : std::nullopt;
}

std::optional<Tape7Geometry> geometry_of(const Params& input, Tape7Mode mode) {
  const auto g = input.find("GEOMETRY");
  if (!g || !g->has("H1ALT") || !g->has("OBSZEN")) return std::nullopt;
  Tape7Geometry geometry;
  geometry.observer_height = g->number("H1ALT") * 1e3;
  geometry.end_height = g->number("H2ALT", 0) * 1e3;
  geometry.zenith = g->number_in("OBSZEN", 0, 180, "degrees") * kDegree;
  // Names of types, which some versions write, say nothing that is needed.
  if (const auto type = g->find("ITYPE"); type && type->as_text().find_first_not_of("123") == std::string::npos)
    geometry.path_type = static_cast<int>(type->as_integer(1, 3));
  if (mode == Tape7Mode::irradiance) return geometry;
  if (const auto range = number_of(*g, "HRANGE", 0, 1e9); range && *range > 0) geometry.range = *range * 1e3;
  if (const auto kind = number_of(*g, "IPARM", 0, 12); kind == 2.0 || kind == 12.0) {
    if (const auto azimuth = number_of(*g, "PARM1", -360, 360)) geometry.relative_azimuth = *azimuth * kDegree;
    if (const auto zenith = number_of(*g, "PARM2", 0, 180)) geometry.solar_zenith = *zenith * kDegree;
  }
  return geometry;
}

Tape7Block block_of(const Params& one) {
  const auto output = one.find("MODTRANOUTPUT");
  if (!output)
    throw one.error("a case without its output", "a case with MODTRANOUTPUT: JSONOPT with WRT_OUTPUT in FILEOPTIONS");
  const Params all = output->at("SPECTRA");
  Tape7Block b;
  std::optional<Params> spectra;
  for (const auto& [key, mode] :
       {std::pair("TRANSMITTANCE", Tape7Mode::transmittance), std::pair("RADIANCE", Tape7Mode::radiance),
        std::pair("IRRADIANCE", Tape7Mode::irradiance)})
    if (!spectra && (spectra = all.find(key))) b.mode = mode;
  if (!spectra) throw all.error("no spectra in the output of a case", "TRANSMITTANCE, RADIANCE or IRRADIANCE");
  b.header = spectra->where();
  b.header_lines = 0;
  for (const std::string& key : spectra->keys()) {
    const Params list = spectra->at(key);
    if (list.kind() != Params::Kind::list || key == "FREQ" || key == "FREQUENCY" || key == "WAVENUMBER") continue;
    const std::string name = tape7_name(key);
    b.columns.push_back({name, tape7_scale(name).unit, numbers(list)});
    if (b.columns.back().values.size() != b.columns[0].values.size())
      throw list.error(
          "the list " + key +
          strf(" has %zu values, the first %zu", b.columns.back().values.size(), b.columns[0].values.size()));
  }
  if (b.columns.empty() || b.columns[0].values.empty()) throw spectra->error("spectra without a value");
  const auto input = one.find("MODTRANINPUT");
  b.wavenumber = wavenumbers(*spectra, input, b.columns[0].values.size());
  if (b.wavenumber.size() != b.columns[0].values.size())
    throw spectra->error(strf("%zu wavenumbers for %zu values", b.wavenumber.size(), b.columns[0].values.size()));
  for (size_t i = 0; i < b.wavenumber.size(); ++i)
    if (!(b.wavenumber[i] > (i ? b.wavenumber[i - 1] : 0)))
      throw spectra->error(strf("wavenumbers do not ascend at %g", b.wavenumber[i]));
  for (Tape7Column& c : b.columns)
    if (tape7_scale(c.name).by_square)
      for (size_t i = 0; i < c.values.size(); ++i) c.values[i] *= b.wavenumber[i] * b.wavenumber[i];
  const Tape7Column* scattered = b.find("MULT_SCAT");
  if (b.mode == Tape7Mode::radiance &&
      (!scattered || std::all_of(scattered->values.begin(), scattered->values.end(), [](double v) { return v == 0; })))
    b.mode = Tape7Mode::thermal_radiance;
  if (input) {
    b.geometry = geometry_of(*input, b.mode);
    if (const auto options = input->find("RTOPTIONS"))
      b.many_scatterings = options->text("IMULT", "RT_NO_MULTIPLE_SCATTER") != "RT_NO_MULTIPLE_SCATTER";
  }
  return b;
}

}  // namespace

std::vector<Tape7Block> parse_modtran6(std::string_view json, const std::string& file_name) {
  const Params cases = Params::parse_text(json, file_name).at("MODTRAN");
  std::vector<Tape7Block> blocks;
  for (const Params& one : cases.items()) blocks.push_back(block_of(one));
  if (blocks.empty()) throw cases.error("there is no case in it");
  return blocks;
}

std::vector<Tape7Block> read_modtran6(const std::string& path) { return parse_modtran6(read_text(path), path); }

}  // namespace suite
