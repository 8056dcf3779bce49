#include "air/mie.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

using Complex = std::complex<double>;

// std::complex asks for infinities in every product and quotient; the series has none.
struct Number {
  double re, im;
};
Number over(double a, Number b) {
  const double s = a / (b.re * b.re + b.im * b.im);
  return {b.re * s, -b.im * s};
}
Number times(Number a, Number b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }

size_t orders(double x) { return static_cast<size_t>(std::ceil(x + 4.5 * std::cbrt(x) + 4)); }

// z psi_n'(z) / psi_n(z) for n = 0 .. last, psi the Riccati-Bessel function, downward from where the start has been
// forgotten. Only z^2 enters, so that a small absorption is no difference of large numbers.
std::vector<Number> log_derivatives(Number z2, size_t last) {
  const double size = std::sqrt(std::hypot(z2.re, z2.im)), from = std::max(static_cast<double>(last), size);
  std::vector<Number> f(last + 1);
  size_t n = static_cast<size_t>(from + 8 * std::cbrt(from) + 16);
  Number now{static_cast<double>(n) + 1, 0};
  for (; n > 0; --n) {
    if (n <= last) f[n] = now;
    const double order = static_cast<double>(n);
    const Number step = times(z2, over(1, {now.re + order, now.im}));
    now = {order - step.re, -step.im};
  }
  f[0] = now;
  return f;
}

// psi_n and chi_n of a real argument. psi runs upward while it oscillates and by its ratios from above where it decays,
// where upward steps would lose it; chi is stable upward.
void riccati(double x, size_t last, std::vector<double>& psi, std::vector<double>& chi) {
  psi.resize(last + 1);
  chi.resize(last + 1);
  const std::vector<Number> f = log_derivatives({x * x, 0}, last);
  psi[0] = std::sin(x);
  chi[0] = std::cos(x);
  double psi_before = chi[0], chi_before = -psi[0];
  for (size_t n = 1; n <= last; ++n) {
    const double order = static_cast<double>(n), step = (2 * order - 1) / x;
    psi[n] = order > x ? psi[n - 1] * x / (f[n].re + order) : step * psi[n - 1] - psi_before;
    chi[n] = step * chi[n - 1] - chi_before;
    psi_before = psi[n - 1];
    chi_before = chi[n - 1];
  }
}

void check(double x, Complex index) {
  if (!(x >= 1e-6 && x <= 1e6))
    throw Error(strf("Mie scattering: the size parameter %g is outside its range", x), "1e-6 .. 1e6");
  if (!(index.real() > 0 && index.imag() >= 0 && std::abs(index) * x <= 1e7))
    throw Error(strf("Mie scattering: the index %g + %gi is outside its range", index.real(), index.imag()),
                "n above 0, k not negative, |index| times the size parameter at most 1e7");
  if (index == 1.0) throw Error("Mie scattering: a sphere of index 1 scatters nothing");
}

}  // namespace

MieSphere::MieSphere(double size_parameter, Complex index) : x_(size_parameter) {
  check(x_, index);
  const size_t last = orders(x_);
  std::vector<double> psi, chi;
  riccati(x_, last, psi, chi);
  const Number m2{index.real() * index.real() - index.imag() * index.imag(), 2 * index.real() * index.imag()},
      inverse_m2 = over(1, m2);
  const std::vector<Number> inside = log_derivatives({m2.re * x_ * x_, m2.im * x_ * x_}, last);
  a_.resize(last + 1);
  b_.resize(last + 1);
  for (size_t n = 1; n <= last; ++n) {
    const double order = static_cast<double>(n);
    // Bohren & Huffman, equation 4.88, with xi = psi - i chi. By the Wronskian of psi and chi, what order n absorbs,
    // Re c - |c|^2, is -Im(slope) over the squared denominator.
    auto coefficient = [&](Number slope) {
      const Complex s{(slope.re + order) / x_, slope.im / x_};
      const Complex above = s * psi[n] - psi[n - 1], aside = s * chi[n] - chi[n - 1];
      const Complex below{above.real() + aside.imag(), above.imag() - aside.real()};
      absorption_ += (2 * order + 1) * std::max(0.0, -s.imag()) / std::norm(below);
      return above / below;
    };
    a_[n] = coefficient(times(inside[n], inverse_m2));
    b_[n] = coefficient(inside[n]);
  }
  sum_efficiencies();
}

