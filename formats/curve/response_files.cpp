// Spectral responses in netCDF-4 (which is HDF5) as agencies publish them: one variable of wavelengths, one of
// responses with a dimension of bands, or a variable of responses a band. Based on: "NetCDF Climate and Forecast (CF)
// Metadata Conventions", 1.11 (units, missing and packed values).
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "base/files.h"
#include "formats/curve/internal.h"
#include "formats/hdf5/foreign.h"

namespace suite {

namespace {

// What the netCDF library writes beside a dimension that has no values of its own.
constexpr const char* kNoVariable = "This is a netCDF dimension but not a netCDF variable";
constexpr size_t kMostVariables = 4096, kMostBandsOfFile = 4096;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has_any(const std::string& text, std::initializer_list<const char*> words) {
  return std::ranges::any_of(words, [&](const char* w) { return text.find(w) != text.npos; });
}

struct Unit {
  double to_um = 0;
  bool wavenumber = false;  // 1/cm: the wavelength is 1e4 um over it
};

// As UDUNITS writes it; nothing when it is no length.
std::optional<Unit> unit_of_length(const std::string& text) {
  const std::string u = lower(text);
  for (const char* name : {"nm", "nanometer", "nanometers", "nanometre", "nanometres"})
    if (u == name) return Unit{1e-3};
  for (const char* name : {"um", "micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres",
                           "1e-6 m", "\u00b5m", "\u03bcm"})
    if (u == name) return Unit{1};
  for (const char* name : {"m", "meter", "meters", "metre", "metres"})
    if (u == name) return Unit{1e6};
  for (const char* name : {"cm-1", "cm^-1", "1/cm", "cm**-1"})
    if (u == name) return Unit{1e4, true};
  return std::nullopt;
}

class ResponseFile {
 public:
  explicit ResponseFile(const std::string& path) : path_(path), file_(path) { look("", 0); }
  std::vector<NamedCurve> read() const;

 private:
  using Table = h5::Foreign::Table;
  // The datasets of numbers and texts, down to two groups.
  void look(const std::string& group, int depth);
  std::string wavelength_variable() const;
  std::vector<std::string> response_variables(const std::string& wavelength, const Table& waves) const;
  Unit unit(const std::string& variable) const;
  Table numbers(const std::string& variable) const;  // NaN where one is missing
  std::vector<std::string> band_names(size_t bands) const;
  NamedCurve band(const std::string& name, const Table& waves, size_t row, std::span<const double> response,
                  const Unit& unit) const;
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const {
    throw Error(Where{path_, 0, 0, {}, -1}, what, hint);
  }
  static std::string last_name(const std::string& variable) { return lower(variable.substr(variable.rfind('/') + 1)); }

