// The texts of formats/preset/texts, which CMake puts into the library.
#pragma once
#include <string_view>
#include <vector>

namespace suite {

enum class PresetKind { instrument, lidar };
struct PresetText {
  PresetKind kind;
  std::string_view name, text;
};
const std::vector<PresetText>& preset_texts();

}  // namespace suite
