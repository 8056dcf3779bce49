// Texts that a program makes once and a user may edit afterwards: they are never written over.
#pragma once
#include <span>
#include <string>

namespace suite {

struct NamedText {
  std::string file, text;
};

// Writes those that are not there, in folders that are. Error, naming the file, before anything is written: one is
// there with other content. Outputs are to be checked before (check_outputs()): a text that is there is read.
void write_kept_texts(std::span<const NamedText> texts);

}  // namespace suite
