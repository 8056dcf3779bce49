#include "sqt/half_grid.h"

#include <algorithm>

#include "base/error.h"

namespace suite::sqt {

GridPlace place_in(const std::vector<double>& a, double x) {
  const size_t n = a.size();
  if (!(x > a.front())) return {0, 0, 0};
  if (x >= a.back()) return {n - 1, n - 1, 0};
  const size_t i = static_cast<size_t>(std::upper_bound(a.begin(), a.end(), x) - a.begin()) - 1;
  return {i, i + 1, (x - a[i]) / (a[i + 1] - a[i])};
}

GridPlace place_around(const std::vector<double>& a, double x) {
  const size_t n = a.size();
  if (n == 1) return {0, 0, 0};
  if (x >= a.front() && x < a.back()) return place_in(a, x);
  const double gap = a.front() + 2 * kPi - a.back(), beyond = x >= a.back() ? x - a.back() : x + 2 * kPi - a.back();
  return {n - 1, 0, std::clamp(beyond / gap, 0.0, 1.0)};
}

HalfAngles HalfGrid::angles(size_t node) const {
  const size_t h = node % theta_h.size(), rest = node / theta_h.size();
  return {theta_h[h], theta_d[rest % theta_d.size()], phi_d[rest / theta_d.size()]};
}

HalfGrid::Corners HalfGrid::at(const HalfAngles& a) const {
  const GridPlace h = place_in(theta_h, a.theta_h), d = place_in(theta_d, a.theta_d), p = place_around(phi_d, a.phi_d);
  Corners c;
  for (size_t k = 0; k < 8; ++k) {
    const bool up = k & 1, outward = k & 2, round = k & 4;
    c.node[k] = node(round ? p.high : p.low, outward ? d.high : d.low, up ? h.high : h.low);
    c.weight[k] = (round ? p.t : 1 - p.t) * (outward ? d.t : 1 - d.t) * (up ? h.t : 1 - h.t);
  }
  return c;
}

void HalfGrid::check() const {
  const auto axis = [](const std::vector<double>& a, const char* name, double low, double high) {
    if (a.empty()) throw Error(strf("no angle %s", name));
    for (size_t i = 0; i < a.size(); ++i)
      if (!(a[i] >= low && a[i] <= high) || (i && !(a[i] > a[i - 1])))
        throw Error(strf("%s must ascend within %.4g to %.4g rad", name, low, high));
  };
  axis(theta_h, "theta_h", 0, kPi / 2 + 1e-6);
  axis(theta_d, "theta_d", 0, kPi / 2 + 1e-6);
  axis(phi_d, "phi_d", -kPi, kPi);
  if (phi_d.size() > 1 && phi_d.back() - phi_d.front() > 2 * kPi - 1e-9)
    throw Error("phi_d: the last angle is the first");
}

}  // namespace suite::sqt
