#include "optics/models/gauss_facets.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

const double kRootPi = std::sqrt(kPi);

// x with erf(x) = t, within 4e-7 of itself, for t strictly between -1 and 1 (M. Giles, "Approximating the erfinv
// function", GPU Computing Gems, 2010, in single precision).
double about_inverse_erf(double t) {
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
  return x * t;
}
double inside(double t) { return std::clamp(t, -1 + 1e-15, 1 - 1e-15); }
// The same with a step of Newton, within 1e-10.
double inverse_erf(double t) {
  t = inside(t);
  const double x = about_inverse_erf(t);
  return x - (std::erf(x) - t) * 0.5 * kRootPi * std::exp(x * x);
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

GaussFacets::Sample GaussFacets::sample(Vec2 u) { return {u.x, inverse_erf(2 * u.y - 1)}; }

// Stretches to slopes of unit roughness and turns the view into x.
GaussFacets::View::View(GaussFacets facets, Dir out) : facets_(facets) {
  const Dir v = normalized({facets.ax * out.x, facets.ay * out.y, out.z});
  cosine_ = v.z;
  sine_ = std::sqrt(v.x * v.x + v.y * v.y);
  cx_ = sine_ > 0 ? v.x / sine_ : 1;
  cy_ = sine_ > 0 ? v.y / sine_ : 0;
  if (sine_ < 1e-9) return;
  least_ = -cosine_ / sine_;
  edge_ = std::exp(-least_ * least_);
  erf_least_ = std::erf(least_);
  // Integral of the density from the least slope that is seen, times 2 / sqrt(pi).
  total_ = cosine_ * (1 - erf_least_) + sine_ / kRootPi * edge_;
  const double theta = std::atan2(sine_, cosine_);
  fit_ = 1 + theta * (-0.876 + theta * (0.4265 - 0.0594 * theta));
}

// Slope m towards the viewer, of unit roughness, that a view along (sine, cosine) to the normal sees with density
// max(0, cosine + m sine) exp(-m^2): the distribution is inverted by Newton's steps within a bracket, from where a fit
// says (W. Jakob, "An improved visible normal sampling routine for the Beckmann distribution", 2014).
double GaussFacets::View::slope(double u) const {
  if (sine_ < 1e-9) return inverse_erf(2 * u - 1);
  double low = std::max(least_, -6.0), high = std::max(low, 0.0) + 6;
  const double wanted = u * total_;
  double m = std::clamp(about_inverse_erf(inside(erf_least_ + (1 - erf_least_) * std::pow(u, fit_))), low, high);
  for (int step = 0; step < 40; ++step) {
    const double fall = std::exp(-m * m),
                 below = cosine_ * (std::erf(m) - erf_least_) + sine_ / kRootPi * (edge_ - fall);
    const double miss = below - wanted, density = 2 / kRootPi * (cosine_ + m * sine_) * fall;
    (miss > 0 ? high : low) = m;
    const double next = density > 0 ? m - miss / density : low;
    const double old = m;
    m = next > low && next < high ? next : 0.5 * (low + high);
    if (std::fabs(m - old) < 1e-7) break;  // what is left is the square of that
  }
  return m;
}

Dir GaussFacets::View::normal(Sample s) const {
  const double m = slope(s.u);
  return normalized({facets_.ax * (cx_ * m - cy_ * s.across), facets_.ay * (cy_ * m + cx_ * s.across), 1});
}

}  // namespace suite
