#include "formats/reptran/reptran.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/files.h"
#include "formats/reptran/netcdf3.h"

namespace suite {

namespace {

constexpr size_t kMost = 1'000'000;

size_t length_of(const NetCdf3& file, const char* name) {
  const std::vector<size_t>& shape = file.shape(name);
  if (shape.size() != 1 || shape[0] < 1 || shape[0] > kMost)
    throw file.fault(std::string("has a variable '") + name + "' of another shape than expected");
  return shape[0];
}
std::vector<double> axis(const NetCdf3& file, const char* name) { return file.numbers(name, {length_of(file, name)}); }

// A whole number that was stored as any number; Error outside low to high.
size_t whole(const NetCdf3& file, double value, const char* what, size_t low, size_t high) {
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)))
    throw file.fault(strf("has %g as %s", value, what), strf("%zu to %zu", low, high));
  return static_cast<size_t>(value);
}

void read_bands(const NetCdf3& file, RepresentativeTable& table) {
  const std::vector<double> low = axis(file, "wvlmin"), high = axis(file, "wvlmax"), count = axis(file, "nwvl_in_band");
  const size_t bands = low.size(), wavelengths = length_of(file, "wvl");
  const std::vector<size_t>& shape = file.shape("iwvl");
  if (high.size() != bands || count.size() != bands || shape.size() != 2 || shape[1] != bands)
    throw file.fault("has variables of its bands that do not fit each other");
  const std::vector<double> index = file.numbers("iwvl", shape), weight = file.numbers("iwvl_weight", shape);
  for (size_t b = bands; b-- > 0;) {
    RepresentativeTable::Band band{1e7 / high[b], 1e7 / low[b], {}};
    const size_t n = whole(file, count[b], "wavelengths of a band", 1, shape[0]);
    for (size_t q = 0; q < n; ++q)
      band.members.push_back(
          {whole(file, index[q * bands + b], "a wavelength", 1, wavelengths) - 1, weight[q * bands + b]});
    table.bands.push_back(std::move(band));
  }
}

RepresentativeGas read_gas(const NetCdf3& file, Gas gas, size_t wavelengths) {
  RepresentativeGas out;
  out.gas = gas;
  out.pressure = axis(file, "pressure");
  out.temperature = file.numbers("t_ref", {out.pressure.size()});
  out.offset = axis(file, "t_pert");
  out.share = axis(file, "vmrs");
  const std::vector<double> index = axis(file, "wvl_index");
  out.place.assign(wavelengths, -1);
  for (size_t j = 0; j < index.size(); ++j)
    out.place[whole(file, index[j], "a wavelength", 1, wavelengths) - 1] = static_cast<long>(j);
  const std::vector<double> section =
      file.numbers("xsec", {out.offset.size(), out.share.size(), index.size(), out.pressure.size()});
  for (const double x : section) out.cross_section.push_back(static_cast<float>(1e-20 * x));
  // The files go from the ground up.
  if (out.pressure.front() > out.pressure.back()) {
    std::reverse(out.pressure.begin(), out.pressure.end());
    std::reverse(out.temperature.begin(), out.temperature.end());
    const auto run = static_cast<std::ptrdiff_t>(out.pressure.size());
    for (auto at = out.cross_section.begin(); at != out.cross_section.end(); at += run) std::reverse(at, at + run);
  }
  return out;
}

}  // namespace

ReadReptran read_reptran(const std::string& path) {
  const NetCdf3 bands(path);
  ReadReptran out;
  read_bands(bands, out.table);
  const size_t wavelengths = length_of(bands, "wvl");
  const std::string stem = path.size() > 4 && path.ends_with(".cdf") ? path.substr(0, path.size() - 4) : path;
  for (std::string name : bands.strings("species_name")) {
    const std::string table = stem + ".lookup." + name + ".cdf";
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::optional<Gas> gas = gas_of(name);
    if (!gas || !file_exists(table)) {
      out.notes.push_back("without " + name + ", whose table is not there");
      continue;
    }
    out.table.gases.push_back(read_gas(NetCdf3(table), *gas, wavelengths));
  }
  if (out.table.gases.empty())
    throw bands.fault("has no table of a gas beside it", "they are called " + stem + ".lookup.H2O.cdf and so on");
  out.table.source = "REPTRAN (Gasteiger et al., 2014), " + path;
  check_representative(out.table, Where{path, 0, 0, {}, -1});
  return out;
}

}  // namespace suite
