#include "output.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "preview.h"

namespace suite {

namespace {

EnviHeader header_of(const CaptureResult& r, const OutputSpec& output) {
  EnviHeader h;
  h.samples = r.columns;
  h.lines = r.rows;
  h.type = output.type == OutputSpec::Type::float64 ? EnviType::float64 : EnviType::float32;
  h.interleave = static_cast<Interleave>(output.order);
  return h;
}

void describe_bands(EnviHeader& h, std::span<const Band> bands) {
  h.bands = bands.size();
  h.data_units = "W/(m2 sr um)";
  for (const Band& b : bands) {
    h.band_names.push_back(b.name);
    h.wavelength_um.push_back(b.center_um);
    h.fwhm_um.push_back(b.fwhm_um);
  }
}

// The bands of the preview: named ones, or those nearest to red, green and blue; one band when there are fewer than 3.
std::vector<size_t> preview_bands(std::span<const Band> bands, const std::vector<std::string>& names) {
  std::vector<size_t> chosen;
  if (!names.empty()) {
    std::vector<std::string> known;
    for (const Band& b : bands) known.push_back(b.name);
    for (const std::string& name : names) {
      const auto found = std::find(known.begin(), known.end(), name);
      if (found == known.end()) throw Error("the preview names a band '" + name + "' that the sensor does not have", name_hint(name, known));
      chosen.push_back(static_cast<size_t>(found - known.begin()));
    }
    return chosen;
  }
  if (bands.size() < 3) return {0};
  for (const double wanted : {0.65, 0.55, 0.45}) {
    size_t best = 0;
    for (size_t b = 0; b < bands.size(); ++b)
      if (std::fabs(bands[b].center_um - wanted) < std::fabs(bands[best].center_um - wanted)) best = b;
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace

std::vector<std::string> write_capture(const std::string& folder, const Sensor& sensor, const CaptureResult& r, const OutputSpec& output,
                                       const std::vector<std::string>& material_names) {
  const std::string base = folder + "/" + sensor.name();
  const std::span<const Band> bands = sensor.bands(sensor.tasks()[r.task].captures[r.capture].state);
  std::vector<std::string> files;

  EnviHeader radiance = header_of(r, output);
  describe_bands(radiance, bands);
  radiance.description = "spectral radiance of sensor '" + sensor.name() + "'";
  write_envi(base + ".img", radiance, r.radiance);
  files.push_back(base + ".img");

  EnviHeader error = radiance;
  error.description = "standard error of the spectral radiance of sensor '" + sensor.name() + "'";
  write_envi(base + "_error.img", error, r.standard_error);
  files.push_back(base + "_error.img");

  EnviHeader truth = header_of(r, output);
  truth.type = EnviType::float64;  // positions and indices keep every digit
  truth.bands = r.truth_names.size();
  truth.band_names = r.truth_names;
  truth.ignore_value = std::nan("");
  truth.description = "truth of sensor '" + sensor.name() + "'; materials:";
  for (size_t i = 0; i < material_names.size(); ++i) truth.description += strf(" %zu=%s", i, material_names[i].c_str());
  write_envi(base + "_truth.img", truth, r.truth);
  files.push_back(base + "_truth.img");

  std::string correlation = "# correlation of the standard errors of the bands; 1 = they err together\nband";
  for (const Band& b : bands) correlation += "," + b.name;
  for (size_t a = 0; a < r.bands; ++a) {
    correlation += "\n" + bands[a].name;
    for (size_t b = 0; b < r.bands; ++b) correlation += strf(",%.4f", r.error_correlation[a * r.bands + b]);
  }
  write_file(base + "_error_correlation.csv", correlation + "\n");
  files.push_back(base + "_error_correlation.csv");

  write_preview(base + ".png", r.radiance, r.columns, r.rows, r.bands, preview_bands(bands, output.preview));
  files.push_back(base + ".png");
  return files;
}

}  // namespace suite
