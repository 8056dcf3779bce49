#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/files.h"
#include "base/inputs.h"
#include "formats/render_state/internal.h"

namespace suite::render_state {

namespace {

constexpr size_t kTaken = 1;  // its place among the columns of sums
constexpr size_t kCounts = RunStatistics::kCounts;

// body(first, last) of the longest runs of blocks that follow one another, not beyond what is read or written at once.
template <class Body>
void for_runs(std::span<const size_t> blocks, Body body) {
  constexpr size_t kAtOnce = 256;
  for (size_t i = 0; i < blocks.size();) {
    size_t end = i + 1;
    while (end < blocks.size() && blocks[end] == blocks[end - 1] + 1 && end - i < kAtOnce) ++end;
    body(blocks[i], blocks[end - 1] + 1);
    i = end;
  }
}

// The problems of some blocks in the order in which their rows stand in the file.
std::vector<size_t> problems_of(const Columns& c, size_t first, size_t last) {
  std::vector<size_t> problems;
  for (size_t b = first; b < last; ++b)
    for (size_t i = 0; i < c.blocks[b].problems(); ++i) problems.push_back(problem_at(c.shape.columns, c.blocks[b], i));
  return problems;
}

}  // namespace

StateFile::StateFile(std::string path, StateIdentity identity)
    : path_(std::move(path)), identity_(std::move(identity)) {}

StateFile::~StateFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void StateFile::read_places(const std::vector<CaptureShape>& shapes) {
  const OwnResults own;
  h5::Reader reader(path_, kHint);
  check_identity(reader, path_, identity_);
  const StateHead head = read_head(reader);
  cap_ = head.cap, part_ = head.part;
  const auto at = [&](const char* name, h5::Id type, const char* units, long long count) {
    return reader.file_offset(name, reader.open(name, type, units, 1, count));
  };
  cap_at_ = at("/cap", h5::native<uint32_t>(), "1", 1);
  budget_at_ = at("/budget", h5::native<double>(), "SI", 7);
  if (part_) part_at_ = at("/part", h5::native<uint32_t>(), "1", 4);
  for (size_t c = 0; c < shapes.size(); ++c) columns_.push_back(columns_of(reader, c, shapes[c]));
}

void StateFile::open(int mode, int lock) {
  descriptor_ = ::open(path_.c_str(), mode | O_CLOEXEC);
  if (descriptor_ < 0) fail(std::string("cannot be opened: ") + std::strerror(errno));
  if (::flock(descriptor_, lock | LOCK_NB) != 0 && errno == EWOULDBLOCK) fail("is in use by another run");
}

void StateFile::begin(const std::vector<CaptureShape>& shapes) {
  read_places(shapes);
  open(O_RDWR, LOCK_EX);
}

void StateFile::begin_reading(const std::vector<CaptureShape>& shapes) {
  read_places(shapes);
  open(O_RDONLY, LOCK_SH);
}

void StateFile::load(size_t capture, Accumulators& sums, std::vector<double>& needs, BlockCounts& counts) {
  const Columns& c = columns_.at(capture);
  load_needs(c, needs, &counts);
  const auto into = sums.columns();
  const auto ours = static_cast<size_t>(sums.scrambles()), theirs = static_cast<size_t>(c.shape.scrambles);
  const std::vector<size_t> valid = marked(c.valid, c);
  std::vector<std::byte> stored;
  for_runs(valid, [&](size_t first, size_t last) {
    const std::vector<size_t> problems = problems_of(c, first, last);
    for (size_t i = 0; i < into.size(); ++i) {
      const size_t width = into[i].width;
      if (!width) continue;
      stored.resize(problems.size() * theirs * width);
      get(c.sums[i] + c.first[first] * theirs * width, stored.data(), stored.size());
      for (size_t p = 0; p < problems.size(); ++p)
        std::copy_n(&stored[p * theirs * width], std::min(ours, theirs) * width,
                    into[i].data + problems[p] * ours * width);
    }
    for (const size_t p : problems) check_counts(sums, p);
  });
  load_counts(c, valid, counts);
}

void StateFile::load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) {
  const Columns& c = columns_.at(capture);
  load_needs(c, needs, nullptr);
  paths.assign(c.shape.problems(), 0);
  const auto scrambles = static_cast<size_t>(c.shape.scrambles);
  std::vector<uint32_t> taken;
  for_runs(marked(c.valid, c), [&](size_t first, size_t last) {
    const std::vector<size_t> problems = problems_of(c, first, last);
    taken.resize(problems.size() * scrambles);
    get(c.sums[kTaken] + c.first[first] * scrambles * sizeof(uint32_t), taken.data(), taken.size() * sizeof(uint32_t));
    for (size_t i = 0; i < taken.size(); ++i) paths[problems[i / scrambles]] += taken[i];
  });
}

