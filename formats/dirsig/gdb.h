// DIRSIG's geometric database (.gdb): facets with material IDs, as Wavefront OBJ.
#pragma once
#include <optional>
#include <set>
#include <string>

#include "formats/dirsig/item.h"

namespace suite::dirsig {

struct Gdb {
  std::string obj;                  // `usemtl` is the material's ID, `g` the part
  std::set<std::string> materials;  // as `usemtl` has them
  Item account;                     // one entry a field of each part
};

// The name of a material of facets with a temperature of their own (degrees Celsius): ID@-23.15C.
std::string warm_name(const std::string& id, double celsius);
struct WarmName {
  std::string id;
  double celsius = 0;
};
std::optional<WarmName> warm_name_of(std::string_view name);

// Corners keep their order, turned around where the facet's normal says so. Error, located: anything that is not of the
// format, facets of fewer than three corners.
Gdb parse_gdb(std::string_view text, const std::string& file);

// The same of an OBJ's text: what it holds, and the materials that it asks for. Nothing is wrong for it.
struct ObjAccount {
  std::set<std::string> materials;  // `usemtl`
  bool unnamed = false;             // faces stand before the first `usemtl`
  Item account;
};
ObjAccount account_of_obj(std::string_view text, const std::string& file);

}  // namespace suite::dirsig
