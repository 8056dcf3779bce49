#include "formats/ply/ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/files.h"
#include "base/number_text.h"
#include "formats/ply/header.h"
#include "scene/mesh_builder.h"

namespace suite {

namespace ply {
namespace {

constexpr size_t kLongestPolygon = 100'000;  // corners

// The values behind the header, one after the other, and where they stand.
class Values {
 public:
  Values(std::string_view text, const Header& header, const std::string& file)
      : text_(text), format_(header.format), file_(file), at_(header.bytes), line_(header.lines) {}

  double next(Type type) { return format_ == Header::Format::ascii ? number() : binary(type); }
  void begin_row() { row_ = at_; }
  // A row of an ASCII file is a line.
  void end_row() {
    if (format_ != Header::Format::ascii) return;
    const size_t stop = std::min(text_.find('\n', at_), text_.size());
    if (text_.substr(at_, stop - at_).find_first_not_of(" \t\r") != text_.npos)
      throw fault("more values than the header says");
    at_ = std::min(stop + 1, text_.size());
    ++line_;
  }
  size_t left() const { return text_.size() - at_; }
  Where here() const {
    if (format_ != Header::Format::ascii) return {file_, 0, 0, {}, static_cast<long long>(row_)};
    const size_t stop = std::min(text_.find('\n', row_), text_.size());
    return {file_, line_ + 1, 1, text_.substr(row_, std::min<size_t>(stop - row_, 200)), -1};
  }
  Error fault(const std::string& what) const { return {here(), what, {}}; }

 private:
  double number() {
    const size_t first = text_.find_first_not_of(" \t\r", at_);
    if (first == text_.npos) throw fault("the file ends before the last element");
    if (text_[first] == '\n') throw fault("fewer values than the header says");
    const size_t stop = std::min(text_.find_first_of(" \t\r\n", first), text_.size());
    const std::string_view word = text_.substr(first, stop - first);
    const std::optional<double> value = number_of(word);
    if (!value) throw fault("'" + printable(word.substr(0, 40)) + "' is no number");
    at_ = stop;
    return *value;
  }
  double binary(Type type) {
    const size_t size = size_of(type);
    if (left() < size) throw fault("the file ends before the last element");
    const size_t first = at_;
    at_ += size;
    const bool turned = (format_ == Header::Format::big) == (std::endian::native == std::endian::little);
    const auto as = [&](auto number) {
      unsigned char raw[sizeof number];
      for (size_t k = 0; k < sizeof number; ++k)
        raw[k] = static_cast<unsigned char>(text_[first + (turned ? sizeof number - 1 - k : k)]);
      std::memcpy(&number, raw, sizeof number);
      return static_cast<double>(number);
    };
    switch (type) {
      case Type::int8:
        return as(int8_t{});
      case Type::uint8:
        return as(uint8_t{});
      case Type::int16:
        return as(int16_t{});
      case Type::uint16:
        return as(uint16_t{});
      case Type::int32:
        return as(int32_t{});
      case Type::uint32:
        return as(uint32_t{});
      case Type::float32:
        return as(float{});
      default:
        return as(double{});
    }
  }

  std::string_view text_;
  const Header::Format format_;
  const std::string& file_;
  size_t at_, row_ = 0;
  int line_;
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, Report& report)
      : header_(header_of(text, file)),
        values_(text, header_, file),
        file_(file),
        builder_(file, report),
        mesh_(builder_.mesh()) {}
  SourceMesh run();

 private:
  void check_size(const Element& e) const;
  void vertices(const Element& e);
  void faces(const Element& e);
  void strips(const Element& e);
  void skip(const Element& e);
  size_t list_count(const Property& p);
  void face(std::span<const double> corner);
  bool known(std::span<const double> corner);
  void add(const char* code, const std::string& what) { builder_.add(code, values_.here(), what); }
  void add_finding(const char* code, const std::string& what) { builder_.add(code, Where{file_, 0, 0, {}, -1}, what); }

