// PLY: the polygon file format of Stanford, ASCII and binary of both orders. See FORMAT.md.
#pragma once
#include <span>
#include <string>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// The faces and triangle strips of a file; polygons are split. Findings (SP201 to SP206, SP705, SP706) go to `report`
// with their line (ASCII) or byte; faces that are found wrong are left out. Error when the file cannot be read, its
// header is wrong, or it ends early.
SourceMesh read_ply(const std::string& path, Report& report);
SourceMesh parse_ply(std::span<const std::byte> bytes, const std::string& file, Report& report);

}  // namespace suite
