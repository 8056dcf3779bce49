// What the files of this folder share.
#pragma once
#include <string>

namespace suite {

// The header that belongs to an image (or `image` itself when it is a header). Error when there is none.
std::string envi_header_path(const std::string& image);

}  // namespace suite
