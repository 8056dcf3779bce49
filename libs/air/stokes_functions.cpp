#include "air/stokes_functions.h"

#include <algorithm>

namespace suite {

StokesFunctions::StokesFunctions(int order, double mu, size_t degrees) : rows_(degrees) {
  std::vector<double> zero(degrees), plus(degrees), minus(degrees);
  wigner_d(order, 0, mu, zero), wigner_d(order, 2, mu, plus), wigner_d(order, -2, mu, minus);
  for (size_t l = 0; l < degrees; ++l) rows_[l] = {zero[l], (plus[l] + minus[l]) / 2, (plus[l] - minus[l]) / 2};
}

StokesMode scattered(const GreekMatrix& matrix, const StokesFunctions& out, const StokesFunctions& in,
                     const StokesMode& x) {
  StokesMode sum;
  for (size_t l = 0; l < std::min({matrix.degrees.size(), out.degrees(), in.degrees()}); ++l)
    sum += out.times(l, StokesFunctions::scattered(matrix.degrees[l], in.times(l, x)));
  return sum;
}

StokesMode of_beam(const GreekMatrix& matrix, int order, const StokesFunctions& out, const StokesFunctions& beam) {
  return (order == 0 ? 1 : 2) / (4 * kPi) * scattered(matrix, out, beam, {1, 0, 0, 0});
}

}  // namespace suite
