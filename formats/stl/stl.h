// STL: triangles without anything else, ASCII and binary. See FORMAT.md.
#pragma once
#include <span>
#include <string>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// The triangles of a file; corners at exactly the same place become one vertex, and the order of the corners says where
// the front is. Findings (SP203, SP204, SP706) go to `report` with their line (ASCII) or byte. Error when the file
// cannot be read or is not STL.
SourceMesh read_stl(const std::string& path, Report& report);
SourceMesh parse_stl(std::span<const std::byte> bytes, const std::string& file, Report& report);

}  // namespace suite
