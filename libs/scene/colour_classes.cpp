#include "scene/colour_classes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace suite {

namespace {

constexpr size_t kLevels = 64;  // of a channel

size_t cell_of(const float* display) {
  size_t cell = 0;
  for (size_t c = 0; c < 3; ++c)
    cell = cell * kLevels + std::min(kLevels - 1, static_cast<size_t>(std::clamp(display[c], 0.0f, 1.0f) * kLevels));
  return cell;
}

// The texels of one cell of colours.
struct Cell {
  size_t where = 0, count = 0;
  std::array<double, 3> display{}, linear{};  // sums
};

// Cells first..last of a list, and the channel in which they differ most.
struct Class {
  size_t first = 0, last = 0;
  size_t channel = 0;
  double deviation = 0, mean = 0;  // squared, summed over its texels; of that channel
};

Class measured(const std::vector<Cell>& cells, size_t first, size_t last) {
  Class made{first, last};
  for (size_t c = 0; c < 3; ++c) {
    double n = 0, sum = 0, square = 0;
    for (size_t i = first; i < last; ++i) {
      const auto count = static_cast<double>(cells[i].count);
      const double v = cells[i].display[c] / count;
      n += count, sum += count * v, square += count * v * v;
    }
    const double deviation = square - sum * sum / n;
    if (deviation > made.deviation) made.channel = c, made.deviation = deviation, made.mean = sum / n;
  }
  return made;
}

std::vector<Cell> cells_of(std::span<const float> display) {
  std::vector<Cell> all(kLevels * kLevels * kLevels);
  for (size_t i = 0; i + 2 < display.size(); i += 3) {
    Cell& cell = all[cell_of(&display[i])];
    ++cell.count;
    for (size_t c = 0; c < 3; ++c) {
      const double v = std::clamp(double{display[i + c]}, 0.0, 1.0);
      cell.display[c] += v, cell.linear[c] += linear_from_srgb(v);
    }
  }
  std::vector<Cell> filled;
  for (size_t k = 0; k < all.size(); ++k)
    if (all[k].count) filled.push_back(all[k]), filled.back().where = k;
  return filled;
}

// Cuts a class in two at the mean of its widest channel; false: all its texels are of one colour.
bool cut(std::vector<Cell>& cells, std::vector<Class>& classes, size_t which) {
  const Class old = classes[which];
  const auto at = [&](size_t i) { return cells.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto middle = std::partition(at(old.first), at(old.last), [&](const Cell& cell) {
    return cell.display[old.channel] / static_cast<double>(cell.count) <= old.mean;
  });
  const auto m = static_cast<size_t>(middle - cells.begin());
  if (m == old.first || m == old.last) return false;
  classes[which] = measured(cells, old.first, m);
  classes.push_back(measured(cells, m, old.last));
  return true;
}

}  // namespace

ColourClasses classify_colours(std::span<const float> display, size_t most) {
  std::vector<Cell> cells = cells_of(display);
  std::vector<Class> classes;
  if (!cells.empty()) classes.push_back(measured(cells, 0, cells.size()));
  while (!classes.empty() && classes.size() < most) {
    const auto widest =
        std::ranges::max_element(classes, [](const Class& a, const Class& b) { return a.deviation < b.deviation; });
    if (!(widest->deviation > 1e-12) || !cut(cells, classes, static_cast<size_t>(widest - classes.begin()))) break;
  }
  ColourClasses made;
  std::vector<uint16_t> number(kLevels * kLevels * kLevels, 0);
  for (size_t k = 0; k < classes.size(); ++k) {
    LinearRgb sum{};
    double n = 0;
    for (size_t i = classes[k].first; i < classes[k].last; ++i) {
      number[cells[i].where] = static_cast<uint16_t>(k), n += static_cast<double>(cells[i].count);
      for (size_t c = 0; c < 3; ++c) sum[c] += cells[i].linear[c];
    }
    for (double& v : sum) v /= n;
    made.colours.push_back(sum);
  }
  double square = 0;
  for (size_t i = 0; i + 2 < display.size(); i += 3) {
    made.number.push_back(number[cell_of(&display[i])]);
    for (size_t c = 0; c < 3; ++c) {
      const double off = std::fabs(srgb_from_linear(made.colours[made.number.back()][c]) - double{display[i + c]});
      square += off * off, made.worst = std::max(made.worst, off);
    }
  }
  made.rms = made.number.empty() ? 0 : std::sqrt(square / (3 * static_cast<double>(made.number.size())));
  return made;
}

}  // namespace suite
