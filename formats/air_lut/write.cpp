#include <cmath>

#include "base/files.h"
#include "formats/air_lut/air_lut.h"
#include "formats/air_lut/zarr.h"
#include "formats/hdf5/netcdf.h"
#include "math/vec.h"

namespace suite {

namespace {

struct KeyText {
  const char *unit, *what;
};
// By LutKey.
constexpr KeyText kTexts[kLutKeys] = {
    {"1", "path reflectance over a black ground, pi L / (E0 mu0)"},
    {"1", "spherical albedo of the air from below"},
    {"1", "direct transmittance from the sun to the ground"},
    {"1", "diffuse transmittance from the sun to a black ground"},
    {"1", "direct transmittance from the ground to the sensor"},
    {"1", "diffuse transmittance from the ground to the sensor"},
    {"uW cm-2 sr-1 nm-1", "thermal path radiance"},
    {"uW cm-2 sr-1 nm-1", "thermal irradiance on the ground divided by pi"},
    {"1", "two-way transmittance, direct down and direct up"},
    {"1", "two-way transmittance, diffuse down and direct up"},
    {"1", "two-way transmittance, direct down and diffuse up"},
    {"1", "two-way transmittance, diffuse down and diffuse up"},
};

// Axes that the table runs over: those of one value are constants.
std::vector<size_t> running(const LutTable& table) {
  std::vector<size_t> axes;
  for (size_t a = 0; a < kLutAxes; ++a)
    if (table.axes[a].values.size() > 1) axes.push_back(a);
  return axes;
}

std::vector<double> of_bands(const LutTable& table, double Band::*member) {
  std::vector<double> values;
  for (const Band& b : table.bands) values.push_back(1e3 * (b.*member));
  return values;
}

// [band][state][view]
std::vector<double> by_band(const LutTable& table, const LutResult& result, size_t key) {
  std::vector<double> values;
  values.reserve(table.bands.size() * table.states() * table.views());
  for (size_t b = 0; b < table.bands.size(); ++b)
    for (const LutState& state : result.states)
      for (const LutValues& view : state) values.push_back(view[key][b]);
  return values;
}

template <class Writer>
void put_angles(Writer& file, const LutTable& table) {
  const std::vector<double>& suns = table.axes[static_cast<size_t>(LutAxisOf::sun_zenith)].values;
  if (suns.size() != 1) return;
  const double zenith = suns[0], cosine = std::cos(zenith * kDegree);
  file.variable("coszen", {}, {&cosine, 1}, {{"units", "1"}, {"long_name", "cosine of the sun's zenith angle"}});
  file.variable("solzen", {}, {&zenith, 1}, {{"units", "degree"}, {"long_name", "zenith angle of the sun"}});
}

// [band][state][height] of one number a band, or with the radii behind.
template <class Of>
std::vector<double> of_kernels(const LutTable& table, const LutResult& result, Of&& of) {
  std::vector<double> values;
  for (size_t b = 0; b < table.bands.size(); ++b)
    for (const std::vector<LutKernel>& heights : result.kernels)
      for (const LutKernel& kernel : heights) of(kernel, b, values);
  return values;
}

// Mean density of the light from around over each ring, 1/km2: the kernel over its integral.
void append_density(const LutKernel& kernel, const std::vector<double>& radii, size_t b, std::vector<double>& values) {
  double inner = 0, before = 0;
  for (size_t r = 0; r < radii.size(); ++r) {
    const double outer = 1e-3 * radii[r];
    values.push_back((kernel.within[r][b] - before) / (kPi * (outer * outer - inner * inner)));
    inner = outer, before = kernel.within[r][b];
  }
}

template <class Writer>
void put_kernels(Writer& file, const LutTable& table, const LutResult& result) {
  if (result.kernels.empty()) return;
  std::vector<double> km;
  for (const double r : result.kernel.radii) km.push_back(1e-3 * r);
  file.dimension("radius", km, {{"units", "km"}, {"long_name", "outer edge of a ring about the place looked at"}});
  std::vector<std::string> plain{"wl"};
  for (const size_t a : running(table))
    if (a <= static_cast<size_t>(LutAxisOf::height)) plain.emplace_back(table.axes[a].name);
  std::vector<std::string> ringed = plain;
  ringed.emplace_back("radius");
  const auto put = [&](const char* name, const std::vector<std::string>& dimensions, const char* unit, const char* what,
                       auto&& of) {
    file.variable(name, dimensions, of_kernels(table, result, of), {{"units", unit}, {"long_name", what}});
  };
  const auto rings = [](std::vector<std::vector<double>> LutKernel::*member) {
    return [member](const LutKernel& k, size_t b, std::vector<double>& to) {
      for (const std::vector<double>& r : k.*member) to.push_back(r[b]);
    };
  };
  const auto number = [](std::vector<double> LutKernel::*member) {
    return [member](const LutKernel& k, size_t b, std::vector<double>& to) { to.push_back((k.*member)[b]); };
  };
  put("kernel_within", ringed, "1", "share of the light from around that comes from nearer than the radius",
      rings(&LutKernel::within));
  put("kernel_within_error", ringed, "1", "standard error of kernel_within", rings(&LutKernel::within_error));
  put("kernel_density", ringed, "km-2", "adjacency kernel over its integral, mean of the ring that ends at the radius",
      [&](const LutKernel& k, size_t b, std::vector<double>& to) { append_density(k, result.kernel.radii, b, to); });
  put("kernel_total", plain, "1", "diffuse transmittance from the ground to a sensor straight above, by photons",
      number(&LutKernel::total));
  put("kernel_total_error", plain, "1", "standard error of kernel_total", number(&LutKernel::total_error));
  put("kernel_around", plain, "1", "share of an even ground's light that comes from around",
      number(&LutKernel::around));
}

template <class Writer>
void put_table(Writer& file, const LutTable& table, const LutResult& result, const LutNotes& notes) {
  file.dimension("wl", of_bands(table, &Band::center_um), {{"units", "nm"}, {"long_name", "centre of the band"}});
  std::vector<std::string> dimensions{"wl"};
  for (const size_t a : running(table)) {
    const LutAxis& axis = table.axes[a];
    file.dimension(std::string(axis.name), axis.values, {{"units", axis.unit}});
    dimensions.emplace_back(axis.name);
  }
  file.variable("fwhm", {"wl"}, of_bands(table, &Band::fwhm_um), {{"units", "nm"}});
  file.variable("solar_irr", {"wl"}, table.solar_irradiance,
                {{"units", "uW cm-2 nm-1"}, {"long_name", "solar irradiance at 1 AU"}});
  put_angles(file, table);
  for (size_t k = 0; k < kLutKeys; ++k)
    file.variable(std::string(kLutNames[k]), dimensions, by_band(table, result, k),
                  {{"units", kTexts[k].unit}, {"long_name", kTexts[k].what}});
  for (size_t k = 0; k < kLutKeys && !result.errors[0].empty(); ++k)
    file.variable(
        std::string(kLutNames[k]) + "_error", {"wl"}, result.errors[k],
        {{"units", kTexts[k].unit},
         {"long_name", "largest difference of one state from its solution with finer bins and more streams"}});
  put_kernels(file, table, result);
  file.attribute("RT_mode", std::string("transm"));
  file.attribute("dayofyear", 93LL);  // 1 AU: what ISOFIT takes as its reference
  file.attribute("ISOFIT status", std::string("success"));
  for (size_t a = 0; a < kLutAxes; ++a)
    if (table.axes[a].values.size() == 1)
      file.attribute("constant " + std::string(table.axes[a].name),
                     strf("%.10g %s", table.axes[a].values[0], table.axes[a].unit));
  for (const auto& [name, text] : notes) file.attribute(name, text);
  file.close();
}

}  // namespace

void write_lut_netcdf(const std::string& path, const LutTable& table, const LutResult& result, const LutNotes& notes) {
  AtomicFile to(path);
  h5::NetcdfWriter file(to.temporary(), path);
  put_table(file, table, result, notes);
  to.commit();
}

void write_lut_zarr(const std::string& path, const LutTable& table, const LutResult& result, const LutNotes& notes) {
  ZarrWriter file(path);
  put_table(file, table, result, notes);
}

void write_lut_csv(const std::string& path, const LutTable& table, const LutResult& result) {
  AtomicFile to(path);
  std::string text;
  for (const LutAxis& axis : table.axes) text += strf("%s (%s),", std::string(axis.name).c_str(), axis.unit);
  text += "wl (nm),fwhm (nm),solar_irr (uW cm-2 nm-1)";
  for (size_t k = 0; k < kLutKeys; ++k) text += strf(",%s (%s)", std::string(kLutNames[k]).c_str(), kTexts[k].unit);
  text += "\n";
  size_t combination = 0;
  for (const LutState& state : result.states)
    for (const LutValues& view : state) {
      std::string at;
      for (size_t a = kLutAxes, k = combination; a-- > 0;) {
        const std::vector<double>& values = table.axes[a].values;
        at = strf("%.10g,", values[k % values.size()]) + at;
        k /= values.size();
      }
      ++combination;
      for (size_t b = 0; b < table.bands.size(); ++b) {
        text += at + strf("%.10g,%.10g,%.7g", 1e3 * table.bands[b].center_um, 1e3 * table.bands[b].fwhm_um,
                          table.solar_irradiance[b]);
        for (size_t k = 0; k < kLutKeys; ++k) text += strf(",%.7g", view[k][b]);
        text += "\n";
      }
      to.write(text);
      text.clear();
    }
  to.commit();
}

}  // namespace suite
