// Based on: GDAL's driver documentation of GeoTIFF (tags GDAL_METADATA 42112 and GDAL_NODATA 42113): a number stands
// for stored * scale + offset of its band, and the mark of missing values is one of the stored numbers.
#include <charconv>
#include <cmath>
#include <memory>

#include "base/files.h"
#include "formats/raster/stored.h"
#include "formats/raster/tags.h"

namespace suite {

namespace {

// The text of a tag of GDAL's; empty = none.
std::string text_of(TIFF* tiff, ttag_t tag) {
  char* text = nullptr;
  uint16_t count = 0;
  const TIFFField* known = TIFFFindField(tiff, tag, TIFF_ANY);
  if (!known) return {};
  const bool got = TIFFFieldPassCount(known) ? TIFFGetField(tiff, tag, &count, &text) : TIFFGetField(tiff, tag, &text);
  return got && text ? text : "";
}

// An attribute of an element, `name="value"`; empty = none.
std::string attribute(const std::string& element, const std::string& name) {
  const size_t at = element.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const size_t from = at + name.size() + 3, to = element.find('"', from);
  return to == std::string::npos ? std::string() : element.substr(from, to - from);
}

std::optional<double> number_in(std::string text) {
  const size_t first = text.find_first_not_of(" \t\r\n+");
  if (first == std::string::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
  double value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

// <Item name="SCALE" sample="0" role="scale">0.01</Item>
void read_items(const std::string& xml, const Where& where, Raster& raster) {
  for (size_t at = xml.find("<Item"); at != std::string::npos; at = xml.find("<Item", at + 5)) {
    const size_t close = xml.find('>', at), end = xml.find("</Item", at);
    if (close == std::string::npos || end == std::string::npos || end < close) return;
    const std::string element = xml.substr(at, close - at), role = attribute(element, "role");
    if (role != "scale" && role != "offset") continue;
    const std::string text = xml.substr(close + 1, end - close - 1);
    const auto value = number_in(text), band = number_in(attribute(element, "sample"));
    if (!value || !std::isfinite(*value) || (role == "scale" && *value == 0))
      throw Error(where, "its tag GDAL_METADATA has a " + role + " of '" + text.substr(0, 60) + "'",
                  "a finite number is expected, and no scale of 0");
    if (!band || !(*band >= 0 && *band < raster.channels)) continue;
    if (raster.numbers.empty()) raster.numbers.resize(raster.channels);
    RasterNumbers& n = raster.numbers[static_cast<size_t>(*band)];
    (role == "scale" ? n.scale : n.offset) = *value;
  }
}

}  // namespace

std::optional<double> no_data_of(TIFF* tiff) {
  add_gdal_tags(tiff);
  return number_in(text_of(tiff, kNoDataTag));
}

void read_tiff_numbers(const std::string& path, Raster& raster) {
  {
    const RandomAccessFile file(path);
    std::vector<std::byte> start(4);
    if (file.size() < start.size()) return;
    file.read_at(0, start);
    const std::string magic(reinterpret_cast<const char*>(start.data()), 2);
    if (magic != "II" && magic != "MM") return;
  }
  be_quiet();
  const std::unique_ptr<TIFF, CloseTiff> tiff(XTIFFOpen(path.c_str(), "r"));
  if (!tiff) return;
  raster.no_data = no_data_of(tiff.get());
  read_items(text_of(tiff.get(), kGdalMetadataTag), Where{path, 0, 0, {}, -1}, raster);
  double* scale = nullptr;
  uint16_t count = 0;
  if (TIFFGetField(tiff.get(), TIFFTAG_GEOPIXELSCALE, &count, &scale) && count >= 3) raster.scale_z = scale[2];
}

}  // namespace suite
