// Where a value lies on the axis of a table.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace suite {

// Between i and i + 1 of an ascending axis with share s of the latter; the nearest end outside. An axis of one: i = 0,
// s = 0.
struct AxisPlace {
  size_t i = 0;
  double s = 0;
};
inline AxisPlace place_on(const std::vector<double>& axis, double value) {
  if (axis.size() == 1 || value <= axis.front()) return {};
  if (value >= axis.back()) return {axis.size() - 2, 1};
  const auto i = static_cast<size_t>(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin()) - 1;
  return {i, (value - axis[i]) / (axis[i + 1] - axis[i])};
}

}  // namespace suite
