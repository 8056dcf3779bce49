#include "base/kept_texts.h"

#include "base/error.h"
#include "base/files.h"

namespace suite {

void write_kept_texts(std::span<const NamedText> texts) {
  for (const NamedText& t : texts)
    if (file_exists(t.file) && read_text(t.file) != t.text)
      throw Error(Where{t.file, 0, 0, {}, -1}, "is there with other content than --convert writes",
                  "remove it, or name another folder");
  for (const NamedText& t : texts)
    if (!file_exists(t.file)) write_file(t.file, t.text);  // those that are there are the same
}

}  // namespace suite
