// The header of a bundle in words and as JSON (schema "suite.sqt-header/1").
#pragma once
#include <string>

#include "base/json.h"
#include "formats/sqt/sqt.h"

namespace suite {

Json header_json(const SqtFile& file, const std::string& path);
std::string header_text(const SqtFile& file, const std::string& path);

}  // namespace suite
