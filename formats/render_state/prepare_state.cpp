// A state file is made, filled with the work of others, or widened when its run begins.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/files.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "formats/render_state/internal.h"

namespace suite {

namespace {

using namespace render_state;

bool roomy(const std::string& path, const std::vector<CaptureShape>& shapes) {
  const OwnResults own;
  h5::Reader reader(path, kHint);
  for (size_t c = 0; c < shapes.size(); ++c)
    if (static_cast<int>(reader.get<uint32_t>(group_of(c) + "/shape", "1", 1, 5)[3]) < shapes[c].scrambles)
      return false;
  return true;
}

// What several states hold of one capture.
struct Joined {
  Accumulators sums;
  BlockCounts counts;
  std::vector<double> needs;
};

void join(StateFile& file, size_t capture, const CaptureShape& s, const std::vector<Block>& blocks, Joined& all) {
  Joined one{Accumulators(all.sums.shape()), {s.columns, s.rows, s.scrambles}, {}};
  file.load(capture, one.sums, one.needs, one.counts);
  all.counts.join(one.counts, all.sums, one.sums);
  all.sums.join(one.sums);
  if (one.needs.empty()) return;
  if (all.needs.empty()) all.needs.assign(s.problems(), NAN);
  for (size_t b = 0; b < blocks.size(); ++b) {
    const size_t first = problem_at(s.columns, blocks[b], 0);
    if (!std::isnan(all.needs[first]) || std::isnan(one.needs[first])) continue;
    all.counts.join_pilot(one.counts, b);
    for (size_t i = 0; i < blocks[b].problems(); ++i) {
      const size_t problem = problem_at(s.columns, blocks[b], i);
      all.needs[problem] = one.needs[problem];
    }
  }
}

// Saves what is known of a capture: needs everywhere, sums where they will be saved by the run.
void save(const Joined& all, size_t capture, const CaptureShape& s, const std::vector<Block>& blocks, StateFile& to) {
  std::vector<size_t> piloted, begun;
  for (size_t b = 0; b < blocks.size(); ++b) {
    bool taken = false;
    for (size_t i = 0; !taken && i < blocks[b].problems(); ++i)
      taken = all.sums.paths(problem_at(s.columns, blocks[b], i)) > 0;
    if (taken && (s.mine.empty() || s.mine[b])) begun.push_back(b);
    if (!all.needs.empty() && !std::isnan(all.needs[problem_at(s.columns, blocks[b], 0)])) piloted.push_back(b);
  }
  if (!piloted.empty()) to.save_needs(capture, piloted, all.needs, all.counts);
  if (!begun.empty()) to.save(capture, begun, all.sums, all.counts);
}

void fill(const std::vector<std::string>& from, const StateIdentity& identity, const std::vector<CaptureShape>& shapes,
          StateFile& to) {
  std::vector<std::unique_ptr<StateFile>> files;
  for (const std::string& path : from) {
    files.push_back(std::make_unique<StateFile>(path, identity));
    files.back()->begin_reading(shapes);
    if (!to.cap() && files.back()->cap()) to.save_cap(files.back()->cap());
  }
  for (size_t c = 0; c < shapes.size(); ++c) {
    const CaptureShape& s = shapes[c];
    const std::vector<Block> blocks = blocks_of(s.columns, s.rows);
    Joined all{
        Accumulators({s.problems(), s.values, s.scrambles, s.truth_slots, true}), {s.columns, s.rows, s.scrambles}, {}};
    for (const auto& file : files) join(*file, c, s, blocks, all);
    save(all, c, s, blocks, to);
  }
}

// A new state that begins with the work of others, one of which may be the one that it replaces.
void create_from(const std::string& path, const StateIdentity& identity, const StateSetup& setup,
                 const std::vector<CaptureShape>& shapes) {
  if (setup.from.empty()) return create_state(path, identity, setup.budget, setup.part, shapes);
  const std::string beside = path + ".joined";
  const Temporary guard(beside.c_str());
  try {
    create_state(beside, identity, setup.budget, setup.part, shapes);
    StateFile to(beside, identity);
    to.begin(shapes);
    to.fill(true);
    fill(setup.from, identity, shapes, to);
    to.fill(false);
  } catch (...) {
    ::unlink(beside.c_str());
    throw;
  }
  if (std::rename(beside.c_str(), path.c_str()) != 0)
    throw Error(Where{path, 0, 0, {}, -1}, "cannot be replaced", kHint);
}

class PreparedState final : public StateStore {
 public:
  PreparedState(const std::string& path, const StateIdentity& identity, StateSetup setup)
      : path_(path), identity_(identity), setup_(std::move(setup)), file_(path, identity) {}
  void begin(const std::vector<CaptureShape>& shapes) override {
    const bool wider = setup_.use == StateUse::extend && !roomy(path_, shapes);
    if (wider) setup_.from = {path_};
    if (wider || setup_.use == StateUse::start) create_from(path_, identity_, setup_, shapes);
    file_.begin(shapes);
    if (setup_.use == StateUse::extend) file_.save_budget(setup_.budget);
  }
  void load(size_t capture, Accumulators& sums, std::vector<double>& needs, BlockCounts& counts) override {
    file_.load(capture, sums, needs, counts);
  }
  void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    file_.load_paths(capture, paths, needs);
  }
  void save_needs(size_t capture, std::span<const size_t> blocks, std::span<const double> needs,
                  const BlockCounts& counts) override {
    file_.save_needs(capture, blocks, needs, counts);
  }
  void save(size_t capture, std::span<const size_t> blocks, const Accumulators& sums,
            const BlockCounts& counts) override {
    file_.save(capture, blocks, sums, counts);
  }
  uint32_t cap() const override { return file_.cap(); }
  void save_cap(uint32_t paths) override { file_.save_cap(paths); }
  void finish() override { file_.finish(); }

 private:
  std::string path_;
  StateIdentity identity_;
  StateSetup setup_;
  StateFile file_;
};

}  // namespace

std::unique_ptr<StateStore> make_state(const std::string& path, const StateIdentity& identity, StateSetup setup) {
  return std::make_unique<PreparedState>(path, identity, std::move(setup));
}

}  // namespace suite
