// HDF5 files that other programs wrote: any layout the library knows, numbers of any type, no units. What is declared
// is held against the size of the file before memory is asked for; the structure of old layouts has no checksums and is
// followed by the library as it stands, so that a file damaged on purpose may do what the library lets it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "formats/hdf5/h5.h"

namespace suite::h5 {

class Foreign {
 public:
  explicit Foreign(const std::string& path);  // Error: missing, no HDF5 file, damaged

  bool has(const std::string& name) const;
  struct Table {
    size_t rows = 1, columns = 0;  // of a dataset with one dimension: one row
    std::vector<double> values;    // row by row
  };
  // A dataset of one or two dimensions as doubles. Error: missing, no numbers, more dimensions, not whole, kept in
  // other files, packed by other means than deflate and shuffle, or above 1 GiB.
  Table table(const std::string& name) const;
  std::vector<std::string> children(const std::string& group) const;  // by name; Error when there is no such group
  // An attribute of a dataset: a text (empty: none, or no text), a number. Error: no such dataset.
  std::string text(const std::string& name, const std::string& attribute) const;
  std::optional<double> number(const std::string& name, const std::string& attribute) const;
  // The texts of a dataset: strings, or a row of characters each; empty when it holds none. Error: no such dataset.
  std::vector<std::string> names(const std::string& name) const;
  struct Kind {
    int dimensions = -1;  // -1: no dataset
    bool numbers = false, texts = false;
    unsigned long long rows = 1, columns = 0;  // of one or two dimensions, as Table
  };
  Kind kind(const std::string& name) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string path_;
  Handle file_;
};

}  // namespace suite::h5
