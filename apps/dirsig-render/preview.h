// The quick look at a radiance cube.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace suite {

// PNG of one band (grey) or three (red, green, blue): each linear from 0 to the 99th percentile over all chosen bands,
// so that colours stay in proportion, then sRGB. radiance: [problem][band].
void write_preview(const std::string& path, std::span<const double> radiance, uint32_t columns, uint32_t rows, size_t bands, std::span<const size_t> chosen);

}  // namespace suite