  std::string path_;
  h5::Foreign file_;
  std::vector<std::string> variables_, texts_;
};

void ResponseFile::look(const std::string& group, int depth) {
  for (const std::string& child : file_.children(group.empty() ? "/" : group)) {
    const std::string name = group + "/" + child;
    const h5::Foreign::Kind kind = file_.kind(name);
    if (kind.dimensions < 0 && depth < 2) {
      look(name, depth + 1);
    } else if (kind.numbers && kind.dimensions <= 2 && !file_.text(name, "NAME").starts_with(kNoVariable)) {
      variables_.push_back(name);
    } else if (kind.texts) {
      texts_.push_back(name);
    }
    if (variables_.size() > kMostVariables) fail("holds more than 4096 variables", "a file of responses alone");
  }
}

std::string ResponseFile::wavelength_variable() const {
  std::vector<std::string> found;
  for (const std::string& v : variables_) {
    const std::string name = last_name(v);
    if (has_any(name, {"wavelength", "wavenumber", "lambda"}) &&
        !has_any(name, {"central", "center", "centre", "number"}))
      found.push_back(v);
  }
  for (const std::string& v : variables_)
    if (last_name(v).find("wavenumber") != std::string::npos && found.empty()) found.push_back(v);
  if (found.empty()) fail("has no variable of wavelengths", "a variable 'wavelength' with 'units' (nm, um, m or cm-1)");
  if (found.size() > 1)
    fail("has several variables of wavelengths: '" + printable(found[0]) + "', '" + printable(found[1]) + "'",
         "keep one: ncks -x -v VARIABLE IN.nc OUT.nc");
  return found[0];
}

std::vector<std::string> ResponseFile::response_variables(const std::string& wavelength, const Table& waves) const {
  std::vector<std::string> named, fitting;
  for (const std::string& v : variables_) {
    if (v == wavelength) continue;
    const h5::Foreign::Kind shape = file_.kind(v);
    const bool along = shape.rows * shape.columns == waves.values.size() || shape.columns == waves.values.size() ||
                       (waves.rows == 1 && shape.rows == waves.values.size());
    if (!along) continue;
    fitting.push_back(v);
    const std::string name = last_name(v);
    const bool uncertainty = has_any(name, {"uncert", "std", "stdev", "error", "flag", "count", "min", "max"});
    if (has_any(name, {"response", "rsr", "srf", "isrf", "transmi"}) && !uncertainty) named.push_back(v);
  }
  const std::vector<std::string>& taken = named.empty() ? fitting : named;
  if (taken.empty())
    fail("has no variable of responses along '" + printable(wavelength) + "'",
         "a variable 'response' with the dimensions (band, wavelength)");
  const auto tables = std::ranges::count_if(taken, [&](const std::string& v) { return file_.kind(v).dimensions == 2; });
  if (tables > 1 || (tables == 1 && taken.size() > 1))
    fail("has several variables of responses: '" + printable(taken[0]) + "', '" + printable(taken[1]) + "'",
         "keep one: ncks -x -v VARIABLE IN.nc OUT.nc");
  return taken;
}

Unit ResponseFile::unit(const std::string& variable) const {
  const std::string text = file_.text(variable, "units");
  const std::optional<Unit> unit = unit_of_length(text);
  if (!unit)
    fail("variable '" + printable(variable) + "' has " +
             (text.empty() ? "no units" : "the units '" + printable(text) + "'"),
         "wavelengths are in nm, um or m, wavenumbers in cm-1: ncatted -a units," +
             variable.substr(variable.rfind('/') + 1) + ",o,c,nm FILE.nc");
  return *unit;
}

ResponseFile::Table ResponseFile::numbers(const std::string& variable) const {
  Table t = file_.table(variable);
  const double scale = file_.number(variable, "scale_factor").value_or(1),
               offset = file_.number(variable, "add_offset").value_or(0);
  const std::optional<double> fill = file_.number(variable, "_FillValue"),
                              missing = file_.number(variable, "missing_value");
  for (double& v : t.values) v = (fill && v == *fill) || (missing && v == *missing) ? NAN : v * scale + offset;
  return t;
}

std::vector<std::string> ResponseFile::band_names(size_t bands) const {
  for (const std::string& v : texts_) {
    if (!has_any(last_name(v), {"band", "channel", "name"})) continue;
    std::vector<std::string> names = file_.names(v);
    if (names.size() == bands && std::ranges::none_of(names, [](auto& n) { return n.empty(); })) {
      for (std::string& name : names) name = printable(name);
      return names;
    }
  }
  std::vector<std::string> names;
  for (size_t k = 0; k < bands; ++k) names.push_back(strf("B%zu", k + 1));
  return names;
}

// Rows without a wavelength or a response fill up a table whose bands have different lengths.
NamedCurve ResponseFile::band(const std::string& name, const Table& waves, size_t row, std::span<const double> response,
                              const Unit& unit) const {
  std::vector<std::array<double, 2>> points;
  const double* wave = &waves.values[waves.rows > 1 ? row * waves.columns : 0];
  for (size_t k = 0; k < response.size(); ++k) {
    if (!std::isfinite(wave[k]) || !(wave[k] > 0) || !std::isfinite(response[k])) continue;
    const double um = unit.wavenumber ? unit.to_um / wave[k] : wave[k] * unit.to_um;
    if (!(um >= 0.01 && um <= 10000))
      fail("band '" + name + strf("': wavelength %g um is not between 0.01 and 10000 um", um), "are the units right?");
    points.push_back({um, response[k]});
  }
  if (points.size() > 1 && points.front()[0] > points.back()[0]) std::ranges::reverse(points);
  std::vector<double> x, y;
  for (const auto& [um, value] : points) {
    if (!x.empty() && !(um > x.back()))
      fail("band '" + name + strf("': wavelength %g um follows %g um", um, x.back()), "sort its wavelengths");
    x.push_back(um), y.push_back(value);
  }
  return {name, response_of(std::move(x), std::move(y), name, path_)};
}

std::vector<NamedCurve> ResponseFile::read() const {
  const std::string wavelength = wavelength_variable();
  const Unit unit_of_waves = unit(wavelength);
  const Table waves = numbers(wavelength);
  if (waves.values.empty()) fail("variable '" + printable(wavelength) + "' is empty", "give it values");
  const std::vector<std::string> variables = response_variables(wavelength, waves);
  std::vector<NamedCurve> bands;
  if (file_.kind(variables[0]).dimensions == 1) {
    if (waves.rows > 1)
      fail("the wavelengths have two dimensions, the responses one",
           "responses with the dimensions (band, wavelength)");
    for (const std::string& v : variables) {
      const Table t = numbers(v);
      bands.push_back(band(printable(v.substr(v.rfind('/') + 1)), waves, 0, t.values, unit_of_waves));
    }
    return bands;
  }
  const Table t = numbers(variables[0]);
  const size_t length = waves.rows > 1 ? waves.columns : waves.values.size();
  // A band a row, or a band a column where only the rows are as many as the wavelengths.
  const bool by_row = t.columns == length, by_column = waves.rows == 1 && t.rows == length;
  const size_t count = by_row ? t.rows : t.columns;
  if ((!by_row && !by_column) || (waves.rows > 1 && waves.rows != t.rows) || count > kMostBandsOfFile)
    fail(strf("responses of %zu x %zu for wavelengths of %zu x %zu", t.rows, t.columns, waves.rows, waves.columns),
         "responses with the dimensions (band, wavelength), at most 4096 bands");
  if (by_row && by_column)
    fail(strf("as many bands as wavelengths, %zu: which dimension is that of the bands is unknown", length),
         "write a table: 'wavelength_nm,B1,B2,...'");
  const std::vector<std::string> names = band_names(count);
  for (size_t b = 0; b < count; ++b) {
    std::vector<double> response;
    for (size_t k = 0; k < length; ++k) response.push_back(t.values[by_row ? b * length + k : k * t.columns + b]);
    bands.push_back(band(names[b], waves, b, response, unit_of_waves));
  }
  return bands;
}

std::array<char, 8> head_of(const std::string& path) {
  std::array<char, 8> head{};
  if (input_size(path) >= head.size()) RandomAccessFile(path).read_at(0, std::as_writable_bytes(std::span(head)));
  return head;
}

bool is_classic(const std::array<char, 8>& head) { return std::memcmp(head.data(), "CDF", 3) == 0 && head[3] < ' '; }

}  // namespace

bool is_response_file(const std::string& path) {
  const std::array<char, 8> head = head_of(path);
  return std::memcmp(head.data(), "\x89HDF\r\n\x1a\n", 8) == 0 || is_classic(head);
}

std::vector<NamedCurve> read_response_file(const std::string& path) {
  if (is_classic(head_of(path)))
    throw Error(Where{path, 0, 0, {}, -1}, "is a classic netCDF file (version 3), responses are read from netCDF-4",
                "convert it: nccopy -k nc4 IN.nc OUT.nc");
  return ResponseFile(path).read();
}

}  // namespace suite
