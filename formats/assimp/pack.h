// A model as bytes and back, from one process to another of the same program.
#pragma once
#include <string>
#include <string_view>

#include "formats/assimp/part.h"

namespace suite {

std::string packed(const AssimpModel& model);
// Nothing is trusted beyond its size: the bytes are those of packed(), or fewer. False: fewer.
bool unpack(std::string_view bytes, AssimpModel& model);

}  // namespace suite
