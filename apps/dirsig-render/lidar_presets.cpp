#include "lidar_presets.h"

#include <array>

#include "base/error.h"
#include "base/registry.h"

namespace suite {

namespace {

// In the texts "typical" marks numbers that no source gives: they are to be replaced where they matter.
struct Preset {
  const char *name, *summary, *text;
};

constexpr std::array kPresets{
    Preset{"gedi_like", "space, full waveform, 25 m footprints",
           R"(# Source: gedi.umd.edu/instrument/specifications (1064 nm, 242 Hz, 10 mJ, 14 ns, 25 m footprints);
# eoportal.org/satellite-missions/iss-gedi (telescope of 80 cm, on the ISS). Divergence: 25 m from 410 km.
- kind: lidar
  name: gedi_like
  motion: {kind: straight, position_m: [0, 0, 410000], heading_deg: 52, speed_m_s: 7200, follow_earth: false}  # typical; better: kind: orbit
  tasks: [{start: 0, pulses: 10}]
  laser: {wavelength_um: 1.064, pulse_energy_j: 0.010, rate_hz: 242, pulse: {kind: gaussian, fwhm_ns: 14},
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.061}}
  receiver: {aperture_mm: 800, field_of_view_mrad: 0.1, throughput: 0.6, filter_nm: 1}  # field of view, throughput, filter: typical
  gate: {start_m: 409800, stop_m: 410100, bin_ns: 0.5}
  detectors:  # typical; samples of 1 ns as in product L1B
    - {kind: waveform, name: waveform, quantum_efficiency: 0.5, receiver_fwhm_ns: 5, amplifier_noise_e: 20, sample_ns: 1, bits: 12,
       gain_e_per_dn: 2, offset_dn: 200, returns: {by: gaussian, threshold_dn: 30}}
  pulses_in_air: unfold
)"},
    Preset{
        "icesat2_like", "space, photon counting, strong beam",
        R"(# Source: icesat-2.gsfc.nasa.gov/space-lasers (532 nm, 10 kHz, telescope of 2.6 feet, 0.7 m along the track);
# eo-atlas.org/products/sensor/icesat-2-atlas (strong beam 175 uJ, weak 45 uJ, footprint 11 m, six beams). Divergence: 11 m from 496 km.
- kind: lidar
  name: icesat2_like
  motion: {kind: straight, position_m: [0, 0, 496000], heading_deg: 0, speed_m_s: 7000, follow_earth: false}  # typical; better: kind: orbit
  tasks: [{start: 0, pulses: 100}]
  laser: {wavelength_um: 0.532, pulse_energy_j: 1.75e-4, rate_hz: 10000, pulse: {kind: gaussian, fwhm_ns: 1.5},  # pulse: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.0222}}
  receiver: {aperture_mm: 800, field_of_view_mrad: 0.083, throughput: 0.5, filter_nm: 0.04}  # but for the aperture: typical
  gate: {start_m: 495900, stop_m: 496050, bin_ns: 0.2}
  detectors:  # typical
    - {kind: photon_counting, name: strong, detection_efficiency: 0.15, pixels_per_spot: 16, dead_time_ns: 3, resolution_ns: 0.2}
  pulses_in_air: unfold
)"},
    Preset{
        "calipso_like", "space, backscatter profiles of clouds and aerosol",
        R"(# Source: calipso.cnes.fr/en/CALIPSO/lidar.htm (532 and 1064 nm, 20 Hz, telescope of 1 m, field of view 130 urad, 30 m vertically);
# de.wikiversity.org, CALIOP (110 mJ a wavelength). 1064 nm: a second sensor. Without polarisation.
- kind: lidar
  name: calipso_like
  motion: {kind: straight, position_m: [0, 0, 705000], heading_deg: 0, speed_m_s: 7000, follow_earth: false}  # typical; better: kind: orbit
  tasks: [{start: 0, pulses: 20}]
  laser: {wavelength_um: 0.532, pulse_energy_j: 0.110, rate_hz: 20.16, pulse: {kind: rectangular, length_ns: 20},  # length: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.1}}  # typical
  receiver: {aperture_mm: 1000, field_of_view_mrad: 0.13, throughput: 0.6, filter_nm: 0.04}  # throughput, filter: typical
  gate: {start_m: 675000, stop_m: 705500, bin_ns: 100}
  detectors:  # typical
    - {kind: waveform, name: profile, quantum_efficiency: 0.2, receiver_fwhm_ns: 100, amplifier_noise_e: 1, sample_ns: 200, bits: 14,
       gain_e_per_dn: 0.1, offset_dn: 500, returns: {by: none}}
)"},
    Preset{
        "vq_840_gl", "RIEGL VQ-840-GL: airborne, bathymetry, 532 nm",
        R"(# Source: data sheet of the RIEGL VQ-840-GL (532 nm, 50 to 200 kHz, divergence 1 to 6 mrad, field of view 3 to 18 mrad, nearly elliptic
# +-20 degrees across and +-14 along, 10 to 100 lines/s, from 75 m).
- kind: lidar
  name: vq_840_gl
  motion: {kind: straight, position_m: [0, 0, 75], heading_deg: 0, speed_m_s: 10}
  tasks: [{start: 0, stop: 0.1}]
  laser: {wavelength_um: 0.532, pulse_energy_j: 2.0e-5, rate_hz: 50000, pulse: {kind: gaussian, fwhm_ns: 1.5},  # energy, pulse: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 1}}
  receiver: {aperture_mm: 80, field_of_view_mrad: 6, throughput: 0.7, filter_nm: 1}  # but for the field of view: typical
  scanner: {kind: palmer, mirror_tilt_deg: 10, rotation_hz: 69, incidence_deg: 45}  # an oval; tilt and incidence: typical
  gate: {start_m: 40, stop_m: 110, bin_ns: 0.1}
  detectors: [{kind: waveform, name: full, quantum_efficiency: 0.5, receiver_fwhm_ns: 1, amplifier_noise_e: 20, sample_ns: 0.5, bits: 16,
               gain_e_per_dn: 1, offset_dn: 100, returns: {by: gaussian, threshold_dn: 80}}]  # typical
)"},
    Preset{
        "als50_ii", "Leica ALS50-II: airborne, oscillating mirror",
        R"(# Source: nerc-arf-dan.pml.ac.uk, Sensors/LeicaLIDAR (1064 nm, 0.22 mrad, full swath 75 degrees, pulses of 4 or 9 ns, up to 8 W);
# HELIOS++, data/scanners_als.xml (up to 150 kHz, mirror up to 90 Hz, 4 returns).
- kind: lidar
  name: als50_ii
  motion: {kind: straight, position_m: [0, 0, 900], heading_deg: 0, speed_m_s: 60}
  tasks: [{start: 0, stop: 0.1}]
  laser: {wavelength_um: 1.064, average_power_w: 8, rate_hz: 60000, pulse: {kind: gaussian, fwhm_ns: 4}, beam: {kind: gaussian, full_angle_1_e2_mrad: 0.22}}
  receiver: {aperture_mm: 100, field_of_view_mrad: 1, throughput: 0.8, filter_nm: 3}  # typical
  scanner: {kind: triangle, half_angle_deg: 20, rate_hz: 40}
  gate: {start_m: 800, stop_m: 1050, bin_ns: 0.25}
  detectors: [{kind: linear, name: points, quantum_efficiency: 0.8, receiver_fwhm_ns: 2, amplifier_noise_e_per_ns: 20,
               returns: {by: gaussian, threshold_e_per_ns: 200, most: 4}}]  # typical
)"},
    Preset{
        "lms_q560", "RIEGL LMS-Q560: airborne, polygon, full waveform",
        R"(# Source: data sheet of the RIEGL LMS-Q560 (parallel unidirectional lines, up to 240 kHz, full waveform); HELIOS++, data/scanners_als.xml
# (0.5 mrad, 4 ns, mirror +-45 degrees of which +-22.5 are lit, 10 to 160 lines/s).
- kind: lidar
  name: lms_q560
  motion: {kind: straight, position_m: [0, 0, 400], heading_deg: 0, speed_m_s: 40}
  tasks: [{start: 0, stop: 0.1}]
  laser: {wavelength_um: 1.55, pulse_energy_j: 8.0e-6, rate_hz: 100000, pulse: {kind: gaussian, fwhm_ns: 4},  # wavelength, energy: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.5}}
  receiver: {aperture_mm: 50, field_of_view_mrad: 1.5, throughput: 0.8, filter_nm: 10}  # typical
  scanner: {kind: sweep, half_angle_deg: 45, from_deg: -22.5, to_deg: 22.5, rate_hz: 80}
  gate: {start_m: 350, stop_m: 480, bin_ns: 0.25}
  detectors: [{kind: waveform, name: full, quantum_efficiency: 0.7, receiver_fwhm_ns: 2, amplifier_noise_e: 30, sample_ns: 1, bits: 8,
               gain_e_per_dn: 400, offset_dn: 10, returns: {by: gaussian, threshold_dn: 6}}]  # typical
)"},
    Preset{
        "vux_1uav", "RIEGL VUX-1UAV: drone, rotating mirror, 330 degrees",
        R"(# Source: HELIOS++, data/scanners_als.xml (0.5 mrad, 4 ns, 50 to 550 kHz, +-165 degrees lit, 10 to 200 lines/s, from 3 m).
- kind: lidar
  name: vux_1uav
  motion: {kind: straight, position_m: [0, 0, 60], heading_deg: 0, speed_m_s: 6}
  tasks: [{start: 0, stop: 0.1}]
  laser: {wavelength_um: 1.55, pulse_energy_j: 1.0e-6, rate_hz: 100000, pulse: {kind: gaussian, fwhm_ns: 4},  # wavelength, energy: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.5}}
  receiver: {aperture_mm: 40, field_of_view_mrad: 1.5, throughput: 0.8, filter_nm: 10}  # typical
  scanner: {kind: sweep, half_angle_deg: 180, from_deg: -165, to_deg: 165, rate_hz: 50}
  gate: {start_m: 3, stop_m: 300, bin_ns: 0.25}
  detectors: [{kind: linear, name: points, quantum_efficiency: 0.7, receiver_fwhm_ns: 2, amplifier_noise_e_per_ns: 10,
               returns: {by: gaussian, threshold_e_per_ns: 100, most: 15}}]  # typical
)"},
    Preset{
        "livox_mid_70", "Livox Mid-70: rosettes by two prisms",
        R"(# Source: HELIOS++, data/scanners_als.xml (905 nm, 100 kHz, prisms of 29.7 degrees and index 1.5095 at -77.73 and 121.57 Hz, 4 ns,
# 0.89 mrad of the narrow axis, from 2 m, 2 returns).
- kind: lidar
  name: livox_mid_70
  position_m: [0, 0, 2]
  look_at_m: [10, 0, 1]
  tasks: [{start: 0, stop: 0.1}]
  laser: {wavelength_um: 0.905, pulse_energy_j: 5.0e-7, rate_hz: 100000, pulse: {kind: gaussian, fwhm_ns: 4},  # energy: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 0.89}}
  receiver: {aperture_mm: 20, field_of_view_mrad: 5, throughput: 0.7, filter_nm: 10}  # typical
  scanner: {kind: risley, prisms: [{wedge_deg: 29.7, index: 1.5095, rotation_hz: 77.733, phase_deg: 180},
                                   {wedge_deg: 29.7, index: 1.5095, rotation_hz: -121.567, phase_deg: 180, tilted: first}]}
  gate: {start_m: 2, stop_m: 260, bin_ns: 0.25}
  detectors: [{kind: linear, name: points, quantum_efficiency: 0.6, receiver_fwhm_ns: 2, amplifier_noise_e_per_ns: 10,
               returns: {by: gaussian, threshold_e_per_ns: 100, most: 2}}]  # typical
)"},
    Preset{
        "vlp_16", "Velodyne VLP-16: sixteen lasers, turned about z",
        R"(# Source: VLP-16 user manual 63-9243 (lasers fire 2.304 us apart, all of them every 55.296 us, -15 to 15 degrees in steps of 2).
- kind: lidar
  name: vlp_16
  motion: {kind: static, position_m: [0, 0, 2]}
  tasks: [{start: 0, stop: 0.02}]
  laser: {wavelength_um: 0.903, pulse_energy_j: 3.0e-7, rate_hz: 18084.5, pulse: {kind: gaussian, fwhm_ns: 6},  # wavelength, energy, pulse: typical
          beam: {kind: gaussian, full_angle_1_e2_mrad: 3}}  # typical
  receiver: {aperture_mm: 20, field_of_view_mrad: 5, throughput: 0.7, filter_nm: 10}  # typical
  scanner: {kind: rotating_head, rotation_hz: 10, elevations_deg: [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15],
            firing_us: [0, 2.304, 4.608, 6.912, 9.216, 11.52, 13.824, 16.128, 18.432, 20.736, 23.04, 25.344, 27.648, 29.952, 32.256, 34.56]}
  gate: {start_m: 1, stop_m: 100, bin_ns: 0.25}
  detectors: [{kind: linear, name: points, quantum_efficiency: 0.6, receiver_fwhm_ns: 3, amplifier_noise_e_per_ns: 10,
               returns: {by: threshold, threshold_e_per_ns: 100}}]  # typical
)"}};

}  // namespace

std::string list_lidar_presets() {
  std::string list;
  for (const Preset& p : kPresets) list += strf("%-14s %s\n", p.name, p.summary);
  return list;
}

std::string lidar_preset(const std::string& name) {
  std::vector<std::string> names;
  for (const Preset& p : kPresets) {
    if (p.name == name) return p.text;
    names.emplace_back(p.name);
  }
  throw Error("there is no preset '" + name + "'", name_hint(name, names));
}

}  // namespace suite
