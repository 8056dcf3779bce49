// Columns of an HDF5 file whose lengths are known at the end: values wait in files beside it. Internal to
// formats/lidar_hdf.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "base/files.h"
#include "formats/hdf5/h5.h"

namespace suite {

class SpooledColumns {
 public:
  // path: of the HDF5 file. made_by: the command line. Error: not writable.
  SpooledColumns(const std::string& path, const std::string& made_by);
  ~SpooledColumns();
  template <class T>
  void add(const std::string& name, const char* units, T value) {
    put(name, units, h5::native<T>(), &value, 1, sizeof(T));
  }
  template <class T>
  void add(const std::string& name, const char* units, std::span<const T> values) {
    put(name, units, h5::native<T>(), values.data(), values.size(), sizeof(T));
  }
  size_t size(const std::string& name) const;  // values so far, 0 = no such column
  h5::Writer& writer() { return writer_; }
  void finish();  // the file is there, whole

 private:
  struct Column;
  void put(const std::string& name, const char* units, h5::Id type, const void* data, size_t count, size_t bytes);
  std::string path_;
  AtomicFile file_;
  h5::Writer writer_;
  std::map<std::string, std::unique_ptr<Column>> columns_;
};

}  // namespace suite
