// The account of an import: every element, attribute and key of every file that was read, and what became of it.
#pragma once
#include <array>
#include <memory>

#include "formats/dirsig/item.h"

namespace suite::dirsig {

struct Entry {
  Where where;
  std::string path;  // "geometrylist/object/@enabled"
  std::string value;
  Fate fate;
  std::string note;
  bool part = false;  // of something else that is unsupported, and nothing more can be said of it
};

class Ledger {
 public:
  // Takes a file's tree, which stays where it is. kind: "scene", "material database", ...
  const Item& add(std::string file, std::string kind, Item root);
  // Whether a file is in it already; its tree.
  const Item* of(const std::string& file) const;

  // Gives what was not dealt with the fate unsupported, and the name that may be meant. After it every item has a fate.
  void close();

  size_t items() const;                       // elements, attributes and keys of all files
  std::array<size_t, kFates> counts() const;  // sums to items() once closed
  std::vector<Entry> entries() const;         // in the order of the files
  std::vector<std::string> files() const;
  std::string text() const;  // counts, and every entry that is not exact or converted
  std::string json() const;  // schema "suite.import/1": all entries

 private:
  struct File {
    std::string path, kind;
    std::unique_ptr<Item> root;
  };
  std::vector<File> files_;
};

}  // namespace suite::dirsig
