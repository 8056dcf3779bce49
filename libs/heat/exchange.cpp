#include "heat/exchange.h"

#include <algorithm>
#include <cmath>
#include <optional>

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
  std::vector<Entry> shares(row.begin(), row.end());
  double sum = 0;
  for (const Entry& entry : shares) {
    if (entry.end >= elements_ + outsides_)
      throw Error(strf("the exchange of element %zu ends at %u", element, entry.end),
                  strf("there are %zu elements and %zu outsides", elements_, outsides_));
    if (!(entry.share >= 0 && std::isfinite(entry.share)))
      throw Error(strf("element %zu has a share of exchange of %g", element, entry.share), "0 to 1");
    sum += entry.share;
  }
  if (!(std::fabs(sum - 1) <= 1e-6))
    throw Error(strf("the shares of exchange of element %zu sum to %.9g", element, sum), "1");
  const auto by_end = [](const Entry& a, const Entry& b) { return a.end < b.end; };
  if (!std::is_sorted(shares.begin(), shares.end(), by_end)) std::stable_sort(shares.begin(), shares.end(), by_end);
  double stored = 0;
  for (size_t k = 0; k < shares.size();) {
    const uint32_t end = shares[k].end;
    double share = 0;
    for (; k < shares.size() && shares[k].end == end; ++k) share += shares[k].share;
    const auto rounded = static_cast<float>(share);
    if (rounded == 0) continue;
    ends_.push_back(end);
    shares_.push_back(rounded);
    stored += rounded;
  }
  begins_.push_back(ends_.size());
  factors_.push_back(1 / stored);
}

ExchangeMatrix ExchangeMatrix::of_rows(size_t outsides, std::vector<size_t> begins, std::vector<uint32_t> ends,
                                       std::vector<float> shares) {
  ExchangeMatrix m(begins.size() - 1, outsides);
  SUITE_CHECK(begins.back() == ends.size() && ends.size() == shares.size());
  m.begins_ = std::move(begins), m.ends_ = std::move(ends), m.shares_ = std::move(shares);
  for (size_t i = 0; i < m.elements_; ++i) {
    double sum = 0;
    for (size_t k = m.begins_[i]; k < m.begins_[i + 1]; ++k) {
      SUITE_CHECK(m.ends_[k] < m.elements_ + outsides && m.shares_[k] >= 0);
      sum += double{m.shares_[k]};
    }
    SUITE_CHECK(sum > 0 && std::isfinite(sum));
    m.factors_.push_back(1 / sum);
  }
  return m;
}

