#include "preview.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/run_app.h"
#include "formats/picture/picture.h"

namespace suite {

void write_preview(const std::string& path, std::span<const double> radiance, uint32_t columns, uint32_t rows, size_t bands, std::span<const size_t> chosen) {
  std::vector<double> values;
  for (size_t i = 0; i < size_t{columns} * rows; ++i)
    for (const size_t b : chosen)
      if (const double v = radiance[i * bands + b]; std::isfinite(v)) values.push_back(v);
  double white = 1;
  if (!values.empty()) {
    const auto at = values.begin() + static_cast<long>(0.99 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    if (*at > 0) white = *at;
  }
  Canvas canvas(static_cast<int>(columns), static_cast<int>(rows), kBlack);
  for (uint32_t r = 0; r < rows; ++r)
    for (uint32_t c = 0; c < columns; ++c) {
      const double* v = &radiance[(size_t{r} * columns + c) * bands];
      auto shade = [&](size_t k) { return srgb(v[chosen[std::min(k, chosen.size() - 1)]] / white); };
      canvas.set(static_cast<int>(c), static_cast<int>(r), {shade(0), shade(1), shade(2)});
    }
  write_png(path, canvas, command_line());
}

}  // namespace suite
