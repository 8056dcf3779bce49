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
  uint64_t valid = 0, piloted = 0, needs = 0, sums = 0, paths = 0, failures = 0, truncated = 0, largest = 0,
           squares = 0, missing = 0, missing_of = 0, truth = 0;
};

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
    const size_t n = c.shape.problems(), wide = c.shape.values * static_cast<size_t>(c.shape.scrambles);
    load_needs(c, needs);
    std::vector<uint8_t> valid(ranges_of(c.shape));
    get(c.valid, valid.data(), valid.size());
    for (size_t r = 0; r < valid.size(); ++r) {
      if (!valid[r]) continue;
      const size_t first = r * kRangeRows * c.shape.columns,
                   count = std::min(n - first, size_t{kRangeRows} * c.shape.columns);
      std::vector<double> stored(wide * count);
      get(c.sums + first * wide * 8, stored.data(), stored.size() * 8);
      const size_t scrambles = static_cast<size_t>(c.shape.scrambles);
      std::vector<uint32_t> paths(count), failures(count * scrambles);
      std::vector<float> truncated(count), largest(count);
      std::vector<double> squares(count);
      get(c.paths + first * 4, paths.data(), count * 4);
      if (std::any_of(paths.begin(), paths.end(), [](uint32_t x) { return x > (1u << 31); }))
        fail("holds more paths than can be");
      get(c.failures + first * scrambles * 4, failures.data(), failures.size() * 4);
      get(c.truncated + first * 4, truncated.data(), count * 4);
      get(c.largest + first * 4, largest.data(), count * 4);
      get(c.squares + first * 8, squares.data(), count * 8);
      for (size_t i = 0; i < count; ++i) {
        sums.set_paths(first + i, paths[i]);
        for (int s = 0; s < std::min(c.shape.scrambles, sums.scrambles()); ++s) {
          std::copy_n(&stored[i * wide + static_cast<size_t>(s) * c.shape.values], c.shape.values,
                      sums.sums(first + i, s));
          const uint32_t rejected = failures[i * scrambles + static_cast<size_t>(s)];
          if (rejected > dealt(paths[i], static_cast<uint32_t>(s))) fail("holds more rejected samples than samples");
          sums.failures(first + i, s) = rejected;
        }
        sums.truncated(first + i) = truncated[i];
        sums.largest(first + i) = largest[i];
        sums.squares(first + i) = squares[i];
      }
      if (sums.keeps_missing()) {
        get(c.missing + first * c.shape.values * 8, sums.missing(first).light, count * c.shape.values * 8);
        get(c.missing_of + first * 16, sums.missing(first).reference, count * 16);
      }
      get(c.truth + first * c.shape.truth_slots * 8, sums.truth(first), count * c.shape.truth_slots * 8);
    }
  }

  void load_paths(size_t capture, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    const Columns& c = columns_.at(capture);
    load_needs(c, needs);
    paths.assign(c.shape.problems(), 0);
    std::vector<uint8_t> valid(ranges_of(c.shape));
    get(c.valid, valid.data(), valid.size());
    for (size_t r = 0; r < valid.size(); ++r) {
      if (!valid[r]) continue;
      const size_t first = r * kRangeRows * c.shape.columns;
      get(c.paths + first * 4, &paths[first], std::min(paths.size() - first, size_t{kRangeRows} * c.shape.columns) * 4);
    }
  }

  void save_needs(size_t capture, std::span<const double> needs) override {
    const Columns& c = columns_.at(capture);
    put(c.needs, needs.data(), needs.size_bytes());
    sync();
    mark(c.piloted, 1);
  }

  void save(size_t capture, size_t first, size_t count, const Accumulators& sums) override {
    const Columns& c = columns_.at(capture);
    const size_t range = first / (size_t{kRangeRows} * c.shape.columns),
                 wide = c.shape.values * static_cast<size_t>(c.shape.scrambles);
    mark(c.valid + range, 0);
    std::vector<uint32_t> paths, failures;
    std::vector<float> truncated, largest;
    std::vector<double> squares;
    for (size_t i = first; i < first + count; ++i) {
      paths.push_back(sums.paths(i));
      for (int s = 0; s < c.shape.scrambles; ++s) failures.push_back(s < sums.scrambles() ? sums.failures(i, s) : 0);
      truncated.push_back(sums.truncated(i)), largest.push_back(sums.largest(i));
      squares.push_back(sums.squares(i));
    }
    if (sums.scrambles() == c.shape.scrambles) {
      // Problems, scrambles and bands lie behind one another in the accumulators as they do in the file.
      put(c.sums + first * wide * 8, sums.sums(first, 0), wide * count * 8);
    } else {
      const size_t used = c.shape.values * static_cast<size_t>(std::min(sums.scrambles(), c.shape.scrambles));
      std::vector<double> padded(wide * count, 0.0);
      for (size_t i = 0; i < count; ++i) std::copy_n(sums.sums(first + i, 0), used, &padded[i * wide]);
      put(c.sums + first * wide * 8, padded.data(), padded.size() * 8);
    }
    put(c.paths + first * 4, paths.data(), count * 4);
    put(c.failures + first * static_cast<size_t>(c.shape.scrambles) * 4, failures.data(), failures.size() * 4);
    put(c.truncated + first * 4, truncated.data(), count * 4);
    put(c.largest + first * 4, largest.data(), count * 4);
    put(c.squares + first * 8, squares.data(), count * 8);
    if (sums.keeps_missing()) {  // a hole in the file, all zeros, where nothing is missing
      put(c.missing + first * c.shape.values * 8, sums.missing_light(first), count * c.shape.values * 8);
      put(c.missing_of + first * 16, sums.missing_of(first), count * 16);
    }
    put(c.truth + first * c.shape.truth_slots * 8, sums.truth(first), count * c.shape.truth_slots * 8);
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
    c.sums = at("/sums", h5::native<double>(), "W/(m2 sr um)",
                n * static_cast<long long>(c.shape.values) * c.shape.scrambles);
    c.paths = at("/paths", h5::native<uint32_t>(), "1", n);
    c.failures = at("/failures", h5::native<uint32_t>(), "1", n * c.shape.scrambles);
    c.truncated = at("/truncated", h5::native<float>(), "1", n);
    c.largest = at("/largest", h5::native<float>(), "W/(m2 sr um)", n);
    c.squares = at("/squares", h5::native<double>(), "SI", n);
    c.missing = at("/missing", h5::native<double>(), "W/(m2 sr um)", n * static_cast<long long>(c.shape.values));
    c.missing_of = at("/missing_of", h5::native<double>(), "SI", 2 * n);
    c.truth = at("/truth", h5::native<double>(), "1", n * static_cast<long long>(c.shape.truth_slots));
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
    Accumulators sums(s.problems(), s.values, s.scrambles, s.truth_slots, true);
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
