// Keys of texts, options of programs and parts of the renderer that have new names. The old names are still read, give
// the same results and one warning each. One table holds all of them; the reference page is made from it
// (`docs/reference/renamed.md`).
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

struct RenamedName {
  enum class Of { key, option, part } of;
  std::string_view old_name, new_name;
  const char* where;  // the map that has the key, the programs that have the option, or the option that takes the part
};

// All of them. A new name may have several old ones, and the reverse.
std::span<const RenamedName> renamed_names();

// The rows whose new name is this key.
std::span<const RenamedName* const> old_names_of_key(std::string_view key);

// One old name that was met. Of one name in one file only the first place is kept.
struct RenamedUse {
  const RenamedName* name;
  Where where;  // of the key; of an option or a part: its name in place of a file
};
void note_renamed(const RenamedName& name, const Where& where);
// The name of a part of the renderer now, and notes it when it was an old one; others as they are.
std::string new_part_name(const std::string& name);
// Those noted since the last call, in order.
std::vector<RenamedUse> take_renamed_uses();
// "sim.yaml:3:1: the key 'knots' is now 'hero_wavelengths'; ...", without a code.
std::string text_of(const RenamedUse& use);

// Error at the place of the old name, when a text gives both.
Error both_given(const RenamedName& name, const Where& old_place, const Where& new_place);

// The arguments of a program with the new names of its options. Those that were old are noted. UsageError: an option is
// given by both names.
std::vector<std::string> with_new_options(const std::string& program, std::vector<std::string> arguments);

}  // namespace suite
