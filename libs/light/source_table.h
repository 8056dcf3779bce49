// The table of kinds of sources: what `--list-sources` prints, and what the conformance tests run over.
#pragma once
#include <span>
#include <string>

namespace suite {

struct SourceRow {
  std::string key;   // of the simulation text: "sun", "sky", "lamps", ...
  std::string kind;  // its `kind`, or empty when the key has one kind only
  std::string summary;
  std::string example;  // a simulation text that holds nothing else; lamps name the material "lamp"
};

std::span<const SourceRow> source_kinds();

}  // namespace suite
