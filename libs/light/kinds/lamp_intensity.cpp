#include "light/kinds/lamp_intensity.h"

#include <algorithm>
#include <cmath>

namespace suite {

double relative_intensity(const LampSpec& s, Dir local) {
  double value = 1;
  if (s.kind == LampSpec::Kind::spot) {
    const double cos_inner = std::cos(s.inner), cos_outer = std::cos(s.outer);
    if (local.z <= cos_outer && s.outer < kPi) return 0;
    if (local.z < cos_inner) {
      const double t = (local.z - cos_outer) / (cos_inner - cos_outer);
      value = t * t * (3 - 2 * t);
    }
  }
  if (!s.table) return value;
  const IntensityTable& t = *s.table;
  if (t.sqt) {
    double sum = 0;
    for (size_t c = 0; c < t.sqt->channels(); ++c) sum += t.sqt->value({0, 0, 1}, local, c);
    return value * sum / static_cast<double>(t.sqt->channels());
  }
  const double row = polar_angle(local) / kPi * static_cast<double>(t.polars - 1);
  double phi = azimuth(local) / (2 * kPi);
  phi -= std::floor(phi);
  const double column = phi * static_cast<double>(t.azimuths);
  const size_t r = std::min(t.polars - 2, static_cast<size_t>(row)),
               c = std::min(t.azimuths - 1, static_cast<size_t>(column)), n = (c + 1) % t.azimuths;
  const double fr = row - static_cast<double>(r), fc = column - static_cast<double>(c);
  auto at = [&](size_t i, size_t j) { return t.value[i * t.azimuths + j]; };
  return value *
         ((1 - fr) * ((1 - fc) * at(r, c) + fc * at(r, n)) + fr * ((1 - fc) * at(r + 1, c) + fc * at(r + 1, n)));
}

LightProfile profile_of(const LampSpec& s) {
  LightProfile profile{};
  for (int step = 0; step < 32; ++step) {
    double sum = 0;
    for (int k = 0; k <= 8; ++k) {
      const double z = std::clamp(-1 + (step + k / 8.0) / 16, -1.0, 1.0), r = std::sqrt(std::max(0.0, 1 - z * z));
      for (int a = 0; a < 32; ++a) {
        const double phi = 2 * kPi * (a + 0.5) / 32;
        sum += relative_intensity(s, {r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    profile[static_cast<size_t>(step)] = static_cast<float>(sum / (9 * 32));
  }
  // A spot's rim may lie between two places as well.
  const float least = 1e-3f * *std::max_element(profile.begin(), profile.end());
  for (float& p : profile) p = std::max(p, least);
  return profile;
}

double dimming(const LampSpec& s, double time) {
  if (!s.schedule) return 1;
  const auto row = s.schedule->when.at(time);
  return row ? s.schedule->scale[*row] : 1;
}

double brightest(const LampSpec& s, std::optional<TimeSpan> window) {
  if (!s.schedule) return 1;
  const LampSchedule& table = *s.schedule;
  if (!window) {
    const double most = *std::max_element(table.scale.begin(), table.scale.end());
    return table.when.period > 0 ? most : std::max(1.0, most);
  }
  double most = 0;
  table.when.over(*window,
                  [&](std::optional<size_t> row, TimeSpan) { most = std::max(most, row ? table.scale[*row] : 1.0); });
  return most;
}

}  // namespace suite
