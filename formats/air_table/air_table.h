// Tables of gas absorption in files (HDF5). See FORMAT.md.
#pragma once
#include <string>

#include "air/gas_table.h"

namespace suite {

// Error: a table that is none (check_gas_table), or a path that cannot be written. The file appears whole or not at
// all.
void write_air_table(const std::string& path, const GasTable& table);
// Error: no such file or no air table, of another version, sizes that do not fit, values out of range. Every size is
// checked before memory is asked for.
GasTable read_air_table(const std::string& path);

}  // namespace suite
