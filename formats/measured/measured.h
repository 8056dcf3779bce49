// Any measured scattering file: the format is recognised by its first bytes, else by its extension.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "sqt_fit/samples.h"

namespace suite {

// A function that can be asked at any pair of directions (MERL, RGL), or scattered samples (raw sample text, Cornell,
// CSV).
using Measured = std::variant<std::shared_ptr<const sqt::Function>, sqt::Samples>;

// Error: of the reader, or that no reader knows the file (the hint lists the formats).
Measured read_measured(const std::string& path);

// Whether read_measured would try: one of the formats by its first bytes or its extension. Error: unreadable.
bool looks_measured(const std::string& path);

// One line per format for --help.
std::string measured_formats();

}  // namespace suite
