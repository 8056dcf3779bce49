// OpenEXR out, through OpenImageIO. Viewers show the channels R, G and B, or Y, and find nothing to show otherwise.
#include <OpenImageIO/imageio.h>

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/run_app.h"
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

void describe(const FloatRaster& r, OIIO::ImageSpec& spec) {
  spec.attribute("ImageDescription", r.comment);
  spec.attribute("Software", strf("suite %s", kVersion));
  if (!r.units.empty()) spec.attribute("units", r.units);
  std::string names;
  for (const RasterBand& b : r.bands) names += (names.empty() ? "" : ", ") + b.name;
  spec.attribute("band_names", names);
  const auto told = [&](double RasterBand::*number) {
    return std::all_of(r.bands.begin(), r.bands.end(), [&](const RasterBand& b) { return b.*number > 0; });
  };
  if (told(&RasterBand::wavelength_um)) spec.attribute("wavelength_um", list(r, &RasterBand::wavelength_um));
  if (told(&RasterBand::fwhm_um)) spec.attribute("fwhm_um", list(r, &RasterBand::fwhm_um));
  if (r.sun_deg) {
    spec.attribute("sun_azimuth_deg", static_cast<float>((*r.sun_deg)[0]));
    spec.attribute("sun_elevation_deg", static_cast<float>((*r.sun_deg)[1]));
  }
  // Unknown, as Exif has it; without a date the library would put in that of today.
  spec.attribute("DateTime", "    :  :     :  :  ");
  if (r.utc.size() < 19) return;
  spec.attribute("acquisition_time", r.utc);
  // The attributes of the standard: whole seconds of local time, which is UTC here.
  std::string date = r.utc.substr(0, 19);
  date[4] = date[7] = ':', date[10] = ' ';
  spec.attribute("DateTime", date);
  spec.attribute("utcOffset", 0.0f);
}

}  // namespace

void write_exr(const std::string& path, const FloatRaster& r, std::span<const float> values) {
  const size_t bands = r.bands.size(), pixels = size_t{r.width} * r.height;
  SUITE_CHECK_EQ(values.size(), pixels * bands);
  const std::vector<std::string> extra = shown(r);
  AtomicFile file(path);
  const Where where{path, 0, 0, {}, -1};
  auto out = OIIO::ImageOutput::create("openexr");
  if (!out) throw Error(where, "this build writes no OpenEXR");
  OIIO::ImageSpec spec(static_cast<int>(r.width), static_cast<int>(r.height), static_cast<int>(extra.size() + bands),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels(r, extra);
  spec.attribute("compression", "zip");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.alpha_channel = -1;
  describe(r, spec);
  bool fine = out->open(file.temporary(), spec);
  std::vector<float> row(size_t{r.width} * (extra.size() + bands));
  for (uint32_t y = 0; fine && y < r.height; ++y) {
    float* to = row.data();
    for (uint32_t x = 0; x < r.width; ++x) {
      const float* pixel = &values[(size_t{y} * r.width + x) * bands];
      for (size_t i = 0; i < extra.size(); ++i) *to++ = pixel[r.display[i]];
      to = std::copy(pixel, pixel + bands, to);
    }
    fine = out->write_scanline(static_cast<int>(y), 0, OIIO::TypeDesc::FLOAT, row.data());
  }
  if (!fine || !out->close()) throw Error(where, "cannot be written: " + out->geterror());
  file.commit();
}

}  // namespace suite
