#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "base/files.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "formats/render_state/internal.h"

namespace suite {

namespace {

using namespace render_state;

// Where the columns of one capture stand in the file.
struct Columns {
  CaptureShape shape;
  uint64_t valid = 0, piloted = 0, needs = 0;
  std::array<uint64_t, Accumulators::kColumns> sums{};
};
constexpr size_t kTaken = 1;  // its place among them

class StateFile final : public StateStore {
 public:
  StateFile(const std::string& path, const StateIdentity& identity) : path_(path), identity_(identity) {}
  ~StateFile() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  void begin(const std::vector<CaptureShape>& shapes) override {
    {
      const OwnResults own;
      h5::Reader reader(path_, kHint);
      check_identity(reader, path_, identity_);
      read_budget(reader);
      cap_ = reader.get<uint32_t>("/cap", "1", 1, 1)[0];
      cap_at_ = reader.file_offset("/cap", reader.open("/cap", h5::native<uint32_t>(), "1", 1, 1));
      budget_at_ = reader.file_offset("/budget", reader.open("/budget", h5::native<double>(), "SI", 1, 7));
      for (size_t c = 0; c < shapes.size(); ++c) columns_.push_back(columns_of(reader, c, shapes[c]));
    }
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot be opened for writing");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      fail("is in use by another run");
    }
  }

  void load(size_t capture, Accumulators& sums, std::vector<double>& needs) override {
    const Columns& c = columns_.at(capture);
    load_needs(c, needs);
    const auto into = sums.columns();
    const auto ours = static_cast<size_t>(sums.scrambles()), theirs = static_cast<size_t>(c.shape.scrambles);
    std::vector<std::byte> stored;
    for_each_valid(c, [&](size_t first, size_t count) {
      for (size_t i = 0; i < into.size(); ++i) {
        const size_t width = into[i].width;
        if (!width) continue;
        if (ours == theirs) {
          get(c.sums[i] + first * ours * width, into[i].data + first * ours * width, count * ours * width);
          continue;
        }
        stored.resize(count * theirs * width);
        get(c.sums[i] + first * theirs * width, stored.data(), stored.size());
        for (size_t p = 0; p < count; ++p)
          std::copy_n(&stored[p * theirs * width], std::min(ours, theirs) * width,
                      into[i].data + (first + p) * ours * width);
      }
      for (size_t p = first; p < first + count; ++p) check_counts(sums, p);
    });
  }

  void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    const Columns& c = columns_.at(capture);
    load_needs(c, needs);
    paths.assign(c.shape.problems(), 0);
    const auto scrambles = static_cast<size_t>(c.shape.scrambles);
    std::vector<uint32_t> taken;
    for_each_valid(c, [&](size_t first, size_t count) {
      taken.resize(count * scrambles);
      get(c.sums[kTaken] + first * scrambles * sizeof(uint32_t), taken.data(), taken.size() * sizeof(uint32_t));
      for (size_t i = 0; i < taken.size(); ++i) paths[first + i / scrambles] += taken[i];
    });
  }

  void save_needs(size_t capture, std::span<const double> needs) override {
    const Columns& c = columns_.at(capture);
    put(c.needs, needs.data(), needs.size_bytes());
    sync();
    mark(c.piloted, 1);
  }

  void save(size_t capture, size_t first, size_t count, const Accumulators& sums) override {
    const Columns& c = columns_.at(capture);
    const size_t range = first / (size_t{kRangeRows} * c.shape.columns);
    mark(c.valid + range, 0);
    const auto from = sums.columns();
    const auto ours = static_cast<size_t>(sums.scrambles()), theirs = static_cast<size_t>(c.shape.scrambles);
    std::vector<std::byte> padded;
    for (size_t i = 0; i < from.size(); ++i) {
      const size_t width = from[i].width;  // 0: a hole in the file, all zeros
      if (!width) continue;
      const std::byte* data = from[i].data + first * ours * width;
      if (ours != theirs) {
        padded.assign(count * theirs * width, std::byte{});
        for (size_t p = 0; p < count; ++p)
          std::copy_n(data + p * ours * width, std::min(ours, theirs) * width, &padded[p * theirs * width]);
        data = padded.data();
      }
      put(c.sums[i] + first * theirs * width, data, count * theirs * width);
    }
    sync();
    mark(c.valid + range, 1);
  }

