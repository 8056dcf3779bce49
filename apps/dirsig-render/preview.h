// The quick look at a radiance cube.
#pragma once
#include <span>
#include <string>

namespace suite {

// PNG of one band (grey) or three (red, green, blue): each linear from 0 to the 99th percentile over all of them, so
// that colours stay in proportion, then sRGB; the file's comment says so. values: [pixel][band]. Pictures wider or
// higher than 16384 show every n-th pixel.
void write_preview(const std::string& path, std::span<const double> values, uint32_t columns, uint32_t rows,
                   size_t bands);

}  // namespace suite
