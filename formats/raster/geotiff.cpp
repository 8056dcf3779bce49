// Based on: OGC 19-008r4, GeoTIFF Standard 1.1 (raster space, model tie points, key values).
#include <cstdarg>
#include <cstdio>
#include <memory>

#include <geo_normalize.h>
#include <geovalues.h>

#include "base/files.h"
#include "formats/raster/raster.h"
#include "formats/raster/tags.h"

namespace suite {

namespace {

void quiet(const char*, const char*, va_list) {}

const double* tag(TIFF* tiff, ttag_t id, uint16_t& count) {
  double* data = nullptr;
  count = 0;
  return TIFFGetField(tiff, id, &count, &data) ? data : nullptr;
}

void read_transform(TIFF* tiff, GTIF* keys, const Where& where, double m[6]) {
  uint16_t n = 0;
  if (const double* t = tag(tiff, TIFFTAG_GEOTRANSMATRIX, n); t && n == 16) {
    const double values[6] = {t[3], t[0], t[1], t[7], t[4], t[5]};
    std::copy(values, values + 6, m);
  } else {
    uint16_t scales = 0, ties = 0;
    const double* scale = tag(tiff, TIFFTAG_GEOPIXELSCALE, scales);
    const double* tie = tag(tiff, TIFFTAG_GEOTIEPOINTS, ties);
    if (!scale || scales < 2 || !tie || ties < 6)
      throw Error(where, "has no pixel scale and tie point", "a GeoTIFF with a position is expected");
    const double values[6] = {tie[3] - scale[0] * tie[0], scale[0], 0, tie[4] + scale[1] * tie[1], 0, -scale[1]};
    std::copy(values, values + 6, m);
  }
  unsigned short type = RasterPixelIsArea;
  GTIFKeyGetSHORT(keys, GTRasterTypeGeoKey, &type, 0, 1);
  if (type == RasterPixelIsPoint) {  // the tie point is a pixel's centre: move to its corner
    m[0] -= 0.5 * (m[1] + m[2]);
    m[3] -= 0.5 * (m[4] + m[5]);
  }
  for (int i = 0; i < 6; ++i)
    if (!(m[i] > -1e9 && m[i] < 1e9)) throw Error(where, "has a position that is not finite or absurd");
  if (m[1] * m[5] - m[2] * m[4] == 0) throw Error(where, "has a pixel scale of zero");
}

}  // namespace

void be_quiet() {
  TIFFSetErrorHandler(quiet);
  TIFFSetWarningHandler(quiet);
}

void add_gdal_tags(TIFF* tiff) {
  static const TIFFFieldInfo metadata[] = {
      {kGdalMetadataTag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALMetadata")}};
  static const TIFFFieldInfo no_data[] = {
      {kNoDataTag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoData")}};
  static const TIFFFieldInfo rpc[] = {
      {kRpcTag, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, const_cast<char*>("RPCCoefficient")}};
  if (!TIFFFindField(tiff, kRpcTag, TIFF_ANY)) TIFFMergeFieldInfo(tiff, rpc, 1);
  if (!TIFFFindField(tiff, kGdalMetadataTag, TIFF_ANY)) TIFFMergeFieldInfo(tiff, metadata, 1);
  if (!TIFFFindField(tiff, kNoDataTag, TIFF_ANY)) TIFFMergeFieldInfo(tiff, no_data, 1);
}

// EPSG: units of length (9002 foot, 9003 US survey foot), heights in feet (NAVD88 8228, 6360; NGVD29 5702).
double height_unit(GTIF* keys) {
  constexpr double foot = 0.3048, us_survey_foot = 1200.0 / 3937;
  unsigned short code = 0;
  if (GTIFKeyGetSHORT(keys, VerticalUnitsGeoKey, &code, 0, 1)) {
    if (code == 9002) return foot;
    if (code == 9003) return us_survey_foot;
  }
  if (GTIFKeyGetSHORT(keys, VerticalCSTypeGeoKey, &code, 0, 1)) {
    if (code == 8228) return foot;
    if (code == 6360 || code == 5702) return us_survey_foot;
  }
  return 1;
}

// EPSG's vertical systems count from the sea or the geoid; 5001 to 5033 stood for ellipsoids in GeoTIFF 1.0.
int vertical_system(GTIF* keys) {
  unsigned short code = 0;
  if (!GTIFKeyGetSHORT(keys, VerticalCSTypeGeoKey, &code, 0, 1) || code == KvUserDefined) return 0;
  return code >= 1024 && !(code >= 5001 && code <= 5033) ? code : 0;
}

GeoReference read_georeference(const std::string& path) {
  const Where where{path, 0, 0, {}, -1};
  input_size(path);
  be_quiet();
  const std::unique_ptr<TIFF, CloseTiff> tiff(XTIFFOpen(path.c_str(), "r"));
  if (!tiff) throw Error(where, "is not a TIFF file", "a GeoTIFF is expected");
  const std::unique_ptr<GTIF, FreeKeys> keys(GTIFNew(tiff.get()));
  if (!keys) throw Error(where, "has no GeoTIFF keys", "a GeoTIFF is expected");
  GeoReference ref;
  read_transform(tiff.get(), keys.get(), where, ref.to_map);
  unsigned short code = 0, model = 0;
  GTIFKeyGetSHORT(keys.get(), GTModelTypeGeoKey, &model, 0, 1);
  if (GTIFKeyGetSHORT(keys.get(), ProjectedCSTypeGeoKey, &code, 0, 1) && code != KvUserDefined &&
      model != ModelTypeGeographic) {
    ref.epsg = code;
  } else if (GTIFKeyGetSHORT(keys.get(), GeographicTypeGeoKey, &code, 0, 1) && code != KvUserDefined &&
             model != ModelTypeProjected) {
    ref.epsg = code;
    ref.geographic = true;
  } else {
    throw Error(where, "names no EPSG code in its GeoTIFF keys", "ProjectedCSType or GeographicType is needed");
  }
  ref.height_unit_m = height_unit(keys.get());
  ref.vertical_epsg = vertical_system(keys.get());
  ref.no_data = no_data_of(tiff.get());
  return ref;
}

}  // namespace suite
