#include "scene/scene.h"

#include <algorithm>
#include <cmath>

#include "base/mapped_file.h"

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
  if (!stored || stored->here.load(std::memory_order_acquire)) return;
  const std::lock_guard lock(stored->turn);
  if (stored->here.load(std::memory_order_relaxed)) return;
  stored->fetch(*this);  // whoever asks again after an Error is told again
  stored->here.store(true, std::memory_order_release);
}

void Mesh::let_go() const {
  if (!stored) return;
  const auto give = [](const auto& values) { suite::let_go(values.data(), values.size() * sizeof(values[0])); };
  give(positions), give(indices), give(normals), give(uvs);
}

bool uses_media(const Scene& s) {
  return s.ambient != kNone || !s.volumes.empty() ||
         std::any_of(s.materials.begin(), s.materials.end(), [](const Material& m) { return m.bounds_medium(); });
}

}  // namespace suite
