#include "formats/instances/instances.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "math/dualquat.h"

namespace suite {

namespace {

constexpr size_t kMaxRows = 100'000'000;
enum Column { x, y, z, heading, qw, qx, qy, qz, scale, sx, sy, sz, column_count };
const std::vector<std::string> kNames{"x", "y", "z", "heading_deg", "qw", "qx", "qy", "qz", "scale", "sx", "sy", "sz"};
using Row = std::array<double, column_count>;
constexpr Row kDefault{0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};

Affine3 transform(const Row& r, const Where& where) {
  for (const double v : r)
    if (!std::isfinite(v)) throw Error(where, "a number is not finite");
  if (r[scale] * r[sx] * r[sy] * r[sz] == 0) throw Error(where, "a scale of 0");
  const double norm = std::hypot(std::hypot(r[qw], r[qx]), std::hypot(r[qy], r[qz]));
  if (!(norm > 1e-12 && norm < 1e12)) throw Error(where, "a quaternion without length");
  Affine3 t = scaling({r[scale] * r[sx], r[scale] * r[sy], r[scale] * r[sz]});
  if (r[heading] != 0) t = rotation({0, 0, 1}, -r[heading] * kDegree) * t;
  if (r[qx] != 0 || r[qy] != 0 || r[qz] != 0) t = Pose{normalized(Quat{r[qw], r[qx], r[qy], r[qz]}), {}}.affine() * t;
  t.b = {r[x], r[y], r[z]};
  return t;
}

std::vector<Affine3> read_binary(const std::string& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  constexpr size_t width = 8 * sizeof(double);
  if (bytes.size() % width)
    throw Error(Where{path, 0, 0, {}, -1}, strf("has %zu bytes, rows have %zu", bytes.size(), width));
  std::vector<Affine3> out;
  out.reserve(bytes.size() / width);
  for (size_t at = 0; at < bytes.size(); at += width) {
    double v[8];
    std::memcpy(v, bytes.data() + at, width);
    Row r = kDefault;
    r[x] = v[0], r[y] = v[1], r[z] = v[2], r[qw] = v[3], r[qx] = v[4], r[qy] = v[5], r[qz] = v[6], r[scale] = v[7];
    out.push_back(transform(r, Where{path, 0, 0, {}, static_cast<long long>(at)}));
  }
  return out;
}

std::vector<int> read_header(std::string_view line, const Where& where) {
  std::vector<int> columns;
  std::array<bool, column_count> seen{};
  for (size_t at = 0; at <= line.size();) {
    const size_t end = std::min(line.find(',', at), line.size());
    std::string name(line.substr(at, end - at));
    name.erase(0, name.find_first_not_of(" \t"));
    name.erase(name.find_last_not_of(" \t") + 1);
    int found = 0;
    while (found < column_count && kNames[static_cast<size_t>(found)] != name) ++found;
    if (found == column_count) throw Error(where, "unknown column '" + name + "'", name_hint(name, kNames));
    if (seen[static_cast<size_t>(found)]) throw Error(where, "column '" + name + "' is given twice");
    seen[static_cast<size_t>(found)] = true;
    columns.push_back(found);
    at = end + 1;
  }
  if (!seen[x] || !seen[y]) throw Error(where, "the columns 'x' and 'y' are needed");
  if (seen[heading] && (seen[qw] || seen[qx] || seen[qy] || seen[qz]))
    throw Error(where, "'heading_deg' and a quaternion exclude each other");
  const bool q = seen[qw] && seen[qx] && seen[qy] && seen[qz];
  if (!q && (seen[qw] || seen[qx] || seen[qy] || seen[qz]))
    throw Error(where, "a quaternion needs 'qw', 'qx', 'qy' and 'qz'");
  return columns;
}

std::vector<Affine3> read_csv(const std::string& path) {
  const std::string text = read_text(path, size_t{16} << 30);
  std::vector<int> columns;
  std::vector<Affine3> out;
  int line_no = 0;
  for (size_t start = 0; start < text.size();) {
    const size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line(text.data() + start, end - start);
    start = end + 1;
    ++line_no;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto where = [&] { return Where{path, line_no, 1, line.substr(0, 200), -1}; };
    if (line.empty() || line.front() == '#') continue;
    if (columns.empty()) {
      columns = read_header(line, where());
      continue;
    }
    if (out.size() >= kMaxRows) throw Error(where(), strf("more than %zu rows", kMaxRows));
    Row row = kDefault;
    const char* p = line.data();
    const char* const stop = line.data() + line.size();
    for (size_t k = 0; k < columns.size(); ++k) {
      while (p < stop && (*p == ' ' || *p == '\t' || *p == '+')) ++p;
      const auto [after, code] = std::from_chars(p, stop, row[static_cast<size_t>(columns[k])]);
      p = after;
      while (p < stop && (*p == ' ' || *p == '\t')) ++p;
      const bool last = k + 1 == columns.size();
      if (code != std::errc() || (last ? p != stop : p == stop || *p != ','))
        throw Error(where(), strf("expected %zu numbers separated by commas", columns.size()));
      ++p;
    }
    out.push_back(transform(row, where()));
  }
  if (columns.empty()) throw Error(Where{path, 0, 0, {}, -1}, "is empty", "a header line with 'x,y,...' is expected");
  return out;
}

}  // namespace

std::vector<Affine3> read_instances(const std::string& path) {
  const bool binary = path.size() > 4 && path.compare(path.size() - 4, 4, ".f64") == 0;
  return binary ? read_binary(path) : read_csv(path);
}

}  // namespace suite
