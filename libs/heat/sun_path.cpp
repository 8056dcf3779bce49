#include "heat/sun_path.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace suite {

namespace {

constexpr double kAlike = 0.05;  // of the light, that spectra may place elsewhere
constexpr double kLowSun = 0.1;  // sine of its height, below which its spectrum changes with every step

double apart(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return INFINITY;
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::fabs(double{a[i]} - double{b[i]}) / 2;
  return sum;
}

bool comparable(const SunPath& a, const SunPath& b) {
  if (a.moments.size() != b.moments.size() || a.moments.size() < 2 || apart(a.sky, b.sky) > kAlike) return false;
  if (std::fabs(a.angular_radius - b.angular_radius) > kNearSun / 10) return false;
  for (size_t k = 0; k < a.moments.size(); ++k) {
    if (std::fabs((a.moments[k] - a.moments[0]) - (b.moments[k] - b.moments[0])) > 1e-3) return false;
    if (std::min(a.towards[k].z, b.towards[k].z) > kLowSun && apart(a.beam[k], b.beam[k]) > kAlike) return false;
  }
  return true;
}

}  // namespace

SunPath path_of(const SunCourse& course) {
  SunPath path{course.moments, {}, course.angular_radius, course.beam, course.sky};
  for (const double t : course.moments) path.towards.push_back(course.towards(t));
  return path;
}

SunNear near_path(const SunPath& found, const SunPath& wanted) {
  SunNear out;
  const size_t n = found.moments.size();
  if (!comparable(found, wanted)) {
    out.off = INFINITY;
    return out;
  }
  const double step = found.moments[1] - found.moments[0];
  for (size_t k = 0; k < n; ++k) {
    const Dir d = wanted.towards[k];
    out.at.push_back(static_cast<double>(k));
    if (!(d.z > 0)) continue;
    double nearest = INFINITY;
    for (size_t s = k > 0 ? k - 1 : 0; s + 1 < n && s <= k; ++s) {
      const Vec3 a = found.towards[s], along = found.towards[s + 1] - a;
      const double length2 = dot(along, along);
      const double x = length2 > 0 ? std::clamp(dot(d - a, along) / length2, 0.0, 1.0) : 0;
      const double off = angle_between(d, normalized(a + along * x));
      if (off < nearest) nearest = off, out.at[k] = static_cast<double>(s) + x;
    }
    out.off = std::max(out.off, nearest);
    out.late = std::max(out.late, step * std::fabs(out.at[k] - static_cast<double>(k)));
  }
  out.fits = out.off <= kNearSun;
  return out;
}

void move_along(Sunlight& sun, const SunNear& near) {
  const size_t n = sun.moments;
  SUITE_CHECK_EQ(near.at.size(), n);
  for (CompactRows* values : {&sun.beam, &sun.beam_by_mirrors}) {
    parallel_for(0, values->rows(), 64, [&](size_t begin, size_t end) {
      std::vector<float> row(n), of(n);
      for (size_t f = begin; f < end; ++f) {
        values->get(f, of);
        for (size_t k = 0; k < n; ++k) {
          const size_t s = std::min(static_cast<size_t>(near.at[k]), n - 2);
          const auto x = static_cast<float>(near.at[k] - static_cast<double>(s));
          row[k] = of[s] + (of[s + 1] - of[s]) * x;
        }
        values->set(f, row);
      }
    });
  }
}

}  // namespace suite
