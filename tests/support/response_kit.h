// Small responses of laser pulses for tests: flat ground under a level flight, with a second return above it.
#pragma once
#include <cmath>

#include "detection/response.h"
#include "spectral/planck.h"

namespace suite::test {

inline ResponseHead response_head(uint32_t columns = 1, uint32_t rows = 1) {
  ResponseHead h;
  h.bin = 1e-10, h.bins = 2000;
  h.channels = {"single", "multiple", "tag:grass", "tag:roof"};
  h.columns = columns, h.rows = rows;
  h.pixels.assign(size_t{columns} * rows, Dir{0, 0, -1});
  h.epoch = Utc{2026, 11, 28, 0, 0, 0};
  h.origin = Geodetic{50, 8, 100};
  h.epsg = 25832;
  return h;
}

// Looking straight down from (2 p, 0, 1000) m at a thousandth of a second a pulse; bins begin 50 ns before the ground.
inline ResponsePulse response_pulse(double number) {
  const double ground = 2 * 1000 / kSpeedOfLight;
  Pose pose;
  pose.translation = {2 * number, 0, 1000};
  return {number * 1e-3, 1.064, 1e-4, ground - 50e-9, pose, pose};
}

// A roof 6 m above the ground (40 ns before it), which keeps a quarter of the light. east: m, of the first pulse.
inline ResponseBlock response_block(const ResponseHead& head, uint64_t first, size_t pulses, double photons = 400,
                                    double east = 0) {
  ResponseBlock b;
  b.first_pulse = first;
  for (size_t p = 0; p < pulses; ++p) {
    b.pulses.push_back(response_pulse(static_cast<double>(first + p)));
    b.pulses.back().emission.translation.x += east, b.pulses.back().reception.translation.x += east;
    for (size_t x = 0; x < head.pixel_count(); ++x) {
      const auto put = [&](uint32_t bin, double single, double multiple, double grass, double roof) {
        b.bin.push_back(bin), b.contributions.push_back(64);
        for (const double v : {single, multiple, grass, roof}) b.value.push_back(v), b.variance.push_back(1e-4 * v * v);
      };
      put(0, 0.01, 0, 0.01, 0);
      put(101, 0.25 * photons, 0, 0, 0.25 * photons);
      put(501, 0.7 * photons, 0.05 * photons, 0.75 * photons, 0);
      b.begin.push_back(b.bin.size());
      b.bound.push_back(0.02), b.paths.push_back(4096);
    }
  }
  return b;
}

}  // namespace suite::test
