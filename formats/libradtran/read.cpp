#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/libradtran/libradtran.h"
#include "formats/libradtran/request.h"
#include "math/vec.h"

namespace suite {

namespace {

enum class Kind { wavelength, wavenumber, irradiance, intensity, radiance, other };
Kind kind_of(const std::string& name) {
  if (name == "lambda" || name == "wavelength") return Kind::wavelength;
  if (name == "wavenumber") return Kind::wavenumber;
  for (const char* e : {"edir", "eglo", "edn", "eup", "enet", "esum", "fdir", "fglo", "fdn", "fup", "f"})
    if (name == e) return Kind::irradiance;
  for (const char* u : {"uavgdir", "uavgglo", "uavgdn", "uavgup", "uavg"})
    if (name == u) return Kind::intensity;
  return name == "uu" || name == "u0u" ? Kind::radiance : Kind::other;
}

class Reader {
 public:
  Reader(const LibradtranRequest& request, std::string_view output, const std::string& name, LibradtranPower power)
      : request_(request), lines_(output, name), power_(power) {
    run_.where.file = name;
  }

  LibradtranRun read() {
    run_.thermal = request_.thermal;
    if (request_.solar_zenith && !request_.thermal) run_.solar_zenith = *request_.solar_zenith * kDegree;
    for (const double u : request_.umu) run_.view_zenith.push_back(std::acos(-u));
    for (const double phi : request_.phi) {
      double relative = phi - request_.phi0;
      while (relative < 0) relative += 360;
      while (relative > 360) relative -= 360;
      run_.relative_azimuth.push_back(relative * kDegree);
    }
    name_columns();
    while (lines_.next()) row();
    if (rows_.empty()) throw lines_.error_at_end("there is no spectrum in it");
    arrange();
    return std::move(run_);
  }

 private:
  void add(const std::string& name, int view = -1, int azimuth = -1) {
    run_.columns.push_back({name, unit_of(name), view, azimuth, {}});
  }
  void name_columns() {
    const int views = static_cast<int>(request_.umu.size()), azimuths = static_cast<int>(request_.phi.size());
    for (const std::string& name : request_.columns) {
      const Kind kind = kind_of(name);
      if ((kind == Kind::wavelength || kind == Kind::wavenumber) && wave_ < 0)
        wave_ = static_cast<int>(run_.columns.size()), wave_is_number_ = kind == Kind::wavenumber;
      if (name != "uu") {
        add(name);
        continue;
      }
      for (int v = 0; v < views; ++v)
        for (int a = 0; a < azimuths; ++a) add(name, v, a);
    }
    if (wave_ < 0)
      throw lines_.error_at_end("the input asks for no wavelength", "'lambda' or 'wavenumber' in output_user");
    in_row_ = run_.columns.size();
    if (!request_.radiance_lines) return;
    for (int v = 0; v < views; ++v) {
      add("u0u", v);
      for (int a = 0; a < azimuths; ++a) add("uu", v, a);
    }
  }
  std::string unit_of(const std::string& name) const {
    const Kind kind = kind_of(name);
    if (kind == Kind::other || kind == Kind::wavelength || kind == Kind::wavenumber) return {};
    switch (request_.quantity) {
      case LibradtranRequest::Quantity::brightness:
        return "K";
      case LibradtranRequest::Quantity::transmittance:
      case LibradtranRequest::Quantity::reflectivity:
        return "1";
      case LibradtranRequest::Quantity::absolute:
        break;
    }
    return kind == Kind::radiance ? "W/(m2 sr um)" : "W/(m2 um)";
  }

  void expect(size_t count) const {
    if (lines_.words() != count)
      throw lines_.error(std::min(count, lines_.words()),
                         strf("%zu numbers, the input asks for %zu", lines_.words(), count),
                         "the output and the input of one run");
  }
  void row() {
    expect(in_row_);
    std::vector<double> values;
    for (size_t i = 0; i < in_row_; ++i) values.push_back(lines_.number(i, "a value of the spectrum"));
    const double wave = values[static_cast<size_t>(wave_)];
    if (!(wave > 0)) throw lines_.error(static_cast<size_t>(wave_), "a wavelength is positive");
    places_.push_back(lines_.where(static_cast<size_t>(wave_)));
    if (request_.radiance_lines) radiances(values);
    rows_.push_back(std::move(values));
  }
  void radiances(std::vector<double>& values) {
    const auto line = [&] {
      if (!lines_.next()) throw lines_.error_at_end("the output is cut within a wavelength");
    };
    const auto angle = [&](size_t i, double expected, const char* what) {
      const double got = lines_.number(i, what);
      if (std::fabs(got - expected) > 2e-3)
        throw lines_.error(i, strf("%s is %g, that of the input %g", what, got, expected));
    };
    const size_t azimuths = request_.phi.size();
    if (azimuths > 0) {
      line();
      expect(azimuths);
      for (size_t a = 0; a < azimuths; ++a) angle(a, request_.phi[a], "phi");
    }
    for (const double u : request_.umu) {
      line();
      expect(2 + azimuths);
      angle(0, u, "umu");
      for (size_t i = 1; i < 2 + azimuths; ++i) values.push_back(lines_.number(i, "a radiance"));
    }
  }

