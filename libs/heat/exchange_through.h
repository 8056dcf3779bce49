// The exchange through intervals of rest (rests.h): one matrix for each, of which those after the first keep the rows
// in which they differ from it.
#pragma once
#include <memory>

#include "heat/exchange_paths.h"

namespace suite {

class ExchangeThrough {
 public:
  // The same at all times. The matrix must outlive this.
  ExchangeThrough(const ExchangeMatrix& always) : first_(&always) {}
  // By interval, one after the other; the first must outlive this. Rows whose shares differ by less than kAlike
  // altogether, as far away neighbours make each other do, are those of the first.
  ExchangeThrough(const ExchangeMatrix& first, const ExchangePaths& paths);
  static constexpr double kAlike = 1e-4;

  size_t elements() const { return first_->elements(); }
  size_t outsides() const { return first_->outsides(); }
  const ExchangeMatrix& first() const { return *first_; }
  size_t entries() const;
  // As ExchangeMatrix::receive_one(). shares: of each moment by interval, as interval_shares() has them; not asked for
  // with one interval.
  void receive_one(size_t element, const Histories& emitted, std::span<const std::vector<float>> shares,
                   std::span<double> received) const;

 private:
  const ExchangeMatrix* first_;
  std::shared_ptr<const std::vector<ExchangeMatrix>> later_;
};

}  // namespace suite
