#include "heat/closed_backs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "heat/heat_walk.h"

namespace suite {

namespace {

// The share of places of a face that see closed backs wherever they look: straight on, and to eight sides at 45 and 75
// degrees. With three standard errors of so many places, for the paths began at others.
double shut_in(const HeatScene& scene, size_t face) {
  constexpr uint32_t kPlaces = 48;
  const double side = scene.faces.is_back(face) ? -1 : 1;
  std::vector<Ray> rays;
  for (uint32_t k = 0; k < kPlaces; ++k) {
    const SampleStream numbers(0, face, 0);
    const Hit place = scene.elements.point(scene.faces.element(face), {numbers, k, kPointBlock});
    const Dir up = normalized(side * place.normal);
    const Frame frame = Frame::around(up);
    const Vec3 from = scene.tracer.leave(place, up);
    rays.push_back({from, up, place.time});
    for (int n = 0; n < 8; ++n) {
      const double zenith = (n % 2 ? 75 : 45) * kDegree, turn = n * kPi / 4;
      const Vec3 d = frame.x * (std::sin(zenith) * std::cos(turn)) + frame.y * (std::sin(zenith) * std::sin(turn)) +
                     frame.z * std::cos(zenith);
      rays.push_back({from, normalized(d), place.time});
    }
  }
  std::vector<Hit> hits(rays.size());
  TraceStatistics ignored;
  scene.tracer.nearest(rays, hits, false, ignored);
  const size_t each = rays.size() / kPlaces;
  double shut = 0;
  for (uint32_t k = 0; k < kPlaces; ++k) {
    bool all = true;
    for (size_t n = k * each; n < (k + 1) * each && all; ++n)
      all = hits[n].hit() && dot(rays[n].direction, hits[n].normal) > 0;
    shut += all;
  }
  const double share = shut / kPlaces;
  return shut > 0 ? std::min(1.0, share + 3 * std::sqrt(share * (1 - share) / kPlaces)) : 0;
}

}  // namespace

std::string back_note(const HeatScene& scene, const ExchangePaths& exchange) {
  constexpr double kLittle = 1e-3;  // as the rounding of places on closed bodies may let through
  const auto& [tracer, elements, faces, optics] = scene;
  std::vector<std::array<double, 2>> ended(optics.has_heat.size(), {0, 0});  // m2 of emission, in front and behind
  const size_t each = size_t{exchange.blocks} * exchange.paths;
  for (size_t from = 0; from * each < exchange.ends.size(); ++from) {
    const uint32_t emitter = exchange.rows.face(from);  // beyond the faces there are rows of other intervals
    double all = 0, behind = 0;
    for (size_t k = from * each; k < (from + 1) * each; ++k) {
      const uint32_t end = exchange.ends[k], face = faces.face_of(end);
      all += double{exchange.weights[k]};
      if (face != kNone && end != face) behind += double{exchange.weights[k]};
    }
    const double counts = behind > 0 ? std::max(0.0, 1 - shut_in(scene, emitter) * all / behind) : 0;
    for (size_t k = from * each; k < (from + 1) * each; ++k) {
      const uint32_t end = exchange.ends[k], face = faces.face_of(end);
      if (face == kNone) continue;
      const double sent = exchange.area[emitter] * double{exchange.weights[k]};
      ended[elements[faces.element(face)].material][end == face ? 0 : 1] += end == face ? sent : counts * sent;
    }
  }
  std::string seen;
  for (size_t m = 0; m < ended.size(); ++m)
    if (const double behind = ended[m][1]; behind > kLittle * (behind + ended[m][0]))
      seen += strf("%s'%s' (%.2g %%)", seen.empty() ? "" : ", ", optics.materials->materials[m].id.c_str(),
                   100 * behind / (behind + ended[m][0]));
  if (seen.empty()) return {};
  return "closed backs are seen, of materials (with the share of the infrared ending on each that comes from behind) " +
         seen +
         ": they are as warm as their fronts, and nothing that falls there, sunlight neither, warms them; "
         "'back: open' lets both sides take part";
}

}  // namespace suite
