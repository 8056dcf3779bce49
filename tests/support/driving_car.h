// A car that drives over a plain by day, cameras that look down on it, and folders of results that must be the same.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"

namespace suite {

inline constexpr const char* kDrivingCar = R"(scene: 1
times_s: [0, 10]
materials: {grey: {model: lambert, reflectance: 0.4}, red: {model: lambert, reflectance: 0.8}}
objects:
  ground: {plane: {width: 60, depth: 60}, material: grey}
  car: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 3}, material: red}
world:
  - {place: ground}
  - place: car
    motion: {kind: keyframes, keys: [{time_s: 0, position_m: [-9, 0, 0]}, {time_s: 10, position_m: [9, 0, 0]}]}
)";

// A simulation of it, up to where its cameras begin.
inline constexpr const char* kDay =
    "scene: scene.h5\nmax_nodes: 3\nsun: {direction: {zenith_deg: 40, azimuth_deg: 100}, irradiance: 3}\n"
    "sky: {radiance: 0.3}\nsensors:\n";

inline std::string camera(const std::string& name, int columns, int rows, double time_s, const std::string& paths) {
  return strf("  - {kind: frame_camera, name: %s, columns: %d, rows: %d, time_s: %g, paths: %s,\n", name.c_str(),
              columns, rows, time_s, paths.c_str()) +
         "     pitch_um: 10, focal_length_mm: 2, position_m: [0, 0, 100], look_at_m: [0, 0, 0], up: [0, 1, 0],\n"
         "     bands: [{name: b, center_um: 0.55, fwhm_um: 0.01}, {name: c, center_um: 0.65, fwhm_um: 0.01}]}\n";
}

// The text of a file without what differs between two commands that do the same: the command itself, the clock, and how
// many have worked at it.
inline std::vector<std::string> same_in_all_runs(const std::string& path) {
  static const std::regex differs(
      "^suite .*dirsig-render|command|paths_kept|seconds|peak_bytes|share_in_|\"threads\"|\"ranks\"");
  std::vector<std::string> lines;
  std::istringstream text(read_text(path));
  for (std::string line; std::getline(text, line);)
    if (!std::regex_search(line, differs)) lines.push_back(line);
  return lines;
}

// Each file of `one` stands in `other`, the same; `images` of them at least are images.
inline void expect_same_folders(const std::string& one, const std::string& other, size_t images) {
  size_t found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(one)) {
    const std::string name = entry.path().filename().string(), there = other + "/" + name;
    ASSERT_TRUE(file_exists(there)) << there;
    if (name.ends_with(".png")) continue;  // holds the command; its pixels are those of the image
    if (name.ends_with(".hdr") || name.ends_with(".json"))
      EXPECT_EQ(same_in_all_runs(entry.path()), same_in_all_runs(there)) << name;
    else
      EXPECT_EQ(read_bytes(entry.path()), read_bytes(there)) << name;
    found += name.ends_with(".img");
  }
  EXPECT_GE(found, images);
}

}  // namespace suite
