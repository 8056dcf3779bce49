// What reading and writing GeoTIFF share. Internal to formats/raster.
#pragma once
#include <optional>

#include <geotiff.h>
#include <xtiffio.h>

namespace suite {

constexpr ttag_t kGdalMetadataTag = 42112;  // GDAL_METADATA, XML
constexpr ttag_t kNoDataTag = 42113;        // GDAL_NODATA, text
constexpr ttag_t kRpcTag = 50844;           // RPCCoefficientTag, doubles

struct CloseTiff {
  void operator()(TIFF* t) const { XTIFFClose(t); }
};
struct FreeKeys {
  void operator()(GTIF* g) const { GTIFFree(g); }
};

// Makes libtiff know these tags, where it does not.
void add_gdal_tags(TIFF* tiff);
// libtiff talks to standard error on its own; what matters comes back as return values.
void be_quiet();
// The mark of missing values, as the tag GDAL_NODATA has it.
std::optional<double> no_data_of(TIFF* tiff);

}  // namespace suite
