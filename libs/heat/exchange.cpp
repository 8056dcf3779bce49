#include "heat/exchange.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "math/anderson.h"
#include "spectral/planck.h"

namespace suite {

ExchangeMatrix::ExchangeMatrix(size_t elements, size_t outsides)
    : elements_(elements), outsides_(outsides), begins_{0} {
  SUITE_CHECK(elements + outsides < UINT32_MAX);
}

void ExchangeMatrix::add_row(std::span<const Entry> row) {
  const size_t element = factors_.size();
  SUITE_CHECK_LT(element, elements_);
  std::map<uint32_t, double> shares;
  double sum = 0;
  for (const Entry& entry : row) {
    if (entry.end >= elements_ + outsides_)
      throw Error(strf("the exchange of element %zu ends at %u", element, entry.end),
                  strf("there are %zu elements and %zu outsides", elements_, outsides_));
    if (!(entry.share >= 0 && std::isfinite(entry.share)))
      throw Error(strf("element %zu has a share of exchange of %g", element, entry.share), "0 to 1");
    shares[entry.end] += entry.share;
    sum += entry.share;
  }
  if (!(std::fabs(sum - 1) <= 1e-6))
    throw Error(strf("the shares of exchange of element %zu sum to %.9g", element, sum), "1");
  double stored = 0;
  for (const auto& [end, share] : shares) {
    const auto rounded = static_cast<float>(share);
    if (rounded == 0) continue;
    ends_.push_back(end);
    shares_.push_back(rounded);
    stored += rounded;
  }
  begins_.push_back(ends_.size());
  factors_.push_back(1 / stored);
}

void ExchangeMatrix::receive(std::span<const double> emitted, size_t moments, std::span<double> received) const {
  SUITE_CHECK_EQ(factors_.size(), elements_);
  SUITE_CHECK_EQ(emitted.size(), (elements_ + outsides_) * moments);
  SUITE_CHECK_EQ(received.size(), elements_ * moments);
  parallel_for(0, elements_, 64, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      double* sum = &received[i * moments];
      std::fill(sum, sum + moments, 0.0);
      for (size_t k = begins_[i]; k < begins_[i + 1]; ++k) {
        const double share = shares_[k] * factors_[i];
        const double* from = &emitted[ends_[k] * moments];
#pragma GCC ivdep
        for (size_t m = 0; m < moments; ++m) sum[m] += share * from[m];
      }
    }
  });
}

namespace {

double kelvin_of(double emitted) { return std::sqrt(std::sqrt(emitted / kStefanBoltzmann)); }

// The largest difference of two histories of emitted flux, as temperatures.
double largest_change(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!(b[i] > 0 && b[i] < INFINITY))
      throw Error(strf("coupled elements answer with an emitted flux of %g W/m2", b[i]), "positive and finite");
    largest = std::fmax(largest, std::fabs(kelvin_of(std::fmax(a[i], 0.0)) - kelvin_of(b[i])));
  }
  return largest;
}

}  // namespace

CouplingResult couple_histories(const ExchangeMatrix& exchange, size_t moments, std::span<double> emitted,
                                const Respond& respond, const CouplingOptions& options) {
  SUITE_CHECK(moments > 0 && options.tolerance > 0);
  const size_t own = exchange.elements() * moments;
  SUITE_CHECK_EQ(emitted.size(), own + exchange.outsides() * moments);
  std::vector<double> received(own), present(emitted.begin(), emitted.begin() + static_cast<std::ptrdiff_t>(own));
  std::vector<double> answer(own);
  Anderson anderson(std::vector<double>(own, 1.0), options.memory);
  CouplingResult result;
  for (double last = 0;; last = result.change) {
    std::copy(present.begin(), present.end(), emitted.begin());
    exchange.receive(emitted, moments, received);
    respond(received, answer);
    ++result.sweeps;
    result.change = largest_change(present, answer);
    // Of changes that shrink by a ratio, this much is still to come.
    const double ratio = last > 0 ? std::clamp(result.change / last, 0.0, 0.99) : 0.9;
    result.distance = result.change * ratio / (1 - ratio);
    if (result.change == 0 || (result.sweeps > 1 && result.distance <= options.tolerance)) {
      std::copy(answer.begin(), answer.end(), emitted.begin());
      return result;
    }
    if (result.sweeps >= options.most_sweeps)
      throw Error(strf("coupled surfaces still change by %g K after %d sweeps", result.change, result.sweeps),
                  "allow more sweeps, or a memory for Anderson's method");
    std::vector<double> next = anderson.next(present, answer);
    const bool sound = std::all_of(next.begin(), next.end(), [](double m) { return m > 0; });
    present = sound ? std::move(next) : answer;
  }
}

}  // namespace suite