void MieSphere::sum_efficiencies() {
  double sum = 0, cosine = 0;
  for (size_t n = 1; n < a_.size(); ++n) {
    const double order = static_cast<double>(n);
    sum += (2 * order + 1) * (std::norm(a_[n]) + std::norm(b_[n]));
    cosine += (2 * order + 1) / (order * (order + 1)) * (a_[n] * std::conj(b_[n])).real();
    if (n + 1 < a_.size())
      cosine +=
          order * (order + 2) / (order + 1) * (a_[n] * std::conj(a_[n + 1]) + b_[n] * std::conj(b_[n + 1])).real();
  }
  scattering_ = 2 / (x_ * x_) * sum;
  absorption_ *= 2 / (x_ * x_);
  asymmetry_ = 2 * cosine / sum;
}

MieSphere::Amplitudes MieSphere::amplitudes(double cosine) const {
  // Angular functions pi_n and tau_n, upward (equation 4.47). Sum and difference of the two amplitudes share them.
  Complex plus = 0, minus = 0;
  double before = 0, now = 1;
  for (size_t n = 1; n < a_.size(); ++n) {
    const double order = static_cast<double>(n), s = cosine * now, t = s - before;
    const double tau = order * t - before, share = (2 * order + 1) / (order * (order + 1));
    plus += share * (now + tau) * (a_[n] + b_[n]);
    minus += share * (now - tau) * (a_[n] - b_[n]);
    before = now;
    now = s + (order + 1) / order * t;
  }
  return {0.5 * (plus + minus), 0.5 * (plus - minus)};
}

PlaneBlocks MieSphere::polarised(double cosine) const {
  const Amplitudes s = amplitudes(cosine);
  const double across = std::norm(s.across), along = std::norm(s.along), all = 0.5 * (along + across);
  if (!(all > 0)) return {1, 0, 0, 0, 0, 0};
  const std::complex<double> x = s.across * std::conj(s.along), y = s.along * std::conj(s.across);
  return PlaneBlocks::of(1, 0.5 * (along - across) / all, x.real() / all, y.imag() / all);
}

double MieSphere::phase(double cosine) const {
  const Amplitudes s = amplitudes(cosine);
  return 0.5 * (std::norm(s.across) + std::norm(s.along)) / (kPi * x_ * x_ * scattering_);
}

template <class Use>
void MieSphere::each_amplitude(std::span<const double> cosines, const Use& use) const {
  // As amplitudes(), with a block of angles abreast for each order.
  constexpr size_t kBlock = 16;
  for (size_t first = 0; first < cosines.size(); first += kBlock) {
    const size_t count = std::min(kBlock, cosines.size() - first);
    double mu[kBlock] = {}, before[kBlock] = {}, now[kBlock], plus[2][kBlock] = {}, minus[2][kBlock] = {};
    std::copy_n(cosines.begin() + static_cast<std::ptrdiff_t>(first), count, mu);
    std::fill_n(now, kBlock, 1.0);
    for (size_t n = 1; n < a_.size(); ++n) {
      const double order = static_cast<double>(n), share = (2 * order + 1) / (order * (order + 1)),
                   next = (order + 1) / order;
      const Complex p = share * (a_[n] + b_[n]), m = share * (a_[n] - b_[n]);
      for (size_t i = 0; i < kBlock; ++i) {
        const double s = mu[i] * now[i], t = s - before[i], tau = order * t - before[i];
        plus[0][i] += p.real() * (now[i] + tau);
        plus[1][i] += p.imag() * (now[i] + tau);
        minus[0][i] += m.real() * (now[i] - tau);
        minus[1][i] += m.imag() * (now[i] - tau);
        before[i] = now[i];
        now[i] = s + next * t;
      }
    }
    for (size_t i = 0; i < count; ++i) use(first + i, Number{plus[0][i], plus[1][i]}, Number{minus[0][i], minus[1][i]});
  }
}

void MieSphere::add_phase(std::span<const double> cosines, double weight, std::span<double> sums) const {
  const double scale = weight / (4 * kPi * x_ * x_ * scattering_);
  each_amplitude(cosines, [&](size_t i, Number plus, Number minus) {
    // |S1|^2 + |S2|^2 is half of what sum and difference of the two have.
    sums[i] += scale * (plus.re * plus.re + plus.im * plus.im + minus.re * minus.re + minus.im * minus.im);
  });
}

void MieSphere::add_matrices(std::span<const double> cosines, double weight, std::span<PlaneBlocks> sums) const {
  const double scale = weight / (4 * kPi * x_ * x_ * scattering_);
  each_amplitude(cosines, [&](size_t i, Number plus, Number minus) {
    const double p = plus.re * plus.re + plus.im * plus.im, m = minus.re * minus.re + minus.im * minus.im;
    const double both = plus.re * minus.re + plus.im * minus.im, turn = plus.im * minus.re - plus.re * minus.im;
    sums[i] = sums[i] + PlaneBlocks::of(scale * (p + m), -2 * scale * both, scale * (p - m), 2 * scale * turn);
  });
}

}  // namespace suite
