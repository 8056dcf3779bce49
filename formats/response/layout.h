// Names that writer and reader share. Internal to formats/response.
#pragma once
#include <string>

#include "base/error.h"

namespace suite::response_layout {

inline constexpr const char *kFormat = "suite range response", *kVersion = "1";
inline constexpr const char* kBins = "bin_s_bins_columns_rows_group_index_epsg_blocks_pulses";
inline constexpr const char* kScrambles = "/scrambles";    // their number, and Student's quantile at 95 %
inline constexpr const char* kUnfinished = "/unfinished";  // identity of a run that was stopped
inline std::string in_block(size_t number, const char* name) { return strf("/block/%zu/", number) + name; }

}  // namespace suite::response_layout
