#include "optics/models/gauss_facets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace suite {

namespace {

constexpr double kRootPi = 1.7724538509055159;
constexpr int kMostSteps = 40;
bool arrived(double old, double m) { return std::fabs(m - old) < 1e-7; }  // what is left is the square of that

// x with erf(x) = t, within 4e-7 of itself, for t strictly between -1 and 1 (M. Giles, "Approximating the erfinv
// function", GPU Computing Gems, 2010, in single precision).
inline double about_inverse_erf(double t) {
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
inline GaussFacets::View::Search GaussFacets::View::start(double power) const {
  const double low = std::max(least_, -6.0), high = std::max(low, 0.0) + 6;
  return {std::clamp(about_inverse_erf(inside(erf_least_ + (1 - erf_least_) * power)), low, high), low, high};
}

// fall: exp(-m^2), erf: of m. Without branches, for loops over many samples.
inline GaussFacets::View::Search GaussFacets::View::next(const Search& s, double wanted, double fall,
                                                         double erf) const {
  const double below = cosine_ * (erf - erf_least_) + sine_ / kRootPi * (edge_ - fall);
  const double miss = below - wanted, density = 2 / kRootPi * (cosine_ + s.m * sine_) * fall, by = miss / density;
  const double low = miss > 0 ? s.low : s.m, high = miss > 0 ? s.m : s.high, to = density > 0 ? s.m - by : low;
  return {(to > low) & (to < high) ? to : 0.5 * (low + high), low, high};
}

double GaussFacets::View::slope(double u) const {
  if (sine_ < 1e-9) return inverse_erf(2 * u - 1);
  Search search = start(std::pow(u, fit_));
  const double wanted = u * total_;
  for (int n = 0; n < kMostSteps; ++n) {
    const double old = search.m;
    search = next(search, wanted, std::exp(-old * old), std::erf(old));
    if (arrived(old, search.m)) break;
  }
  return search.m;
}

Dir GaussFacets::View::normal(double m, double across) const {
  return normalized({facets_.ax * (cx_ * m - cy_ * across), facets_.ay * (cy_ * m + cx_ * across), 1});
}
Dir GaussFacets::View::normal(Sample s) const { return normal(slope(s.u), s.across); }

void GaussFacets::View::normals(std::span<const Sample> samples, std::span<Dir> h) const {
  if (sine_ < 1e-9) {
    for (size_t i = 0; i < samples.size(); ++i) h[i] = normal(samples[i]);
    return;
  }
  constexpr size_t kBlock = 64;
  for (size_t begin = 0; begin < samples.size(); begin += kBlock) {
    const auto block = samples.subspan(begin, std::min(kBlock, samples.size() - begin));
    std::array<double, kBlock> power, m, low, high, fall, erf;
    std::array<int64_t, kBlock> open;  // 1: has not arrived
    const size_t count = block.size();
    for (size_t i = 0; i < count; ++i) power[i] = std::pow(block[i].u, fit_);
    for (size_t i = 0; i < count; ++i) {
      const Search search = start(power[i]);
      m[i] = search.m, low[i] = search.low, high[i] = search.high, open[i] = 1;
    }
    int64_t any = 1;
    for (int n = 0; n < kMostSteps && any; ++n) {
      for (size_t i = 0; i < count; ++i) fall[i] = std::exp(-m[i] * m[i]);
      for (size_t i = 0; i < count; ++i) erf[i] = std::erf(m[i]);
      any = 0;
      for (size_t i = 0; i < count; ++i) {
        const Search to = next({m[i], low[i], high[i]}, block[i].u * total_, fall[i], erf[i]);
        const double old = m[i];
        m[i] = open[i] ? to.m : old;
        low[i] = to.low, high[i] = to.high;
        open[i] &= !arrived(old, to.m);
        any |= open[i];
      }
    }
    for (size_t i = 0; i < count; ++i) h[begin + i] = normal(m[i], block[i].across);
  }
}

}  // namespace suite
