// Based on: 3D Systems, "StereoLithography Interface Specification", 1988 (as published by M. Burns, "Automated
// Fabrication", 1993, section 6.5).
#include "formats/stl/stl.h"

#include <cmath>
#include <cstring>
#include <unordered_map>

#include "base/files.h"
#include "base/number_text.h"

namespace suite {

namespace {

constexpr double kFarthest = 1e15;  // of the file's units
constexpr size_t kHeader = 84, kFacet = 50;

struct HashOfPlace {
  size_t operator()(const Vec3& v) const {
    size_t h = 0;
    for (const double c : {v.x, v.y, v.z}) h = (h ^ std::hash<double>()(c)) * 0x9E3779B97F4A7C15u;
    return h ^ (h >> 29);
  }
};

class Collector {
 public:
  Collector(const std::string& file, Report& report) : file_(file), report_(report) { mesh_.file = file; }

  void solid(std::string name, int line) { group_ = std::move(name), line_ = line, new_run_ = true; }
  // The file's normal is compared with the corners and then left: it says nothing that they do not.
  void facet(Vec3 normal, const std::array<Vec3, 3>& corner, const Where& where) {
    for (const Vec3& c : corner)
      if (!(std::fabs(c.x) < kFarthest && std::fabs(c.y) < kFarthest && std::fabs(c.z) < kFarthest)) {
        report_.add("SP203", file_, {where, strf("(%g, %g, %g) is no place, or absurdly far away", c.x, c.y, c.z)});
        return;
      }
    turned_ += dot(normal, cross(corner[1] - corner[0], corner[2] - corner[0])) < 0;
    if (new_run_) mesh_.runs.push_back({group_, "", static_cast<uint32_t>(mesh_.indices.size() / 3), line_});
    new_run_ = false;
    for (const Vec3& c : corner) {
      const Vec3 place{c.x + 0.0, c.y + 0.0, c.z + 0.0};  // -0 is the same place as 0
      const auto [at, fresh] = vertices_.try_emplace(place, static_cast<uint32_t>(mesh_.positions.size()));
      if (fresh) mesh_.positions.push_back(place);
      mesh_.indices.push_back(at->second);
    }
    if (mesh_.positions.size() > kNone - 4) throw Error(where, "more than 2^32 - 4 vertices");
  }
  SourceMesh take() {
    const Where whole{file_, 0, 0, {}, -1};
    if (mesh_.indices.empty()) report_.add("SP204", file_, {whole, "no facet"});
    if (turned_)
      report_.add(
          "SP706", file_,
          {whole, strf("%zu normals look to the other side than their corners' order says, which holds", turned_)},
          turned_);
    if (mesh_.runs.empty()) mesh_.runs.push_back({"", "", 0, 0});
    return std::move(mesh_);
  }

 private:
  const std::string& file_;
  Report& report_;
  SourceMesh mesh_;
  std::unordered_map<Vec3, uint32_t, HashOfPlace> vertices_;
  std::string group_;
  int line_ = 0;
  bool new_run_ = true;
  size_t turned_ = 0;
};

SourceMesh parse_binary(std::span<const std::byte> bytes, const std::string& file, Report& report) {
  uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  Collector collector(file, report);
  for (size_t k = 0; k < count; ++k) {
    const size_t at = kHeader + kFacet * k;
    float v[12];
    std::memcpy(v, bytes.data() + at, sizeof v);
    const auto point = [&](size_t i) { return Vec3{v[3 * i], v[3 * i + 1], v[3 * i + 2]}; };
    collector.facet(point(0), {point(1), point(2), point(3)}, Where{file, 0, 0, {}, static_cast<long long>(at)});
  }
  return collector.take();
}

// The words of a text, line by line.
class Words {
 public:
  Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}
  // Empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_])) step();
    const size_t first = at_;
    while (at_ < text_.size() && !std::strchr(" \t\r\n", text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }
  std::string_view rest_of_line() {
    const size_t stop = std::min(text_.find('\n', at_), text_.size());
    std::string_view rest = text_.substr(at_, stop - at_);
    at_ = stop;
    const size_t first = rest.find_first_not_of(" \t\r"), last = rest.find_last_not_of(" \t\r");
    return first == rest.npos ? "" : rest.substr(first, last - first + 1);
  }
  void expect(const char* word) {
    const std::string_view found = next();
    if (found != word)
      throw fault("'" + std::string(word) + "' is expected, found " +
                  (found.empty() ? "the end" : "'" + printable(found.substr(0, 40)) + "'"));
  }
  Vec3 point() {
    Vec3 v;
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = next();
      const std::optional<double> value = number_of(word);
      if (!value) throw fault("'" + printable(word.substr(0, 40)) + "' is no number");
      v[c] = *value;
    }
    return v;
  }
  int line() const { return line_; }
  Where here() const {
    const size_t stop = std::min(text_.find('\n', begin_), text_.size());
    return {file_, line_, 1, text_.substr(begin_, std::min<size_t>(stop - begin_, 200)), -1};
  }
  Error fault(const std::string& what) const { return {here(), what, {}}; }

 private:
  void step() {
    if (text_[at_++] == '\n') ++line_, begin_ = at_;
  }
  std::string_view text_;
  const std::string& file_;
  size_t at_ = 0, begin_ = 0;
  int line_ = 1;
};

SourceMesh parse_ascii(std::string_view text, const std::string& file, Report& report) {
  Words words(text, file);
  Collector collector(file, report);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word != "solid") throw words.fault("'solid' is expected, found '" + printable(word.substr(0, 40)) + "'");
    collector.solid(printable(words.rest_of_line().substr(0, 200)), words.line());
    for (word = words.next(); word == "facet"; word = words.next()) {
      words.expect("normal");
      const Where where = words.here();
      const Vec3 normal = words.point();
      words.expect("outer");
      words.expect("loop");
      std::array<Vec3, 3> corner;
      for (Vec3& c : corner) {
        words.expect("vertex");
        c = words.point();
      }
      words.expect("endloop");
      words.expect("endfacet");
      collector.facet(normal, corner, where);
    }
    if (word != "endsolid")
      throw words.fault("'facet' or 'endsolid' is expected, found " +
                        (word.empty() ? "the end" : "'" + printable(word.substr(0, 40)) + "'"));
    words.rest_of_line();
  }
  return collector.take();
}

}  // namespace

SourceMesh parse_stl(std::span<const std::byte> bytes, const std::string& file, Report& report) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // Many binary files begin with "solid" as well; their size says what they are.
  uint32_t count = 0;
  if (bytes.size() >= kHeader) {
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() == kHeader + kFacet * size_t{count}) return parse_binary(bytes, file, report);
  }
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first != text.npos && text.substr(first, 5) == "solid" && text.find('\0') == text.npos)
    return parse_ascii(text, file, report);
  if (bytes.size() < kHeader)
    throw Error(Where{file, 0, 0, {}, static_cast<long long>(bytes.size())}, "ends within the header of an STL file");
  throw Error(Where{file, 0, 0, {}, 80}, strf("declares %u facets, which are %zu bytes, and has %zu", count,
                                              kHeader + kFacet * size_t{count}, bytes.size()));
}

SourceMesh read_stl(const std::string& path, Report& report) { return parse_stl(read_bytes(path), path, report); }

}  // namespace suite
