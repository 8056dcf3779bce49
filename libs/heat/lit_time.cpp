#include "heat/lit_time.h"

#include <algorithm>

namespace suite {

LitTime::LitTime(double begin, double step, size_t steps) : begin_(begin), step_(step) {
  pieces_.resize(steps), whole_.resize(steps + 1);
}

void LitTime::clear() {
  std::ranges::fill(pieces_, std::array<double, 3>{});
  std::ranges::fill(whole_, 0.0);
}

void LitTime::add_piece(size_t step, double from, double to, double weight) {
  if (step >= pieces_.size()) return;
  pieces_[step][0] += weight * (to - from);
  pieces_[step][1] += weight * (to * to - from * from) / 2;
  pieces_[step][2] += weight * (to * to * to - from * from * from) / 3;
}

void LitTime::add(const PointDay& day, double weight) {
  const auto steps = static_cast<double>(pieces_.size());
  const auto place = [&](size_t change) {
    return change < day.changes.size() ? std::clamp((day.changes[change] - begin_) / step_, 0.0, steps) : steps;
  };
  // Lit from one change to the next but one.
  for (size_t change = day.lit_first ? 0 : 1; change <= day.changes.size(); change += 2) {
    const double from = change == 0 ? 0 : place(change - 1), to = place(change);
    if (!(to > from)) continue;
    const auto first = static_cast<size_t>(from), last = static_cast<size_t>(to);
    const double in_first = from - static_cast<double>(first), in_last = to - static_cast<double>(last);
    if (first == last) {
      add_piece(first, in_first, in_last, weight);
      continue;
    }
    add_piece(first, in_first, 1, weight);
    if (in_last > 0) add_piece(last, 0, in_last, weight);
    whole_[first + 1] += weight, whole_[last] -= weight;
  }
}

double LitTime::total(std::span<const float> shares) const {
  double sum = 0, whole = 0;
  for (size_t m = 0; m < pieces_.size(); ++m) {
    whole += whole_[m];
    sum += (pieces_[m][0] + whole) * (shares.empty() ? 1 : double{shares[m]});
  }
  return sum;
}

void LitTime::by_step(std::span<float> out) const {
  double whole = 0;
  for (size_t m = 0; m < pieces_.size(); ++m) out[m] = static_cast<float>(pieces_[m][0] + (whole += whole_[m]));
}

}  // namespace suite