void StateFile::save_needs(size_t capture, std::span<const size_t> blocks, std::span<const double> needs,
                           const BlockCounts& counts) {
  const Columns& c = columns_.at(capture);
  for_runs(blocks, [&](size_t first, size_t last) {
    std::vector<double> rows;
    for (const size_t p : problems_of(c, first, last)) rows.push_back(needs[p]);
    put(c.needs + c.first[first] * sizeof(double), rows.data(), rows.size() * sizeof(double));
  });
  for (const size_t b : blocks)
    put(c.pilot_counts + b * kCounts * sizeof(uint64_t), counts.pilot(b).data(), counts.pilot(b).size_bytes());
  sync();
  mark(c.piloted, blocks, 1);
}

void StateFile::save(size_t capture, std::span<const size_t> blocks, const Accumulators& sums,
                     const BlockCounts& counts) {
  const Columns& c = columns_.at(capture);
  if (any_marked(c.valid, blocks)) {
    mark(c.valid, blocks, 0);
    sync();
  }
  const auto from = sums.columns();
  const auto ours = static_cast<size_t>(sums.scrambles()), theirs = static_cast<size_t>(c.shape.scrambles);
  std::vector<std::byte> stored;
  for_runs(blocks, [&](size_t first, size_t last) {
    const std::vector<size_t> problems = problems_of(c, first, last);
    for (size_t i = 0; i < from.size(); ++i) {
      const size_t width = from[i].width;  // 0: a hole in the file, all zeros
      if (!width) continue;
      stored.assign(problems.size() * theirs * width, std::byte{});
      for (size_t p = 0; p < problems.size(); ++p)
        std::copy_n(from[i].data + problems[p] * ours * width, std::min(ours, theirs) * width,
                    &stored[p * theirs * width]);
      put(c.sums[i] + c.first[first] * theirs * width, stored.data(), stored.size());
    }
  });
  const size_t row = theirs * kCounts;
  std::vector<uint64_t> padded(row);
  for (const size_t b : blocks) {
    std::ranges::copy(counts.of(b).first(std::min(row, counts.of(b).size())), padded.begin());
    put(c.counts + b * row * sizeof(uint64_t), padded.data(), row * sizeof(uint64_t));
  }
  sync();
  mark(c.valid, blocks, 1);
}

void StateFile::fill(bool on) {
  filling_ = on;
  sync();
}

void StateFile::save_cap(uint32_t paths) {
  cap_ = paths;
  put(cap_at_, &cap_, sizeof cap_);
  sync();
}

void StateFile::finish() {
  sync();
  if (!part_) return;
  part_->finished = true;
  const std::vector<uint32_t> packed = pack(*part_);
  put(part_at_, packed.data(), packed.size() * sizeof(uint32_t));
  sync();
}

void StateFile::save_budget(const Budget& budget) {
  const std::vector<double> packed = pack(budget);
  put(budget_at_, packed.data(), packed.size() * sizeof(double));
  sync();
}

