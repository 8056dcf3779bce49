// Running statistics in double, and the little inferential statistics that estimates and tests need.
#pragma once
#include <cmath>
#include <cstdint>
#include <span>

namespace suite {

struct Estimate {
  double mean = 0;
  double stderr_ = 0;  // standard error of the mean
  uint64_t n = 0;
  uint64_t failures = 0;  // samples that were NaN or negative and not averaged in
};

// Welford's recurrence; merge after Chan, Golub & LeVeque 1979.
class RunningStats {
 public:
  void add(double x) {
    ++n_;
    const double delta = x - mean_;
    mean_ += delta / static_cast<double>(n_);
    m2_ += delta * (x - mean_);
  }
  void merge(const RunningStats& o) {
    if (!o.n_) return;
    const double n = static_cast<double>(n_ + o.n_), delta = o.mean_ - mean_;
    m2_ += o.m2_ + delta * delta * static_cast<double>(n_) * static_cast<double>(o.n_) / n;
    mean_ += delta * static_cast<double>(o.n_) / n;
    n_ += o.n_;
  }
  uint64_t n() const { return n_; }
  double mean() const { return mean_; }
  double variance() const { return n_ > 1 ? m2_ / static_cast<double>(n_ - 1) : 0; }  // unbiased
  double stderr_of_mean() const { return n_ > 1 ? std::sqrt(variance() / static_cast<double>(n_)) : 0; }
  Estimate estimate() const { return {mean_, stderr_of_mean(), n_, 0}; }

 private:
  uint64_t n_ = 0;
  double mean_ = 0, m2_ = 0;
};

// Regularised lower incomplete gamma P(a, x); a > 0, x >= 0 (Abramowitz & Stegun 6.5.29, Lentz's fraction 6.5.31).
double gamma_p(double a, double x);
// The upper one, Q = 1 - P, with its relative digits kept where it is small.
double gamma_q(double a, double x);
// Probability that a chi-square variable with k degrees of freedom exceeds x; far tails keep their relative digits.
double chi_square_tail(double x, double k);
// Two-sided tail of a standard normal beyond |z|.
double normal_two_sided(double z);
// Quantile t with P(|T| <= t) = confidence of Student's distribution with n degrees of freedom (n >= 1).
double student_t_quantile(double confidence, int n);

// Pearson's chi-square of observed counts against expected ones; cells expected below `pool_below` are pooled.
// Returns the p-value; `degrees` receives the degrees of freedom used.
double chi_square_test(std::span<const double> observed, std::span<const double> expected, double pool_below,
                       int* degrees = nullptr);

}  // namespace suite
