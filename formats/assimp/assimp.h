// FBX, Collada and 3DS models, by the Open Asset Import Library. See FORMAT.md.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "base/report.h"
#include "scene/source_model.h"

namespace suite {

// options.unit_m: times the file's own unit (FBX; Collada's is applied by the library). y_up: null: as the file says.
// What is left out goes to `report`
// (SP705, SP706). The file is read in a process of its own, so that a damaged one ends nothing else. Error when it
// cannot be read, or this was built without the library.
SourceModel parse_assimp(std::span<const std::byte> bytes, const std::string& file, const SourceModelOptions& options,
                         const bool* y_up, Report& report);
SourceModel read_assimp(const std::string& path, const SourceModelOptions& options, const bool* y_up, Report& report);

// Whether a file is one of these, by its name.
bool is_assimp(const std::string& path);

}  // namespace suite