  uint32_t cap() const override { return cap_; }
  void save_cap(uint32_t paths) override {
    cap_ = paths;
    put(cap_at_, &cap_, sizeof cap_);
    sync();
  }

  void save_budget(const Budget& budget) {
    const std::vector<double> packed = pack(budget);
    put(budget_at_, packed.data(), packed.size() * sizeof(double));
    sync();
  }

 private:
  void load_needs(const Columns& c, std::vector<double>& needs) const {
    uint8_t piloted = 0;
    get(c.piloted, &piloted, 1);
    needs.assign(piloted ? c.shape.problems() : 0, 0.0);
    if (!piloted) return;
    get(c.needs, needs.data(), needs.size() * sizeof(double));
    if (std::any_of(needs.begin(), needs.end(), [](double x) { return !(x >= 0); })) fail("holds needs that cannot be");
  }
  // body(first, count) for each range of problems that is valid.
  template <class Body>
  void for_each_valid(const Columns& c, Body body) const {
    std::vector<uint8_t> valid(ranges_of(c.shape));
    get(c.valid, valid.data(), valid.size());
    for (size_t r = 0; r < valid.size(); ++r) {
      const size_t first = r * kRangeRows * c.shape.columns;
      if (valid[r]) body(first, std::min(c.shape.problems() - first, size_t{kRangeRows} * c.shape.columns));
    }
  }
  void check_counts(const Accumulators& sums, size_t problem) const {
    constexpr uint32_t most = 1u << 28;
    for (int s = 0; s < sums.scrambles(); ++s) {
      if (sums.taken(problem, s) > most) fail("holds more paths than can be");
      if (sums.failures(problem, s) > sums.taken(problem, s)) fail("holds more rejected samples than samples");
    }
  }
  static Columns columns_of(h5::Reader& r, size_t capture, const CaptureShape& wanted) {
    const std::string g = group_of(capture);
    Columns c;
    const std::vector<uint32_t> shape = r.get<uint32_t>(g + "/shape", "1", 1, 5);
    c.shape = {shape[0], shape[1], shape[2], static_cast<int>(shape[3]), shape[4]};
    if (c.shape.columns != wanted.columns || c.shape.rows != wanted.rows || c.shape.values != wanted.values ||
        c.shape.truth_slots != wanted.truth_slots || (shape[3] != 4 && shape[3] != 8))
      r.fail(strf("capture %zu has another shape than in this run", capture));
    const auto n = static_cast<long long>(c.shape.problems());
    auto at = [&](const char* name, h5::Id type, const char* units, long long rows) {
      return r.file_offset(g + name, r.open(g + name, type, units, 1, rows));
    };
    c.valid = at("/valid", h5::native<uint8_t>(), "1", static_cast<long long>(ranges_of(c.shape)));
    c.piloted = at("/piloted", h5::native<uint8_t>(), "1", 1);
    c.needs = at("/needs", h5::native<double>(), "1", n);
    for (size_t i = 0; i < kSumsColumns.size(); ++i) {
      const SumsColumn& column = kSumsColumns[i];
      c.sums[i] = at(column.name, column.type(), column.units,
                     n * c.shape.scrambles * static_cast<long long>(column.width(c.shape)));
    }
    return c;
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error(Where{path_, 0, 0, {}, -1}, what, kHint); }
  void get(uint64_t at, void* data, size_t bytes) const {
    for (char* to = static_cast<char*>(data); bytes > 0;) {
      const ssize_t n = ::pread(descriptor_, to, bytes, static_cast<off_t>(at));
      if (n <= 0) fail("cannot be read");
      to += n, at += static_cast<uint64_t>(n), bytes -= static_cast<size_t>(n);
    }
  }
  void put(uint64_t at, const void* data, size_t bytes) const {
    for (const char* from = static_cast<const char*>(data); bytes > 0;) {
      const ssize_t n = ::pwrite(descriptor_, from, bytes, static_cast<off_t>(at));
      if (n <= 0) fail(std::string("cannot be written: ") + std::strerror(errno));
      from += n, at += static_cast<uint64_t>(n), bytes -= static_cast<size_t>(n);
    }
  }
  void sync() const {
    if (::fdatasync(descriptor_) != 0) fail(std::string("cannot be written: ") + std::strerror(errno));
  }
  void mark(uint64_t at, uint8_t value) const {
    put(at, &value, 1);
    sync();
  }

