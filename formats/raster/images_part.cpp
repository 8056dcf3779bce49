// The part `images`: all calls of OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/late_part.h"
#include "formats/raster/images.h"

namespace suite {

namespace {

double scale_of(const OIIO::TypeDesc& stored) {
  switch (stored.basetype) {
    case OIIO::TypeDesc::UINT8:
      return 255;
    case OIIO::TypeDesc::INT8:
      return 127;
    case OIIO::TypeDesc::UINT16:
      return 65535;
    case OIIO::TypeDesc::INT16:
      return 32767;
    case OIIO::TypeDesc::UINT32:
      return 4294967295.0;
    case OIIO::TypeDesc::INT32:
      return 2147483647.0;
    case OIIO::TypeDesc::HALF:
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE:
      return 1;
    default:
      return 0;
  }
}

std::string reason(const std::string& problem) { return problem.empty() ? "unknown reason" : problem; }

ImageRead read(const std::string& path, std::span<const std::byte> packed, ImageFacts& facts,
               const std::function<float*()>& room) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // values as stored, not multiplied by alpha
  OIIO::Filesystem::IOMemReader memory(packed.data(), packed.size());
  OIIO::Filesystem::IOProxy* const from = packed.empty() ? nullptr : &memory;
  if (from) config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &from);
  const auto input = OIIO::ImageInput::open(path, &config, from);
  if (!input) return {false, OIIO::geterror()};
  const OIIO::ImageSpec& spec = input->spec();
  facts = {spec.width,
           spec.height,
           spec.depth,
           spec.nchannels,
           spec.format.size(),
           spec.get_string_attribute("compression") == "none",
           !spec.format.is_floating_point(),
           scale_of(spec.format),
           spec.format.c_str()};
  // Fewer bits than the type has are stretched to its range.
  const bool is_unsigned =
      spec.format.basetype == OIIO::TypeDesc::UINT8 || spec.format.basetype == OIIO::TypeDesc::UINT16;
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
  if (is_unsigned && bits > 0 && static_cast<size_t>(bits) < 8 * spec.format.size()) facts.scale = (1 << bits) - 1;
  if (!input->read_image(0, 0, 0, facts.channels, OIIO::TypeDesc::FLOAT, room()))
    return {true, reason(input->geterror())};
  return {true, {}};
}

// Into memory: to files its writer of OpenEXR passes over the last bytes that a disk has no room for.
std::string write(const ImageToWrite& image, const std::function<const float*(int)>& row,
                  std::vector<unsigned char>& bytes) {
  const auto out = OIIO::ImageOutput::create(image.format);
  if (!out) return reason(OIIO::geterror());
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = image.channels;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.alpha_channel = -1;
  for (const ImageAttribute& a : image.attributes)
    std::visit([&](const auto& value) { spec.attribute(a.name, value); }, a.value);
  OIIO::Filesystem::IOVecOutput memory(bytes);
  bool fine = out->set_ioproxy(&memory) && out->open(image.format, spec);
  for (int y = 0; fine && y < image.height; ++y) fine = out->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, row(y));
  return fine && out->close() ? "" : reason(out->geterror());
}

}  // namespace

SUITE_PART_VERSION;
extern "C" {
extern const ImageCalls suite_image_calls;
const ImageCalls suite_image_calls{read, write};
}

}  // namespace suite
