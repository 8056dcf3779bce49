// tinyobjloader tokenises; we resolve indices, check, split polygons and merge corners. Its callbacks carry no line
// numbers, so the stream buffer it reads from tells how far it has come.
#include "formats/obj/obj.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <limits>
#include <map>

#include "base/files.h"
#include "math/polygon.h"

namespace suite {

namespace {

// Characters in memory as a stream, without copying them.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // streambuf wants char*; nothing is ever put back or written
    setg(begin, begin, begin + text.size());
  }
  size_t position() const { return static_cast<size_t>(gptr() - eback()); }
};

std::string trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == text.npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

size_t words_of(std::string_view text) {
  size_t words = 0;
  for (size_t at = text.find_first_not_of(" \t\r"); at != text.npos && text[at] != '#'; ++words) {
    at = text.find_first_of(" \t\r", at);
    if (at != text.npos) at = text.find_first_not_of(" \t\r", at);
  }
  return words;
}

class Collector {
 public:
  Collector(std::string_view original, const MemoryBuffer& buffer, const std::string& file, Report& report)
      : original_(original), buffer_(buffer), file_(file), report_(report) {
    mesh_.file = file;
  }

  void vertex(double x, double y, double z) {
    positions_.push_back({x, y, z});
    check_number_line(3, positions_.back());
  }
  void normal(double x, double y, double z) {
    normals_.push_back({x, y, z});
    check_number_line(3, normals_.back());
  }
  void uv(double u, double v) {
    uvs_.push_back({static_cast<float>(u), static_cast<float>(v)});
    check_number_line(1, {u, v, 0});
  }
  void face(const tinyobj::index_t* corner, int count);
  void use_material(const char* name) {
    material_ = trimmed(name);
    new_run_ = true;
  }
  void part(std::string name) {
    group_ = std::move(name);
    new_run_ = true;
  }
  SourceMesh finish(ObjLook* look);

 private:
  struct Corner {
    uint32_t v;
    uint32_t vt, vn;  // kNone = not given
  };
  struct Shared {  // output vertices of one position, a linked list
    uint32_t vt, vn, next;
  };
  static constexpr int kLongestList = 64;  // more of one position are in `crowded_`

  // Moves on to the line the loader has just read; the lines before it are counted.
  void sync_line() {
    const size_t end = buffer_.position();
    while (counted_ < end) {
      line_start_ = counted_;
      size_t stop = original_.find_first_of("\r\n", counted_);
      if (stop == std::string_view::npos) stop = original_.size();
      line_end_ = stop;
      counted_ = std::min(original_.size(), stop + (original_.substr(stop, 2) == "\r\n" ? 2 : 1));
      ++line_;
      smoothing_statement(original_.substr(line_start_, line_end_ - line_start_));
    }
  }
  // The loader hands out no `s` statements.
  void smoothing_statement(std::string_view line) {
    const size_t at = line.find_first_not_of(" \t");
    if (at == std::string_view::npos || line[at] != 's' || at + 1 >= line.size() ||
        (line[at + 1] != ' ' && line[at + 1] != '\t'))
      return;
    const size_t value = line.find_first_not_of(" \t", at + 1);
    uint32_t group = 0;  // "off", 0, and what is no number
    if (value != std::string_view::npos) std::from_chars(line.data() + value, line.data() + line.size(), group);
    smoothing_ = group;
    any_smoothing_ = any_smoothing_ || group;
  }
  Where here() {
    sync_line();
    return {file_, line_, 1, std::string(original_.substr(line_start_, std::min<size_t>(line_end_ - line_start_, 200))),
            -1};
  }
  void add(const char* code, const std::string& message) { report_.add(code, file_, {here(), message}); }

  void check_number_line(int at_least, Vec3 value);
  bool resolve(int index, size_t count, const char* what, const char* code, uint32_t& out);
  uint32_t output_vertex(const Corner& c);
  void unlisted_statements(ObjLook& look);

  std::string_view original_;
  const MemoryBuffer& buffer_;
  const std::string& file_;
  Report& report_;
  size_t counted_ = 0, line_start_ = 0, line_end_ = 0;
  int line_ = 0;

