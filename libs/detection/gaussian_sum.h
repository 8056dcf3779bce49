// A baseline and Gaussians over even samples: values, sums of least squares, and their fit by Levenberg and Marquardt.
//
// Times are in samples: the sums are then of order one. Parameters: baseline, then amplitude, centre, width of each
// Gaussian. Based on: D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", J. SIAM 11,
// 1963.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace suite {

// A symmetric positive matrix of n rows as its factor L of L L^T, in place; false when it is none.
bool factor_matrix(std::vector<double>& a, size_t n);
// x of L L^T x = x, in place.
void solve_factored(const std::vector<double>& l, size_t n, std::vector<double>& x);

// weight(k, value): one over the variance of sample k, of which the sum expects `value`.
using SampleWeight = std::function<double(size_t, double)>;

struct GaussianSum {
  size_t samples = 0, pulses = 0;
  struct Sums {
    std::vector<double> square, side;  // J^T W J (lower half) and J^T W r
    double chi_square = 0;
  };
  size_t size() const { return 1 + 3 * pulses; }
  // Of the middle of a sample, and its slopes.
  double value(const std::vector<double>& p, size_t k, std::vector<double>& slope) const;
  Sums sums(const std::vector<double>& p, std::span<const double> signal, const SampleWeight& weight) const;
};

struct SumFit {
  std::vector<double> p;
  double chi_square = 0;
  bool converged = false;
};
// enough: a fall of chi-square that is not worth another step. Widths stay at least_width or above.
SumFit fit_gaussians(std::vector<double> p, std::span<const double> signal, const SampleWeight& weight,
                     double least_width, int steps, double enough);

}  // namespace suite
