#include "heat/sunlight.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "heat/sunlight_wave.h"

namespace suite {

uint32_t sky_patch(Dir d) {
  const auto ring = std::min(kSkyRings - 1, static_cast<uint32_t>(kSkyRings * std::max(0.0, d.z)));
  const double turn = std::atan2(d.y, d.x) / (2 * kPi);
  const auto column = std::min(kSkyTurns - 1, static_cast<uint32_t>(kSkyTurns * (turn < 0 ? turn + 1 : turn)));
  return ring * kSkyTurns + column;
}

Sunlight trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                        const HeatOptics& optics, const SunCourse& course, const PathOptions& options, uint32_t joins,
                        const std::function<void(size_t)>& progress) {
  Sunlight out;
  const size_t n = faces.size();
  out.moments = course.moments.size(), out.blocks = options.blocks;
  out.beam.assign(n * out.moments, 0.0f);
  out.sky.assign(n * kSkyPatches, 0.0f);
  out.beam_of_block.assign(n * out.blocks * Sunlight::kParts, 0.0f);
  for (auto* each : {&out.below, &out.sun_hours, &out.absorptance}) each->assign(n, 0.0f);
  for (auto* each : {&out.diffuse_of_block, &out.below_of_block}) each->assign(n * out.blocks, 0.0f);
  for (size_t m = 0; m < optics.materials->materials.size(); ++m)
    if (const ScatterModel* model = optics.sun->material(static_cast<uint32_t>(m)).model)
      out.mirrors = out.mirrors || model->has_delta();
  std::atomic<uint64_t> rays{0}, unfinished{0};
  constexpr double kUnit = 1e6;
  // Waves are always the same: rays that go together may decide the last bits of a hit.
  constexpr size_t kWave = 32;
  parallel_for(0, (n + kWave - 1) / kWave, 1, [&](size_t first, size_t last) {
    const FlushDenormals denormals;
    const AtWork work(tracer);
    SunlightWave wave(tracer, elements, faces, optics, course, options, joins, out);
    for (size_t w = first; w < last; ++w) {
      const size_t begin = w * kWave, end = std::min(n, begin + kWave);
      wave.beam(begin, end);
      wave.scattered(begin, end);
    }
    rays += wave.rays();
    unfinished += static_cast<uint64_t>(wave.unfinished() * kUnit);
    if (progress) progress(std::min(n, last * kWave) - first * kWave);
  });
  out.rays = static_cast<double>(rays);
  out.unfinished =
      static_cast<double>(unfinished) / kUnit / (1.0 * static_cast<double>(n) * options.blocks * options.paths);
  return out;
}

}  // namespace suite
