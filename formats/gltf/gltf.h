// glTF 2.0 and GLB: meshes, the hierarchy of nodes that places them, and motions. See FORMAT.md.
#pragma once
#include <span>
#include <string_view>

#include "base/report.h"
#include "scene/source_model.h"

namespace suite {

// The default scene of a file. Buffers that it names are found by options.resolve, relative to the file; images are
// never opened. What is left out or approximated goes to `report` (SP705 to SP707). Error when the file cannot be read,
// needs an extension that is not read here, or says something that cannot be (its place in the file's JSON is told).
SourceModel read_gltf(const std::string& path, const SourceModelOptions& options, Report& report);
SourceModel parse_gltf(std::span<const std::byte> bytes, const std::string& file, const SourceModelOptions& options,
                       Report& report);

// Whether a file is glTF by its name and its first bytes.
bool is_gltf(const std::string& path, std::string_view head);

}  // namespace suite
