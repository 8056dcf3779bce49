// The table of what scenes can be made from.
#pragma once
#include "scene/importer.h"

namespace suite {

const Registry<ImporterRow>& importers();
// The first row that takes the file for its own. Error: no such file; none does.
const ImporterRow& importer_of(const std::string& path);

}  // namespace suite
