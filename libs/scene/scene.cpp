#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace suite {

uint32_t oct_encode(Dir d) {
  const double s = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
  double u = d.x * s, v = d.y * s;
  if (d.z < 0) {
    const double fu = (1 - std::fabs(v)) * std::copysign(1.0, u), fv = (1 - std::fabs(u)) * std::copysign(1.0, v);
    u = fu, v = fv;
  }
  const auto snorm = [](double x) {
    return static_cast<uint32_t>(
        static_cast<uint16_t>(static_cast<int16_t>(std::lround(std::clamp(x, -1.0, 1.0) * 32767))));
  };
  return snorm(u) | (snorm(v) << 16);
}

Dir oct_decode(uint32_t code) {
  double u = static_cast<int16_t>(code & 0xffff) / 32767.0, v = static_cast<int16_t>(code >> 16) / 32767.0;
  const double z = 1 - std::fabs(u) - std::fabs(v);
  if (z < 0) {
    const double fu = (1 - std::fabs(v)) * std::copysign(1.0, u), fv = (1 - std::fabs(u)) * std::copysign(1.0, v);
    u = fu, v = fv;
  }
  return normalized(Vec3{u, v, z});
}

void Mesh::require() const {
  if (!stored) return;
  const std::lock_guard lock(stored->turn);
  if (!positions.empty() || !indices.empty() || !stored->vertices) return;
  try {
    stored->fill(*this);
  } catch (...) {  // whoever asks again must be told again
    positions.clear(), indices.clear(), normals.clear(), uvs.clear();
    throw;
  }
}

bool uses_media(const Scene& s) {
  return s.ambient != kNone || !s.volumes.empty() ||
         std::any_of(s.materials.begin(), s.materials.end(), [](const Material& m) { return m.bounds_medium(); });
}

}  // namespace suite
