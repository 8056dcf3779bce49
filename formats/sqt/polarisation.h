// Mueller matrices behind the payload of an .sqt (FORMAT.md).
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/json.h"
#include "base/params.h"
#include "sqt/mueller_table.h"

namespace suite::sqt_file {

// Axes for the header, and the elements as an .xz stream.
Json mueller_axes(const sqt::MuellerTable& table);
std::vector<std::byte> mueller_elements(const sqt::MuellerTable& table);

// p: the header's `polarisation`. Error: axes or elements that are none, sizes that do not fit.
std::shared_ptr<const sqt::MuellerTable> mueller_of(const Params& p, std::span<const std::byte> elements);

}  // namespace suite::sqt_file
