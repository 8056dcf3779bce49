#include "formats/hdf5/format_version.h"

#include "base/version.h"

namespace suite::h5 {

void check_version(const Reader& file, const char* read) {
  const std::string found = file.text("version");
  if (found != read) file.fail("is of version '" + found + "', suite " + kVersion + " reads version " + read);
}

}  // namespace suite::h5
