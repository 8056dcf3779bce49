// Rasters as maps and terrains take them: what the file says of its numbers, unless the text says otherwise.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/envi/envi.h"
#include "formats/scene_text/reader.h"

namespace suite::scene_text {

namespace {

// The mark of a gap is any number: rasters use the ends of their types, beyond what a quantity may be.
double mark_of(const Params& p) {
  const std::string text = p.as_text();
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  if (code != std::errc() || stop != end) throw p.error("expected a number, found '" + text.substr(0, 60) + "'");
  return value;
}

MapRaster read_image(const EnviImage& image, const std::string& path) {
  const EnviHeader& h = image.header();
  MapRaster raster;
  raster.width = static_cast<uint32_t>(h.samples);
  raster.height = static_cast<uint32_t>(h.lines);
  raster.channels = static_cast<uint32_t>(h.bands);
  raster.integer = h.type != EnviType::float32 && h.type != EnviType::float64;
  raster.values.reserve(h.values());
  for (size_t line = 0; line < h.lines; ++line)
    for (const double v : image.read_lines(line, 1)) raster.values.push_back(static_cast<float>(v));
  raster.no_data = h.ignore_value;
  raster.wavelength_um = h.wavelength_um;
  EnviNumbers numbers = suite::numbers_of(h, path);
  if (!numbers.gain.empty() || !numbers.offset.empty())
    for (size_t b = 0; b < h.bands; ++b)
      raster.numbers.push_back(
          {numbers.gain.empty() ? 1 : numbers.gain[b], numbers.offset.empty() ? 0 : numbers.offset[b]});
  raster.bad = std::move(numbers.bad);
  return raster;
}

}  // namespace

MapRaster Reader::pixels_of(const Params& p, const Params& file, Pixels kind) {
  const std::string path = input(file);
  MapRaster raster;
  if (kind == Pixels::cube || path.ends_with(".img")) {
    const EnviImage image(path);
    if (image.header().values() > size_t{1} << 31)
      throw file.error("the image is too large to be baked", "at most 2^31 values");
    raster = read_image(image, path);
  } else {
    static_cast<Raster&>(raster) = read_raster(path);
  }
  if (const auto mark = p.find("no_data")) raster.no_data = mark_of(*mark);
  return raster;
}

std::vector<float> Reader::values_in(const Params& p, const Params& file, Raster&& raster, const char* scale,
                                     const char* offset) {
  const bool own = p.has(scale) || p.has(offset);
  const auto says = std::find_if(raster.numbers.begin(), raster.numbers.end(),
                                 [](const RasterNumbers& n) { return n != RasterNumbers{}; });
  if (own && says != raster.numbers.end())
    report_.add(
        "SP507", file.as_text(),
        {file.where(), strf("by the file a value is stored * %.9g + %.9g; '%s' and '%s' of the text replace that",
                            says->scale, says->offset, scale, offset)});
  return values_of(std::move(raster), own ? Numbers::stored : Numbers::scaled);
}

// Bands that the header calls bad, or that hold no value anywhere, say nothing: the spectrum runs straight across.
void Reader::leave_bad_bands(const Params& file, MapRaster& raster) {
  const size_t bands = raster.channels, pixels = raster.values.size() / bands;
  std::vector<bool> keep(bands, false);
  for (size_t b = 0; b < bands; ++b) {
    if (!raster.bad.empty() && raster.bad[b]) continue;
    for (size_t i = 0; i < pixels && !keep[b]; ++i) keep[b] = !is_no_data(raster, raster.values[i * bands + b]);
  }
  const auto kept = static_cast<size_t>(std::count(keep.begin(), keep.end(), true));
  if (kept == bands) return;
  if (kept == 0)
    throw file.error("no band of the cube has a value",
                     "'bbl' calls all bad, or all numbers are marks of missing ones");
  std::string which;
  for (size_t b = 0; b < bands; ++b)
    if (!keep[b] && which.size() < 60) which += strf("%s%.4g", which.empty() ? "" : ", ", raster.wavelength_um[b]);
  report_.add("SP507", file.as_text(),
              {file.where(),
               strf("%zu of %zu bands are bad or empty (%s um%s) and left out; the spectra are linear across them",
                    bands - kept, bands, which.c_str(), which.size() >= 60 ? ", ..." : "")});
  const auto thin = [&](auto& list, size_t rows) {
    size_t to = 0;
    for (size_t i = 0; i < rows * bands; ++i)
      if (keep[i % bands]) list[to++] = list[i];
    list.resize(to);
  };
  thin(raster.values, pixels);
  thin(raster.wavelength_um, 1);
  if (!raster.numbers.empty()) thin(raster.numbers, 1);
  raster.channels = static_cast<uint32_t>(kept);
  raster.bad.clear();
}

void Reader::refuse_nan(const Params& p, const Params& file, const Raster& raster) {
  for (size_t i = 0; i < raster.values.size(); ++i)
    if (std::isnan(raster.values[i]) && !is_no_data(raster, raster.values[i]))
      throw p.error(strf("pixel %zu of '%s' is not a number", i / raster.channels, file.as_text().c_str()),
                    "'no_data: nan' makes gaps of such pixels");
}

// Where one channel of a pixel is missing the whole pixel is.
void Reader::close_gaps(const Params& p, const Params& file, double mark, PropertyMap& map) {
  size_t gaps = 0, torn = 0;
  for (size_t i = 0; i < map.values.size(); i += map.channels) {
    const auto first = map.values.begin() + static_cast<std::ptrdiff_t>(i), last = first + map.channels;
    const auto missing = std::count_if(first, last, [](float v) { return std::isnan(v); });
    if (!missing) continue;
    ++gaps;
    torn += missing < static_cast<std::ptrdiff_t>(map.channels);
    std::fill(first, last, NAN);
  }
  if (!gaps) return;
  const size_t pixels = map.values.size() / map.channels;
  if (map.kind == MapKind::bump || map.kind == MapKind::normal)
    throw p.error(strf("%zu pixels hold the mark of a missing value (%g)", gaps, mark),
                  "a bump or normal map has no gaps: fill them");
  if (gaps == pixels) throw p.error(strf("every pixel holds the mark of a missing value (%g)", mark));
  report_.add("SP507", file.as_text(),
              {file.where(), strf("%zu of %zu pixels are gaps (%g%s); the material itself holds there", gaps, pixels,
                                  mark, torn ? strf(", %zu of them in some bands only", torn).c_str() : "")});
}

}  // namespace suite::scene_text
