// Standard errors with the help of the problems beside: what four scrambles of a problem alone tell is too little.
//
// Through an edge or the cells of a map a problem's samples take few values, and light that is met now and then (a
// neighbouring slope, a gap) leaves most problems without a sample of it. Four scrambles that are dealt evenly then
// often agree to the last digit although all of them are off (in two of five problems of an uneven meadow at 16 paths,
// whose means then were 1 % off); others overstate. Their variance is right on the mean over problems, and the interval
// around a single one is not. So the variance of the mean becomes
//
//   V = (d E^2 + p B) / (d + p)
//
// with E the standard error from the problem's own scrambles (d degrees of freedom: one less than scrambles) and B what
// the problems around it let expect: the greater of
//
// - r S: S is the variance that the mean would have if its samples were independent; r, how much better than that they
//   are dealt, is sum w_j E_j^2 / sum w_j S_j over the 24 problems around, w_j = 1 / (1 + log2(S_j / S)^2), so that
//   smooth problems are compared with smooth ones and edges with edges (where the reference value has no S, as in a
//   band without light, with those that have none either: the mean of their E_j^2);
// - what those of about the same mean saw on all sides (around.h): samples that never met the rare light have no S.
//   Where that is nothing and E is 0, what any of them saw within four problems.
//
// p = kPriorDegrees, in proportion less where fewer than one is alike (sum w_j < 1). Where B is known far better than
// E^2, V has (d + p)^2 / d degrees of freedom (F. Satterthwaite, 1946): 12 with four scrambles, 14 with eight;
// intervals take Student's quantile for these, 2.18 and 2.14 for 95 %.
//
// This is the shrinkage of variances of G. Smyth, "Linear models and empirical Bayes methods for assessing differential
// expression in microarray experiments", Stat. Appl. Genet. Mol. Biol. 3(1), 2004, section 3, with a prior that differs
// from problem to problem.
//
// Assumes: problems beside each other look at things beside each other.
#pragma once
#include <cstdint>
#include <span>

namespace suite {

inline constexpr double kPriorDegrees = 3;
constexpr double pooled_degrees(double own) { return (own + kPriorDegrees) * (own + kPriorDegrees) / own; }

// [problem], row-major, in whole rows of `columns`.
struct PoolInput {
  uint32_t columns;
  size_t values;                    // of a problem
  size_t reference;                 // the value that scatter and around are of; the others go with it
  std::span<const double> scatter;  // S, (W/(m2 sr um))^2
  std::span<const double> around;   // standard error that those around let expect, W/(m2 sr um); 0 = nothing is known
};

// errors: [problem][value], standard errors; come in from the problems' own scrambles, go out as above; such as are not
// finite stay as they are and tell others nothing. own_degrees: d > 0.
void pool_errors(const PoolInput& input, double own_degrees, std::span<double> errors);

}  // namespace suite
