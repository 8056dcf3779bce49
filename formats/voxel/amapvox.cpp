// Based on: G. Vincent et al., AMAPVox (https://amapvox.org), whose files are a header of #key: value, the names of the
// columns, and a line each cell.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/voxel/voxel.h"

namespace suite {

namespace {

constexpr std::string_view kFirstLine = "VOXEL SPACE";
constexpr double kMostAmapvoxCells = 1 << 28;
// A file may leave out empty cells, but not nearly all of a huge grid: cells for each of its bytes.
constexpr double kCellsOfByte = 1000;

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const std::string& column, Report& report)
      : lines_(text, file), file_(file), column_(column), report_(report) {}
  VoxelData run();

 private:
  void header();
  void resolution(std::string_view text);
  void leaf_angles(std::string_view type);
  void check_grid();
  void columns();
  void row();

  TextLines lines_;
  const std::string& file_;
  const std::string& column_;
  Report& report_;
  std::optional<Vec3> low_, high_, split_, cell_;
  Where cell_at_;
  std::vector<std::string> names_;
  size_t taken_ = 0;
  VoxelData data_;
  std::vector<bool> given_;
  size_t unseen_ = 0;
};

// Three numbers, with or without brackets and commas.
std::optional<Vec3> three(TextLines& lines, std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  TextLines one(plain, "");
  if (!one.next() || one.words() < 3) throw lines.error(0, "three numbers are expected behind the key");
  try {
    return Vec3{one.number(0, "x"), one.number(1, "y"), one.number(2, "z")};
  } catch (const Error& e) {
    throw lines.error(0, e.message(), e.hint());
  }
}

// Several keys may stand on a line: "#res: 0.5 #MAX_PAD: 5".
void Reader::header() {
  if (!lines_.next_raw() || lines_.line().substr(0, kFirstLine.size()) != kFirstLine)
    throw lines_.error(0, "the first line is not 'VOXEL SPACE'", "a file of AMAPVox begins with it");
  while (lines_.next_raw()) {
    std::string_view line = lines_.line();
    const size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos) continue;
    line.remove_prefix(begin);
    if (line.front() != '#') return columns();
    for (size_t at = 0; at != line.npos;) {
      const size_t next = line.find('#', at + 1);
      const std::string_view part = line.substr(at + 1, next == line.npos ? next : next - at - 1);
      const size_t colon = part.find(':');
      const std::string_view rest = colon == part.npos ? std::string_view() : part.substr(colon + 1);
      const std::string_view name = part.substr(0, colon);
      if (name == "min_corner") low_ = three(lines_, rest);
      if (name == "max_corner") high_ = three(lines_, rest);
      if (name == "split") split_ = three(lines_, rest);
      if (name == "res") resolution(rest);
      if (name == "lad_type") leaf_angles(rest);
      at = next;
    }
  }
  throw lines_.error_at_end("ends before the names of its columns");
}

// One number or three, m.
void Reader::resolution(std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  TextLines one(plain, "");
  if (!one.next()) return;
  try {
    const bool all = one.words() >= 3;
    cell_ = Vec3{one.number(0, "x"), one.number(all ? 1 : 0, "y"), one.number(all ? 2 : 0, "z")};
  } catch (const Error& e) {
    throw lines_.error(0, e.message(), e.hint());
  }
  cell_at_ = lines_.where();
}

// Which way its leaves lie, by which a scanner's hits were made densities; here a medium decides how they meet light.
void Reader::leaf_angles(std::string_view type) {
  const size_t first = type.find_first_not_of(" \t"), last = type.find_last_not_of(" \t\r");
  if (first == type.npos) return;
  const std::string name = printable(type.substr(first, last - first + 1));
  if (name == "Spherical" || name == "spherical") return;
  report_.add("SP707", file_,
              {lines_.where(), "the densities are of leaves that lie as '" + name +
                                   "' says; a medium of leaves takes them to lie every way alike"});
}

