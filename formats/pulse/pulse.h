// Shapes of transmitted pulses as tables of text. See FORMAT.md.
#pragma once
#include <string>

#include "detection/detection.h"

namespace suite {

// column: name of the column of powers, or empty where the file has one. Error, with its line: no numbers, another
// number of columns, no such column (with those there are). What pulses cannot be, PulseShape::table() refuses.
PulseTable read_pulse_file(const std::string& path, const std::string& column = {});

}  // namespace suite
