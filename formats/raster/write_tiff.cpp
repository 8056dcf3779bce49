// Based on: OGC 19-008r4, GeoTIFF Standard 1.1 (user-defined projected CRS, CT_Orthographic); GDAL's raster data model
// and GTiff driver (tags 42112 GDAL_METADATA and 42113 GDAL_NODATA, domain IMAGERY); RPCs in GeoTIFF (tag 50844, NGA
// STDI-0002's RPC00B). The ellipsoidal orthographic projection (EPSG method 9840) of a point is its east and north in
// the tangent plane, which is what scene ENU is.
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
  for (const auto& [name, value] : r.remarks) xml += item(name.c_str(), "", value);
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
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, r.doubles ? 64 : 32);
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

void set_tangent_plane(GTIF* keys, const std::array<double, 2>& origin_deg) {
  GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, ModelTypeProjected);
  GTIFKeySet(keys, GeographicTypeGeoKey, TYPE_SHORT, 1, 4326);
  GTIFKeySet(keys, ProjectedCSTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, ProjectionGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, ProjCoordTransGeoKey, TYPE_SHORT, 1, CT_Orthographic);
  GTIFKeySet(keys, ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
  GTIFKeySet(keys, ProjCenterLatGeoKey, TYPE_DOUBLE, 1, origin_deg[0]);
  GTIFKeySet(keys, ProjCenterLongGeoKey, TYPE_DOUBLE, 1, origin_deg[1]);
  GTIFKeySet(keys, ProjFalseEastingGeoKey, TYPE_DOUBLE, 1, 0.0);
  GTIFKeySet(keys, ProjFalseNorthingGeoKey, TYPE_DOUBLE, 1, 0.0);
}

void set_epsg(GTIF* keys, int epsg, bool geographic) {
  GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, geographic ? ModelTypeGeographic : ModelTypeProjected);
  GTIFKeySet(keys, geographic ? GeographicTypeGeoKey : ProjectedCSTypeGeoKey, TYPE_SHORT, 1, epsg);
  if (geographic)
    GTIFKeySet(keys, GeogAngularUnitsGeoKey, TYPE_SHORT, 1, Angular_Degree);
  else
    GTIFKeySet(keys, ProjLinearUnitsGeoKey, TYPE_SHORT, 1, Linear_Meter);
}

void set_plane(GTIF* keys) {
  GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, KvUserDefined);
  GTIFKeySet(keys, GTCitationGeoKey, TYPE_ASCII, 0, "local plane, m");
}

// The numbers that say where the picture is, and the keys that say in which system.
bool set_position(TIFF* tiff, const FloatRaster& r) {
  if (r.placement) {
    const RasterPlacement& at = *r.placement;
    const double scale[3] = {at.gsd_x, at.gsd_y, 0}, tie[6] = {0, 0, 0, at.west, at.north, 0};
    TIFFSetField(tiff, TIFFTAG_GEOPIXELSCALE, 3, scale);
    TIFFSetField(tiff, TIFFTAG_GEOTIEPOINTS, 6, tie);
  } else {
    std::vector<double> ties;
    for (const GroundControl& c : r.control)
      for (const double x : {c.column, c.row, 0.0, c.x, c.y, c.z}) ties.push_back(x);
    TIFFSetField(tiff, TIFFTAG_GEOTIEPOINTS, static_cast<int>(ties.size()), ties.data());
  }
  const std::unique_ptr<GTIF, FreeKeys> keys(GTIFNew(tiff));
  if (!keys) return false;
  GTIFKeySet(keys.get(), GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
  if (r.placement && r.placement->epsg)
    set_epsg(keys.get(), r.placement->epsg, r.placement->geographic);
  else if (r.placement && r.placement->origin_deg)
    set_tangent_plane(keys.get(), *r.placement->origin_deg);
  else if (r.placement || r.on_plane)
    set_plane(keys.get());
  else
    set_epsg(keys.get(), 4326, true);
  return GTIFWriteKeys(keys.get()) != 0;
}

using RowSource = std::function<void(uint32_t row, std::span<double> values)>;

template <class T>
bool write_strips(TIFF* tiff, const FloatRaster& r, uint32_t rows_per_strip, const RowSource& row) {
  const size_t row_values = size_t{r.width} * r.bands.size();
  std::vector<double> values(row_values);
  std::vector<T> strip;
  for (uint32_t first = 0, i = 0; first < r.height; first += rows_per_strip, ++i) {
    // The encoder works in the buffer that it is given.
    strip.clear();
    for (uint32_t y = first; y < std::min(first + rows_per_strip, r.height); ++y) {
      row(y, values);
      for (const double x : values) strip.push_back(static_cast<T>(x));
    }
    if (TIFFWriteEncodedStrip(tiff, i, strip.data(), static_cast<tmsize_t>(strip.size() * sizeof(T))) < 0) return false;
  }
  return true;
}

}  // namespace

void write_float_tiff(const std::string& path, const FloatRaster& r, std::span<const float> values) {
  const size_t row_values = size_t{r.width} * r.bands.size();
  SUITE_CHECK_EQ(values.size(), row_values * r.height);
  write_float_tiff_rows(path, r, [&](uint32_t row, std::span<double> to) {
    std::copy_n(values.begin() + static_cast<long>(row * row_values), row_values, to.begin());
  });
}

void write_float_tiff_rows(const std::string& path, const FloatRaster& r, const RowSource& row) {
  const Where where{path, 0, 0, {}, -1};
  if (r.bands.size() > 65535) throw Error(where, strf("a TIFF has at most 65535 bands, not %zu", r.bands.size()));
  AtomicFile file(path);
  be_quiet();
  const size_t row_values = size_t{r.width} * r.bands.size(), bytes = r.doubles ? 8 : 4;
  const bool big = static_cast<double>(bytes * row_values) * r.height > kClassicLimit;
  std::unique_ptr<TIFF, CloseTiff> tiff(XTIFFOpen(file.temporary().c_str(), big ? "w8" : "w"));
  if (!tiff) throw Error(where, "cannot be written");
  const auto rows = static_cast<uint32_t>(std::clamp<size_t>(kStripBytes / bytes / row_values, 1, r.height));
  set_layout(tiff.get(), r, rows);
  set_texts(tiff.get(), r);
  if ((r.placement || !r.control.empty()) && !set_position(tiff.get(), r))
    throw Error(where, "its position cannot be written");
  if (r.rpc) TIFFSetField(tiff.get(), kRpcTag, static_cast<int>(r.rpc->size()), r.rpc->data());
  const bool written =
      r.doubles ? write_strips<double>(tiff.get(), r, rows, row) : write_strips<float>(tiff.get(), r, rows, row);
  if (!written || !TIFFWriteDirectory(tiff.get())) throw Error(where, "cannot be written", "is the disk full?");
  tiff.reset();
  file.commit();
}

}  // namespace suite
