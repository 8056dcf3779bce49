#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/tape7/cards.h"
#include "formats/tape7/units.h"

namespace suite {

namespace {

// Names of two words as older versions write them.
constexpr const char* kTwoWords[] = {"TOT TRANS", "PTH THRML", "THRML SCT", "SURF EMIS", "SOL SCAT", "SING SCAT",
                                     "SNGL SCAT", "GRND RFLT", "DRCT RFLT", "TOTAL RAD", "REF SOL",  "SOL TR"};

struct Heading {
  std::string name;
  int end = 0;  // the column after its last character; numbers are written flush with it
};

std::vector<Heading> words_of(std::string line) {
  for (const std::string two : kTwoWords)
    for (size_t at = line.find(two); at != std::string::npos; at = line.find(two, at + two.size()))
      line[at + two.find(' ')] = '_';
  std::vector<Heading> words;
  for (size_t i = 0; i < line.size();) {
    if (line[i] == ' ' || line[i] == '\t') {
      ++i;
      continue;
    }
    const size_t end = std::min(line.find_first_of(" \t", i), line.size());
    words.push_back({line.substr(i, end - i), static_cast<int>(end)});
    i = end;
  }
  return words;
}

bool is_header(std::string_view line) {
  const size_t at = line.find_first_not_of(' ');
  if (at == std::string_view::npos) return false;
  return line.substr(at).starts_with("FREQ") || line.substr(at).starts_with("WAVL");
}

// What Fortran writes: 1.2345-101 for exponents of three digits, and stars for what does not fit its field, which is
// read as NaN. Nothing when the text is no such number.
std::optional<double> fortran_number(std::string_view w) {
  if (w.find_first_not_of('*') == std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
  if (w[0] == '+') w.remove_prefix(1);
  double value = 0;
  const char* const end = w.data() + w.size();
  const auto [stop, code] = std::from_chars(w.data(), end, value);
  if (code != std::errc()) return std::nullopt;
  if (stop == end)
    return std::isfinite(value) && std::fabs(value) <= kLargestNumber ? std::optional(value) : std::nullopt;
  int exponent = 0;
  if (end - stop != 4 || *stop != '-' || std::from_chars(stop + 1, end, exponent).ptr != end) return std::nullopt;
  return value * std::pow(10, -exponent);
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : lines_(text, file), file_(file) {}

  std::vector<Tape7Block> all() {
    std::vector<Tape7Block> blocks;
    std::vector<std::string> before;
    while (lines_.next_raw()) {
      if (is_header(lines_.line())) {
        blocks.push_back(block(before));
        before.clear();
      } else if (before.size() < kMostCards) {
        before.emplace_back(lines_.line().substr(0, 200));
      }
    }
    if (blocks.empty())
      throw Error({file_, 0, 0, {}, -1}, "there is no spectrum in it",
                  "a line that begins with FREQ, and numbers below");
    return blocks;
  }

 private:
  static constexpr size_t kMostCards = 2000;  // a profile of the user's has some hundred lines

  Tape7Block block(const std::vector<std::string>& before) {
    Tape7Block b;
    b.header = lines_.where();
    read_header(b);
    int rows = 0;
    for (bool ended = false; !ended;) {
      if (!lines_.next_raw())
        throw lines_.error_at_end("the spectrum is cut: no line -9999 ends it",
                                  strf("it begins in line %d and has %d rows", b.header.line, rows));
      if (lines_.words() == 0) throw lines_.error(0, "an empty line within a spectrum", "-9999 ends a spectrum");
      ended = lines_.word(0).starts_with("-9999");
      if (!ended) read_row(b, rows++);
    }
    if (rows == 0) throw Error(b.header, "a spectrum without a row");
    finish(b, before);
    return b;
  }

  void read_header(Tape7Block& b) {
    if (lines_.word(0) != "FREQ")
      throw Error(b.header, "a spectrum over wavelength, as scanned with a slit function, is not read",
                  "the unscanned file, whose first column is FREQ");
    headings_ = words_of(std::string(lines_.line()));
    names_second_ = headings_.size() > 1 && headings_[1].name == "COMBIN";
    if (headings_.size() > 1 && headings_[1].name == "TOTAL") names_second_ = true;
    if (names_second_) {
      if (!lines_.next_raw()) throw lines_.error_at_end("the second line of the header is missing");
      const std::vector<Heading> second = words_of(std::string(lines_.line()));
      if (second.size() != headings_.size())
        throw lines_.error(
            0, strf("the second line of the header has %zu names, the first %zu", second.size(), headings_.size()));
      for (size_t i = 0; i < second.size(); ++i) headings_[i].name += "_" + second[i].name;
    }
    b.header_lines = names_second_ ? 2 : 1;
    // Of mode irradiance: a fourth column without a name, and numbers that do not stand under theirs.
    sun_only_ = std::any_of(headings_.begin(), headings_.end(), [](auto& h) { return h.name == "SOLAR"; });
    if (sun_only_) headings_.push_back({"DEPTH", headings_.back().end + 9});
    if (headings_.size() < 2) throw Error(b.header, "the header names no column beside FREQ");
    for (size_t i = 1; i < headings_.size(); ++i)
      b.columns.push_back({headings_[i].name, tape7_scale(headings_[i].name).unit, {}});
  }

  struct Field {
    std::string_view text;
    size_t word;  // of the line
    int end;      // the column after it
  };
  // The numbers of a line. Where one fills its field it touches the next, and the names above tell them apart.
  std::vector<Field> fields() const {
    std::vector<Field> all;
    for (size_t i = 0; i < lines_.words(); ++i) {
      std::string_view w = lines_.word(i);
      int begin = static_cast<int>(w.data() - lines_.line().data());
      if (!fortran_number(w))
        for (const Heading& h : headings_)
          if (h.end > begin && h.end < begin + static_cast<int>(w.size())) {
            all.push_back({w.substr(0, static_cast<size_t>(h.end - begin)), i, h.end});
            w.remove_prefix(static_cast<size_t>(h.end - begin));
            begin = h.end;
          }
      all.push_back({w, i, begin + static_cast<int>(w.size())});
    }
    return all;
  }

  // The column of a number: by its place where none is blank, else the one whose name ends nearest to its end.
  size_t column_of(const std::vector<Field>& fields, size_t field, size_t after) const {
    // Older versions write no depth in mode irradiance.
    if (fields.size() == headings_.size() || (sun_only_ && fields.size() + 1 == headings_.size())) return field;
    const auto off = [&](size_t heading) { return std::abs(headings_[heading].end - fields[field].end); };
    size_t best = after;
    for (size_t i = after; i < headings_.size(); ++i)
      if (off(i) < off(best)) best = i;
    if (best == headings_.size() || off(best) > 4)
      throw lines_.error(fields[field].word, "this number stands under no column of the header",
                         strf("the header has %zu columns, this line %zu numbers", headings_.size(), fields.size()));
    return best;
  }

  void read_row(Tape7Block& b, int row) {
    const std::vector<Field> all = fields();
    if (all.size() > headings_.size())
      throw lines_.error(all[headings_.size()].word,
                         strf("more numbers (%zu) than columns (%zu)", all.size(), headings_.size()));
    for (Tape7Column& c : b.columns) c.values.push_back(std::numeric_limits<double>::quiet_NaN());
    size_t next = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      const size_t column = column_of(all, i, next), word = all[i].word;
      const std::optional<double> value = fortran_number(all[i].text);
      if (!value) throw lines_.error(word, "'" + std::string(all[i].text.substr(0, 40)) + "' is not a number");
      next = column + 1;
      if (column > 0) {
        b.columns[column - 1].values[static_cast<size_t>(row)] = *value;
        continue;
      }
      if (!(*value > 0)) throw lines_.error(word, "a wavenumber is positive");
      if (row > 0 && !(*value > b.wavenumber.back()))
        throw lines_.error(
            word, "wavenumbers do not ascend",
            strf("the line before has %g", b.wavenumber.back()) +
                (b.find("LOS") ? "; a file of several lines of sight is read when it is cut into one each" : ""));
      b.wavenumber.push_back(*value);
    }
    if (b.wavenumber.size() != static_cast<size_t>(row) + 1) throw lines_.error(0, "a row without its wavenumber");
  }

  void finish(Tape7Block& b, const std::vector<std::string>& before) const {
    const Tape7Cards cards = tape7_cards(before, b.wavenumber.front(), b.wavenumber.back());
    b.geometry = cards.geometry;
    b.many_scatterings = cards.multiple.value_or(0) != 0;
    const auto filled = [&](const char* name) {
      const Tape7Column* c = b.find(name);
      return c && std::any_of(c->values.begin(), c->values.end(), [](double v) { return std::isfinite(v); });
    };
    b.mode = names_second_                               ? Tape7Mode::transmittance
             : b.find("SOLAR")                           ? Tape7Mode::irradiance
             : filled("SOL_SCAT") || filled("MULT_SCAT") ? Tape7Mode::radiance
                                                         : Tape7Mode::thermal_radiance;
    // A run with the Sun below the horizon may leave the Sun's columns blank.
    const bool agrees = !cards.mode || *cards.mode == static_cast<int>(b.mode) ||
                        (*cards.mode == 2 && b.mode == Tape7Mode::thermal_radiance);
    if (!agrees)
      throw Error(b.header,
                  strf("these are not the columns of mode %d, which the first card of the run says", *cards.mode),
                  "IEMSCT 0 transmittance, 1 thermal radiance, 2 radiance with the Sun, 3 the Sun's irradiance");
    for (Tape7Column& c : b.columns)
      if (tape7_scale(c.name).by_square)
        for (size_t i = 0; i < c.values.size(); ++i) c.values[i] *= b.wavenumber[i] * b.wavenumber[i];
  }

  TextLines lines_;
  std::string file_;
  std::vector<Heading> headings_;
  bool names_second_ = false, sun_only_ = false;
};

const char* name_of(Tape7Mode mode) {
  switch (mode) {
    case Tape7Mode::transmittance:
      return "transmittance (IEMSCT 0)";
    case Tape7Mode::thermal_radiance:
      return "thermal radiance (IEMSCT 1)";
    case Tape7Mode::radiance:
      return "radiance with the Sun (IEMSCT 2)";
    case Tape7Mode::irradiance:
      return "the Sun's irradiance (IEMSCT 3)";
  }
  return "";
}

}  // namespace

const Tape7Column* Tape7Block::find(std::string_view name) const {
  for (const Tape7Column& c : columns)
    if (c.name == name) return &c;
  return nullptr;
}

Where Tape7Block::line_of(size_t row) const {
  return {header.file, header.line + header_lines + static_cast<int>(row), 0, {}, -1};
}

const Tape7Column& Tape7Block::column(std::string_view name) const {
  const Tape7Column* c = find(name);
  if (!c) {
    std::vector<std::string> known;
    for (const Tape7Column& other : columns) known.push_back(other.name);
    throw Error(header, strf("no column '%s' in a run of mode %s", std::string(name).c_str(), name_of(mode)),
                name_hint(name, known));
  }
  for (size_t i = 0; i < c->values.size(); ++i)
    if (!std::isfinite(c->values[i]))
      throw Error(line_of(i), strf("column '%s' is blank at %g 1/cm", c->name.c_str(), wavenumber[i]),
                  strf("the run is of mode %s", name_of(mode)));
  return *c;
}

const Tape7Column& Tape7Block::transmittance() const {
  for (const char* name : {"COMBIN_TRANS", "TOTAL_TRANS", "TRANS"})
    if (find(name)) return column(name);
  return column("TOT_TRANS");
}

std::vector<double> Tape7Block::path_radiance() const {
  const bool sun = mode == Tape7Mode::radiance;
  const auto add = [](std::vector<double>& sum, const std::vector<double>& part) {
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
  };
  if (!find("THRML_EM")) {
    std::vector<double> sum = column("PTH_THRML").values;
    if (sun) add(sum, column("SOL_SCAT").values);
    return sum;
  }
  // Version 6 names them THRML_EM and MULT_SCAT. Whether these contain THRML_SCT and SING_SCAT is what the total says.
  const std::vector<double>& total = column("TOTAL_RAD").values;
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (int with = 0; with < (sun ? 4 : 2); ++with) {
    std::vector<double> sum = column("THRML_EM").values;
    if (with & 1) add(sum, column("THRML_SCT").values);
    if (sun) add(sum, column("MULT_SCAT").values);
    if (with & 2) add(sum, column("SING_SCAT").values);
    double off = 0;
    for (size_t i = 0; i < sum.size(); ++i)
      off = std::max(off, std::fabs(sum[i] + column("SURF_EMIS").values[i] + column("GRND_RFLT").values[i] - total[i]) /
                              (std::fabs(total[i]) + 1e-30));
    if (off < least) least = off, best = std::move(sum);
  }
  if (least > 1e-3)
    throw Error(header, "no sum of the path's parts, SURF_EMIS and GRND_RFLT is TOTAL_RAD",
                strf("the nearest is off by %g of it", least));
  return best;
}

std::vector<double> Tape7Block::two_way_transmittance() const {
  std::vector<double> ratio = column("REF_SOL").values;
  const std::vector<double>& sun = column("TOA_SUN").values;
  for (size_t i = 0; i < ratio.size(); ++i) {
    if (!(sun[i] > 0)) throw Error(line_of(i), strf("no sunlight above the air at %g 1/cm", wavenumber[i]));
    ratio[i] /= sun[i];
  }
  return ratio;
}

std::vector<Tape7Block> parse_tape7(std::string_view text, const std::string& file_name) {
  return Reader(text, file_name).all();
}

std::vector<Tape7Block> read_tape7(const std::string& path) { return parse_tape7(read_text(path), path); }

}  // namespace suite
