// The attribute `version` of the suite's own HDF5 files. A file is read by the suites that write its version, and told
// apart from all others by it.
#pragma once
#include "formats/hdf5/h5.h"

namespace suite::h5 {

// Error: the file is of another version than `read`; with the suite's, which says what other one to look for.
void check_version(const Reader& file, const char* read);

}  // namespace suite::h5
