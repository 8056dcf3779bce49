#include "heat/exchange_through.h"

#include <algorithm>

#include "base/error.h"

namespace suite {

ExchangeThrough::ExchangeThrough(const ExchangeMatrix& first, const ExchangePaths& paths) : first_(&first) {
  if (paths.rows.size() == paths.faces()) return;
  std::vector<ExchangeMatrix> later;
  for (size_t k = 1; k < paths.rows.intervals; ++k)
    later.push_back(paths.in_interval(k).matrix(first.outsides()).differing(first, kAlike));
  later_ = std::make_shared<const std::vector<ExchangeMatrix>>(std::move(later));
}

size_t ExchangeThrough::entries() const {
  size_t sum = first_->entries();
  if (later_)
    for (const ExchangeMatrix& m : *later_) sum += m.entries();
  return sum;
}

void ExchangeThrough::receive_one(size_t element, const Histories& emitted, std::span<const std::vector<float>> shares,
                                  std::span<double> received) const {
  first_->receive_one(element, emitted, received);
  if (!later_ || std::ranges::none_of(*later_, [&](const ExchangeMatrix& m) { return m.has_row(element); })) return;
  SUITE_CHECK_EQ(shares.size(), later_->size() + 1);
  std::vector<double> first(received.begin(), received.end()), other(received.size());
  for (size_t m = 0; m < received.size(); ++m) received[m] *= double{shares[0][m]};
  for (size_t k = 0; k < later_->size(); ++k) {
    const ExchangeMatrix& matrix = (*later_)[k];
    if (matrix.has_row(element)) matrix.receive_one(element, emitted, other);
    const std::vector<double>& now = matrix.has_row(element) ? other : first;
    for (size_t m = 0; m < received.size(); ++m) received[m] += double{shares[k + 1][m]} * now[m];
  }
}

}  // namespace suite