  std::vector<Vec3> positions_, normals_;
  std::vector<std::array<float, 2>> uvs_;
  std::vector<uint32_t> heads_;      // first output vertex of each position
  std::vector<Shared> shared_;       // parallel to the output vertices
  std::vector<uint32_t> vertex_of_;  // output vertex -> position
  std::map<std::array<uint32_t, 3>, uint32_t> crowded_;
  std::string group_, material_;
  bool new_run_ = true;
  std::vector<Corner> corners_;
  std::vector<Vec3> ring_;
  size_t without_normal_ = 0, without_uv_ = 0;
  uint32_t smoothing_ = 0;
  bool any_smoothing_ = false;
  SourceMesh mesh_;
};

// The loader turns what it cannot read into 0; the line itself tells whether it could.
void Collector::check_number_line(int at_least, Vec3 value) {
  sync_line();
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  const char* p = original_.data() + line_start_;
  const char* const end = original_.data() + line_end_;
  while (p < end && blank(*p)) ++p;
  while (p < end && !blank(*p)) ++p;  // v, vn, vt
  int tokens = 0;
  for (; tokens < at_least; ++tokens) {
    while (p < end && blank(*p)) ++p;
    if (p == end || *p == '#') break;
    if (*p == '\\') return;  // continued on the next line
    const char* stop = p;
    while (stop < end && !blank(*stop)) ++stop;
    double number = 0;
    const auto [read_to, code] = std::from_chars(*p == '+' ? p + 1 : p, stop, number);
    // Out of range may also mean too small, which is 0 and fine.
    const bool too_large = code == std::errc::result_out_of_range && std::fabs(std::strtod(p, nullptr)) > 1;
    if (code == std::errc::invalid_argument || read_to != stop || !std::isfinite(number) || too_large)
      return add("SP203",
                 "'" + std::string(p, std::min<size_t>(static_cast<size_t>(stop - p), 40)) + "' is no finite number");
    p = stop;
  }
  if (tokens < at_least) return add("SP203", strf("%d numbers, %d are needed", tokens, at_least));
  if (!(std::fabs(value.x) < 1e15 && std::fabs(value.y) < 1e15 && std::fabs(value.z) < 1e15))
    add("SP203", strf("(%g, %g, %g) is absurdly far away", value.x, value.y, value.z));
}

bool Collector::resolve(int index, size_t count, const char* what, const char* code, uint32_t& out) {
  const long long i = index > 0 ? index - 1LL : static_cast<long long>(count) + index;
  if (index != 0 && i >= 0 && i < static_cast<long long>(count)) {
    out = static_cast<uint32_t>(i);
    return true;
  }
  add(code, index == 0 ? strf("%s index 0", what) : strf("%s index %d of %zu", what, index, count));
  return false;
}

uint32_t Collector::output_vertex(const Corner& c) {
  if (heads_.size() < positions_.size()) heads_.resize(positions_.size(), kNone);
  int seen = 0;
  for (uint32_t k = heads_[c.v]; k != kNone; k = shared_[k].next, ++seen)
    if (shared_[k].vt == c.vt && shared_[k].vn == c.vn) return k;
  const auto made = static_cast<uint32_t>(shared_.size());
  const bool crowded = seen >= kLongestList;
  if (crowded)
    if (const auto [at, fresh] = crowded_.try_emplace({c.v, c.vt, c.vn}, made); !fresh) return at->second;
  shared_.push_back({c.vt, c.vn, heads_[c.v]});
  vertex_of_.push_back(c.v);
  if (!crowded) heads_[c.v] = made;
  return made;
}

// A number that the loader would turn into another one.
std::string_view too_large(std::string_view line) {
  for (size_t at = line.find_first_of("0123456789"); at != std::string_view::npos;
       at = line.find_first_of("0123456789", at)) {
    const size_t stop = std::min(line.find_first_not_of("0123456789", at), line.size());
    if (stop - at >= 10) {
      uint64_t value = 0;
      const auto [end, code] = std::from_chars(line.data() + at, line.data() + stop, value);
      if (code != std::errc() || value > static_cast<uint64_t>(std::numeric_limits<int>::max()))
        return line.substr(at, stop - at);
    }
    at = stop;
  }
  return {};
}

