#include "importers.h"

#include "base/files.h"
#include "dirsig_import.h"
#include "formats/scene_text/scene_text.h"
#include "helios_import.h"
#include "model_import.h"

namespace suite {

const Registry<ImporterRow>& importers() {
  static const Registry<ImporterRow> table(
      "importer", "", {dirsig_importer(), helios_importer(), model_importer(), scene_text_importer()});
  return table;
}

const ImporterRow& importer_of(const std::string& path) {
  const RandomAccessFile file(path);
  std::string head(std::min<size_t>(file.size(), 4096), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(head)));
  for (const ImporterRow& row : importers())
    if (row.sniff(path, head)) return row;
  std::string known;
  for (const ImporterRow& row : importers()) known += (known.empty() ? "" : "; ") + row.summary;
  throw Error(Where{path, 0, 0, {}, -1}, "is nothing that a scene can be made from", "known: " + known);
}

}  // namespace suite
