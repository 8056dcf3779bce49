#include <OpenImageIO/imageio.h>

#include <cmath>

#include "base/files.h"
#include "formats/raster/raster.h"

namespace suite {

Raster read_raster(const std::string& path, size_t max_pixels) {
  const Where where{path, 0, 0, {}, -1};
  const size_t bytes = file_size(path);  // tells missing files and directories apart
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // values as stored, not multiplied by alpha
  auto input = OIIO::ImageInput::open(path, &config);
  if (!input) throw Error(where, "cannot be read as an image: " + OIIO::geterror(), "PNG and TIFF are expected");
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 4096)
    throw Error(where,
                strf("an image of %d x %d x %d with %d channels", spec.width, spec.height, spec.depth, spec.nchannels));
  const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
  if (pixels > max_pixels) throw Error(where, strf("%zu pixels, at most %zu are accepted here", pixels, max_pixels));
  // What is declared must fit what is there: as it is when uncompressed, else by what deflate can do at best (1032 :
  // 1), times eight for bits stored as bytes.
  const size_t samples = pixels * static_cast<size_t>(spec.nchannels), stored_bytes = samples * spec.format.size();
  const bool plain = spec.get_string_attribute("compression") == "none";
  if (plain ? stored_bytes > bytes : stored_bytes / (8 * 1032) > bytes)
    throw Error(where, strf("declares %d x %d pixels in %zu bytes", spec.width, spec.height, bytes),
                "the file is damaged");
  Raster raster;
  raster.width = static_cast<uint32_t>(spec.width);
  raster.height = static_cast<uint32_t>(spec.height);
  raster.channels = static_cast<uint32_t>(spec.nchannels);
  raster.values.resize(samples);
  raster.integer = !spec.format.is_floating_point();
  const OIIO::TypeDesc stored = spec.format;
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, raster.values.data()))
    throw Error(where, "cannot be read: " + input->geterror(), "the file is damaged");
  // The library maps unsigned integers to 0..1 and signed ones to -1..1; undo that.
  double scale = 1;
  switch (stored.basetype) {
    case OIIO::TypeDesc::UINT8:
      scale = 255;
      break;
    case OIIO::TypeDesc::INT8:
      scale = 127;
      break;
    case OIIO::TypeDesc::UINT16:
      scale = 65535;
      break;
    case OIIO::TypeDesc::INT16:
      scale = 32767;
      break;
    case OIIO::TypeDesc::HALF:
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE:
      return raster;
    default:
      throw Error(where, strf("pixels of type %s", stored.c_str()), "8 or 16 bit integers, or floats, are expected");
  }
  for (float& v : raster.values) v = static_cast<float>(std::round(v * scale));
  return raster;
}

}  // namespace suite
