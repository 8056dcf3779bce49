// The readers of single layouts, told apart in library.cpp.
#pragma once
#include <string_view>

#include "formats/curve/curve.h"

namespace suite {

struct NamedRows {
  std::string name;  // may be empty
  std::vector<double> um, value;
  Where where;
};

// A stored number that marks a deleted channel: USGS's libraries have -1.23e34.
inline bool is_mark(double stored) { return stored <= -1e30; }
// The curve through the values that are there; NaN marks the others, which are left out and reported through
// options.on_warning. No rule holds beyond an end that is marked. Error: as Curve, and no value at all.
Curve curve_of(std::vector<double> um, std::vector<double> value, const CurveOptions& options, const Where& where);

Curve read_table(const std::string& path, const CurveOptions& options);
std::vector<NamedRows> read_sli(const std::string& path, const CurveOptions& options);
std::vector<NamedRows> read_ems(const std::string& path, const CurveOptions& options);

// A response from the zero before its first value to that after its last. Error: nothing but zeros.
Curve response_of(std::vector<double> um, std::vector<double> value, const std::string& name, const std::string& path);
// Responses of several bands in netCDF-4 or HDF5; by the file's first bytes, classic netCDF too, which is refused.
bool is_response_file(const std::string& path);
std::vector<NamedCurve> read_response_file(const std::string& path);

}  // namespace suite
