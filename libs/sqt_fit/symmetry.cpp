#include "sqt_fit/symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace suite::sqt {

namespace {

constexpr double kSame = 1e-5;

bool one_azimuth(const std::vector<Dir>& dirs) {
  const Dir* first = nullptr;
  for (const Dir& d : dirs) {
    const double s = std::hypot(d.x, d.y);
    if (s < kSame) continue;  // the pole has no azimuth
    if (!first) first = &d;
    if (std::fabs(first->x * d.y - first->y * d.x) > kSame * s || first->x * d.x + first->y * d.y < 0) return false;
  }
  return true;
}

// `moving` in the frame where `still` has azimuth 0.
Dir turned(Dir still, Dir moving) {
  const double s = std::hypot(still.x, still.y);
  if (s < kSame) return moving;
  const double c = still.x / s, n = still.y / s;
  return {moving.x * c + moving.y * n, moving.y * c - moving.x * n, moving.z};
}

bool mirrored_values(const Samples& samples, const std::vector<Dir>& still, const std::vector<Dir>& local) {
  const size_t channels = samples.info.wavelength_um.size();
  using Key = std::array<long long, 4>;
  std::map<Key, size_t> index;
  auto key = [&](size_t i, double y) {
    auto grid = [](double x) { return std::llround(x / (10 * kSame)); };
    return Key{grid(still[i].z), grid(local[i].x), grid(y), grid(local[i].z)};
  };
  for (size_t i = 0; i < local.size(); ++i) index.emplace(key(i, local[i].y), i);
  for (size_t i = 0; i < local.size(); ++i) {
    const auto found = index.find(key(i, -local[i].y));
    if (found == index.end()) return false;
    for (size_t c = 0; c < channels; ++c) {
      const double a = samples.value[i * channels + c], b = samples.value[found->second * channels + c];
      if (std::isnan(a) != std::isnan(b) || std::fabs(a - b) > 1e-3 * (std::fabs(a) + std::fabs(b))) return false;
    }
  }
  return true;
}

}  // namespace

void infer_symmetry(Samples& samples, Still reference) {
  const std::vector<Dir>&still = reference == Still::out ? samples.out : samples.in,
        &moving = reference == Still::out ? samples.in : samples.out;
  samples.info.isotropic = one_azimuth(still);
  samples.info.domain = std::any_of(samples.in.begin(), samples.in.end(), [](Dir d) { return d.z < 0; })
                            ? Domain::sphere
                            : Domain::hemisphere;
  samples.info.bilateral = false;
  if (!samples.info.isotropic) return;
  std::vector<Dir> local(still.size());
  bool left = false, right = false;
  for (size_t i = 0; i < still.size(); ++i) {
    local[i] = turned(still[i], moving[i]);
    left = left || local[i].y > kSame;
    right = right || local[i].y < -kSame;
  }
  samples.info.bilateral = !(left && right) || mirrored_values(samples, still, local);
}

}  // namespace suite::sqt
