// Least squares with and without the condition that no unknown is negative. Dense, small, in double.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace suite {

// The x that minimises |A x - b|; columns[j] is column j of A, all as long as b, at most as many as b has entries.
// Householder's QR; unknowns that add nothing within rounding get 0.
std::vector<double> least_squares(const std::vector<std::vector<double>>& columns, std::span<const double> b);

// The active set of a non-negative least-squares fit, kept between calls.
struct NonNegativeFit {
  std::vector<size_t> chosen;  // columns in use
  std::vector<double> x;       // > 0, of each
};
// Adds columns of the candidates to the fit, the steepest first, until done(fit) or `most` are in use or nothing
// improves; drops those that would turn negative. column(j): column j of A. preferred(j): counts as if three times as
// steep.
void fit_non_negative(std::span<const size_t> candidates, const std::function<std::span<const double>(size_t)>& column,
                      std::span<const double> b, const std::function<bool(size_t)>& preferred,
                      const std::function<bool(const NonNegativeFit&)>& done, size_t most, NonNegativeFit& fit);

}  // namespace suite
