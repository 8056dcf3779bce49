#include "heat/heat_audit.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "heat/audit_walk.h"
#include "math/stats.h"

namespace suite {

namespace {

constexpr uint64_t kHeatAuditPurpose = 0x61756469;
constexpr size_t kTogether = 64;  // probes

// Even over area and time: rows of a lattice (the golden section), in a random place.
std::vector<AuditProbe> places(const AuditedScene& scene, const SolvedSurfaces& solved, size_t count,
                               const std::vector<bool>& wanted) {
  std::vector<double> until;
  double area = 0;
  for (size_t f = 0; f < scene.faces.size(); ++f)
    until.push_back(area += wanted.empty() || wanted[f] ? scene.elements[scene.faces.element(f)].area : 0);
  const std::vector<double>& moments = solved.weather.moments;
  const double golden = (std::sqrt(5.0) - 1) / 2, shift = unit_double(hash_of(scene.seed, kHeatAuditPurpose));
  std::vector<AuditProbe> out(count);
  for (size_t i = 0; i < count; ++i) {
    const double u = std::fmod(static_cast<double>(i) * golden + shift, 1.0);
    const auto at = std::upper_bound(until.begin(), until.end(), u * area) - until.begin();
    out[i].face = static_cast<uint32_t>(std::min<std::ptrdiff_t>(at, static_cast<std::ptrdiff_t>(until.size()) - 1));
    const double share =
        (static_cast<double>(i) + unit_double(hash_of(scene.seed, kHeatAuditPurpose, i))) / static_cast<double>(count);
    out[i].time = moments.front() + share * (moments.back() - moments.front());
  }
  return out;
}

}  // namespace

HeatAudit audit_heat(const AuditedScene& scene, const SolvedSurfaces& solved, size_t probes,
                     const std::vector<bool>& wanted, const std::function<void(size_t)>& progress) {
  SUITE_CHECK(probes > 1 && (wanted.empty() || wanted.size() == scene.faces.size()));
  const AuditTables tables(scene, solved);
  HeatAudit out;
  out.probes = places(scene, solved, probes, wanted);
  const size_t pieces = (probes + kTogether - 1) / kTogether;
  std::vector<std::array<double, 3>> told(pieces);  // rays, cut, fast
  parallel_for(0, pieces, 1, [&](size_t first, size_t last) {
    const AtWork work(scene.tracer);
    for (size_t piece = first; piece < last; ++piece) {
      AuditWalk walk(scene, solved, tables);
      const size_t end = std::min(probes, (piece + 1) * kTogether);
      for (size_t i = piece * kTogether; i < end; ++i) {
        AuditProbe& p = out.probes[i];
        const Hit hit = scene.elements.point(scene.faces.element(p.face),
                                             {SampleStream(scene.seed, kHeatAuditPurpose, i), 0, kPointBlock});
        WalkNumbers numbers(hash_of(scene.seed, kHeatAuditPurpose, i), 1);
        p.at = hit.position, p.found = tables.kelvin(p.face, p.time);
        for (int k = 0; k < 2; ++k) {
          const AuditWalk::Found found = walk.follow(hit, p.face, p.time, numbers);
          p.walked[k] = found.kelvin, p.more[k] = found.more;
        }
      }
      told[piece] = {walk.rays(), static_cast<double>(walk.cut()), static_cast<double>(walk.fast())};
      if (progress) progress(end - piece * kTogether);
    }
  });
  for (const auto& [rays, cut, fast] : told)
    out.rays += rays, out.cut += static_cast<size_t>(cut), out.fast += static_cast<size_t>(fast);
  RunningStats bias, square, whole;
  for (const AuditProbe& p : out.probes) {
    bias.add(-(p.more[0] + p.more[1]) / 2), square.add(p.more[0] * p.more[1]);
    whole.add(p.found - (p.walked[0] + p.walked[1]) / 2);
  }
  out.bias = bias.mean(), out.bias_error = bias.stderr_of_mean();
  out.square = square.mean(), out.square_error = square.stderr_of_mean();
  out.whole = whole.mean(), out.whole_error = whole.stderr_of_mean();
  return out;
}

}  // namespace suite
