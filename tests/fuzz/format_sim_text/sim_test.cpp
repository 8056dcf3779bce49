// Damaged simulation texts, with every kind of sensor and of source: a simulation or one located Error.
#include "base/files.h"
#include "formats/sim_text/sim_text.h"
#include "support/fuzz.h"
#include "support/platform_text.h"
#include "support/temp_folder.h"

namespace suite::format_sim_text_sim_test {

namespace {

const std::string kSources =
    "scene: scene.h5\nseed: 3\nepoch: 2026-06-21T10:30:00Z\n"
    "sun: {direction: {zenith_deg: 30, azimuth_deg: 135}, irradiance: {wavelength_um: [0.4, 2], value: [1, 2], "
    "outside: hold}}\n"
    "sky: {radiance: 1, table: [[1, 2], [3, 4]]}\n"
    "lamps: [{kind: spot, position_m: [0, 0, 1], intensity: 1, outer_deg: 10, axis: [0, 0, -1]}]\n"
    "atmosphere: {heights_m: [0, 1000, 5000], aerosol: {optical_depth_550: 0.1}, gases: [{name: o3, "
    "column_optical_depth: 0.1, "
    "scale_height_m: 8000}]}\n"
    "output: {type: uint16, scale: 0.1, files: task, preview: [pan]}\nsensors:\n";
const std::string kBands = "bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1}]";
const std::string kSensors =
    "  - {kind: frame_camera, name: a, columns: 4, rows: 3, pitch_um: 5, focal_length_mm: 9, position_m: [0, 0, 60], "
    "look_at_m: [0, 0, 0], paths: {min: 4, max: 8, relative_error: 0.1}, " +
    kBands +
    "}\n  - {kind: fisheye, name: b, size: 5, position_m: [0, 0, 2], units: brightness_temperature, geolocation: "
    "true, " +
    kBands +
    "}\n  - {kind: orthographic, name: c, columns: 3, rows: 3, gsd_m: 1, center_m: [0, 0], truth: [range], units: "
    "remote_sensing_reflectance, irradiance_at_m: [0, 0, 1], channels: [water_leaving], geolocation: {pixel_m: 2}, " +
    kBands +
    "}\n  - {kind: point, name: d, collectors: [{quantity: radiance, position_m: [0, 0, 1], look: [0, 1, -1]}], " +
    kBands +
    "}\n  - {kind: goniometer, name: e, patch: {origin_m: [0, 0], size_m: [2, 2]}, height_m: 3, view_zenith_deg: [0, "
    "30], " +
    kBands + "}\n";

// The platform's text as an item of the list.
std::string platform() {
  std::string text = "  - ";
  for (const char c : test::kGoodPlatform) text += c == '\n' ? "\n    " : std::string(1, c);
  return text + "\n";
}

const std::vector<std::string> kWords{"nan",
                                      "1e999",
                                      "1e300",
                                      "-1e30",
                                      "0",
                                      "-1",
                                      "[",
                                      "]",
                                      "{",
                                      "}",
                                      ": ",
                                      ", ",
                                      "- ",
                                      "\n",
                                      "../evil",
                                      "a/b",
                                      "\"\"",
                                      "'.'",
                                      "name: ",
                                      "\x1b[",
                                      "\xff",
                                      "99999",
                                      "[0, 1e300, -1]"};

void read(const TempFolder& folder, std::span<const std::byte> bytes) {
  test::put_file(folder / "sim.yaml", bytes);
  SimulationCallbacks callbacks;
  callbacks.deliver = [](const Delivery&) {};
  callbacks.origin = [](const std::string&, const std::vector<SimulationScene>&) { return GeodeticOrigin{}; };
  const Simulation sim = read_simulation(folder / "sim.yaml", callbacks);
  for (const auto& sensor : sim.sensors) {
    if (sensor->name().find('/') != std::string::npos) throw std::runtime_error("a name leads out of the folder");
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        if (c.problems() == 0 || !(c.window.begin <= c.window.end)) throw std::runtime_error("an empty capture");
  }
}

}  // namespace

TEST(FuzzSim, SourcesAndSimpleSensors) {
  const TempFolder folder;
  test::fuzz(
      test::bytes_of(kSources + kSensors), [&](std::span<const std::byte> b) { read(folder, b); }, 1, test::kMutations,
      kWords);
}

TEST(FuzzSim, Platform) {
  const TempFolder folder;
  test::fuzz(
      test::bytes_of("scene: scene.h5\nsensors:\n" + platform()),
      [&](std::span<const std::byte> b) { read(folder, b); }, 2, test::kMutations, kWords);
}

// The night sky, arrays with detectors that count photons, Stokes vectors behind an analyser, a laser radar.
TEST(FuzzSim, NightSkyAndDetectors) {
  const std::string array =
      "integration_time_s: 0.0005, paths: {min: 16, detector_noise: 0.3}, columns: 4, rows: 4, pitch_um: 80, bands: "
      "[{name: "
      "pan, center_um: 0.7, fwhm_um: 0.4, shape: rectangular}], ";
  const std::string text =
      "scene: scene.h5\nepoch: 2026-01-16T04:00:00Z\nnight_sky: {scale: {airglow: 1.3, zodiacal: 0.5}, stars: {}}\n"
      "moon: {direction: {time_utc: 2026-01-16T04:00:00Z}}\natmosphere: {profile: us_standard, scattering: traced}\n"
      "sensors:\n  - kind: platform\n    name: yard\n    motion: {kind: static, position_m: [0, 0, 100]}\n    tasks: "
      "[{start: 0}]\n"
      "    instruments:\n      - focal_length_mm: 20\n        f_number: 1.4\n        arrays:\n"
      "          - {name: emccd, " +
      array +
      "detector: {kind: emccd, quantum_efficiency: 0.9, em_gain: 300, read_noise_e: 50, clock_induced_e: 0.005, "
      "gain_e_per_dn: 20}}\n          - {name: spad, " +
      array +
      "detector: {kind: spad, quantum_efficiency: 0.4, fill_factor: 0.6, frames: 15, dark_rate_hz: 100, crosstalk: "
      "0.01}}\n          - {name: tube, " +
      array +
      "detector: {kind: intensifier, quantum_efficiency: 0.4, gain_e: 300, gain_e_per_dn: 4, halo: {share: 0.03, "
      "radius_um: 500}, phosphor: {blur_um: 60}, background_lx: 2.0e-7}}\n"
      "  - {kind: frame_camera, name: p, columns: 4, rows: 3, pitch_um: 5, focal_length_mm: 9, position_m: [0, 0, 60], "
      "look_at_m: [0, 0, 0], stokes: linear, analyser: {polarizer_deg: 30, extinction: 1000}, " +
      kBands +
      "}\n  - {kind: lidar, name: als, position_m: [0, 0, 100], look_at_m: [10, 0, 0], laser: {wavelength_um: 1.064, "
      "pulse_energy_j: 1.5e-4, rate_hz: 1000, beam: {kind: gaussian, waist_mm: 2, m2: 2}}, receiver: {aperture_mm: "
      "150, "
      "array: {columns: 4, rows: 2, pitch_um: 50, focal_length_mm: 400}}, gate: {start_m: 9, stop_m: 110, bin_ns: "
      "0.5}, tasks: [{start: 0, pulses: 5}]}\n";
  const TempFolder folder;
  ASSERT_NO_THROW(read(folder, test::bytes_of(text)));  // what is damaged is whole at first
  test::fuzz(
      test::bytes_of(text), [&](std::span<const std::byte> b) { read(folder, b); }, 3, test::kMutations, kWords);
}

}  // namespace suite::format_sim_text_sim_test
