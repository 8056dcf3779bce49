// Sums of the problems of one capture, and what follows from them.
//
// Everything is kept per independent scramble, which is where standard errors come from, and joined over the scrambles
// in their order when it is asked for. What stands in a scramble's row is a function of how many of its samples are in,
// and of nothing else: not of where, when and beside what they were computed. So a capture may be computed in parts, by
// problems or by scrambles, and joined to the same bits.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "estimate/deal.h"

namespace suite {

class Accumulators {
 public:
  // What a problem gathers.
  struct Shape {
    size_t problems = 0;
    size_t bands = 0;        // values a problem: [channel][bin][band]
    int scrambles = 4;       // 4 or 8
    size_t truth_slots = 0;  // doubles of truth
    bool missing = false;    // light may be lost (transport/lost_light.h), and what is known of it is kept
    size_t bytes() const;    // of all problems
    bool operator==(const Shape&) const = default;
  };
  explicit Accumulators(const Shape& shape);

  const Shape& shape() const { return shape_; }
  int scrambles() const { return shape_.scrambles; }
  size_t bands() const { return shape_.bands; }
  size_t problems() const { return shape_.problems; }
  double* sums(size_t problem, int scramble) { return &sums_[row(problem, scramble) * shape_.bands]; }
  const double* sums(size_t problem, int scramble) const { return &sums_[row(problem, scramble) * shape_.bands]; }

  // Samples taken: of one scramble, of all.
  uint32_t taken(size_t problem, int scramble) const { return taken_[row(problem, scramble)]; }
  uint32_t paths(size_t problem) const;
  // One more sample of a scramble is taken.
  void take(size_t problem, int scramble) { ++taken_[row(problem, scramble)]; }
  // All scrambles hold what the first n samples deal them.
  void set_paths(size_t problem, uint32_t n);
  // The number of the first sample that the scrambles of a set have not taken; 2^32 - 1 for a set that holds none of
  // ours.
  uint32_t next(size_t problem, Scrambles of) const;
  // Rejected samples: of one scramble, of all.
  uint32_t& failures(size_t problem, int scramble) { return failures_[row(problem, scramble)]; }
  uint32_t failures(size_t problem, int scramble) const { return failures_[row(problem, scramble)]; }
  uint32_t failures(size_t problem) const;
  // Samples that were averaged in: of one scramble, of all.
  uint32_t accepted(size_t problem, int scramble) const {
    return taken(problem, scramble) - failures(problem, scramble);
  }
  uint32_t accepted(size_t problem) const { return paths(problem) - failures(problem); }
  // Throughput cut at the maximum number of nodes.
  float& truncated(size_t problem, int scramble) { return truncated_[row(problem, scramble)]; }
  // What single samples are at the reference band (of the first bin): the largest of them, for the tail indicator, and
  // the sum of their squares, from which their scatter follows.
  void note_sample(size_t problem, int scramble, double value) {
    const size_t r = row(problem, scramble);
    largest_[r] = std::max(largest_[r], static_cast<float>(value));
    squares_[r] += value * value;
  }
  float largest(size_t problem) const;
  // The variance that the mean of a problem would have at the reference band if its accepted samples were independent:
  // their variance over their number; 0 for fewer than two. mean: of the reference band.
  double scatter(size_t problem, double mean) const;

  // Light that samples are known to have missed, with what they carried. light: its sums, bands() values. reference:
  // its sum at the reference band, and that of its squares over the chance of having met it, which is the square that
  // meeting it by chance would have summed to; infinite where nothing but an explicit sample finds it.
  struct Missing {
    double* light;
    double* reference;
    double* square;
  };
  bool keeps_missing() const { return shape_.missing; }
  Missing missing(size_t problem, int scramble) {
    const size_t r = row(problem, scramble);
    return {&missing_[r * shape_.bands], &missing_of_[2 * r], &missing_of_[2 * r + 1]};
  }
  // One value of the missing light, over all scrambles.
  double missing_light(size_t problem, size_t value) const;

