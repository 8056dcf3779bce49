#include "heat/sunlight.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "heat/sunlight_mirrored.h"
#include "heat/sunlight_wave.h"

namespace suite {

uint32_t sky_patch(Dir d) {
  const auto ring = std::min(kSkyRings - 1, static_cast<uint32_t>(kSkyRings * std::max(0.0, d.z)));
  const double turn = std::atan2(d.y, d.x) / (2 * kPi);
  const auto column = std::min(kSkyTurns - 1, static_cast<uint32_t>(kSkyTurns * (turn < 0 ? turn + 1 : turn)));
  return ring * kSkyTurns + column;
}

std::array<float, kSkyShapes> sky_shapes(uint32_t patch) {
  const double z = (patch / kSkyTurns + 0.5) / kSkyRings, turn = 2 * kPi * (patch % kSkyTurns + 0.5) / kSkyTurns;
  const double across = std::sqrt(1 - z * z), x = across * std::cos(turn), y = across * std::sin(turn);
  const double shapes[kSkyShapes] = {1, x, y, z, x * y, x * z, y * z, z * z, x * x - y * y};
  std::array<float, kSkyShapes> out;
  for (size_t k = 0; k < kSkyShapes; ++k) out[k] = static_cast<float>(shapes[k]);
  return out;
}

namespace {

constexpr double kUnfinishedUnit = 1e6;

}  // namespace

std::vector<uint32_t> SunCourse::sunny() const {
  std::vector<uint32_t> out;
  for (uint32_t k = 0; k < moments.size(); ++k)
    if (up(moments[k])) out.push_back(k);
  return out;
}

double Sunlight::unfinished(uint32_t paths) const {
  return static_cast<double>(count.unfinished) / kUnfinishedUnit / (1.0 * static_cast<double>(faces()) * paths);
}

Sunlight untraced_sunlight(const Elements& elements, const HeatFaces& faces, const SunCourse& course,
                           const PathOptions& options) {
  Sunlight out;
  const size_t n = faces.size();
  SUITE_CHECK(options.paths > 0 && options.paths % 2 == 0);
  out.moments = course.moments.size(), out.blocks = options.blocks;
  out.rows = rows_of_faces(elements, n);
  out.beam = CompactRows(n, out.moments);
  out.sky = CompactRows(n, kSkyPatches);
  out.lit.assign(n * course.sunny().size(), 0);
  out.beam_of_block = CompactRows(n * out.blocks, Sunlight::kParts);
  out.beam_spread = CompactRows(n * Sunlight::kContrasts, Sunlight::kParts);
  out.sky_of_block = CompactRows(n * out.blocks, kSkyShapes);
  for (auto* each : {&out.below, &out.sun_hours, &out.absorptance}) each->assign(n, 0.0f);
  out.below_of_block.assign(n * out.blocks, 0.0f);
  return out;
}

void Sunlight::make_more() {
  rows.add_more();
  const size_t n = rows.size();
  beam.resize(n), sky.resize(n), below.resize(n);
  beam_of_block.resize(n * blocks), sky_of_block.resize(n * blocks), below_of_block.resize(n * blocks);
}

void trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                    const SunCourse& course, const PathOptions& options, uint32_t joins, SunStage stage,
                    FaceRange range, Sunlight& out, const std::function<void(size_t)>& progress) {
  constexpr size_t kWave = Sunlight::kTogether;
  const auto [first_row, end_row] = out.rows.alike(range.begin);
  SUITE_CHECK((range.begin - first_row) % kWave == 0 && range.end <= end_row &&
              ((range.end - first_row) % kWave == 0 || range.end == end_row));
  range = {range.begin - first_row, range.end - first_row};
  std::atomic<uint64_t> rays{0}, unfinished{0};
  // Waves are always the same: rays that go together may decide the last bits of a hit.
  parallel_for(range.begin / kWave, (range.end + kWave - 1) / kWave, 1, [&](size_t first, size_t last) {
    const FlushDenormals denormals;
    const AtWork work(tracer);
    SunlightWave wave(tracer, elements, faces, optics, course, options, joins, out);
    for (size_t w = first; w < last; ++w) {
      const size_t begin = first_row + w * kWave, end = std::min(end_row, begin + kWave);
      stage == SunStage::straight ? wave.beam(begin, end) : wave.scattered(begin, end);
    }
    rays += wave.rays();
    unfinished += static_cast<uint64_t>(wave.unfinished() * kUnfinishedUnit);
    if (progress) progress(std::min(end_row - first_row, last * kWave) - first * kWave);
  });
  out.count += {rays, unfinished};
}

std::vector<float> trace_straight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                                  const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                                  const std::function<bool(size_t)>& wanted) {
  constexpr size_t kWave = Sunlight::kTogether;
  const size_t n = faces.size();
  Sunlight out = untraced_sunlight(elements, faces, course, options);
  parallel_for(0, (n + kWave - 1) / kWave, 1, [&](size_t first, size_t last) {
    const FlushDenormals denormals;
    const AtWork work(tracer);
    SunlightWave wave(tracer, elements, faces, optics, course, options, kSunJoins, out);
    for (size_t w = first; w < last; ++w) {
      const size_t begin = w * kWave, end = std::min(n, begin + kWave);
      bool any = false;
      for (size_t f = begin; f < end; ++f) any = any || wanted(f);
      if (any) wave.beam(begin, end);
    }
  });
  return out.beam.floats();
}

Sunlight trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                        const HeatOptics& optics, const SunCourse& course, const PathOptions& options, uint32_t joins,
                        const std::function<void(size_t)>& progress) {
  Sunlight out = untraced_sunlight(elements, faces, course, options);
  for (const SunStage stage : {SunStage::straight, SunStage::scattered})
    trace_sunlight(tracer, elements, faces, optics, course, options, joins, stage, {0, faces.size()}, out, progress);
  out.make_more();
  if (const size_t all = out.rows.size(); all > faces.size())
    trace_sunlight(tracer, elements, faces, optics, course, options, joins, SunStage::scattered, {faces.size(), all},
                   out, progress);
  add_mirrored_sunlight(tracer, elements, faces, optics, course, options, out);
  return out;
}

}  // namespace suite