ExchangeMatrix ExchangeMatrix::differing(const ExchangeMatrix& other, double alike) && {
  SUITE_CHECK(elements_ == other.elements_ && outsides_ == other.outsides_);
  const auto differ = [&](size_t row) {
    double off = 0;
    size_t k = begins_[row], j = other.begins_[row];
    const size_t end = begins_[row + 1], other_end = other.begins_[row + 1];
    while ((k < end || j < other_end) && off < alike) {
      const bool here = k < end && (j == other_end || ends_[k] <= other.ends_[j]),
                 there = j < other_end && (k == end || other.ends_[j] <= ends_[k]);
      off += std::fabs((here ? shares_[k] * factors_[row] : 0) - (there ? other.shares_[j] * other.factors_[row] : 0));
      k += here, j += there;
    }
    return off >= alike;
  };
  ExchangeMatrix out(elements_, outsides_);
  for (size_t row = 0; row < elements_; ++row) {
    if (differ(row))
      for (size_t k = begins_[row]; k < begins_[row + 1]; ++k)
        out.ends_.push_back(ends_[k]), out.shares_.push_back(shares_[k]);
    out.begins_.push_back(out.ends_.size()), out.factors_.push_back(factors_[row]);
  }
  return out;
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

void ExchangeMatrix::receive_one(size_t element, const Histories& emitted, std::span<double> received) const {
  double* sum = received.data();
  double least = 0;
  std::fill(received.begin(), received.end(), 0.0);
  for (size_t k = begins_[element]; k < begins_[element + 1]; ++k) {
    const double share = shares_[k] * factors_[element];
    least += share * emitted.least(ends_[k]);
    const std::span<const float> from = emitted.above(ends_[k]);
#pragma GCC ivdep
    for (size_t m = 0; m < from.size(); ++m) sum[m] += share * static_cast<double>(from[m]);
  }
  for (double& r : received) r += least;
}

namespace {

constexpr size_t kPiecesTogether = 32;  // answer to the same

double kelvin_of(double emitted) { return std::sqrt(std::sqrt(emitted / kStefanBoltzmann)); }

// K, of a row's history and the answer to it.
double change_in_kelvin(const Histories& before, size_t row, std::span<const double> answer) {
  double largest = 0;
  for (size_t m = 0; m < answer.size(); ++m) {
    const double after = answer[m];
    if (!(after > 0 && after < INFINITY))
      throw Error(strf("an element of a surface would emit %g W/m2 at moment %zu of the span", after, m),
                  "a shorter step_s, or layers that hold more heat");
    largest = std::fmax(largest, std::fabs(kelvin_of(std::fmax(before.at(row, m), 0.0)) - kelvin_of(after)));
  }
  return largest;
}

// The largest difference of two histories of emitted flux, as temperatures, over the rows of the second.
double largest_change(const Histories& a, const Histories& b) {
  std::vector<double> largest(b.rows(), 0);
  parallel_for(0, b.rows(), 64, [&](size_t first, size_t last) {
    std::vector<double> answer(b.moments());
    for (size_t row = first; row < last; ++row) {
      b.get(row, answer);
      largest[row] = change_in_kelvin(a, row, answer);
    }
  });
  return *std::max_element(largest.begin(), largest.end());
}

// What histories cannot tell of the temperature of the element that they round most, K.
double least_change(const Histories& h, size_t rows) {
  double most = 0;
  for (size_t row = 0; row < rows; ++row) {
    const auto above = h.above(row);
    const double swing = double{*std::max_element(above.begin(), above.end())}, top = h.least(row) + swing;
    most = std::fmax(most, kelvin_of(top) / 4 * swing / top);
  }
  return std::ldexp(2 * most, -24);
}

// What Anderson's method makes of an answer to `present`, where that is sound.
void accelerate(Anderson& anderson, const Histories& present, Histories& answer) {
  std::vector<double> before = present.values();
  before.resize(answer.rows() * answer.moments());  // without the outsides
  const std::vector<double> next = anderson.next(before, answer.values());
  if (!std::all_of(next.begin(), next.end(), [](double m) { return m > 0; })) return;
  for (size_t row = 0; row < answer.rows(); ++row) answer.set(row, {&next[row * answer.moments()], answer.moments()});
}

// Sweeps until there. sweep: returns the largest change, K; least: what histories cannot tell.
CouplingResult settle(const std::function<double()>& sweep, const std::function<double()>& least_of,
                      const CouplingOptions& options) {
  SUITE_CHECK(options.tolerance > 0);
  CouplingResult result;
  for (double last = 0;; last = result.change) {
    result.change = sweep();
    ++result.sweeps;
    // Of changes that shrink by a ratio, this much is still to come.
    const double ratio = last > 0 ? std::clamp(result.change / last, 0.0, 0.99) : 0.9;
    result.distance = result.change * ratio / (1 - ratio);
    const double least = least_of();
    if (result.change <= least) result.distance = std::fmin(result.distance, least);
    if (result.change == 0 || (result.sweeps > 1 && (result.distance <= options.tolerance || result.change <= least)))
      return result;
    if (result.sweeps >= options.most_sweeps)
      throw Error(strf("coupled surfaces still change by %g K after %d sweeps", result.change, result.sweeps),
                  "allow more sweeps, or a memory for Anderson's method");
  }
}

}  // namespace

double answer_in_place(Histories& emitted, size_t pieces,
                       const std::function<void(size_t piece, const PutEmitted& put)>& answer) {
  struct Answers {
    std::vector<uint32_t> rows;
    std::vector<double> values;
    double change = 0;
  };
  const size_t moments = emitted.moments();
  double largest = 0;
  for (size_t first = 0; first < pieces; first += kPiecesTogether) {
    std::vector<Answers> answers(std::min(kPiecesTogether, pieces - first));
    parallel_for(0, answers.size(), 1, [&](size_t begin, size_t end) {
      for (size_t k = begin; k < end; ++k)
        answer(first + k, [&](uint32_t row, std::span<const double> values) {
          Answers& a = answers[k];
          a.rows.push_back(row), a.values.insert(a.values.end(), values.begin(), values.end());
          a.change = std::fmax(a.change, change_in_kelvin(emitted, row, values));
        });
    });
    for (const Answers& a : answers) {
      for (size_t i = 0; i < a.rows.size(); ++i) emitted.set(a.rows[i], {&a.values[i * moments], moments});
      largest = std::fmax(largest, a.change);
    }
  }
  return largest;
}

CouplingResult relax_histories(Histories& emitted, size_t elements, const Sweep& sweep,
                               const CouplingOptions& options) {
  SUITE_CHECK(emitted.moments() > 0 && elements > 0 && elements <= emitted.rows());
  return settle([&] { return sweep(emitted); }, [&] { return least_change(emitted, elements); }, options);
}

CouplingResult couple_histories(const ExchangeMatrix& exchange, Histories& emitted, const Respond& respond,
                                const CouplingOptions& options) {
  SUITE_CHECK(emitted.moments() > 0 && exchange.elements() > 0);
  SUITE_CHECK_EQ(emitted.rows(), exchange.elements() + exchange.outsides());
  Histories answer(exchange.elements(), emitted.moments());
  std::optional<Anderson> anderson;
  if (options.memory > 0) anderson.emplace(std::vector<double>(answer.rows() * answer.moments(), 1.0), options.memory);
  bool first = true;
  const CouplingResult result = settle(
      [&] {
        if (!first && anderson) accelerate(*anderson, emitted, answer);
        if (!first) emitted.take(answer);
        first = false;
        respond(emitted, answer);
        return largest_change(emitted, answer);
      },
      [&] { return least_change(answer, answer.rows()); }, options);
  emitted.take(answer);
  return result;
}

}  // namespace suite
