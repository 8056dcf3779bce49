#include <algorithm>
#include <array>
#include <cmath>

#include "optics/models/ward.h"

namespace suite {

namespace {

constexpr size_t kRows = 129, kColumns = 33;

// Nodes and weights of Gauss-Legendre quadrature with 16 points on [-1, 1] (Newton's iteration on P_16).
struct Legendre16 {
  std::array<double, 16> x, w;
  Legendre16() {
    for (int i = 0; i < 16; ++i) {
      double t = std::cos(kPi * (i + 0.75) / 16.5), derivative = 1;
      for (int step = 0; step < 50; ++step) {
        double p = 1, before = 0;
        for (int k = 1; k <= 16; ++k) {
          const double older = before;
          before = p;
          p = ((2 * k - 1) * t * before - (k - 1) * older) / k;
        }
        derivative = 16 * (t * p - before) / (t * t - 1);
        t -= p / derivative;
      }
      x[static_cast<size_t>(i)] = t;
      w[static_cast<size_t>(i)] = 2 / ((1 - t * t) * derivative * derivative);
    }
  }
};

// Integral of (a - b q^2) N(q; mean, sigma) over [-limit, limit].
double across(double a, double b, double mean, double sigma, double limit) {
  const double low = (-limit - mean) / sigma, high = (limit - mean) / sigma;
  constexpr double root_half = 0.70710678118654752440, inv_root_2pi = 0.39894228040143267794;
  const double mass = 0.5 * (std::erf(high * root_half) - std::erf(low * root_half));
  const double el = inv_root_2pi * std::exp(-0.5 * low * low), eh = inv_root_2pi * std::exp(-0.5 * high * high);
  const double first = el - eh;  // of the standard normal
  const double second = mass + low * el - high * eh;
  return (a - b * mean * mean) * mass - 2 * b * mean * sigma * first - b * sigma * sigma * second;
}

}  // namespace

WardAlbedo::WardAlbedo(double alpha_x, double alpha_y)
    : ax_(alpha_x), ay_(alpha_y), columns_(alpha_x == alpha_y ? 1 : kColumns), table_(kRows * columns_) {
  for (size_t c = 0; c < columns_; ++c) {
    // Columns are even in the azimuth of the slopes' ellipse, where anisotropic albedos change evenly.
    const double turn = columns_ == 1 ? 0 : kPi / 2 * static_cast<double>(c) / static_cast<double>(columns_ - 1);
    const double phi = std::atan2(ax_ * std::sin(turn), ay_ * std::cos(turn));
    const double cp = std::cos(phi), sp = std::sin(phi), width = slope_width(cp, sp);
    for (size_t r = 0; r + 1 < kRows; ++r) {
      const double v = 1 - static_cast<double>(r) / (kRows - 1), s = 1 / (v * v) - 1;
      table_[r * columns_ + c] = integral(s / width, cp, sp);
    }
    table_[(kRows - 1) * columns_ + c] = 1;  // at grazing half of the slopes reflect with weight 2
  }
}

double WardAlbedo::integral(double t, double cos_phi, double sin_phi) const {
  static const Legendre16 rule;
  // Slopes are Gaussian with variances alpha^2 / 2; p is along out, q across, correlated when anisotropic.
  const double vx = ax_ * ax_ / 2, vy = ay_ * ay_ / 2;
  const double vp = vx * cos_phi * cos_phi + vy * sin_phi * sin_phi, covariance = (vy - vx) * cos_phi * sin_phi;
  const double sp = std::sqrt(vp), drift = covariance / vp, sq = std::sqrt(vx * vy / vp);
  // The reflected direction is above the horizon where p^2 + q^2 < 1 + 2 p t.
  const double root = std::hypot(1.0, t), low = std::max(-1 / (t + root), -9 * sp), high = std::min(t + root, 9 * sp);
  if (!(low < high)) return 0;
  // Breakpoints where the integrand bends: around the mean, and geometrically towards the lower limit.
  double sum = 0;
  constexpr int panels = 24;
  for (int i = 0; i < panels; ++i) {
    const double a = static_cast<double>(i) / panels, b = static_cast<double>(i + 1) / panels;
    const double from = low + (high - low) * a * a, to = low + (high - low) * b * b;
    for (size_t n = 0; n < 16; ++n) {
      const double p = 0.5 * (from + to) + 0.5 * (to - from) * rule.x[n], z = p / sp;
      const double forward = 1 + p * t, limit2 = 1 + 2 * p * t - p * p;
      if (!(limit2 > 0) || !(forward > 0)) continue;
      const double density = std::exp(-0.5 * z * z) / (sp * std::sqrt(2 * kPi));
      sum += 0.5 * (to - from) * rule.w[n] * density *
             across(2 - (1 + p * p) / forward, 1 / forward, drift * p, sq, std::sqrt(limit2));
    }
  }
  return sum;
}

double WardAlbedo::exact(Dir out) const {
  const double s = std::hypot(out.x, out.y);
  return s == 0 ? integral(0, 1, 0) : integral(s / out.z, std::fabs(out.x) / s, std::fabs(out.y) / s);
}

double WardAlbedo::at(Dir out) const {
  const double s = std::hypot(out.x, out.y), cp = s > 0 ? std::fabs(out.x) / s : 1,
               sp = s > 0 ? std::fabs(out.y) / s : 0;
  const double scaled = slope_width(cp, sp) * s, v = 1 - std::sqrt(out.z / (scaled + out.z));
  const double row = std::clamp(v, 0.0, 1.0) * (kRows - 1);
  const size_t r = std::min(kRows - 2, static_cast<size_t>(row));
  const double wr = row - static_cast<double>(r);
  auto along = [&](size_t c) { return table_[r * columns_ + c] * (1 - wr) + table_[(r + 1) * columns_ + c] * wr; };
  if (columns_ == 1) return along(0);
  const double column = std::atan2(ay_ * sp, ax_ * cp) / (kPi / 2) * static_cast<double>(columns_ - 1);
  const size_t c = std::min(columns_ - 2, static_cast<size_t>(column));
  const double wc = column - static_cast<double>(c);
  return along(c) * (1 - wc) + along(c + 1) * wc;
}

}  // namespace suite