  // Rows of one wavelength follow each other, one a level.
  void arrange() {
    const auto wave = [&](size_t row) { return rows_[row][static_cast<size_t>(wave_)]; };
    while (run_.levels < rows_.size() && wave(run_.levels) == wave(0)) ++run_.levels;
    if (request_.levels && *request_.levels != run_.levels)
      throw Error(places_[0],
                  strf("%zu rows of a wavelength for %zu altitudes of the input", run_.levels, *request_.levels));
    if (rows_.size() % run_.levels != 0) throw lines_.error_at_end("the output is cut within a wavelength");
    const size_t n = rows_.size() / run_.levels;
    for (size_t i = 0; i < n; ++i) {
      for (size_t l = 1; l < run_.levels; ++l)
        if (wave(i * run_.levels + l) != wave(i * run_.levels))
          throw Error(places_[i * run_.levels + l], "a row of another wavelength among the altitudes of one");
      const double w = wave(i * run_.levels);
      run_.wavelength_um.push_back(wave_is_number_ ? 1e4 / w : w * 1e-3);
    }
    const bool falls = n > 1 && run_.wavelength_um[1] < run_.wavelength_um[0];
    for (size_t i = 1; i < n; ++i)
      if (!(falls ? run_.wavelength_um[i] < run_.wavelength_um[i - 1]
                  : run_.wavelength_um[i] > run_.wavelength_um[i - 1]))
        throw Error(places_[i * run_.levels], "wavelengths are not in order");
    if (falls) std::reverse(run_.wavelength_um.begin(), run_.wavelength_um.end());
    for (size_t c = 0; c < run_.columns.size(); ++c)
      for (size_t l = 0; l < run_.levels; ++l)
        for (size_t i = 0; i < n; ++i) {
          const size_t from = falls ? n - 1 - i : i;
          run_.columns[c].values.push_back(rows_[from * run_.levels + l][c] *
                                           factor(run_.columns[c].unit, run_.wavelength_um[i]));
        }
  }
  // To W/(m2 um): from a nanometre or from a wavenumber, of which a micron has 1e4 / wavelength_um^2.
  double factor(const std::string& unit, double wavelength_um) const {
    if (!unit.starts_with("W")) return 1;
    const double watt = !request_.thermal && power_ == LibradtranPower::milliwatt ? 1e-3 : 1;
    return watt * (request_.per == LibradtranRequest::Per::nanometre ? 1e3 : 1e4 / (wavelength_um * wavelength_um));
  }

  const LibradtranRequest& request_;
  TextLines lines_;
  LibradtranPower power_;
  LibradtranRun run_;
  int wave_ = -1;
  bool wave_is_number_ = false;
  size_t in_row_ = 0;
  std::vector<std::vector<double>> rows_;
  std::vector<Where> places_;
};

}  // namespace

const LibradtranColumn& LibradtranRun::column(std::string_view name) const {
  std::vector<std::string> known;
  for (const LibradtranColumn& c : columns) {
    if (c.view >= 0) continue;
    if (c.name == name) return c;
    known.push_back(c.name);
  }
  throw Error(where, "the run has no column '" + std::string(name) + "'", name_hint(name, known));
}

LibradtranRun parse_libradtran(std::string_view input, const std::string& input_name, std::string_view output,
                               const std::string& output_name, LibradtranPower power) {
  return Reader(parse_libradtran_request(input, input_name), output, output_name, power).read();
}

LibradtranRun read_libradtran(const std::string& input_path, const std::string& output_path, LibradtranPower power) {
  return parse_libradtran(read_text(input_path), input_path, read_text(output_path), output_path, power);
}

PathTable libradtran_sky(const LibradtranRun& run, size_t level, bool up) {
  if (level >= run.levels) throw Error(run.where, strf("the run has %zu altitudes", run.levels));
  const size_t n = run.wavelength_um.size();
  const auto at_level = [&](const LibradtranColumn& c) {
    const auto begin = c.values.begin() + static_cast<std::ptrdiff_t>(level * n);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(n));
  };
  std::vector<double> sun;
  for (const LibradtranColumn& c : run.columns)
    if (c.name == "edir" && c.unit == "W/(m2 um)" && run.solar_zenith && *run.solar_zenith < 89.9 * kDegree) {
      sun = at_level(c);
      for (double& v : sun) v /= std::cos(*run.solar_zenith);
    }
  std::vector<PathRun> nodes;
  for (const LibradtranColumn& c : run.columns) {
    if (c.name != "uu" || (run.view_zenith[static_cast<size_t>(c.view)] < kPi / 2) != up) continue;
    if (c.unit != "W/(m2 sr um)")
      throw Error(run.where, "the run's radiances are in '" + c.unit + "'", "no output_quantity");
    const double zenith = run.view_zenith[static_cast<size_t>(c.view)];
    const double azimuth = run.relative_azimuth[static_cast<size_t>(c.azimuth)];
    PathRun node;
    node.at = {zenith, azimuth};
    node.spectra.radiance = at_level(c);
    node.spectra.irradiance = sun;
    node.where = run.where;
    nodes.push_back(std::move(node));
  }
  if (nodes.empty())
    throw Error(run.where, up ? "the run has no radiances that look up" : "the run has no radiances that look down",
                "uu in output_user, umu and phi");
  return PathTable({{"view zenith angle", "rad", 1 / kDegree, "degrees", false},
                    {"relative azimuth", "rad", 1 / kDegree, "degrees", false}},
                   run.wavelength_um, std::move(nodes));
}

}  // namespace suite
