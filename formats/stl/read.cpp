// Based on: 3D Systems, "StereoLithography Interface Specification", 1988 (as published by M. Burns, "Automated
// Fabrication", 1993, section 6.5).
#include "formats/stl/stl.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "base/files.h"
#include "base/number_text.h"
#include "scene/mesh_builder.h"

namespace suite {

namespace {

constexpr size_t kHeader = 84, kFacet = 50;

class Collector {
 public:
  Collector(const std::string& file, Report& report) : builder_(file, report), whole_{file, 0, 0, {}, -1} {}

  void solid(std::string name, int line) { builder_.part(std::move(name), "", line); }
  // The file's normal is compared with the corners and then left: it says nothing that they do not.
  void facet(Vec3 normal, const std::array<Vec3, 3>& corner, const Where& where) {
    for (const Vec3& c : corner)
      if (!builder_.is_place(c, where)) return;
    turned_ += dot(normal, cross(corner[1] - corner[0], corner[2] - corner[0])) < 0;
    const uint32_t a = builder_.vertex(corner[0], where), b = builder_.vertex(corner[1], where);
    builder_.triangle(a, b, builder_.vertex(corner[2], where));
  }
  void unread(size_t bytes, size_t offset) {
    builder_.add("SP705", Where{whole_.file, 0, 0, {}, static_cast<long long>(offset)},
                 strf("%zu bytes behind the last facet are not read", bytes));
  }
  SourceMesh take() {
    if (builder_.empty()) builder_.add("SP204", whole_, "no facet");
    if (turned_)
      builder_.add("SP706", whole_,
                   strf("%zu normals look to the other side than their corners' order says, which holds", turned_),
                   turned_);
    return builder_.take();
  }

 private:
  MeshBuilder builder_;
  Where whole_;
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
  if (const size_t end = kHeader + kFacet * size_t{count}; bytes.size() > end)
    collector.unread(bytes.size() - end, end);
  return collector.take();
}

// The words of a text, line by line.
class Words {
 public:
  Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}
  // In lower case, for keywords come in either; empty at the end.
  std::string next() {
    std::string word(as_written());
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
  }
  std::string_view as_written() {
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
    const std::string found = next();
    if (found != word)
      throw fault("'" + std::string(word) + "' is expected, found " +
                  (found.empty() ? "the end" : "'" + printable(found.substr(0, 40)) + "'"));
  }
  Vec3 point() {
    Vec3 v;
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = as_written();
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

bool begins_with_solid(std::string_view text) {
  const std::string_view word = "solid";
  return text.size() >= word.size() && std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

SourceMesh parse_ascii(std::string_view text, const std::string& file, Report& report) {
  Words words(text, file);
  Collector collector(file, report);
  for (std::string word = words.next(); !word.empty(); word = words.next()) {
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
  if (first != text.npos && begins_with_solid(text.substr(first)) && text.find('\0') == text.npos)
    return parse_ascii(text, file, report);
  // Some programs append colours or padding.
  if (count > 0 && bytes.size() > kHeader + kFacet * size_t{count}) return parse_binary(bytes, file, report);
  if (bytes.size() < kHeader)
    throw Error(Where{file, 0, 0, {}, static_cast<long long>(bytes.size())}, "ends within the header of an STL file");
  throw Error(Where{file, 0, 0, {}, 80}, strf("declares %u facets, which are %zu bytes, and has %zu", count,
                                              kHeader + kFacet * size_t{count}, bytes.size()));
}

SourceMesh read_stl(const std::string& path, Report& report) { return parse_stl(read_bytes(path), path, report); }

}  // namespace suite
