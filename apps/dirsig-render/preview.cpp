#include "preview.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "base/run_app.h"
#include "formats/picture/picture.h"

namespace suite {

void write_preview(const std::string& path, std::span<const double> values, uint32_t columns, uint32_t rows,
                   size_t bands) {
  std::vector<double> finite;
  for (const double v : values)
    if (std::isfinite(v)) finite.push_back(v);
  double white = 1;
  if (!finite.empty()) {
    const auto at = finite.begin() + static_cast<long>(0.99 * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), at, finite.end());
    if (*at > 0) white = *at;
  }
  constexpr uint32_t most = 16384;
  const uint32_t stride = std::max((columns + most - 1) / most, (rows + most - 1) / most);
  Canvas canvas(static_cast<int>((columns + stride - 1) / stride), static_cast<int>((rows + stride - 1) / stride),
                kBlack);
  for (uint32_t r = 0; r < rows; r += stride)
    for (uint32_t c = 0; c < columns; c += stride) {
      const double* v = &values[(size_t{r} * columns + c) * bands];
      auto shade = [&](size_t k) { return srgb(v[std::min(k, bands - 1)] / white); };
      canvas.set(static_cast<int>(c / stride), static_cast<int>(r / stride), {shade(0), shade(1), shade(2)});
    }
  write_png(path, canvas, command_line() + strf("; linear from 0 to %g W/(m2 sr um) (99th percentile), sRGB", white));
}

}  // namespace suite
