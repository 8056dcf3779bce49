#include "instrument_presets.h"

#include <array>

#include "base/error.h"

namespace suite {

namespace {

// In the texts "typical" marks numbers that no source gives: they are to be replaced where they matter.
struct Preset {
  const char *name, *summary, *text;
};

constexpr std::array kPresets{
    Preset{
        "emit", "space station, 285 bands from 0.38 to 2.5 um, 60 m",
        R"(# Source: EGU23-4510 (R. Green: 285 bands, 380 to 2500 nm, 60 m, F/1.8), earth.jpl.nasa.gov/emit/instrument (1240 samples).
# Noise: |a sqrt(b + L)| of emit_noise.txt (github.com/isofit/isofit-data, commit 9bc569de61c7, Apache-2.0) is shot noise
# of 1/a^2 electrons a radiance and read noise sqrt(b)/a; the quantum efficiency is that of optics, grating and detector together.
# Pitch, integration time and widths of bands: typical. Within 1.357-1.402 and 1.826-1.930 um, where water vapour leaves
# no light, the file has no such model: the efficiency runs on between their neighbours.
- kind: platform
  name: emit
  motion: {kind: straight, position_m: [0, 0, 410000], heading_deg: 52, speed_m_s: 7200, follow_earth: false}  # typical; better: kind: orbit
  tasks: [{start: 0, stop: 0.1}]
  truth: []
  instruments:
    - name: spectrometer
      focal_length_mm: 205  # 30 um at 410 km see 60 m
      f_number: 1.8
      arrays:
        - {name: image, columns: 1240, pitch_um: 30, integration_time_s: 0.0083, readout: {kind: line, line_rate_hz: 120}, paths: 16,
           bands: {from_um: 0.3810056, to_um: 2.4929239, count: 285, fwhm_um: 0.0085},
           detector: {kind: ccd, read_noise_e: 298, gain_e_per_dn: 20, quantum_efficiency: {outside: hold, wavelength_um: [
                    0.381, 0.4106, 0.4329, 0.4775, 0.5295, 0.604, 0.6264, 0.6487, 0.6562, 0.6636, 0.6711, 0.6786, 0.6935, 0.7158,
                    0.7531, 0.9546, 0.9844, 1.044, 1.081, 1.126, 1.134, 1.141, 1.193, 1.231, 1.283, 1.29, 1.298, 1.305, 1.313,
                    1.32, 1.328, 1.342, 1.35, 1.409, 1.417, 1.432, 1.439, 1.447, 1.573, 1.677, 1.774, 1.819, 2.012, 2.19, 2.389,
                    2.449, 2.493], value: [
                    0.101, 0.091, 0.0993, 0.101, 0.112, 0.105, 0.0932, 0.09, 0.0847, 0.0676, 0.0822, 0.101, 0.102, 0.114, 0.117,
                    0.078, 0.074, 0.0689, 0.0694, 0.0748, 0.129, 0.077, 0.0886, 0.102, 0.0929, 0.0615, 0.0375, 0.11, 0.138,
                    0.115, 0.115, 0.125, 0.196, 0.378, 0.229, 0.208, 0.21, 0.152, 0.181, 0.197, 0.206, 0.201, 0.208, 0.2, 0.18,
                    0.167, 0.145]}}}
)"},
    Preset{"aviris_ng", "airborne, 427 bands from 0.38 to 2.51 um",
           R"(# Source: AVIRIS-NG Distribution Document (popo.jpl.nasa.gov: 380 to 2510 nm at 5 nm).
# Noise: |a sqrt(b + L)| of avirisng_noise.txt (github.com/isofit/isofit-data, commit 9bc569de61c7, Apache-2.0) is shot noise
# of 1/a^2 electrons a radiance and read noise sqrt(b)/a; the quantum efficiency is that of optics, grating and detector together.
# Optics, pitch, samples, integration time and widths of bands: typical. As the file is not of one read noise within 1.36-1.41, 1.82-1.945 and
# beyond 2.475 um, the efficiency runs on there.
- kind: platform
  name: aviris_ng
  motion: {kind: straight, position_m: [0, 0, 2000], heading_deg: 0, speed_m_s: 100}  # typical
  tasks: [{start: 0, stop: 0.1}]
  truth: []
  instruments:
    - name: spectrometer
      focal_length_mm: 27.5  # typical
      f_number: 1.8          # typical
      arrays:
        - {name: image, columns: 598, pitch_um: 27, integration_time_s: 0.01, readout: {kind: line, line_rate_hz: 50}, paths: 16,
           bands: {from_um: 0.380, to_um: 2.510, count: 427, fwhm_um: 0.0056},
           detector: {kind: ccd, read_noise_e: 112, gain_e_per_dn: 20, quantum_efficiency: {outside: hold, wavelength_um: [
                    0.38, 0.385, 0.4, 0.41, 0.425, 0.445, 0.46, 0.48, 0.495, 0.51, 0.515, 0.525, 0.54, 0.555, 0.57, 0.585, 0.6,
                    0.615, 0.635, 0.655, 0.68, 0.7, 0.72, 0.725, 0.73, 0.735, 0.745, 0.755, 0.77, 0.78, 0.795, 0.8, 0.805, 0.81,
                    0.9, 1.02, 1.11, 1.115, 1.24, 1.35, 1.375, 1.425, 1.435, 1.45, 1.455, 1.46, 1.475, 1.49, 1.525, 1.555, 1.615,
                    1.645, 1.71, 1.785, 1.835, 1.95, 1.975, 2.045, 2.105, 2.155, 2.2, 2.245, 2.32, 2.37, 2.465], value: [
                    0.0065, 0.00695, 0.00968, 0.0129, 0.0202, 0.0268, 0.0299, 0.029, 0.0241, 0.0231, 0.024, 0.0285, 0.0331,
                    0.0404, 0.0383, 0.0386, 0.0356, 0.0352, 0.0321, 0.0321, 0.0297, 0.031, 0.0304, 0.0313, 0.0309, 0.0291,
                    0.0317, 0.0312, 0.0323, 0.0304, 0.0333, 0.0327, 0.0305, 0.0304, 0.0355, 0.0375, 0.0429, 0.0403, 0.0568,
                    0.0739, 0.0796, 0.0857, 0.0829, 0.0721, 0.072, 0.0748, 0.0895, 0.0969, 0.1, 0.0988, 0.11, 0.111, 0.119,
                    0.121, 0.129, 0.119, 0.113, 0.122, 0.115, 0.117, 0.11, 0.115, 0.114, 0.107, 0.106]}}}
)"},
    Preset{
        "msi", "Sentinel-2, 13 bands from 0.44 to 2.2 um, 10 to 60 m",
        R"(# Source: gdal.org/drivers/raster/sentinel2 (bands, widths, sizes on the ground); aouei.github.io/gee_acolite (signal to noise ratios at the
# reference radiances 129.11, 128, 128, 108, 74.6, 68.23, 66.70, 103, 52.39, 8.77, 6, 4, 1.70 W/(m2 sr um) of the Sentinel-2 radiometric
# uncertainty tool). The noise is all shot noise: the quantum efficiency makes it so, and is that of the whole chain.
# Aperture, focal length, orbit, rectangular bands, part of the swath: typical.
- kind: platform
  name: msi
  motion: {kind: straight, position_m: [0, 0, 786000], heading_deg: 193, speed_m_s: 6700, follow_earth: false}  # better: kind: orbit
  tasks: [{start: 0, stop: 0.1}]
  truth: []
  instruments:
    - name: imager
      focal_length_mm: 600
      f_number: 4
      arrays:
        - {name: B1, columns: 100, pitch_um: 45.8, integration_time_s: 0.008776, readout: {kind: line, line_rate_hz: 111.7}, paths: 16,
           bands: [{name: B1, center_um: 0.443, fwhm_um: 0.02, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.003248, gain_e_per_dn: 1}}
        - {name: B2, columns: 600, pitch_um: 7.63, integration_time_s: 0.001463, readout: {kind: line, line_rate_hz: 670}, paths: 16,
           bands: [{name: B2, center_um: 0.49, fwhm_um: 0.065, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.2807, gain_e_per_dn: 1.19}}
        - {name: B3, columns: 600, pitch_um: 7.63, integration_time_s: 0.001463, readout: {kind: line, line_rate_hz: 670}, paths: 16,
           bands: [{name: B3, center_um: 0.56, fwhm_um: 0.035, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.5429, gain_e_per_dn: 1.41}}
        - {name: B4, columns: 600, pitch_um: 7.63, integration_time_s: 0.001463, readout: {kind: line, line_rate_hz: 670}, paths: 16,
           bands: [{name: B4, center_um: 0.665, fwhm_um: 0.03, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.4516, gain_e_per_dn: 1.01}}
        - {name: B5, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B5, center_um: 0.705, fwhm_um: 0.015, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.1046, gain_e_per_dn: 1}}
        - {name: B6, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B6, center_um: 0.74, fwhm_um: 0.015, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.06303, gain_e_per_dn: 1}}
        - {name: B7, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B7, center_um: 0.783, fwhm_um: 0.02, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.06361, gain_e_per_dn: 1}}
        - {name: B8, columns: 600, pitch_um: 7.63, integration_time_s: 0.001463, readout: {kind: line, line_rate_hz: 670}, paths: 16,
           bands: [{name: B8, center_um: 0.842, fwhm_um: 0.115, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.1465, gain_e_per_dn: 1.51}}
        - {name: B8A, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B8A, center_um: 0.865, fwhm_um: 0.02, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.03447, gain_e_per_dn: 1}}
        - {name: B9, columns: 100, pitch_um: 45.8, integration_time_s: 0.008776, readout: {kind: line, line_rate_hz: 111.7}, paths: 16,
           bands: [{name: B9, center_um: 0.945, fwhm_um: 0.02, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.0175, gain_e_per_dn: 1}}
        - {name: B10, columns: 100, pitch_um: 45.8, integration_time_s: 0.008776, readout: {kind: line, line_rate_hz: 111.7}, paths: 16,
           bands: [{name: B10, center_um: 1.375, fwhm_um: 0.03, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.002255, gain_e_per_dn: 1}}
        - {name: B11, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B11, center_um: 1.61, fwhm_um: 0.09, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.104, gain_e_per_dn: 1}}
        - {name: B12, columns: 300, pitch_um: 15.27, integration_time_s: 0.002925, readout: {kind: line, line_rate_hz: 335}, paths: 16,
           bands: [{name: B12, center_um: 2.19, fwhm_um: 0.18, shape: rectangular}], detector: {kind: ccd, quantum_efficiency: 0.08992, gain_e_per_dn: 1}}
)"}};

}  // namespace

std::string list_instrument_presets() {
  std::string list;
  for (const Preset& p : kPresets) list += strf("%-14s %s\n", p.name, p.summary);
  return list;
}

std::optional<std::string> find_instrument_preset(const std::string& name) {
  for (const Preset& p : kPresets)
    if (p.name == name) return p.text;
  return std::nullopt;
}

}  // namespace suite
