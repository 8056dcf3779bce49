// OpenEXR out, through OpenImageIO. Viewers show the channels R, G and B, or Y, and find nothing to show otherwise.
#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/run_app.h"
#include "formats/raster/images.h"
#include "formats/raster/raster_write.h"

namespace suite {

namespace {

// The names of the bands that are written once more for viewers.
std::vector<std::string> shown(const FloatRaster& r) {
  if (r.display.size() == 3) return {"R", "G", "B"};
  return std::vector<std::string>(r.display.size(), "Y");
}

// All bands, in a layer of their own where there is a picture beside them: viewers take a band called `red` for R.
std::vector<std::string> channels(const FloatRaster& r, std::vector<std::string> names) {
  const std::string layer = names.empty() ? "" : "bands.";
  for (const RasterBand& b : r.bands) names.push_back(layer + b.name);
  return names;
}

std::string list(const FloatRaster& r, double RasterBand::*number) {
  std::string text;
  for (const RasterBand& b : r.bands) text += (text.empty() ? "" : ", ") + strf("%.9g", b.*number);
  return text;
}

std::vector<ImageAttribute> attributes(const FloatRaster& r) {
  std::vector<ImageAttribute> all{{"ImageDescription", r.comment}, {"Software", strf("suite %s", kVersion)}};
  if (!r.units.empty()) all.push_back({"units", r.units});
  std::string names;
  for (const RasterBand& b : r.bands) names += (names.empty() ? "" : ", ") + b.name;
  all.push_back({"band_names", names});
  const auto known = [&](double RasterBand::*number) {
    return std::all_of(r.bands.begin(), r.bands.end(), [&](const RasterBand& b) { return b.*number > 0; });
  };
  if (known(&RasterBand::wavelength_um)) all.push_back({"wavelength_um", list(r, &RasterBand::wavelength_um)});
  if (known(&RasterBand::fwhm_um)) all.push_back({"fwhm_um", list(r, &RasterBand::fwhm_um)});
  if (r.sun_deg) {
    all.push_back({"sun_azimuth_deg", static_cast<float>((*r.sun_deg)[0])});
    all.push_back({"sun_elevation_deg", static_cast<float>((*r.sun_deg)[1])});
  }
  // Unknown, as Exif has it; without a date the library would put in that of today.
  std::string date = "    :  :     :  :  ";
  if (r.utc.size() >= 19) {
    all.push_back({"acquisition_time", r.utc});
    // The attributes of the standard: whole seconds of local time, which is UTC here.
    date = r.utc.substr(0, 19);
    date[4] = date[7] = ':', date[10] = ' ';
    all.push_back({"utcOffset", 0.0f});
  }
  all.push_back({"DateTime", date});
  return all;
}

}  // namespace

void write_exr(const std::string& path, const FloatRaster& r, std::span<const float> values) {
  const size_t bands = r.bands.size(), pixels = size_t{r.width} * r.height;
  SUITE_CHECK_EQ(values.size(), pixels * bands);
  const std::vector<std::string> extra = shown(r);
  std::vector<float> row(size_t{r.width} * (extra.size() + bands));
  const ImageToWrite image{"openexr", static_cast<int>(r.width), static_cast<int>(r.height), channels(r, extra),
                           attributes(r)};
  std::vector<unsigned char> bytes;
  const auto row_at = [&](int y) {
    float* to = row.data();
    for (uint32_t x = 0; x < r.width; ++x) {
      const float* pixel = &values[(static_cast<size_t>(y) * r.width + x) * bands];
      for (size_t i = 0; i < extra.size(); ++i) *to++ = pixel[r.display[i]];
      to = std::copy(pixel, pixel + bands, to);
    }
    return row.data();
  };
  const std::string problem = image_calls().write(image, row_at, bytes);
  if (!problem.empty()) throw Error(Where{path, 0, 0, {}, -1}, "cannot be written: " + problem);
  write_file(path, std::as_bytes(std::span(bytes)));
}

}  // namespace suite
