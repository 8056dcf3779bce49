#include <cmath>

#include "formats/four_curve/four_curve.h"
#include "formats/hdf5/foreign.h"
#include "math/vec.h"

namespace suite {

namespace {

// A list of one row, ascending.
std::vector<double> samples(const h5::Foreign& file, const char* name, double low, double high) {
  const h5::Foreign::Table t = file.table(name);
  if (t.values.empty() || (t.rows != 1 && t.columns != 1))
    file.fail(strf("dataset '%s' has %zu x %zu values, one row is wanted", name, t.rows, t.columns));
  for (size_t i = 0; i < t.values.size(); ++i) {
    if (!(t.values[i] >= low && t.values[i] <= high))
      file.fail(strf("dataset '%s' holds %g, %g to %g is allowed", name, t.values[i], low, high));
    if (i > 0 && !(t.values[i] > t.values[i - 1]))
      file.fail(strf("dataset '%s' does not ascend: %g, then %g", name, t.values[i - 1], t.values[i]));
  }
  return t.values;
}

FourCurve condition(const h5::Foreign& file, const std::string& name, const std::vector<double>& wavelength_um,
                    const std::vector<double>& angles_deg) {
  const std::string dataset = "/Conditions/" + name;
  const h5::Foreign::Table t = file.table(dataset);
  if (t.columns != wavelength_um.size() || t.rows != 4 * angles_deg.size())
    file.fail("dataset '" + dataset +
              strf("' has %zu x %zu values, %zu x %zu are wanted: four rows for each angle", t.rows, t.columns,
                   4 * angles_deg.size(), wavelength_um.size()));
  for (const double v : t.values)
    if (!(v >= 0 && v < 1e30)) file.fail("dataset '" + dataset + strf("' holds %g, which is no spectrum", v));
  FourCurve c{name, wavelength_um, {}, {}};
  constexpr double per_cm2 = 1e4;  // cm2 in a m2
  for (size_t i = 0; i < angles_deg.size(); ++i) {
    c.solar_zenith.push_back(angles_deg[i] * kDegree);
    const auto row = [&](size_t k, double factor) {
      std::vector<double> values;
      for (size_t j = 0; j < t.columns; ++j) values.push_back(t.values[(4 * i + k) * t.columns + j] * factor);
      return values;
    };
    c.at.push_back({row(0, per_cm2), row(1, per_cm2), row(2, 1), row(3, per_cm2)});
  }
  return c;
}

}  // namespace

std::vector<FourCurve> read_four_curve(const std::string& path) {
  const h5::Foreign file(path);
  const std::vector<double> wavelength_um = samples(file, "/SpectralSamples", 1e-3, 1e4),
                            angles_deg = samples(file, "/SolarDeclinationSamples", 0, 180);
  std::vector<FourCurve> all;
  for (const std::string& name : file.children("/Conditions"))
    all.push_back(condition(file, name, wavelength_um, angles_deg));
  if (all.empty()) file.fail("group '/Conditions' is empty");
  return all;
}

PathTable four_curve_paths(const FourCurve& condition, double longest) {
  if (!(longest > 0)) throw Error(strf("a path of %g m", longest));
  std::vector<PathRun> runs;
  for (size_t i = 0; i < condition.at.size(); ++i) {
    const FourCurve::Spectra& s = condition.at[i];
    PathRun run;
    run.at = {condition.solar_zenith[i], longest};
    run.where.file = "condition '" + condition.name + "'";
    for (size_t k = 0; k < s.sun.size(); ++k) {
      const double depth = s.extinction[k] * longest;
      run.spectra.transmittance.push_back(std::exp(-depth));
      run.spectra.radiance.push_back(s.path_radiance[k] * longest * (depth > 0 ? -std::expm1(-depth) / depth : 1));
    }
    run.spectra.irradiance = s.sun;
    runs.push_back(std::move(run));
  }
  return PathTable({{"solar zenith angle", "rad", 1 / kDegree, "degrees", false}, {"range", "m", 1, "", true}},
                   condition.wavelength_um, std::move(runs));
}

}  // namespace suite
