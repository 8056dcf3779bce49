// Medians of relative errors without keeping them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace suite {

// A histogram over 1e-9 .. 1e3, 64 bins an octave, so within 1.1 %.
class ErrorHistogram {
 public:
  void add(double relative_error);
  void merge(const ErrorHistogram& o);
  double median() const;  // 0 when empty, infinity when unknown or beyond all bins

 private:
  static constexpr size_t kBins = 64 * 40;
  std::array<uint64_t, kBins> counts_{};
  uint64_t total_ = 0;
};

}  // namespace suite
