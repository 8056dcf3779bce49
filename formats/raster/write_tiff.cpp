// Based on: OGC 19-008r4, GeoTIFF Standard 1.1 (user-defined projected CRS, CT_Orthographic); GDAL's raster data model
// and GTiff driver (tags 42112 GDAL_METADATA and 42113 GDAL_NODATA, domain IMAGERY). The ellipsoidal orthographic
// projection (EPSG method 9840) of a point is its east and north in the tangent plane, which is what scene ENU is.
#include <geo_normalize.h>
#include <geotiff.h>
#include <geovalues.h>
#include <xtiffio.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "base/markup.h"
#include "base/run_app.h"
#include "formats/raster/raster_write.h"
#include "formats/raster/tags.h"

namespace suite {

namespace {

constexpr double kClassicLimit = 4e9;  // bytes: beyond, offsets are 64 bits wide (BigTIFF)
constexpr size_t kStripBytes = size_t{1} << 20;

// One item of GDAL's metadata; more: its attributes after the name. GDAL takes entities of a value apart twice.
std::string item(const char* name, const std::string& more, const std::string& value) {
  return strf("  <Item name=\"%s\"%s>", name, more.c_str()) + in_markup(in_markup(value)) + "</Item>\n";
}

const char* colour_of(const FloatRaster& r, size_t band) {
  static constexpr const char* kColours[] = {"Red", "Green", "Blue"};
  for (size_t i = 0; r.true_colour && r.display.size() == 3 && i < 3; ++i)
    if (r.display[i] == band) return kColours[i];
  return r.bands.size() == 1 ? "Gray" : "Undefined";
}

std::string gdal_metadata(const FloatRaster& r) {
  std::string xml = "<GDALMetadata>\n";
  if (r.utc.size() >= 19) {
    xml += item("acquisition_time", "", r.utc);
    xml += item("ACQUISITIONDATETIME", " domain=\"IMAGERY\"", r.utc.substr(0, 10) + " " + r.utc.substr(11, 8));
  }
  if (r.sun_deg) {
    xml += item("sun_azimuth_deg", "", strf("%.9g", (*r.sun_deg)[0]));
    xml += item("sun_elevation_deg", "", strf("%.9g", (*r.sun_deg)[1]));
  }
  for (size_t b = 0; b < r.bands.size(); ++b) {
    const RasterBand& band = r.bands[b];
    const std::string sample = strf(" sample=\"%zu\"", b);
    xml += item("DESCRIPTION", sample + " role=\"description\"", band.name);
    if (!r.units.empty()) xml += item("UNITTYPE", sample + " role=\"unittype\"", r.units);
    xml += item("COLORINTERP", sample + " role=\"colorinterp\"", colour_of(r, b));
    if (band.wavelength_um > 0) {
      xml += item("CENTRAL_WAVELENGTH_UM", sample + " domain=\"IMAGERY\"", strf("%.9g", band.wavelength_um));
      xml += item("wavelength", sample, strf("%.9g", band.wavelength_um));
      xml += item("wavelength_units", sample, "Micrometers");
    }
    if (band.fwhm_um > 0) {
      xml += item("FWHM_UM", sample + " domain=\"IMAGERY\"", strf("%.9g", band.fwhm_um));
      xml += item("fwhm", sample, strf("%.9g", band.fwhm_um));
    }
  }
  return xml + "</GDALMetadata>\n";
}

void set_layout(TIFF* tiff, const FloatRaster& r, uint32_t rows_per_strip) {
  const auto bands = static_cast<uint16_t>(r.bands.size());
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, r.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, r.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, bands);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows_per_strip);
  // Not RGB: that would call the first three bands red, green and blue, whatever they are.
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  const std::vector<uint16_t> others(bands, EXTRASAMPLE_UNSPECIFIED);
  if (bands > 1) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, bands - 1, others.data());
}

void set_texts(TIFF* tiff, const FloatRaster& r) {
  add_gdal_tags(tiff);
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, r.comment.c_str());
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, strf("suite %s", kVersion).c_str());
  TIFFSetField(tiff, kGdalMetadataTag, gdal_metadata(r).c_str());
  if (r.no_data) TIFFSetField(tiff, kNoDataTag, std::isnan(*r.no_data) ? "nan" : strf("%.17g", *r.no_data).c_str());
}