  const Header header_;
  Values values_;
  const std::string& file_;
  MeshBuilder builder_;
  SourceMesh& mesh_;  // the builder's
  std::vector<uint32_t> corners_;
};

// Every value takes a byte at least, so that a count that cannot be is refused before room is made for it.
void Reader::check_size(const Element& e) const {
  size_t least = 0;
  for (const Property& p : e.properties)
    least += header_.format == Header::Format::ascii ? 2 : size_of(p.list ? p.count_type : p.type);
  // The end of the last line may be missing.
  if (least == 0 || e.count > (values_.left() + 1) / least)
    throw Error(Where{file_, 0, 0, {}, -1},
                strf("%zu of '%s' cannot be in %zu bytes", e.count, printable(e.name).c_str(), values_.left()));
  if (e.count >= kNone) throw Error(Where{file_, 0, 0, {}, -1}, "more than 2^32 - 2 of '" + printable(e.name) + "'");
}

size_t Reader::list_count(const Property& p) {
  const double count = values_.next(p.count_type);
  if (!(count >= 0 && count <= static_cast<double>(values_.left()) && count == std::floor(count)))
    throw values_.fault(strf("a list of %g values", count));
  return static_cast<size_t>(count);
}

void Reader::skip(const Element& e) {
  for (size_t k = 0; k < e.count; ++k) {
    values_.begin_row();
    for (const Property& p : e.properties)
      for (size_t n = p.list ? list_count(p) : 1; n > 0; --n) values_.next(p.type);
    values_.end_row();
  }
}

void Reader::vertices(const Element& e) {
  const std::array<int, 3> place{e.find({"x"}), e.find({"y"}), e.find({"z"})},
      normal{e.find({"nx"}), e.find({"ny"}), e.find({"nz"})};
  const std::array<int, 2> uv{e.find({"u", "s", "texture_u"}), e.find({"v", "t", "texture_v"})};
  for (const int p : place)
    if (p < 0) throw Error(Where{file_, 0, 0, {}, -1}, "vertices without x, y and z");
  const bool has_normal = std::min({normal[0], normal[1], normal[2]}) >= 0, has_uv = std::min(uv[0], uv[1]) >= 0;
  if (e.find({"red", "r", "diffuse_red"}) >= 0)
    add_finding("SP706", "colours of vertices: display colours are no spectra");
  std::vector<double> row(e.properties.size());
  for (size_t k = 0; k < e.count; ++k) {
    values_.begin_row();
    for (size_t c = 0; c < row.size(); ++c) {
      const Property& p = e.properties[c];
      if (!p.list)
        row[c] = values_.next(p.type);
      else
        for (size_t n = list_count(p); n > 0; --n) values_.next(p.type);
    }
    const auto at = [&](int c) { return row[static_cast<size_t>(c)]; };
    mesh_.positions.push_back({at(place[0]), at(place[1]), at(place[2])});
    builder_.is_place(mesh_.positions.back(), values_.here());
    if (has_normal) {
      const Vec3 n{at(normal[0]), at(normal[1]), at(normal[2])};
      const double size = length(n);
      mesh_.normals.push_back(size > 0 && std::isfinite(size) ? oct_encode(n / size) : kNoNormal);
    }
    if (has_uv)
      for (const int c : uv) {
        const auto value = static_cast<float>(at(c));
        mesh_.uvs.push_back(std::isfinite(value) ? value : 0);
      }
    values_.end_row();
  }
}

bool Reader::known(std::span<const double> corner) {
  for (const double c : corner)
    if (!(c >= 0 && c < static_cast<double>(mesh_.positions.size()) && c == std::floor(c))) {
      add("SP201", strf("vertex %g of %zu, counted from 0", c, mesh_.positions.size()));
      return false;
    }
  return true;
}

void Reader::face(std::span<const double> corner) {
  if (corner.size() > kLongestPolygon) throw values_.fault(strf("a polygon of %zu corners", corner.size()));
  if (corner.size() >= 3 && !known(corner)) return;
  if (corner.size() >= 3)
    corners_.assign(corner.begin(), corner.end());
  else
    corners_.assign(corner.size(), 0);  // no face; what its corners say has not been looked at
  builder_.polygon(corners_, values_.here());
}

void Reader::faces(const Element& e) {
  const int indices = e.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !e.properties[static_cast<size_t>(indices)].list)
    throw Error(Where{file_, 0, 0, {}, -1}, "faces without a list 'vertex_indices'");
  if (e.find({"texcoord"}) >= 0)
    add_finding("SP705", "texture coordinates of single faces ('texcoord'); those of vertices are read");
  if (e.find({"red", "r", "diffuse_red"}) >= 0)
    add_finding("SP706", "colours of faces: display colours are no spectra");
  std::vector<double> corner;
  for (size_t k = 0; k < e.count; ++k) {
    values_.begin_row();
    for (size_t c = 0; c < e.properties.size(); ++c) {
      const Property& p = e.properties[c];
      const size_t n = p.list ? list_count(p) : 1;
      if (c == static_cast<size_t>(indices)) corner.clear();
      for (size_t i = 0; i < n; ++i) {
        const double value = values_.next(p.type);
        if (c == static_cast<size_t>(indices)) corner.push_back(value);
      }
    }
    face(corner);
    values_.end_row();
  }
}

// Strips joined in one list, -1 between them.
void Reader::strips(const Element& e) {
  const int indices = e.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !e.properties[static_cast<size_t>(indices)].list)
    throw Error(Where{file_, 0, 0, {}, -1}, "strips without a list 'vertex_indices'");
  for (size_t k = 0; k < e.count; ++k) {
    values_.begin_row();
    for (size_t c = 0; c < e.properties.size(); ++c) {
      const Property& p = e.properties[c];
      std::array<double, 3> last{};
      size_t length = 0;
      for (size_t n = p.list ? list_count(p) : 1; n > 0; --n) {
        const double value = values_.next(p.type);
        if (c != static_cast<size_t>(indices)) continue;
        length = value == -1 ? 0 : length + 1;
        last = {last[1], last[2], value};
        if (length < 3 || !known(last)) continue;
        const auto a = static_cast<uint32_t>(last[0]), b = static_cast<uint32_t>(last[1]),
                   d = static_cast<uint32_t>(last[2]);
        if (a == b || b == d || d == a) continue;  // only leads to where the strip goes on
        if (length % 2)
          builder_.triangle(a, b, d);
        else
          builder_.triangle(b, a, d);
      }
    }
    values_.end_row();
  }
}

