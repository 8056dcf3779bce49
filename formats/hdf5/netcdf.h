// netCDF-4 files: HDF5 with dimension scales, so that any reader of netCDF finds coordinates, dimensions and units.
//
// Based on: "NetCDF-4 File Format", Unidata, appendix C of the NetCDF User's Guide; "HDF5 Dimension Scale Specification
// and Design Notes", The HDF Group (attributes CLASS, NAME, DIMENSION_LIST, REFERENCE_LIST).
#pragma once
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/hdf5/h5.h"

namespace suite::h5 {

// What goes with a variable: `units`, `long_name`, ...
using NetcdfTexts = std::vector<std::pair<std::string, std::string>>;

// Writes to a new file. Dimensions come before the variables that have them.
class NetcdfWriter {
 public:
  // Error when it cannot be made or written, here and below; path: for messages.
  NetcdfWriter(const std::string& temporary, std::string path);
  ~NetcdfWriter();
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  // A dimension with its coordinates. Bug: a second one of a name, no values.
  void dimension(const std::string& name, std::span<const double> values, const NetcdfTexts& texts);
  // Values over dimensions, the last one fastest; of none: a scalar. Bug: another number of values.
  void variable(const std::string& name, const std::vector<std::string>& dimensions, std::span<const double> values,
                const NetcdfTexts& texts);
  void attribute(const std::string& name, const std::string& text);
  void attribute(const std::string& name, long long value);
  void close();

 private:
  struct Dimension {
    Handle scale;
    size_t size = 0;
    std::vector<std::pair<Id, unsigned>> users;  // addresses of variables that have it, and as which dimension
  };
  Handle make(const std::string& name, std::span<const unsigned long long> extent, std::span<const double> values,
              const NetcdfTexts& texts);
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  Handle file_;
  std::map<std::string, Dimension> dimensions_;
};

}  // namespace suite::h5
