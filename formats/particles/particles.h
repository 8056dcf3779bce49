// Optical properties of aerosols and clouds that people bring. See FORMAT.md.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "air/particle_data.h"

namespace suite {

struct ReadParticles {
  ParticleData data;               // its name is that of the file
  std::vector<std::string> notes;  // what was put right, a sentence each
};

// Error, located: unknown or missing columns, wavelengths, angles or orders out of order, values out of range, a phase
// function (or a relative extinction at 0.55 um) that is off by more than 1 %, a series that is negative.
ReadParticles read_particles(const std::string& path);
ReadParticles parse_particles(std::string_view text, const std::string& file_name);

}  // namespace suite
