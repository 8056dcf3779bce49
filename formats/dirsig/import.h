// What all parts of one import share: where files are found and how our text names them, and the account.
#pragma once
#include <map>

#include "formats/dirsig/ledger.h"
#include "formats/dirsig/tree.h"

namespace suite::dirsig {

// Folders in which names of one kind of file are looked for, in this order.
using Folders = std::vector<std::string>;

class Import {
 public:
  // search: further folders; base: the folder that names in our text are relative to.
  Import(std::vector<std::string> search, std::string base);

  Ledger& ledger() { return ledger_; }
  const Ledger& ledger() const { return ledger_; }
  // $NAME in file names; DIRSIG_HOME comes from the environment.
  void set_variable(const std::string& name, const std::string& value) { variables_[name] = value; }

  // The path of the file that a value names: variables are replaced, '\' is '/', drives of Windows are left out, case
  // is passed over where nothing else is found. Marks the value exact, or converted where the name had to be bent.
  // Error, located: nowhere.
  std::string file_of(const Item& named, const Folders& folders);
  // The same of a name that is part of a value, which is not marked. how: what was bent; empty = nothing.
  std::string path_of(const Item& at, std::string_view name, const Folders& folders, std::string& how);
  // A path as our text names it.
  std::string name_of(const std::string& path) const;

  // The tree of a file, read once. Error: as reading and parsing.
  const Item& xml(const std::string& path, const std::string& kind);
  const Item& json(const std::string& path);
  const Item& sections(const std::string& path, const std::string& kind, const std::string& root);
  // A file whose account the reader of its grammar has made; keeps it.
  const Item& keep(const std::string& path, const std::string& kind, Item root);
  const Item* known(const std::string& path) const { return ledger_.of(path); }

 private:
  const Item& added(const std::string& path, const std::string& kind, Item root, const std::string& how);
  std::string replaced(std::string_view name, std::string& how) const;
  std::vector<std::string> search_;
  std::string base_;
  std::map<std::string, std::string> variables_;
  Ledger ledger_;
};

std::string folder_of(const std::string& path);
// Last part of a path without what follows the last dot.
std::string stem_of(const std::string& path);

}  // namespace suite::dirsig
