// Damaged simulation texts, with every kind of sensor and of source: a simulation or one located Error.
#include "base/files.h"
#include "formats/sim_text/sim_text.h"
#include "support/fuzz.h"
#include "support/platform_text.h"
#include "support/temp_folder.h"

namespace suite {

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

}  // namespace suite
