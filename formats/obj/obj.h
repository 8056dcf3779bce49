// Wavefront OBJ geometry. See FORMAT.md.
#pragma once
#include <string>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// What a file names for its materials' looks, and says of colours.
struct ObjLook {
  std::vector<std::string> libraries;  // of `mtllib`, in their order, each once
  bool coloured = false;               // vertices with colours
};

// Reads the triangles of a file; polygons are split, corners with the same position, normal and UV share a vertex.
// Findings (SP201 to SP209) go to `report` with their lines; faces that are found wrong are left out. Error when the
// file cannot be read or is no text. look: filled where it is given (read_mtl, or report_left_out, of mtl.h).
SourceMesh read_obj(const std::string& path, Report& report, ObjLook* look = nullptr);
SourceMesh parse_obj(std::string_view text, const std::string& file, Report& report, ObjLook* look = nullptr);

// Writes every placed mesh that is there at `time` (s), where it is then, flattened into scene ENU, m; placements of
// exact primitives are left out and counted in the result. Written whole or not at all. The hierarchy must be one that
// check_scene accepts. Error: a track does not cover the time.
size_t write_obj(const Scene& scene, double time, const std::string& path);

}  // namespace suite
