// Spectral multiple importance sampling: the densities of one choice, or of all choices of a path, under every hero
// wavelength.
//
// What is drawn from the shapes at one hero wavelength could have been drawn from those at every other one. With P_k
// the probability of hero k and r_k its density over that of the hero that drew, the one-sample balance heuristic
// divides by
//   A = sum P_k r_k,
// take() multiplies the r_k of one more choice, mean() is A, and divide() makes A = 1 where the next choice begins, so
// that nothing overflows on paths of any length. Based on: E. Veach & L. Guibas, "Optimally combining sampling
// techniques for Monte Carlo rendering", SIGGRAPH 1995; A. Wilkie et al., "Hero wavelength spectral sampling", EGSR
// 2014.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace suite {

// K: heroes at most; how many there are is told by P, and by take().
template <int K>
class HeroDensities {
 public:
  double& operator[](size_t k) { return r_[k]; }
  double operator[](size_t k) const { return r_[k]; }
  // The path has chosen nothing yet.
  void start(size_t heroes) { std::fill_n(r_, heroes, 1.0); }
  // One more choice, of density p[k] under hero k and `own` under the one that drew it.
  template <class P>
  void take(size_t heroes, const P& p, double own) {
    for (size_t k = 0; k < heroes; ++k) r_[k] *= double{p[k]} / own;
  }
  // take(), and the mean behind the choice.
  template <class D>
  double take_mean(std::span<const double> P, const D& p, double own) {
    double sum = 0;
    for (size_t k = 0; k < P.size(); ++k) {
      r_[k] *= double{p[k]} / own;
      sum += P[k] * r_[k];
    }
    return sum;
  }
  // Those of `from` with one more choice.
  template <class P>
  void set(size_t heroes, const HeroDensities& from, const P& p, double own) {
    for (size_t k = 0; k < heroes; ++k) r_[k] = from.r_[k] * double{p[k]} / own;
  }
  double part(std::span<const double> P, size_t k) const { return P[k] * r_[k]; }  // of the mean
  double mean(std::span<const double> P) const { return mean_with(P, 0); }
  // The same beside another way to draw it all, whose mean is `first`.
  double mean_with(std::span<const double> P, double first) const {
    double sum = first;
    for (size_t k = 0; k < P.size(); ++k) sum += P[k] * r_[k];
    return sum;
  }
  // Of what follows: a density p[k], of which a share is left.
  template <class D>
  double mean(std::span<const double> P, const D& p) const {
    double sum = 0;
    for (size_t k = 0; k < P.size(); ++k) sum += P[k] * r_[k] * p[k];
    return sum;
  }
  template <class D>
  double mean(std::span<const double> P, const D& p, std::span<const double> share) const {
    double sum = 0;
    for (size_t k = 0; k < P.size(); ++k) sum += P[k] * r_[k] * p[k] * share[k];
    return sum;
  }
  void divide(size_t heroes, double by) {
    for (size_t k = 0; k < heroes; ++k) r_[k] /= by;
  }

 private:
  double r_[K];
};

}  // namespace suite
