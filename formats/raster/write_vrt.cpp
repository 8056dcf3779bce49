// Based on: GDAL's documentation of VRT and of geolocation arrays (RFC 4, RFC 74).
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/markup.h"
#include "formats/raster/raster_write.h"

namespace suite {

namespace {

const char* const kWgs84 =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
    "UNIT[\"degree\",0.0174532925199433]]";

std::string geolocation(const std::string& places) {
  const std::pair<const char*, std::string> items[] = {
      {"SRS", kWgs84},     {"X_DATASET", places}, {"X_DATASET_RELATIVE_TO_SOURCE", "YES"},
      {"X_BAND", "1"},     {"Y_DATASET", places}, {"Y_DATASET_RELATIVE_TO_SOURCE", "YES"},
      {"Y_BAND", "2"},     {"PIXEL_OFFSET", "0"}, {"LINE_OFFSET", "0"},
      {"PIXEL_STEP", "1"}, {"LINE_STEP", "1"},    {"GEOREFERENCING_CONVENTION", "PIXEL_CENTER"}};
  std::string text = "  <Metadata domain=\"GEOLOCATION\">\n";
  for (const auto& [key, value] : items) text += strf("    <MDI key=\"%s\">", key) + in_markup(value) + "</MDI>\n";
  return text + "  </Metadata>\n";
}

}  // namespace

void write_located_vrt(const std::string& path, const FloatRaster& r, const std::string& type, double scale,
                       const std::string& image, const std::string& places) {
  std::string t = strf("<VRTDataset rasterXSize=\"%u\" rasterYSize=\"%u\">\n", r.width, r.height);
  t += geolocation(places);
  for (size_t b = 0; b < r.bands.size(); ++b) {
    t += "  <VRTRasterBand dataType=\"" + type + strf("\" band=\"%zu\">\n", b + 1);
    t += "    <Description>" + in_markup(r.bands[b].name) + "</Description>\n";
    if (!r.units.empty()) t += "    <UnitType>" + in_markup(r.units) + "</UnitType>\n";
    if (scale != 1) t += strf("    <Scale>%.17g</Scale>\n", scale);
    if (r.no_data)
      t += "    <NoDataValue>" + (std::isnan(*r.no_data) ? "nan" : strf("%.17g", *r.no_data)) + "</NoDataValue>\n";
    t +=
        "    <SimpleSource>\n      <SourceFilename relativeToVRT=\"1\">" + in_markup(image) +
        strf("</SourceFilename>\n      <SourceBand>%zu</SourceBand>\n    </SimpleSource>\n  </VRTRasterBand>\n", b + 1);
  }
  write_file(path, t + "</VRTDataset>\n");
}

}  // namespace suite
