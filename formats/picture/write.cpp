#include <OpenImageIO/imageio.h>

#include "base/error.h"
#include "base/files.h"
#include "formats/picture/picture.h"

namespace suite {

void write_png(const std::string& path, int width, int height, std::span<const uint8_t> rgb,
               const std::string& comment) {
  SUITE_CHECK_EQ(rgb.size(), size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
  AtomicFile file(path);
  // The temporary name has no extension that tells the format, so the writer is asked for by name.
  const auto out = OIIO::ImageOutput::create("png");
  const Where where{path, 0, 0, {}, -1};
  if (!out) throw Error(where, "no PNG writer is available: " + OIIO::geterror());
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("ImageDescription", comment);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!out->open(file.temporary(), spec) || !out->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !out->close())
    throw Error(where, "picture cannot be written: " + out->geterror());
  file.commit();
}

void write_png(const std::string& path, const Canvas& canvas, const std::string& comment) {
  static_assert(sizeof(Rgb) == 3);
  write_png(path, canvas.width(), canvas.height(),
            {reinterpret_cast<const uint8_t*>(canvas.pixels().data()), canvas.pixels().size() * 3}, comment);
}

}  // namespace suite