  std::string path_;
  StateIdentity identity_;
  std::vector<Columns> columns_;
  uint64_t cap_at_ = 0, budget_at_ = 0;
  uint32_t cap_ = 0;
  int descriptor_ = -1;
};

bool roomy(const std::string& path, const std::vector<CaptureShape>& shapes) {
  const OwnResults own;
  h5::Reader reader(path, kHint);
  for (size_t c = 0; c < shapes.size(); ++c)
    if (static_cast<int>(reader.get<uint32_t>(group_of(c) + "/shape", "1", 1, 5)[3]) < shapes[c].scrambles)
      return false;
  return true;
}

// Copies what one state holds into another that has more scrambles, through the accumulators.
void copy_state(StateFile& from, StateFile& to, const std::vector<CaptureShape>& shapes) {
  for (size_t c = 0; c < shapes.size(); ++c) {
    const CaptureShape& s = shapes[c];
    Accumulators sums({s.problems(), s.values, s.scrambles, s.truth_slots, true});
    std::vector<double> needs;
    from.load(c, sums, needs);
    if (!needs.empty()) to.save_needs(c, needs);
    for (size_t first = 0; first < s.problems(); first += size_t{kRangeRows} * s.columns)
      to.save(c, first, std::min(s.problems() - first, size_t{kRangeRows} * s.columns), sums);
  }
  if (from.cap()) to.save_cap(from.cap());
}

void extend_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::vector<CaptureShape>& shapes) {
  if (roomy(path, shapes)) {
    StateFile file(path, identity);
    file.begin(shapes);
    file.save_budget(budget);
    return;
  }
  const std::string wider = path + ".wider";
  const Temporary guard(wider.c_str());
  try {
    create_state(wider, identity, budget, shapes);
    StateFile from(path, identity), to(wider, identity);
    from.begin(shapes);
    to.begin(shapes);
    copy_state(from, to, shapes);
  } catch (...) {
    ::unlink(wider.c_str());
    throw;
  }
  if (std::rename(wider.c_str(), path.c_str()) != 0)
    throw Error(Where{path, 0, 0, {}, -1}, "cannot be replaced", kHint);
}

// A state file that is made or widened when its run begins.
class PreparedState final : public StateStore {
 public:
  PreparedState(const std::string& path, StateUse use, const StateIdentity& identity, const Budget& budget)
      : path_(path), use_(use), identity_(identity), budget_(budget), file_(path, identity) {}
  void begin(const std::vector<CaptureShape>& shapes) override {
    if (use_ == StateUse::start) create_state(path_, identity_, budget_, shapes);
    if (use_ == StateUse::extend) extend_state(path_, identity_, budget_, shapes);
    file_.begin(shapes);
  }
  void load(size_t capture, Accumulators& sums, std::vector<double>& needs) override {
    file_.load(capture, sums, needs);
  }
  void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    file_.load_paths(capture, paths, needs);
  }
  void save_needs(size_t capture, std::span<const double> needs) override { file_.save_needs(capture, needs); }
  void save(size_t capture, size_t first, size_t count, const Accumulators& sums) override {
    file_.save(capture, first, count, sums);
  }
  uint32_t cap() const override { return file_.cap(); }
  void save_cap(uint32_t paths) override { file_.save_cap(paths); }

 private:
  std::string path_;
  StateUse use_;
  StateIdentity identity_;
  Budget budget_;
  StateFile file_;
};

}  // namespace

std::unique_ptr<StateStore> make_state(const std::string& path, StateUse use, const StateIdentity& identity,
                                       const Budget& budget) {
  return std::make_unique<PreparedState>(path, use, identity, budget);
}

}  // namespace suite
