// The grammars that DIRSIG's files are written in, each as a tree of items. Errors are located.
#pragma once
#include "formats/dirsig/item.h"

namespace suite::dirsig {

// XML: attributes are children named "@name".
Item parse_xml(std::string_view text, const std::string& file);
// JSON: items of lists are children named "item".
Item parse_json(std::string_view text, const std::string& file);
// "tag + value" texts (.mat, .odb, .mov, .cfg, .adb): lines `KEY = VALUE` or `KEY:VALUE`, `NAME {` ... `}`; '#' begins
// a comment; keys may be of either case, and become upper. Keys that stand in no section are children of the root,
// which is called `root`.
Item parse_sections(std::string_view text, const std::string& file, const std::string& root);

}  // namespace suite::dirsig
