// Values that never change once they are here: those of a vector that was handed over, or of memory that somebody else
// keeps, such as a mapped file. Copies share the values.
#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace suite {

template <class T>
class SharedArray {
 public:
  using value_type = T;
  SharedArray() = default;
  SharedArray(std::vector<T> values) {
    if (values.empty()) return;
    const auto own = std::make_shared<const std::vector<T>>(std::move(values));
    data_ = own->data(), size_ = own->size(), keeps_ = own;
  }
  SharedArray(std::initializer_list<T> values) : SharedArray(std::vector<T>(values)) {}
  // keeps: what `data` is a part of.
  SharedArray(const T* data, size_t size, std::shared_ptr<const void> keeps)
      : data_(data), size_(size), keeps_(std::move(keeps)) {}

  const T* data() const { return data_; }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  const T& operator[](size_t k) const { return data_[k]; }
  friend bool operator==(const SharedArray& a, const SharedArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  const T* data_ = nullptr;
  size_t size_ = 0;
  std::shared_ptr<const void> keeps_;
};

}  // namespace suite
