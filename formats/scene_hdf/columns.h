// How the rows of a table are stored: the words in which a descriptor (scene/tables.h) says it, for writing and for
// reading. Every column is a dataset below the table's group.
//   names(dataset, member)                  texts
//   value(dataset, units, member[, last])   one number; an enumeration as uint8, up to its last name
//   numbers<T, N>(dataset, units, get, set) N numbers a row; set gives false for what cannot be
//   transform(dataset, units, member)       3 x 4 numbers, row-major
//   list<Count>(dataset, units, counts, member)    vectors one behind the other, their sizes in the dataset `counts`
//   values(dataset, units, member, count)          the same, of sizes that follow from the rest of the row
#pragma once
#include <string>
#include <type_traits>
#include <vector>

#include "formats/scene_hdf/internal.h"

namespace suite {

// Enumerations as bytes, other numbers as they are.
template <class T, bool = std::is_enum_v<T>>
struct StoredAs {
  using type = T;
};
template <class T>
struct StoredAs<T, true> {
  using type = uint8_t;
};

template <class Row>
class ColumnWriter {
 public:
  ColumnWriter(h5::Writer& w, const std::string& table, const std::vector<Row>& rows)
      : w_(w), table_("/" + table + "/"), rows_(rows) {}
  void names(const char* dataset, std::string Row::*member) {
    w_.put_names(table_ + dataset, pick(rows_, [member](const Row& r) { return r.*member; }));
  }
  template <class T>
  void value(const char* dataset, const char* units, T Row::*member, T = {}) {
    using Stored = typename StoredAs<T>::type;
    w_.put(table_ + dataset, pick(rows_, [member](const Row& r) { return static_cast<Stored>(r.*member); }), units);
  }
  template <class T, size_t N, class Get, class Set>
  void numbers(const char* dataset, const char* units, Get get, Set) {
    std::vector<T> all;
    for (const Row& r : rows_) {
      const std::array<T, N> row = get(r);
      all.insert(all.end(), row.begin(), row.end());
    }
    w_.put(table_ + dataset, all, units, N);
  }
  void transform(const char* dataset, const char* units, Affine3 Row::*member) {
    numbers<double, 12>(
        dataset, units, [member](const Row& r) { return numbers_of(r.*member); }, nullptr);
  }
  template <class Count, class T>
  void list(const char* dataset, const char* units, const char* counts, std::vector<T> Row::*member) {
    w_.put(table_ + counts, pick(rows_, [member](const Row& r) { return static_cast<Count>((r.*member).size()); }),
           "1");
    values(dataset, units, member, nullptr);
  }
  template <class T, class Size>
  void values(const char* dataset, const char* units, std::vector<T> Row::*member, Size) {
    size_t total = 0;
    for (const Row& r : rows_) total += (r.*member).size();
    auto column = w_.column(table_ + dataset, h5::native<T>(), total, units);
    for (const Row& r : rows_) column.append(std::span<const T>(r.*member));
  }

 private:
  h5::Writer& w_;
  std::string table_;
  const std::vector<Row>& rows_;
};

// Fills `rows`, which the first column sizes.
template <class Row>
class ColumnReader {
 public:
  ColumnReader(h5::Reader& r, const std::string& table, std::vector<Row>& rows)
      : r_(r), table_("/" + table + "/"), rows_(rows) {}
  void names(const char* dataset, std::string Row::*member) {
    fill(r_.get_names(table_ + dataset, expected()), [member](Row& row, std::string& name) { row.*member = name; });
  }
  template <class T>
  void value(const char* dataset, const char* units, T Row::*member, T last = {}) {
    using Stored = typename StoredAs<T>::type;
    fill(r_.get<Stored>(table_ + dataset, units, 1, expected()), [&](Row& row, Stored v) {
      if (std::is_enum_v<T> && v > static_cast<Stored>(last)) reject(dataset);
      row.*member = static_cast<T>(v);
    });
  }
  template <class T, size_t N, class Get, class Set>
  void numbers(const char* dataset, const char* units, Get, Set set) {
    const auto all = r_.get<T>(table_ + dataset, units, N, expected());
    start(all.size() / N);
    for (size_t k = 0; k < rows_.size(); ++k)
      if (!set(rows_[k], &all[N * k])) reject(dataset);
  }
  void transform(const char* dataset, const char* units, Affine3 Row::*member) {
    numbers<double, 12>(dataset, units, nullptr, [member](Row& row, const double* t) {
      row.*member = transform_of(t);
      return true;
    });
  }
  template <class Count, class T>
  void list(const char* dataset, const char* units, const char* counts, std::vector<T> Row::*member) {
    const auto count = r_.get<Count>(table_ + counts, "1", 1, expected());
    start(count.size());
    size_t k = 0;
    values(dataset, units, member, [&](const Row&) { return count[k++]; });
  }
  template <class T, class Size>
  void values(const char* dataset, const char* units, std::vector<T> Row::*member, Size size) {
    Stretch<T> all(r_, table_ + dataset, units);
    for (Row& row : rows_) row.*member = all.next(size(row));
    all.finish();
  }

 private:
  long long expected() const { return started_ ? static_cast<long long>(rows_.size()) : -1; }
  void start(size_t rows) {
    if (!started_) rows_.resize(rows);
    started_ = true;
  }
  template <class Values, class Set>
  void fill(Values values, const Set& set) {
    start(values.size());
    for (size_t k = 0; k < rows_.size(); ++k) set(rows_[k], values[k]);
  }
  [[noreturn]] void reject(const char* dataset) const {
    r_.fail("'" + table_ + dataset + "' has a value that means nothing");
  }
  h5::Reader& r_;
  std::string table_;
  std::vector<Row>& rows_;
  bool started_ = false;
};

}  // namespace suite