void Reader::check_grid() {
  if (!low_ || !high_ || !split_)
    throw lines_.error(0, strf("#%s is missing above", !low_ ? "min_corner" : !high_ ? "max_corner" : "split"));
  double cells = 1;
  for (int c = 0; c < 3; ++c) {
    const double n = (*split_)[c];
    if (!(n >= 1 && n <= 1e6 && n == std::floor(n)))
      throw lines_.error(0, strf("#split of %g cells", n), "whole numbers from 1 to 1000000");
    if (!((*high_)[c] > (*low_)[c])) throw lines_.error(0, "#max_corner does not lie beyond #min_corner");
    data_.cells[static_cast<size_t>(c)] = static_cast<uint32_t>(n);
    cells *= n;
  }
  if (cells > kMostAmapvoxCells || cells > kCellsOfByte * static_cast<double>(lines_.bytes()))
    throw lines_.error(0, strf("#split into %g cells", cells),
                       strf("at most %g, and %g for each byte of the file", kMostAmapvoxCells, kCellsOfByte));
  const Vec3 size = *high_ - *low_;
  for (int c = 0; c < 3 && cell_; ++c)
    if (const double side = size[c] / (*split_)[c]; !(std::fabs((*cell_)[c] - side) <= 1e-3 * side)) {
      report_.add(
          "SP709", file_,
          {cell_at_, strf("#res says cells of %g m, the corners and #split make them %g x %g x %g m, which holds",
                          (*cell_)[c], size.x / split_->x, size.y / split_->y, size.z / split_->z)});
      break;
    }
  data_.to_local = translation(*low_) * scaling({size.x / split_->x, size.y / split_->y, size.z / split_->z});
}

void Reader::columns() {
  check_grid();
  TextLines words(lines_.line(), file_);
  words.next();
  for (size_t k = 0; k < words.words(); ++k) names_.emplace_back(words.word(k));
  if (names_.size() < 4 || names_[0] != "i" || names_[1] != "j" || names_[2] != "k")
    throw lines_.error(0, "the columns do not begin with i j k");
  std::vector<std::string> wanted{column_};
  if (column_.empty()) wanted = {"PadBVTotal", "PAD", "pad"};
  for (const std::string& name : wanted)
    for (size_t k = 3; k < names_.size() && !taken_; ++k)
      if (names_[k] == name) taken_ = k;
  if (taken_) return;
  std::string all;
  for (size_t k = 3; k < names_.size(); ++k) all += (k > 3 ? ", " : "") + printable(names_[k]);
  throw lines_.error(0,
                     column_.empty() ? "there is neither a column PadBVTotal nor PAD"
                                     : "there is no column '" + printable(column_) + "'",
                     "'column' names one of: " + all);
}

void Reader::row() {
  if (lines_.words() != names_.size())
    throw lines_.error(0, strf("%zu values in %zu columns", lines_.words(), names_.size()));
  size_t cell = 0, stride = 1;
  for (size_t c = 0; c < 3; ++c) {
    cell += stride * static_cast<size_t>(lines_.integer(c, names_[c].c_str(), 0, data_.cells[c] - 1));
    stride *= data_.cells[c];
  }
  if (given_[cell]) throw lines_.error(0, "this cell is given twice");
  given_[cell] = true;
  const std::string_view word = lines_.word(taken_);
  if (word == "NA" || word == "NaN" || word == "nan" || word == "-9999" || word == "-9999.0") {
    ++unseen_;
    return;
  }
  data_.density[cell] = static_cast<float>(lines_.number_in(taken_, names_[taken_].c_str(), 0, 1e6));
}

VoxelData Reader::run() {
  header();
  data_.density.assign(data_.size(), 0);
  given_.assign(data_.size(), false);
  size_t rows = 0;
  while (lines_.next()) row(), ++rows;
  const size_t silent = data_.size() - rows;
  if (unseen_ + silent)
    report_.add("SP705", file_,
                {Where{file_, 0, 0, {}, -1},
                 strf("of %zu cells %zu have no value and %zu are not in the file: they were not seen, and are empty "
                      "here",
                      data_.size(), unseen_, silent)},
                unseen_ + silent);
  return std::move(data_);
}

}  // namespace

VoxelData parse_amapvox(std::string_view text, const std::string& file, const std::string& column, Report& report) {
  return Reader(text, file, column, report).run();
}

VoxelData read_amapvox(const std::string& path, const std::string& column, Report& report) {
  return parse_amapvox(read_text(path, size_t{16} << 30), path, column, report);
}

bool is_amapvox(const std::string& path) {
  const RandomAccessFile file(path);
  std::string head(std::min(file.size(), kFirstLine.size()), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(head)));
  return head == kFirstLine;
}

}  // namespace suite
