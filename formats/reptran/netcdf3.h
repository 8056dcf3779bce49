// Classic netCDF files (version 1, and 2 with offsets of 64 bits), read only; variables along a record dimension are
// not. Based on: "The NetCDF Classic Format Specification", Unidata.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite {

class NetCdf3 {
 public:
  // Error: no such file, none of this format, a header that ends early or points outside the file.
  explicit NetCdf3(const std::string& path);
  NetCdf3(std::vector<std::byte> bytes, std::string name_for_messages);

  bool has(const std::string& variable) const { return variables_.count(variable) > 0; }
  // Lengths of its dimensions, the slowest first. Error: no such variable.
  const std::vector<size_t>& shape(const std::string& variable) const { return find(variable).shape; }
  // All numbers, the last dimension fastest. Error: no such variable, text, or another shape than `expected`.
  std::vector<double> numbers(const std::string& variable, const std::vector<size_t>& expected) const;
  // The strings of a variable of characters, along its last dimension, blanks and zeros at their ends dropped.
  std::vector<std::string> strings(const std::string& variable) const;
  Error fault(const std::string& what, const std::string& hint = {}) const;

 private:
  struct Variable {
    std::vector<size_t> shape;
    int type = 0;
    size_t begin = 0, count = 0;
  };
  void read_header();
  const Variable& find(const std::string& name) const;

  std::vector<std::byte> bytes_;
  std::string name_;
  std::map<std::string, Variable> variables_;
};

}  // namespace suite
