#include <sys/statvfs.h>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "base/inputs.h"
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
  if (const std::string version = reader.text("version"); version != kVersion)
    reader.fail("has version '" + version + "', this program reads " + kVersion);
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

namespace {

double bytes_of(const CaptureShape& s) {
  const Accumulators::Shape sums{s.problems(), s.values, s.scrambles, s.truth_slots, true};
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

}  // namespace

void create_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::vector<CaptureShape>& shapes) {
  check_room(path, shapes);
  AtomicFile file(path);
  {
    h5::Writer w(file.temporary(), path);
    w.attribute("format", std::string(kFormat));
    w.attribute("version", std::string(kVersion));
    for (const auto& [key, text] : identity) w.attribute(key, text);
    w.put("/budget", pack(budget), "SI");
    w.put("/cap", std::vector<uint32_t>{0}, "1");
    for (size_t c = 0; c < shapes.size(); ++c) {
      const CaptureShape& s = shapes[c];
      const std::string g = group_of(c);
      const size_t n = s.problems();
      w.put(g + "/shape",
            std::vector<uint32_t>{s.columns, s.rows, static_cast<uint32_t>(s.values),
                                  static_cast<uint32_t>(s.scrambles), static_cast<uint32_t>(s.truth_slots)},
            "1");
      // Zeros by being a hole in the file: nothing is valid yet, and no value is looked at before it is.
      w.put(g + "/valid", std::vector<uint8_t>(ranges_of(s), 0), "1");
      w.put(g + "/piloted", std::vector<uint8_t>{0}, "1");
      w.column(g + "/needs", h5::native<double>(), n, "1");
      for (const SumsColumn& of : kSumsColumns)
        w.column(g + of.name, of.type(), n * static_cast<size_t>(s.scrambles) * of.width(s), of.units);
    }
    w.close();
  }
  file.reserve(file_size(file.temporary()));  // the holes too: a disk that fills up later does not stop the run
  file.commit();
}

}  // namespace render_state

Budget read_state_budget(const std::string& path, const StateIdentity& identity) {
  const OwnResults own;
  h5::Reader reader(path, render_state::kHint);
  render_state::check_identity(reader, path, identity);
  return render_state::read_budget(reader);
}

}  // namespace suite
