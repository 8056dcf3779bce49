#include "optics/models/gauss_facets.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

const double kRootPi = std::sqrt(kPi);

// x with erf(x) = t: an approximation (M. Giles, "Approximating the erfinv function", GPU Computing Gems, 2010, in
// single precision) and two steps of Newton.
double inverse_erf(double t) {
  t = std::clamp(t, -1 + 1e-15, 1 - 1e-15);
  double w = -std::log((1 - t) * (1 + t)), x;
  if (w < 5) {
    w -= 2.5;
    x = 1.50140941 +
        w * (0.246640727 +
             w * (-0.00417768164 +
                  w * (-0.00125372503 +
                       w * (0.00021858087 + w * (-4.39150654e-06 +
                                                 w * (-3.5233877e-06 + w * (3.43273939e-07 + w * 2.81022636e-08)))))));
  } else {
    w = std::sqrt(w) - 3;
    x = 2.83297682 +
        w * (1.00167406 +
             w * (0.00943887047 +
                  w * (-0.0076224613 +
                       w * (0.00573950773 +
                            w * (-0.00367342844 + w * (0.00134934322 + w * (0.000100950558 - w * 0.000200214257)))))));
  }
  x *= t;
  for (int step = 0; step < 2; ++step) x -= (std::erf(x) - t) * 0.5 * kRootPi * std::exp(x * x);
  return x;
}

// Slope m towards the viewer, of unit roughness, that a view along (sine, cosine) to the normal sees with density
// max(0, cosine + m sine) exp(-m^2): the distribution is inverted by Newton's steps within a bracket.
double visible_slope(double cosine, double sine, double u) {
  if (sine < 1e-9) return inverse_erf(2 * u - 1);
  const double least = -cosine / sine, edge = std::exp(-least * least);
  // Integral of the density from the least slope that is seen, times 2 / sqrt(pi).
  const double erf_least = std::erf(least);
  const auto below = [&](double m) {
    return cosine * (std::erf(m) - erf_least) + sine / kRootPi * (edge - std::exp(-m * m));
  };
  double low = std::max(least, -6.0), high = std::max(low, 0.0) + 6;
  const double wanted = u * below(high);
  double m = std::clamp(inverse_erf(2 * u - 1), low, high);
  for (int step = 0; step < 40; ++step) {
    const double miss = below(m) - wanted, density = 2 / kRootPi * (cosine + m * sine) * std::exp(-m * m);
    (miss > 0 ? high : low) = m;
    const double next = density > 0 ? m - miss / density : low;
    const double old = m;
    m = next > low && next < high ? next : 0.5 * (low + high);
    if (std::fabs(m - old) < 1e-12) break;
  }
  return m;
}

}  // namespace

double GaussFacets::density(Dir h) const {
  if (!(h.z > 0)) return 0;
  const double x = h.x / (ax * h.z), y = h.y / (ay * h.z), z2 = h.z * h.z;
  return std::exp(-(x * x + y * y)) / (kPi * ax * ay * z2 * z2);
}

double GaussFacets::lambda(Dir d) const {
  const double across = std::sqrt(ax * ax * d.x * d.x + ay * ay * d.y * d.y), z = std::fabs(d.z);
  if (!(across > 0)) return 0;
  const double v = z / across;
  return v > 6 ? 0 : std::max(0.0, 0.5 * (std::exp(-v * v) / (v * kRootPi) - std::erfc(v)));
}

Dir GaussFacets::visible_normal(Dir out, Vec2 u) const {
  // Stretch to slopes of unit roughness, turn the view into x, sample both slopes, turn and press back.
  const Dir v = normalized({ax * out.x, ay * out.y, out.z});
  const double sine = std::sqrt(v.x * v.x + v.y * v.y), cx = sine > 0 ? v.x / sine : 1, cy = sine > 0 ? v.y / sine : 0;
  const double m = visible_slope(v.z, sine, u.x), across = inverse_erf(2 * u.y - 1);
  return normalized({ax * (cx * m - cy * across), ay * (cy * m + cx * across), 1});
}

}  // namespace suite