void Collector::face(const tinyobj::index_t* corner, int count) {
  sync_line();
  if (count < 3) {
    add("SP202", strf("%d corners", count));
    return;
  }
  // 0 stands for "not given" in what the loader hands over; a 0 that was written shows as "/0" in the line.
  const std::string_view text = original_.substr(line_start_, line_end_ - line_start_);
  for (size_t at = text.find("/0"); at != std::string_view::npos; at = text.find("/0", at + 1))
    if (at + 2 == text.size() || !std::isdigit(static_cast<unsigned char>(text[at + 2]))) {
      add("SP201", "index 0");
      return;
    }
  if (const std::string_view number = too_large(text); !number.empty()) {
    add("SP201", "index " + std::string(number.substr(0, 40)));
    return;
  }
  corners_.clear();
  ring_.clear();
  for (int k = 0; k < count; ++k) {
    Corner c{0, kNone, kNone};
    if (!resolve(corner[k].vertex_index, positions_.size(), "vertex", "SP201", c.v)) return;
    // Without its normal or UV a face is still the same surface.
    if (corner[k].texcoord_index) resolve(corner[k].texcoord_index, uvs_.size(), "texture coordinate", "SP209", c.vt);
    if (corner[k].normal_index) resolve(corner[k].normal_index, normals_.size(), "normal", "SP209", c.vn);
    corners_.push_back(c);
    ring_.push_back(positions_[c.v]);
  }
  if (mesh_.indices.size() / 3 + corners_.size() > std::numeric_limits<int>::max())
    throw Error(here(), "more than 2^31 triangles");
  if (new_run_) {
    const auto first = static_cast<uint32_t>(mesh_.indices.size() / 3);
    const bool joins =
        !mesh_.runs.empty() && mesh_.runs.back().group == group_ && mesh_.runs.back().material == material_;
    if (!joins) mesh_.runs.push_back({group_, material_, first, line_});
    new_run_ = false;
  }
  bool clean = true;
  for (const auto& t : split_polygon(ring_, clean)) {
    for (const int k : t) {
      mesh_.indices.push_back(output_vertex(corners_[k]));
      without_normal_ += corners_[k].vn == kNone;
      without_uv_ += corners_[k].vt == kNone;
    }
    mesh_.lines.push_back(line_);
    if (any_smoothing_) mesh_.smoothing.resize(mesh_.lines.size() - 1, 0), mesh_.smoothing.push_back(smoothing_);
  }
  if (!clean) add("SP206", strf("polygon of %d corners", count));
}

// Statements that make no triangles but look as if they meant to; libraries of materials, and colours.
void Collector::unlisted_statements(ObjLook& look) {
  static constexpr std::string_view others[] = {"l", "p", "curv", "curv2", "surf"};
  int line = 0;
  bool looked_at_vertex = false;
  for (size_t start = 0; start < original_.size();) {
    size_t end = original_.find('\n', start);
    if (end == std::string_view::npos) end = original_.size();
    ++line;
    size_t i = start;
    while (i < end && (original_[i] == ' ' || original_[i] == '\t')) ++i;
    size_t stop = i;
    while (stop < end && original_[stop] != ' ' && original_[stop] != '\t') ++stop;
    const std::string_view word = original_.substr(i, stop - i);
    if (stop < end && std::find(std::begin(others), std::end(others), word) != std::end(others))
      report_.add("SP205", file_, {{file_, line, 1, {}, -1}, "'" + std::string(word) + "'"});
    if (word == "mtllib" && stop < end) {
      const std::string name = trimmed(original_.substr(stop, end - stop));
      if (!name.empty() && std::ranges::find(look.libraries, name) == look.libraries.end())
        look.libraries.push_back(name);
    }
    // Colours stand at all vertices of a file or at none.
    if (word == "v" && !looked_at_vertex) {
      looked_at_vertex = true;
      look.coloured = words_of(original_.substr(stop, end - stop)) >= 6;
    }
    start = end + 1;
  }
}

