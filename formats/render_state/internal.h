// Names and shapes of the columns of a state file, and the file while a run uses it.
#pragma once
#include <array>

#include "formats/hdf5/h5.h"
#include "formats/render_state/render_state.h"

namespace suite::render_state {

inline constexpr const char* kFormat = "dirsig-render state";
inline constexpr const char* kVersion = "6";
inline constexpr const char* kHint =
    "only the run that made a state can continue with it: start a new run, or give another folder";

std::string group_of(size_t capture);  // "/captures/000012"
// The columns of a capture whose rows are [problem][scramble], as Accumulators::columns() has them.
struct SumsColumn {
  const char* name;
  const char* units;
  h5::Id (*type)();
  size_t (*width)(const CaptureShape&);  // values a row
};
extern const std::array<SumsColumn, Accumulators::kColumns> kSumsColumns;

// Where the columns of one capture stand in the file.
struct Columns {
  CaptureShape shape;
  std::vector<Block> blocks;
  std::vector<size_t> first;  // [block + 1] problems of the blocks before: rows of columns go block by block
  uint64_t valid = 0, piloted = 0, needs = 0, counts = 0, pilot_counts = 0;
  std::array<uint64_t, Accumulators::kColumns> sums{};
};
// Error: not of the shape that is wanted; more scrambles or fewer are fine.
Columns columns_of(h5::Reader& reader, size_t capture, const CaptureShape& wanted);

// Checks format, version and identity.
void check_identity(h5::Reader& reader, const std::string& path, const StateIdentity& identity);
StateHead read_head(h5::Reader& reader);
// The budget as the numbers that are stored.
std::vector<double> pack(const Budget& budget);
// What a part is as the numbers that are stored.
std::vector<uint32_t> pack(const StatePart& part);
// Makes a new state file, empty.
void create_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::optional<StatePart>& part, const std::vector<CaptureShape>& shapes);

class StateFile final : public StateStore {
 public:
  StateFile(std::string path, StateIdentity identity);
  ~StateFile() override;
  void begin(const std::vector<CaptureShape>& shapes) override;
  // The same, to be read only, by others too.
  void begin_reading(const std::vector<CaptureShape>& shapes);
  void load(size_t capture, Accumulators& sums, std::vector<double>& needs, BlockCounts& counts) override;
  void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) override;
  void save_needs(size_t capture, std::span<const size_t> blocks, std::span<const double> needs,
                  const BlockCounts& counts) override;
  void save(size_t capture, std::span<const size_t> blocks, const Accumulators& sums,
            const BlockCounts& counts) override;
  uint32_t cap() const override { return cap_; }
  void save_cap(uint32_t paths) override;
  void finish() override;
  void save_budget(const Budget& budget);
  // While a new file is filled that nobody would miss, its order on the disk does not matter.
  void fill(bool on);

 private:
  void read_places(const std::vector<CaptureShape>& shapes);
  void open(int mode, int lock);
  void load_needs(const Columns& c, std::vector<double>& needs, BlockCounts* counts) const;
  void load_counts(const Columns& c, std::span<const size_t> blocks, BlockCounts& counts) const;
  std::vector<size_t> marked(uint64_t at, const Columns& c) const;
  bool any_marked(uint64_t at, std::span<const size_t> blocks) const;
  void mark(uint64_t at, std::span<const size_t> blocks, uint8_t value) const;
  void check_counts(const Accumulators& sums, size_t problem) const;
  [[noreturn]] void fail(const std::string& what) const;
  void get(uint64_t at, void* data, size_t bytes) const;
  void put(uint64_t at, const void* data, size_t bytes) const;
  void sync() const;

  std::string path_;
  StateIdentity identity_;
  std::vector<Columns> columns_;
  uint64_t cap_at_ = 0, budget_at_ = 0, part_at_ = 0;
  std::optional<StatePart> part_;
  uint32_t cap_ = 0;
  bool filling_ = false;
  int descriptor_ = -1;
};

}  // namespace suite::render_state
