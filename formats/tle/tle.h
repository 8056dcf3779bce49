// Two-line element sets (TLE) of satellites; the grammar is in FORMAT.md.
// Based on: D. A. Vallado, P. J. Cefola, "Two-line element sets - practice and use", IAC-12-A6.6.11, 2012.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "motion/sgp4.h"

namespace suite {

struct TleEntry {
  std::string name;  // the title line before the set, or empty
  OrbitElements elements;
};

// All sets of a file or text, in its order. Error, located: no set at all, a line of the wrong length or with the wrong
// checksum, a field that is no number or out of range, line 2 missing or of another satellite, an epoch before 1972.
// Hand-made sets (as in published verification files) often carry no valid checksum: they need `ignored`.
enum class TleChecksum { required, ignored };
std::vector<TleEntry> read_tle(const std::string& path, TleChecksum checksum = TleChecksum::required);
std::vector<TleEntry> parse_tle(std::string_view text, const std::string& file_name,
                                TleChecksum checksum = TleChecksum::required);

// The one set of a satellite, by catalogue number or title. Other sets of the file are not examined, so that one bad
// set in a catalogue does not stop the rest. Errors as above, and: not in the file, or there several times.
TleEntry read_tle_of(const std::string& path, const std::string& satellite);

}  // namespace suite
