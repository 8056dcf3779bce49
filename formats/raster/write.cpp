// Based on: OGC 19-008r4, GeoTIFF Standard 1.1 (user-defined projected CRS, CT_Orthographic). The ellipsoidal
// orthographic projection (EPSG method 9840) of a point is its east and north in the tangent plane, which is what scene
// ENU is.
#include <OpenImageIO/imageio.h>
#include <geo_normalize.h>
#include <geotiff.h>
#include <geovalues.h>
#include <xtiffio.h>

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/files.h"
#include "formats/raster/raster_write.h"

namespace suite {

namespace {

void write_image(const std::string& path, const char* format, uint32_t width, uint32_t height,
                 const std::vector<std::string>& channels, std::span<const float> values, const std::string& comment) {
  const Where where{path, 0, 0, {}, -1};
  SUITE_CHECK_EQ(values.size(), size_t{width} * height * channels.size());
  auto out = OIIO::ImageOutput::create(format);
  if (!out) throw Error(where, std::string("this build writes no ") + format);
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels;
  spec.attribute("ImageDescription", comment);
  spec.attribute("compression", "zip");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.alpha_channel = -1;
  if (!out->open(path, spec) || !out->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !out->close())
    throw Error(where, "cannot be written: " + out->geterror());
}

struct CloseTiff {
  void operator()(TIFF* t) const { XTIFFClose(t); }
};
struct FreeKeys {
  void operator()(GTIF* g) const { GTIFFree(g); }
};

void add_keys(const std::string& path, const RasterPlacement& at) {
  const std::unique_ptr<TIFF, CloseTiff> tiff(XTIFFOpen(path.c_str(), "r+"));
  if (!tiff) throw Error(Where{path, 0, 0, {}, -1}, "cannot be opened to add its position");
  const double scale[3] = {at.gsd_x, at.gsd_y, 0}, tie[6] = {0, 0, 0, at.west, at.north, 0};
  TIFFSetField(tiff.get(), TIFFTAG_GEOPIXELSCALE, 3, scale);
  TIFFSetField(tiff.get(), TIFFTAG_GEOTIEPOINTS, 6, tie);
  const std::unique_ptr<GTIF, FreeKeys> keys(GTIFNew(tiff.get()));
  if (!keys) throw Error(Where{path, 0, 0, {}, -1}, "takes no GeoTIFF keys");
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
  if (!GTIFWriteKeys(keys.get()) || !TIFFRewriteDirectory(tiff.get()))
    throw Error(Where{path, 0, 0, {}, -1}, "its position cannot be written");
}

}  // namespace

void write_float_tiff(const std::string& path, uint32_t width, uint32_t height,
                      const std::vector<std::string>& channels, std::span<const float> values,
                      const std::string& comment, const std::optional<RasterPlacement>& placement) {
  AtomicFile file(path);
  write_image(file.temporary(), "tiff", width, height, channels, values, comment);
  if (placement) add_keys(file.temporary(), *placement);
  file.commit();
}

void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<std::string>& channels,
               std::span<const float> values, const std::string& comment) {
  AtomicFile file(path);
  write_image(file.temporary(), "openexr", width, height, channels, values, comment);
  file.commit();
}

}  // namespace suite
