// What paths found of a scene in a file, whole or in pieces: for other weather, and for searches that were ended. See
// FORMAT.md.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "heat/day_sun.h"
#include "heat/heat_operator.h"
#include "heat/sun_path.h"

namespace suite {

// What a search is of: names ("scene", "paths", ...) and what stands for them. Files fit where all are equal.
using HeatIdentity = std::vector<std::pair<std::string, std::string>>;

struct OperatorIdentity {
  HeatIdentity scene;  // of all of it
  std::string sun;     // digest_of its course: of the sunlight beside that
  size_t ends = 0;     // HeatFaces::ends()
  SunPath path = {};   // of the sun; and
  HeatCut cut = {};    // what the elements were made with: both are kept, and need not agree
};

// Whole or not at all. Error: not writable.
void write_operator(const std::string& path, const HeatOperator& found, const OperatorIdentity& identity,
                    const std::string& made_by);

// An operator in a file.
class StoredOperator {
 public:
  // Error, naming the file: none, damaged, or of another identity but for the sun.
  StoredOperator(const std::string& path, const OperatorIdentity& identity);
  ~StoredOperator();
  bool same_sun() const;  // it has the sunlight, too
  SunPath sun_path() const;
  // into: as untraced_exchange() and untraced_sunlight() make them. Error, naming the file: other sizes, or values that
  // cannot be. The sunlight is that of sun_path().
  void read(ExchangePaths& into) const;
  void read(Sunlight& into) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// What the elements of an operator in a file were made with. Error, naming the file: none, or damaged.
HeatCut operator_cut(const std::string& path);

// Pieces as files in a folder, which is made for the first one; each is there whole or not at all. Error of take() and
// keep(): pieces of another search, damaged or overlapping ones, a folder that cannot be written to.
std::unique_ptr<HeatPieces> pieces_in(const std::string& folder, const OperatorIdentity& identity, double seconds);
// Removes the pieces of a search that is over, and the folder if nothing else is in it. No error when none is there.
void remove_pieces(const std::string& folder);

}  // namespace suite
