#include <sys/statvfs.h>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "base/inputs.h"
#include "formats/hdf5/format_version.h"
#include "formats/render_state/internal.h"

namespace suite {

namespace render_state {

std::string group_of(size_t capture) { return strf("/captures/%06zu", capture); }

namespace {
size_t one(const CaptureShape&) { return 1; }
size_t two(const CaptureShape&) { return 2; }
size_t values(const CaptureShape& s) { return s.values; }
size_t truth_slots(const CaptureShape& s) { return s.truth_slots; }
}  // namespace

const std::array<SumsColumn, Accumulators::kColumns> kSumsColumns{{
    {"/sums", "W/(m2 sr um)", h5::native<double>, values},
    {"/taken", "1", h5::native<uint32_t>, one},
    {"/failures", "1", h5::native<uint32_t>, one},
    {"/truncated", "1", h5::native<float>, one},
    {"/largest", "W/(m2 sr um)", h5::native<float>, one},
    {"/squares", "SI", h5::native<double>, one},
    {"/missing", "W/(m2 sr um)", h5::native<double>, values},
    {"/missing_of", "SI", h5::native<double>, two},
    {"/truth", "1", h5::native<double>, truth_slots},
}};

void check_identity(h5::Reader& reader, const std::string& path, const StateIdentity& identity) {
  if (reader.text("format") != kFormat) reader.fail("is not the state of a run");
  h5::check_version(reader, kVersion);
  for (const auto& [key, mine] : identity)
    if (const std::string theirs = reader.text(key); theirs != mine)
      throw Error(Where{path, 0, 0, {}, -1},
                  strf("belongs to another run: its %s is %.60s, this run's is %.60s", key.c_str(), theirs.c_str(),
                       mine.c_str()),
                  kHint);
}

std::vector<double> pack(const Budget& b) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {b.min_paths ? *b.min_paths : none, b.max_paths ? *b.max_paths : none, b.relative_error.value_or(none),
          b.absolute_floor.value_or(none),   b.all_bands ? 1.0 : 0.0,           b.seconds,
          static_cast<double>(b.more)};
}

std::vector<uint32_t> pack(const StatePart& part) {
  return {part.share.part, part.share.parts, part.planned, part.finished};
}

namespace {

Budget read_budget(h5::Reader& reader) {
  const std::vector<double> v = reader.get<double>("/budget", "SI", 1, 7);
  for (const double x : v)
    if (x < 0 || x > 1e12) reader.fail("holds a budget that cannot be");
  Budget b;
  if (v[0] <= 0x1p31) b.min_paths = static_cast<uint32_t>(v[0]);
  if (v[1] <= 0x1p31) b.max_paths = static_cast<uint32_t>(v[1]);
  if (!std::isnan(v[2])) b.relative_error = v[2];
  if (!std::isnan(v[3])) b.absolute_floor = v[3];
  if (std::isnan(v[4]) || std::isnan(v[5]) || !(v[6] <= 0x1p31)) reader.fail("holds a budget that cannot be");
  b.all_bands = v[4] != 0;
  b.seconds = v[5];
  b.more = static_cast<uint32_t>(v[6]);
  return b;
}

}  // namespace

StateHead read_head(h5::Reader& reader) {
  StateHead head{read_budget(reader), {}, reader.get<uint32_t>("/cap", "1", 1, 1)[0]};
  if (!reader.has("/part")) return head;
  const std::vector<uint32_t> v = reader.get<uint32_t>("/part", "1", 1, 4);
  if (v[0] >= v[1]) reader.fail("holds a part that cannot be");
  head.part = StatePart{{v[0], v[1]}, v[2] != 0, v[3] != 0};
  return head;
}

Columns columns_of(h5::Reader& r, size_t capture, const CaptureShape& wanted) {
  const std::string g = group_of(capture);
  Columns c;
  const std::vector<uint32_t> shape = r.get<uint32_t>(g + "/shape", "1", 1, 5);
  c.shape = {shape[0], shape[1], shape[2], static_cast<int>(shape[3]), shape[4], wanted.mine};
  if (c.shape.columns != wanted.columns || c.shape.rows != wanted.rows || c.shape.values != wanted.values ||
      c.shape.truth_slots != wanted.truth_slots || (shape[3] != 4 && shape[3] != 8))
    r.fail(strf("capture %zu has another shape than in this run", capture));
  c.blocks = blocks_of(c.shape.columns, c.shape.rows);
  c.first.push_back(0);
  for (const Block& b : c.blocks) c.first.push_back(c.first.back() + b.problems());
  const auto blocks = static_cast<long long>(c.blocks.size()), n = static_cast<long long>(c.shape.problems());
  const long long counts = blocks * static_cast<long long>(RunStatistics::kCounts);
  auto at = [&](const char* name, h5::Id type, const char* units, long long rows) {
    return r.file_offset(g + name, r.open(g + name, type, units, 1, rows));
  };
  c.valid = at("/valid", h5::native<uint8_t>(), "1", blocks);
  c.piloted = at("/piloted", h5::native<uint8_t>(), "1", blocks);
  c.needs = at("/needs", h5::native<double>(), "1", n);
  c.counts = at("/counts", h5::native<uint64_t>(), "1", counts * c.shape.scrambles);
  c.pilot_counts = at("/pilot_counts", h5::native<uint64_t>(), "1", counts);
  for (size_t i = 0; i < kSumsColumns.size(); ++i) {
    const SumsColumn& column = kSumsColumns[i];
    c.sums[i] = at(column.name, column.type(), column.units,
                   n * c.shape.scrambles * static_cast<long long>(column.width(c.shape)));
  }
  return c;
}

namespace {

// Problems of a capture that this run will save.
size_t saved_problems(const CaptureShape& s) {
  if (s.mine.empty()) return s.problems();
  const std::vector<Block> blocks = blocks_of(s.columns, s.rows);
  size_t sum = 0;
  for (size_t b = 0; b < blocks.size(); ++b) sum += s.mine[b] ? blocks[b].problems() : 0;
  return sum;
}

double bytes_of(const CaptureShape& s) {
  const Accumulators::Shape sums{saved_problems(s), s.values, s.scrambles, s.truth_slots, true};
  return static_cast<double>(sums.bytes()) + 8.0 * static_cast<double>(s.problems());
}

void check_room(const std::string& path, const std::vector<CaptureShape>& shapes) {
  double bytes = 0;
  for (const CaptureShape& s : shapes) bytes += bytes_of(s);
  const size_t slash = path.rfind('/');
  struct statvfs disk {};
  if (statvfs(slash == std::string::npos ? "." : path.substr(0, slash + 1).c_str(), &disk) == 0 &&
      bytes > static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize))
    throw Error(Where{path, 0, 0, {}, -1},
                strf("the state of this run takes %.3g MB, which the disk has no room for", bytes / 1e6),
                "run without --state, or with fewer bands");
}

void make_columns(h5::Writer& w, size_t capture, const CaptureShape& s) {
  const std::string g = group_of(capture);
  const size_t n = s.problems(), blocks = blocks_of(s.columns, s.rows).size();
  w.put(g + "/shape",
        std::vector<uint32_t>{s.columns, s.rows, static_cast<uint32_t>(s.values), static_cast<uint32_t>(s.scrambles),
                              static_cast<uint32_t>(s.truth_slots)},
        "1");
  // Zeros, most by being a hole in the file: nothing is valid yet, and no value is looked at before it is.
  w.put(g + "/valid", std::vector<uint8_t>(blocks, 0), "1");
  w.put(g + "/piloted", std::vector<uint8_t>(blocks, 0), "1");
  w.column(g + "/needs", h5::native<double>(), n, "1");
  const size_t counts = blocks * RunStatistics::kCounts;
  w.column(g + "/counts", h5::native<uint64_t>(), counts * static_cast<size_t>(s.scrambles), "1");
  w.column(g + "/pilot_counts", h5::native<uint64_t>(), counts, "1");
  for (const SumsColumn& of : kSumsColumns)
    w.column(g + of.name, of.type(), n * static_cast<size_t>(s.scrambles) * of.width(s), of.units);
}

// Takes the disk's room for what a part will save: all but the sums of others' blocks.
void reserve_part(AtomicFile& file, const std::string& path, const std::vector<CaptureShape>& shapes) {
  const OwnResults own;
  h5::Reader reader(file.temporary(), path);
  for (size_t capture = 0; capture < shapes.size(); ++capture) {
    const Columns c = columns_of(reader, capture, shapes[capture]);
    const CaptureShape& s = c.shape;
    const size_t counts = 8 * RunStatistics::kCounts * c.blocks.size(), scrambles = static_cast<size_t>(s.scrambles);
    file.reserve(8 * s.problems(), c.needs);
    file.reserve(counts * scrambles, c.counts);
    file.reserve(counts, c.pilot_counts);
    const Accumulators row({1, s.values, s.scrambles, s.truth_slots, true});
    for (size_t i = 0; i < kSumsColumns.size(); ++i)
      for (size_t b = 0; b < c.blocks.size(); ++b) {
        const size_t bytes = scrambles * row.columns()[i].width;
        if (bytes && (s.mine.empty() || s.mine[b]))
          file.reserve(c.blocks[b].problems() * bytes, c.sums[i] + c.first[b] * bytes);
      }
  }
}

}  // namespace

void create_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::optional<StatePart>& part, const std::vector<CaptureShape>& shapes) {
  check_room(path, shapes);
  AtomicFile file(path);
  {
    h5::Writer w(file.temporary(), path);
    w.attribute("format", std::string(kFormat));
    w.attribute("version", std::string(kVersion));
    for (const auto& [key, text] : identity) w.attribute(key, text);
    w.put("/budget", pack(budget), "SI");
    w.put("/cap", std::vector<uint32_t>{0}, "1");
    if (part) w.put("/part", pack(*part), "1");
    for (size_t c = 0; c < shapes.size(); ++c) make_columns(w, c, shapes[c]);
    w.close();
  }
  // The holes too: a disk that fills up later does not stop the run.
  if (part)
    reserve_part(file, path, shapes);
  else
    file.reserve(file_size(file.temporary()));
  file.commit();
}

}  // namespace render_state

StateHead read_state_head(const std::string& path, const StateIdentity& identity) {
  const OwnResults own;
  h5::Reader reader(path, render_state::kHint);
  render_state::check_identity(reader, path, identity);
  return render_state::read_head(reader);
}

}  // namespace suite
