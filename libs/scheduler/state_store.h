// Where a run keeps what is needed to continue it: implemented by a format, injected by the app.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "estimate/block_counts.h"
#include "transport/pipeline.h"

namespace suite {

// Size of what a capture gathers: the arguments of its Accumulators.
struct CaptureShape {
  uint32_t columns = 0, rows = 0;
  size_t values = 0;  // [channel][time bin][band]
  int scrambles = 4;
  size_t truth_slots = 0;
  std::vector<uint8_t> mine = {};  // [block] 1 where it will be saved by this run; empty = everywhere
  size_t problems() const { return size_t{columns} * rows; }
};

class StateStore {
 public:
  virtual ~StateStore() = default;
  // Called once, before anything else, with the shapes of all captures, counted over all sensors.
  virtual void begin(const std::vector<CaptureShape>& shapes) = 0;
  // What is stored of a capture. sums and counts come in empty and of the capture's size. needs: NaN where the pilot is
  // not known to be finished; empty when it is so nowhere.
  virtual void load(size_t capture, Accumulators& sums, std::vector<double>& needs, BlockCounts& counts) = 0;
  // Of the same only the paths of each problem (0 where nothing is stored) and the needs.
  virtual void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) = 0;
  // The pilot of some blocks of a capture is finished. counts: those of thrown-away pilots are kept with it.
  virtual void save_needs(size_t capture, std::span<const size_t> blocks, std::span<const double> needs,
                          const BlockCounts& counts) = 0;
  // Some blocks of a capture stand still. Called from one thread at a time. After a crash at any moment the store holds
  // each block as it was saved last, or as never begun.
  virtual void save(size_t capture, std::span<const size_t> blocks, const Accumulators& sums,
                    const BlockCounts& counts) = 0;
  // The maximum of paths that a time budget was turned into; 0 = not yet.
  virtual uint32_t cap() const = 0;
  virtual void save_cap(uint32_t paths) = 0;
  // All that this run was to do is saved.
  virtual void finish() = 0;
};

}  // namespace suite
