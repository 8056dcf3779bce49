#include "formats/raster/images.h"

#include "base/late_part.h"

namespace suite {

const ImageCalls& image_calls() {
  static const auto* const calls = static_cast<const ImageCalls*>(late_symbol("images", "suite_image_calls"));
  return *calls;
}

}  // namespace suite
