// The styles and scripts of libs/page/live, which CMake puts into the library.
#pragma once
#include <string_view>
#include <vector>

namespace suite {

struct LiveText {
  std::string_view name, text;  // "live.js", what stands in it
};
const std::vector<LiveText>& live_texts();

}  // namespace suite