SourceMesh Reader::run() {
  bool has_vertices = false;
  for (const Element& e : header_.elements) {
    if (e.count == 0) continue;
    check_size(e);
    const bool surface = e.name == "face" || e.name == "tristrips";
    if (surface && !has_vertices) throw Error(Where{file_, 0, 0, {}, -1}, "faces come before the vertices");
    if (e.name == "vertex") {
      if (has_vertices) throw Error(Where{file_, 0, 0, {}, -1}, "vertices come twice");
      vertices(e), has_vertices = true;
    } else if (e.name == "face") {
      faces(e);
    } else if (e.name == "tristrips") {
      strips(e);
    } else {
      skip(e);
      add_finding("SP706", strf("%zu of '%s' are left out", e.count, printable(e.name).substr(0, 80).c_str()));
    }
  }
  if (mesh_.indices.empty())
    add_finding("SP204", mesh_.positions.empty() ? "neither vertices nor faces"
                                                 : strf("%zu points and no face", mesh_.positions.size()));
  return builder_.take();
}

}  // namespace
}  // namespace ply

SourceMesh parse_ply(std::span<const std::byte> bytes, const std::string& file, Report& report) {
  return ply::Reader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, report).run();
}

SourceMesh read_ply(const std::string& path, Report& report) { return parse_ply(read_bytes(path), path, report); }

}  // namespace suite