// Numbers of the blocks whose mark is set.
std::vector<size_t> StateFile::marked(uint64_t at, const Columns& c) const {
  std::vector<uint8_t> marks(c.blocks.size());
  get(at, marks.data(), marks.size());
  std::vector<size_t> blocks;
  for (size_t b = 0; b < marks.size(); ++b)
    if (marks[b]) blocks.push_back(b);
  return blocks;
}

bool StateFile::any_marked(uint64_t at, std::span<const size_t> blocks) const {
  bool any = false;
  for_runs(blocks, [&](size_t first, size_t last) {
    std::vector<uint8_t> marks(last - first);
    get(at + first, marks.data(), marks.size());
    any = any || std::ranges::any_of(marks, [](uint8_t m) { return m != 0; });
  });
  return any;
}

// A mark that is set reaches the disk after what it stands for, and may do so late.
void StateFile::mark(uint64_t at, std::span<const size_t> blocks, uint8_t value) const {
  for_runs(blocks, [&](size_t first, size_t last) {
    const std::vector<uint8_t> marks(last - first, value);
    put(at + first, marks.data(), marks.size());
  });
}

void StateFile::load_needs(const Columns& c, std::vector<double>& needs, BlockCounts* counts) const {
  const std::vector<size_t> piloted = marked(c.piloted, c);
  needs.assign(piloted.empty() ? 0 : c.shape.problems(), NAN);
  for_runs(piloted, [&](size_t first, size_t last) {
    const std::vector<size_t> problems = problems_of(c, first, last);
    std::vector<double> rows(problems.size());
    get(c.needs + c.first[first] * sizeof(double), rows.data(), rows.size() * sizeof(double));
    for (size_t p = 0; p < rows.size(); ++p) {
      if (!(rows[p] >= 0)) fail("holds needs that cannot be");
      needs[problems[p]] = rows[p];
    }
  });
  if (!counts) return;
  for (const size_t b : piloted)
    get(c.pilot_counts + b * kCounts * sizeof(uint64_t), counts->pilot(b).data(), counts->pilot(b).size_bytes());
}

void StateFile::load_counts(const Columns& c, std::span<const size_t> blocks, BlockCounts& counts) const {
  const size_t row = static_cast<size_t>(c.shape.scrambles) * kCounts;
  for (const size_t b : blocks) {
    const std::span<uint64_t> into = counts.of(b);
    get(c.counts + b * row * sizeof(uint64_t), into.data(), std::min(row, into.size()) * sizeof(uint64_t));
  }
}

void StateFile::check_counts(const Accumulators& sums, size_t problem) const {
  constexpr uint32_t most = 1u << 28;
  for (int s = 0; s < sums.scrambles(); ++s) {
    if (sums.taken(problem, s) > most) fail("holds more paths than can be");
    if (sums.failures(problem, s) > sums.taken(problem, s)) fail("holds more rejected samples than samples");
  }
}

void StateFile::fail(const std::string& what) const { throw Error(Where{path_, 0, 0, {}, -1}, what, kHint); }

void StateFile::get(uint64_t at, void* data, size_t bytes) const {
  for (char* to = static_cast<char*>(data); bytes > 0;) {
    const ssize_t n = ::pread(descriptor_, to, bytes, static_cast<off_t>(at));
    if (n <= 0) fail("cannot be read");
    to += n, at += static_cast<uint64_t>(n), bytes -= static_cast<size_t>(n);
  }
}

void StateFile::put(uint64_t at, const void* data, size_t bytes) const {
  for (const char* from = static_cast<const char*>(data); bytes > 0;) {
    const ssize_t n = ::pwrite(descriptor_, from, bytes, static_cast<off_t>(at));
    if (n <= 0) fail(std::string("cannot be written: ") + std::strerror(errno));
    from += n, at += static_cast<uint64_t>(n), bytes -= static_cast<size_t>(n);
  }
}

void StateFile::sync() const {
  if (filling_) return;
  if (::fdatasync(descriptor_) != 0) fail(std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace suite::render_state