  // How much lower than they should be the means of a problem are, as far as that is known.
  //
  // cut: what is cut at the maximum number of nodes, relative to the mean. A share T of the throughput is cut where
  // paths end; if what lies beyond shines as the problem itself does, L = mean + T L and the mean lacks T / (1 - T) of
  // itself. That is exact where every node sees the same light (cavities, isothermal boxes), too much where paths lose
  // themselves in the dark, too little where they are on their way to the light. T is known at the reference
  // wavelength and taken for all bands; 0.999 at most, where paths lose nothing at all.
  // missing: what of the missing light (per value, missing_light() / accepted()) counts. Meeting it by chance h times
  // has a relative error of 1 / sqrt(h); with h expected meetings less than one, all of it is likely to be missing:
  // min(1, 1 / sqrt(h)). From kEnoughMeetings on the samples themselves tell their error, and 0 counts.
  struct Shortfall {
    double cut = 0, missing = 0;
  };
  static constexpr double kEnoughMeetings = 20;
  Shortfall shortfall(size_t problem) const;
  // What the means of a problem, bands() values, are known to lack, value by value; empty when that is nothing.
  std::vector<double> lacking(size_t problem, std::span<const double> means) const;

  // Truth as its collectors keep it (transport/truth); the rows of a problem's scrambles stand behind one another.
  size_t truth_slots() const { return shape_.truth_slots; }
  double* truth(size_t problem, int scramble) { return truth_.data() + row(problem, scramble) * shape_.truth_slots; }
  std::span<const double> truth(size_t problem) const {
    const size_t width = shape_.truth_slots * static_cast<size_t>(shape_.scrambles);
    return {truth_.data() + problem * width, width};
  }

  // Mean and standard error of one band of one problem. The variance of the mean, sum of (share^2 variance) over the
  // scrambles, is estimated without bias for any shares and variances of the scrambles below one half each:
  //   V = sum a_s d_s^2 / (1 + sum a_s),  a = share^2 / (1 - 2 share),  d = deviation of the scramble's mean,
  // because E[d_s^2] = (1 - 2 share_s) variance_s + V. Infinite when fewer than two scrambles have samples. Means and
  // shares are those of accepted samples.
  void estimate(size_t problem, size_t band, double& mean, double& standard_error) const {
    estimate(problem, band, {&mean, 1}, {&standard_error, 1});
  }
  // The same for all values of a problem at once; spans of bands() values.
  void estimate(size_t problem, std::span<double> means, std::span<double> standard_errors) const {
    estimate(problem, 0, means, standard_errors);
  }

  // Covariance of the errors of two values' means, by the same formula with the product of both deviations; 0 when
  // fewer than two scrambles have samples.
  double covariance(size_t problem, size_t a, size_t b) const;

  // Takes over, row by row, what another has computed further: after any sequence of joins a row is that of the part
  // that went furthest with it. Both must be of one run and one shape but for the number of problems and, where the
  // other has fewer, of scrambles. The other's problem i is problem first + i here, or one problem is that of another
  // number there; joins of distinct problems may run at the same time.
  void join(const Accumulators& part, size_t first = 0);
  void join_problem(size_t problem, const Accumulators& part, size_t there);
  // Forgets everything.
  void clear();

  // All that is kept, as columns of rows [problem][scramble], for those who store or send it. What they hold, in order:
  // sums, taken, failures, truncated, largest, squares, missing, missing_of, truth; a width of 0 where it is not kept.
  template <class Byte>
  struct Column {
    Byte* data;
    size_t width;  // bytes of a row
  };
  static constexpr size_t kColumns = 9;
  std::array<Column<std::byte>, kColumns> columns() { return columns_of<std::byte>(*this); }
  std::array<Column<const std::byte>, kColumns> columns() const { return columns_of<const std::byte>(*this); }

 private:
  // Of so many values from `first` on as the spans hold.
  void estimate(size_t problem, size_t first, std::span<double> means, std::span<double> standard_errors) const;
  size_t row(size_t problem, int scramble) const {
    return problem * static_cast<size_t>(shape_.scrambles) + static_cast<size_t>(scramble);
  }
  template <class Byte, class Self>
  static std::array<Column<Byte>, kColumns> columns_of(Self& self) {
    const auto of = [](auto& v, size_t width) {
      return Column<Byte>{reinterpret_cast<Byte*>(v.data()), v.empty() ? 0 : width * sizeof(v[0])};
    };
    const size_t bands = self.shape_.bands;
    return {of(self.sums_, bands),    of(self.taken_, 1),      of(self.failures_, 1),
            of(self.truncated_, 1),   of(self.largest_, 1),    of(self.squares_, 1),
            of(self.missing_, bands), of(self.missing_of_, 2), of(self.truth_, self.shape_.truth_slots)};
  }
  Shape shape_;
  // [problem][scramble][...]
  std::vector<double> sums_;
  std::vector<uint32_t> taken_, failures_;
  std::vector<float> truncated_, largest_;
  std::vector<double> squares_, missing_, missing_of_, truth_;
};

}  // namespace suite