bool set_position(TIFF* tiff, const RasterPlacement& at) {
  const double scale[3] = {at.gsd_x, at.gsd_y, 0}, tie[6] = {0, 0, 0, at.west, at.north, 0};
  TIFFSetField(tiff, TIFFTAG_GEOPIXELSCALE, 3, scale);
  TIFFSetField(tiff, TIFFTAG_GEOTIEPOINTS, 6, tie);
  const std::unique_ptr<GTIF, FreeKeys> keys(GTIFNew(tiff));
  if (!keys) return false;
  GTIFKeySet(keys.get(), GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
  if (at.origin_deg) {
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeProjected);
    GTIFKeySet(keys.get(), GeographicTypeGeoKey, TYPE_SHORT, 1, 4326);
    GTIFKeySet(keys.get(), ProjectedCSTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
    GTIFKeySet(keys.get(), ProjectionGeoKey, TYPE_SHORT, 1, KvUserDefined);
    GTIFKeySet(keys.get(), ProjCoordTransGeoKey, TYPE_SHORT, 1, CT_Orthographic);
    GTIFKeySet(keys.get(), ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
    GTIFKeySet(keys.get(), ProjCenterLatGeoKey, TYPE_DOUBLE, 1, (*at.origin_deg)[0]);
    GTIFKeySet(keys.get(), ProjCenterLongGeoKey, TYPE_DOUBLE, 1, (*at.origin_deg)[1]);
    GTIFKeySet(keys.get(), ProjFalseEastingGeoKey, TYPE_DOUBLE, 1, 0.0);
    GTIFKeySet(keys.get(), ProjFalseNorthingGeoKey, TYPE_DOUBLE, 1, 0.0);
  } else {
    GTIFKeySet(keys.get(), GTModelTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
    GTIFKeySet(keys.get(), GTCitationGeoKey, TYPE_ASCII, 0, "local plane, m");
  }
  return GTIFWriteKeys(keys.get()) != 0;
}

bool write_strips(TIFF* tiff, std::span<const float> values, size_t strip_values) {
  std::vector<float> strip;
  for (uint32_t i = 0; !values.empty(); ++i) {
    // The encoder works in the buffer that it is given.
    const size_t count = std::min(values.size(), strip_values);
    strip.assign(values.begin(), values.begin() + static_cast<long>(count));
    if (TIFFWriteEncodedStrip(tiff, i, strip.data(), static_cast<tmsize_t>(count * sizeof(float))) < 0) return false;
    values = values.subspan(count);
  }
  return true;
}

}  // namespace

void write_float_tiff(const std::string& path, const FloatRaster& r, std::span<const float> values) {
  const Where where{path, 0, 0, {}, -1};
  SUITE_CHECK_EQ(values.size(), size_t{r.width} * r.height * r.bands.size());
  if (r.bands.size() > 65535) throw Error(where, strf("a TIFF has at most 65535 bands, not %zu", r.bands.size()));
  AtomicFile file(path);
  be_quiet();
  const bool big = 4.0 * static_cast<double>(values.size()) > kClassicLimit;
  std::unique_ptr<TIFF, CloseTiff> tiff(XTIFFOpen(file.temporary().c_str(), big ? "w8" : "w"));
  if (!tiff) throw Error(where, "cannot be written");
  const size_t row_values = size_t{r.width} * r.bands.size();
  const auto rows = static_cast<uint32_t>(std::clamp<size_t>(kStripBytes / 4 / row_values, 1, r.height));
  set_layout(tiff.get(), r, rows);
  set_texts(tiff.get(), r);
  if (r.placement && !set_position(tiff.get(), *r.placement)) throw Error(where, "its position cannot be written");
  if (!write_strips(tiff.get(), values, row_values * rows) || !TIFFWriteDirectory(tiff.get()))
    throw Error(where, "cannot be written", "is the disk full?");
  tiff.reset();
  file.commit();
}

}  // namespace suite
