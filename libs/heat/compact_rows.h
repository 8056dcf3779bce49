// Rows of numbers in two bytes each: by row the least number and a step, of every number how many steps it is above.
// What is the same all over a row is kept to the last bit, and so is the least number; others are off by 1/131070 of
// what the row spans at most.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace suite {

class CompactRows {
 public:
  CompactRows() = default;
  CompactRows(size_t rows, size_t width) : width_(width), least_(rows), step_(rows), above_(rows * width) {}
  // values: a whole number of rows, one after the other.
  CompactRows(std::span<const float> values, size_t width);

  size_t rows() const { return least_.size(); }
  size_t width() const { return width_; }
  double at(size_t row, size_t k) const {
    return double{least_[row]} + double{step_[row]} * static_cast<double>(above_[row * width_ + k]);
  }
  // Numbers that are not finite make all of their row NaN.
  void set(size_t row, std::span<const float> values);
  void get(size_t row, std::span<float> values) const;
  void resize(size_t rows);           // more are 0
  std::vector<float> floats() const;  // of all rows, one after the other

  // As they are kept, for files: by row; by number.
  std::span<float> least() { return least_; }
  std::span<const float> least() const { return least_; }
  std::span<float> steps() { return step_; }
  std::span<const float> steps() const { return step_; }
  std::span<uint16_t> above() { return above_; }
  std::span<const uint16_t> above() const { return above_; }

 private:
  size_t width_ = 0;
  std::vector<float> least_, step_;
  std::vector<uint16_t> above_;  // by row
};

}  // namespace suite
