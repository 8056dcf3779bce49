// The readers of single layouts, told apart in library.cpp.
#pragma once
#include <string_view>

#include "formats/curve/curve.h"

namespace suite {

Curve read_table(const std::string& path, const CurveOptions& options);
std::vector<NamedCurve> read_sli(const std::string& path, const CurveOptions& options);
std::vector<NamedCurve> read_ems(const std::string& path, const CurveOptions& options);

}  // namespace suite
