// Whether an OpenVDB file holds what it declares, looked at before OpenVDB believes it: the library asks for as much
// memory as a length in the file says, and reads on after the end.
#pragma once
#include <string>
#include <vector>

namespace suite {

// Walks the header, all descriptors, and every node of the grids named (those that are there and hold floats). Error,
// located at the byte: a length that the file does not have, a version before 222 (OpenVDB 2.0) or after 224, a
// transform that is no box of equal cells.
void check_vdb(const std::string& path, const std::vector<std::string>& grids);

}  // namespace suite
