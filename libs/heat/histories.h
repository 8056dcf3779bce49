// Histories of many surfaces in half the memory of doubles: by row its least value, and of every moment what is above
// it as a float. What does not change is kept to the last bit; of what does the least values are the most precise, so
// that nights of no air keep their temperatures beside days of 400 K, which are off by 6e-6 K at most.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace suite {

class Histories {
 public:
  Histories() = default;
  Histories(size_t rows, size_t moments) : moments_(moments), least_(rows), above_(rows * moments) {}

  size_t rows() const { return least_.size(); }
  size_t moments() const { return moments_; }
  double at(size_t row, size_t moment) const { return least_[row] + double{above_[row * moments_ + moment]}; }
  double least(size_t row) const { return least_[row]; }
  std::span<const float> above(size_t row) const { return {&above_[row * moments_], moments_}; }

  // A value a moment.
  void set(size_t row, std::span<const double> values);
  void get(size_t row, std::span<double> values) const;
  std::vector<double> values() const;  // of all rows, one after the other
  // Every value by another. In parallel over rows.
  void change(const std::function<double(double)>& to);
  void take(const Histories& first);  // its rows in place of as many first ones here
  void shrink(size_t rows);           // to the first ones

 private:
  size_t moments_ = 0;
  std::vector<double> least_;
  std::vector<float> above_;  // by row and moment
};

}  // namespace suite
