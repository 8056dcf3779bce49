// Colours of the materials of an OBJ: MTL files (Wavefront), of which base colours and their images are read.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/report.h"
#include "formats/obj/obj.h"
#include "scene/source_model.h"

namespace suite {

// The materials that the mesh's runs name, each once, in the order of the libraries: Kd (linear) and map_Kd; those of
// which neither is said are left out. Where an image is scaled or moved (-s, -o) the mesh's texture coordinates are;
// where it is changed in another way, and what else a material says, goes to `report` (SP705 to SP707). resolve: where
// a file is that is named. Error: a library or an image is not there or is no text; numbers that are none, located.
std::vector<SourceMaterial> read_mtl(SourceMesh& mesh, const ObjLook& look,
                                     const std::function<std::string(const std::string&)>& resolve, Report& report);

// What a file names for looks and is not read, as SP706.
void report_left_out(const ObjLook& look, const std::string& file, Report& report);

}  // namespace suite
