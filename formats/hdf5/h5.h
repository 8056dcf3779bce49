// A thin, checked skin over the HDF5 C API for the formats that are HDF5 files: typed columns with units, handles that
// close themselves.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite::h5 {

using Id = int64_t;  // HDF5's hid_t

// Any HDF5 identifier; closed by its own function.
class Handle {
 public:
  Handle() = default;
  Handle(Id id, int (*close)(Id)) : id_(id), close_(close) {}
  Handle(Handle&& o) noexcept : id_(o.id_), close_(o.close_) { o.id_ = -1; }
  Handle& operator=(Handle&& o) noexcept {
    std::swap(id_, o.id_);
    std::swap(close_, o.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator Id() const { return id_; }

 private:
  Id id_ = -1;
  int (*close_)(Id) = nullptr;
};

// The type that values of T have in files: little-endian; uint8_t, std::byte, uint16_t, uint32_t, uint64_t, float,
// double.
template <class T>
Id native();

// How hard the values of a dataset are packed: 0 as they are, else deflate 1 (fast) to 9 after a shuffle of their
// bytes.
using PackLevel = std::function<int(const std::string& dataset)>;

// Writes to a new file. Groups are made on the way. Every dataset gets `units` ("1" for pure numbers, "" for names).
class Writer {
 public:
  // level: null = nothing is packed. Datasets below 4 KiB never are.
  Writer(const std::string& temporary, const std::string& path_for_messages, PackLevel level = {});
  // data: rows x width values; width 1 makes a one-dimensional dataset.
  template <class T>
  void put(const std::string& name, std::span<const T> data, const char* units, size_t width = 1) {
    write(name, native<T>(), data.data(), data.size(), width, units);
  }
  template <class T>
  void put(const std::string& name, const std::vector<T>& data, const char* units, size_t width = 1) {
    put(name, std::span<const T>(data), units, width);
  }
  void put_names(const std::string& name, const std::vector<std::string>& names);
  // Fills a dataset of `total` values piece by piece.
  class Column {
   public:
    template <class T>
    void append(std::span<const T> data) {
      write(native<T>(), data.data(), data.size());
    }
    // Values of the column's own type as bytes.
    void append_raw(Id type, const void* data, size_t count) { write(type, data, count); }

   private:
    friend class Writer;
    void write(Id type, const void* data, size_t count);
    Writer* writer_ = nullptr;
    Handle dataset_, space_;
    unsigned long long at_ = 0;
  };
  Column column(const std::string& name, Id type, size_t total, const char* units);
  void attribute(const std::string& name, const std::string& text);
  void attribute(const std::string& name, std::span<const double> values);
  void close();

 private:
  void write(const std::string& name, Id type, const void* data, size_t count, size_t width, const char* units);
  void make_groups(const std::string& name);
  Handle make(const std::string& name, Id type, size_t count, size_t width, const char* units);
  [[noreturn]] void fail(const std::string& what) const;
  void give_up() const;
  std::string path_;
  PackLevel level_;
  Handle file_;
};

// Reads from a file that is not trusted.
class Reader {
 public:
  // hint: the last words of every message about a fault, what would be right.
  explicit Reader(const std::string& path, std::string hint = "prepare the scene again");
  // All values; Error unless type, width, units and the stored size agree. rows: expected count of rows, or -1 for any.
  template <class T>
  std::vector<T> get(const std::string& name, const char* units, size_t width = 1, long long rows = -1) {
    Opened d = open(name, native<T>(), units, width, rows);
    std::vector<T> data(d.count);
    read(name, d, native<T>(), data.data(), 0, d.count);
    return data;
  }
  std::vector<std::string> get_names(const std::string& name, long long rows = -1);
  struct Opened {
    Handle dataset;
    size_t count = 0;     // values
    bool packed = false;  // not found in the file as they are
  };
  // held: its values will be held in memory; Error when a packed one does not fit there.
  Opened open(const std::string& name, Id type, const char* units, size_t width, long long rows, bool held = true);
  void read(const std::string& name, const Opened& d, Id type, void* out, size_t first, size_t count);
  // `blocks` runs of `run` values, the first at `first`, each `stride` values behind the one before.
  void read_strided(const std::string& name, const Opened& d, Id type, void* out, size_t first, size_t blocks,
                    size_t stride, size_t run);
  // Datasets of which some value was read, here or by who says so.
  const std::set<std::string>& names_read() const { return names_read_; }
  void note_read(const std::string& name) { names_read_.insert(name); }
  // Where the values of a dataset start in the file, for reading past the library (which knows one thread only). Error
  // for a packed one.
  uint64_t file_offset(const std::string& name, const Opened& d) const;
  bool has(const std::string& name) const;
  std::string text(const std::string& attribute) const;
  std::vector<double> numbers(const std::string& attribute, size_t count) const;
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string path_, hint_;
  Handle file_;
  std::set<std::string> names_read_;
};

}  // namespace suite::h5
