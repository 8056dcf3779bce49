// The matrix of exchange from paths: what two faces exchange is one number, whichever of both is asked.
//
// Method: X[i][j] = area x emissivity of i times its share to j is symmetric. Paths from both ends estimate it, each
// with a variance in proportion to the area x emissivity a of where they start, so that the weights a_j / (a_i + a_j)
// and a_i / (a_i + a_j) are best. Rows then sum to a only within the noise; factors d with d_i d_j X[i][j] summing to a
// in every row restore that without giving up the symmetry (P. A. Knight, D. Ruiz, B. Ucar, "A symmetry preserving
// algorithm for matrix scaling", SIAM J. Matrix Anal. Appl. 35, 2014). Closed backs start no paths: what ends there is
// known from one end only, as of the outsides. What is there for a part of the time emits as if it always were, and is
// seen for its share: its own row is of its own paths alone.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "heat/exchange_paths.h"

namespace suite {

namespace {

constexpr int kTurns = 60;        // of scaling; where it is not done by then, rows are made to sum to 1 each for itself
constexpr double kEnough = 1e-8;  // of a row's sum

// By face: ends in their order and what is exchanged with them, W/m2 of emission x m2.
struct Rows {
  std::vector<size_t> begin;
  std::vector<uint32_t> end;
  std::vector<float> exchanged;
  void make_room(size_t faces, size_t entries) {
    begin.reserve(faces + 1), end.reserve(entries), exchanged.reserve(entries);
    begin = {0};
  }
};

// Sums up what has one end; entries need no order.
void put_row(Rows& rows, std::vector<std::pair<uint32_t, double>>& row) {
  std::sort(row.begin(), row.end());
  for (size_t k = 0; k < row.size();) {
    double sum = 0;
    const uint32_t end = row[k].first;
    for (; k < row.size() && row[k].first == end; ++k) sum += row[k].second;
    rows.end.push_back(end), rows.exchanged.push_back(static_cast<float>(sum));
  }
  rows.begin.push_back(rows.end.size());
}

// Shares of every face's own paths.
Rows own_shares(const ExchangePaths& paths) {
  Rows rows;
  const size_t each = size_t{paths.blocks} * paths.paths;
  rows.make_room(paths.faces(), paths.faces() * each);
  std::vector<std::pair<uint32_t, double>> row;
  for (size_t f = 0; f < paths.faces(); ++f) {
    row.clear();
    double sum = 0;
    for (size_t k = f * each; k < (f + 1) * each; ++k) sum += double{paths.weights[k]};
    for (size_t k = f * each; k < (f + 1) * each; ++k)
      if (paths.weights[k] > 0) row.emplace_back(paths.ends[k], double{paths.weights[k]} / sum);
    put_row(rows, row);
  }
  return rows;
}

// From both ends.
Rows joined(const ExchangePaths& paths, const Rows& own, const std::vector<double>& a) {
  const size_t n = a.size();
  std::vector<size_t> next(n + 1, 0);  // where the next that ends at a face goes
  for (size_t i = 0; i < n; ++i)
    for (size_t k = own.begin[i]; k < own.begin[i + 1]; ++k)
      if (own.end[k] < n && own.end[k] != i) ++next[own.end[k] + 1];
  for (size_t i = 0; i < n; ++i) next[i + 1] += next[i];
  std::vector<uint32_t> from(next[n]);
  std::vector<float> share(next[n]);
  const std::vector<size_t> begin = next;
  for (uint32_t i = 0; i < n; ++i)
    for (size_t k = own.begin[i]; k < own.begin[i + 1]; ++k)
      if (const uint32_t j = own.end[k]; j < n && j != i) from[next[j]] = i, share[next[j]++] = own.exchanged[k];
  const auto weight = [&](size_t i, size_t j) { return a[i] + a[j] > 0 ? a[i] * a[j] / (a[i] + a[j]) : 0; };
  const auto there = [&](size_t j) { return paths.always_there(j) ? 1 : double{paths.presence.front()[j]}; };
  Rows rows;
  rows.make_room(n, own.end.size() + from.size());
  std::vector<std::pair<uint32_t, double>> row;
  for (uint32_t i = 0; i < n; ++i) {
    row.clear();
    const bool both = paths.always_there(i);
    for (size_t k = own.begin[i]; k < own.begin[i + 1]; ++k) {
      const uint32_t j = own.end[k];
      row.emplace_back(j, double{own.exchanged[k]} * (both && j < n && j != i ? weight(i, j) : a[i]));
    }
    for (size_t k = begin[i]; both && k < begin[i + 1]; ++k)
      row.emplace_back(from[k], double{share[k]} * weight(i, from[k]) * there(from[k]));
    // What neither emits nor takes anything, and a block of paths that were all drawn in vain: whatever the row is.
    const auto is_nothing = [](const auto& entry) { return !(entry.second > 1e-30); };
    if (std::all_of(row.begin(), row.end(), is_nothing)) row = {{i, 1}};
    put_row(rows, row);
  }
  return rows;
}

// The factor of every face.
std::vector<double> factors(const ExchangePaths& paths, const Rows& rows, const std::vector<double>& a) {
  const size_t n = a.size();
  std::vector<double> d(n, 1.0), off(n, 0.0);
  for (int turn = 0; turn < kTurns; ++turn) {
    parallel_for(0, n, 256, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        double sum = 0;
        for (size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k)
          sum += double{rows.exchanged[k]} * (rows.end[k] < n ? d[rows.end[k]] : 1);
        off[i] = a[i] > 0 && sum > 0 && paths.always_there(i) ? d[i] * sum / a[i] : 1;
      }
    });
    double worst = 0;
    for (size_t i = 0; i < n; ++i) worst = std::fmax(worst, std::fabs(off[i] - 1)), d[i] /= std::sqrt(off[i]);
    if (worst < kEnough) break;
  }
  return d;
}

}  // namespace

ExchangeMatrix ExchangePaths::matrix(size_t outsides) const {
  const size_t n = faces();
  std::vector<double> a;
  for (size_t f = 0; f < n; ++f) a.push_back(area[f] * emissivity[f]);
  Rows both = joined(*this, own_shares(*this), a);
  const std::vector<double> d = factors(*this, both, a);
  parallel_for(0, n, 256, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const auto exchanged = [&](size_t k) {
        return double{both.exchanged[k]} * (both.end[k] < n ? d[both.end[k]] : 1);
      };
      double sum = 0;
      for (size_t k = both.begin[i]; k < both.begin[i + 1]; ++k) sum += exchanged(k);
      for (size_t k = both.begin[i]; k < both.begin[i + 1]; ++k)
        both.exchanged[k] = static_cast<float>(exchanged(k) / sum);
      for (size_t k = both.begin[i]; k < both.begin[i + 1]; ++k)
        if (both.end[k] >= n + outsides) both.end[k] -= static_cast<uint32_t>(n + outsides);
    }
  });
  return ExchangeMatrix::of_rows(outsides, std::move(both.begin), std::move(both.end), std::move(both.exchanged));
}

}  // namespace suite
