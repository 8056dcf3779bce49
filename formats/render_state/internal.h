// Names and shapes of the columns of a state file.
#pragma once
#include <array>

#include "formats/hdf5/h5.h"
#include "formats/render_state/render_state.h"

namespace suite::render_state {

inline constexpr const char* kFormat = "dirsig-render state";
inline constexpr const char* kVersion = "4";
inline constexpr const char* kHint = "start the run anew without --resume and --more, or give it another folder";
inline constexpr uint32_t kRangeRows = kBlockEdge;  // rows of problems that are saved together: one row of blocks

inline size_t ranges_of(const CaptureShape& s) { return (s.rows + kRangeRows - 1) / kRangeRows; }
std::string group_of(size_t capture);  // "/captures/000012"
// The columns of a capture whose rows are [problem][scramble], as Accumulators::columns() has them.
struct SumsColumn {
  const char* name;
  const char* units;
  h5::Id (*type)();
  size_t (*width)(const CaptureShape&);  // values a row
};
extern const std::array<SumsColumn, Accumulators::kColumns> kSumsColumns;
// Checks format, version and identity.
void check_identity(h5::Reader& reader, const std::string& path, const StateIdentity& identity);
Budget read_budget(h5::Reader& reader);
// The budget as the numbers that are stored.
std::vector<double> pack(const Budget& budget);
// Makes a new state file, empty.
void create_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::vector<CaptureShape>& shapes);

}  // namespace suite::render_state