SourceMesh Collector::finish(ObjLook* look) {
  const size_t corners = mesh_.indices.size(), n = shared_.size();
  const Where whole{file_, 0, 0, {}, -1};
  if (corners == 0) report_.add("SP204", file_, {whole, "no face"});
  mesh_.positions.reserve(n);
  for (const uint32_t v : vertex_of_) mesh_.positions.push_back(positions_[v]);
  const bool any_normal = without_normal_ < corners, any_uv = without_uv_ < corners;
  if (any_normal && without_normal_)
    report_.add("SP207", file_, {whole, strf("%zu of %zu corners have none", without_normal_, corners)});
  if (any_uv && without_uv_)
    report_.add("SP208", file_, {whole, strf("%zu of %zu corners have none", without_uv_, corners)});
  if (any_uv) {
    mesh_.uvs.resize(2 * n, 0.0f);
    for (size_t k = 0; k < n; ++k)
      if (shared_[k].vt != kNone)
        mesh_.uvs[2 * k] = uvs_[shared_[k].vt][0], mesh_.uvs[2 * k + 1] = uvs_[shared_[k].vt][1];
  }
  if (any_normal) {
    mesh_.normals.assign(n, kNoNormal);
    for (size_t k = 0; k < n; ++k)
      if (shared_[k].vn != kNone)
        if (const Vec3 v = normals_[shared_[k].vn]; length(v) > 0 && std::isfinite(length(v)))
          mesh_.normals[k] = oct_encode(normalized(v));
  }
  if (without_normal_ == 0) mesh_.smoothing.clear();  // nothing is left for the groups to decide
  ObjLook found;
  unlisted_statements(look ? *look : found);
  return std::move(mesh_);
}

Collector& self(void* user) { return *static_cast<Collector*>(user); }

}  // namespace

SourceMesh parse_obj(std::string_view text, const std::string& file, Report& report, ObjLook* look) {
  if (const size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw Error(Where{file, 0, 0, {}, static_cast<long long>(zero)}, "is not a text file", "Wavefront OBJ is expected",
                "SP003");
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // a mark that some editors put before UTF-8
  // The loader knows no continued lines: blank out the joints in a copy of equal length.
  std::string joined;
  std::string_view parsed = text;
  for (size_t at = text.find('\\'); at != std::string_view::npos; at = text.find('\\', at + 1)) {
    const size_t length = text.substr(at + 1, 2) == "\r\n" ? 3 : text.substr(at + 1, 1) == "\n" ? 2 : 0;
    if (!length) continue;
    if (joined.empty()) joined = text;
    std::fill_n(joined.begin() + static_cast<std::ptrdiff_t>(at), length, ' ');
  }
  if (!joined.empty()) parsed = joined;

  MemoryBuffer buffer(parsed);
  std::istream stream(&buffer);
  Collector collector(text, buffer, file, report);
  tinyobj::callback_t call;
  call.vertex_cb = [](void* u, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t z, tinyobj::real_t) {
    self(u).vertex(x, y, z);
  };
  call.normal_cb = [](void* u, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t z) { self(u).normal(x, y, z); };
  call.texcoord_cb = [](void* u, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t) { self(u).uv(x, y); };
  call.index_cb = [](void* u, tinyobj::index_t* corners, int count) { self(u).face(corners, count); };
  call.usemtl_cb = [](void* u, const char* name, int) { self(u).use_material(name); };
  call.group_cb = [](void* u, const char** names, int count) {
    std::string name;
    for (int k = 0; k < count; ++k) name += (k ? " " : "") + std::string(names[k]);
    self(u).part(name);
  };
  call.object_cb = [](void* u, const char* name) { self(u).part(name); };
  std::string warnings, errors;
  if (!tinyobj::LoadObjWithCallback(stream, call, &collector, nullptr, &warnings, &errors))
    throw Error(Where{file, 0, 0, {}, -1}, "cannot be read as OBJ: " + errors);
  return collector.finish(look);
}

SourceMesh read_obj(const std::string& path, Report& report, ObjLook* look) {
  return parse_obj(read_text(path, size_t{16} << 30), path, report, look);
}

}  // namespace suite
