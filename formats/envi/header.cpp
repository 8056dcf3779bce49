// The text header of an ENVI image: parsed with places, checked before anything is allocated from it.
// Based on: the key list of FORMAT.md; no key is interpreted that is not listed there.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/envi/internal.h"

namespace suite {

size_t size_of(EnviType type) {
  switch (type) {
    case EnviType::uint8:
      return 1;
    case EnviType::int16:
    case EnviType::uint16:
      return 2;
    case EnviType::int32:
    case EnviType::uint32:
    case EnviType::float32:
      return 4;
    case EnviType::float64:
    case EnviType::int64:
    case EnviType::uint64:
      return 8;
  }
  throw Bug("ENVI type without a size");
}

namespace {

constexpr size_t kMaxHeaderBytes = size_t{64} << 20;  // 100 000 bands with long names take a few MB
constexpr long long kMaxExtent = 2147483647;

std::string_view trim(std::string_view s) {
  const char* blanks = " \t\r\n";
  const size_t first = s.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

// Keys are compared without case and with single blanks.
std::string canonical(std::string_view key) {
  std::string out;
  for (const char c : trim(key)) {
    const bool blank = c == ' ' || c == '\t';
    if (blank && !out.empty() && out.back() == ' ') continue;
    out += blank ? ' ' : static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  }
  return out;
}

struct Value {
  std::string key;   // canonical
  std::string text;  // without braces
  bool braces = false;
  Where where;  // of the key
};

// Splits the text into `key = value` pairs; a value in braces may span lines.
class Splitter {
 public:
  Splitter(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::vector<Value> run() {
    if (canonical(next_line()) != "envi") throw Error(where(), "is not an ENVI header", "its first line must be ENVI");
    std::vector<Value> values;
    while (position_ < text_.size()) {
      const std::string_view line = next_line();
      if (trim(line).empty() || trim(line).front() == ';') continue;
      const size_t equals = line.find('=');
      if (equals == std::string_view::npos) throw Error(where(), "expected 'key = value'", "comments start with ';'");
      Value value{canonical(line.substr(0, equals)), {}, false, where()};
      if (value.key.empty()) throw Error(value.where, "the name before '=' is missing");
      std::string_view rest = trim(line.substr(equals + 1));
      if (!rest.empty() && rest.front() == '{') {
        value.braces = true;
        value.text = trim(until_brace(rest.substr(1), value.where));
      } else {
        value.text = rest;
      }
      values.push_back(std::move(value));
    }
    return values;
  }

 private:
  std::string_view next_line() {
    const size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    current_ = line;
    return line;
  }
  Where where() const { return {file_, line_, 1, std::string(current_.substr(0, 200)), -1}; }

  std::string until_brace(std::string_view first, const Where& opened) {
    std::string out;
    for (std::string_view part = first;; part = next_line()) {
      if (const size_t brace = part.find('}'); brace != std::string_view::npos) {
        if (!trim(part.substr(brace + 1)).empty())
          throw Error(where(), "text after the closing brace", "start a new line");
        return out.append(part.substr(0, brace));
      }
      out.append(part).append("\n");
      if (position_ >= text_.size()) throw Error(opened, "the brace opened here is never closed", "add '}'");
    }
  }

  std::string_view text_, current_;
  const std::string& file_;
  size_t position_ = 0;
  int line_ = 0;
};

std::vector<std::string> list_of(const std::string& text) {
  std::vector<std::string> items;
  std::string_view rest = text;
  if (trim(rest).empty()) return items;
  while (true) {
    const size_t comma = rest.find(',');
    items.emplace_back(trim(rest.substr(0, comma)));
    if (comma == std::string_view::npos) return items;
    rest.remove_prefix(comma + 1);
  }
}

double number_of(std::string_view text, const Value& v) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || stop != text.data() + text.size())
    throw Error(v.where, "'" + v.key + "': '" + std::string(text.substr(0, 60)) + "' is not a number");
  return value;
}

long long integer_of(const std::string& text, const Value& v, long long low, long long high) {
  long long value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || stop != text.data() + text.size() || value < low || value > high)
    throw Error(v.where, "'" + v.key + "': '" + text.substr(0, 60) + "' is not a valid value",
                strf("give a whole number from %lld to %lld", low, high));
  return value;
}

// Looks values up by key, and knows which were taken.
class Keys {
 public:
  Keys(std::vector<Value> values, const std::string& file) : values_(std::move(values)), file_(file) {
    for (size_t i = 0; i < values_.size(); ++i) {
      const auto [found, fresh] = index_.emplace(values_[i].key, i);
      if (!fresh)
        throw Error(values_[i].where, "duplicate key '" + values_[i].key + "'",
                    strf("first given in line %d; keep one", values_[found->second].where.line));
    }
    taken_.assign(values_.size(), false);
  }
  const Value* find(const char* key) {
    const auto found = index_.find(key);
    if (found == index_.end()) return nullptr;
    taken_[found->second] = true;
    return &values_[found->second];
  }
  const Value& at(const char* key) {
    if (const Value* v = find(key)) return *v;
    std::vector<std::string> present;
    for (const Value& v : values_) present.push_back(v.key);
    const std::string near = nearest_name(key, present);
    throw Error(Where{file_, 0, 0, {}, -1}, strf("the key '%s' is missing", key),
                near.empty() ? "" : "is '" + near + "' meant to be it?");
  }
  std::vector<std::pair<std::string, std::string>> rest() const {
    std::vector<std::pair<std::string, std::string>> extra;
    for (size_t i = 0; i < values_.size(); ++i)
      if (!taken_[i])
        extra.emplace_back(values_[i].key, values_[i].braces ? "{" + values_[i].text + "}" : values_[i].text);
    return extra;
  }

 private:
  std::vector<Value> values_;
  std::map<std::string, size_t, std::less<>> index_;
  std::vector<bool> taken_;
  const std::string& file_;
};

EnviType type_of(const Value& v) {
  static constexpr int known[] = {1, 2, 3, 4, 5, 12, 13, 14, 15};
  const long long code = integer_of(v.text, v, 0, 1000);
  for (const int k : known)
    if (code == k) return static_cast<EnviType>(k);
  throw Error(v.where, strf("data type %lld is not supported", code),
              "known: 1 uint8, 2 int16, 3 int32, 4 float32, 5 float64, 12 uint16, 13 uint32, 14 int64, 15 uint64");
}

Interleave interleave_of(const Value& v) {
  const std::string text = canonical(v.text);
  if (text == "bsq") return Interleave::bsq;
  if (text == "bil") return Interleave::bil;
  if (text == "bip") return Interleave::bip;
  const std::vector<std::string> known{"bsq", "bil", "bip"};
  throw Error(v.where, "unknown interleave '" + v.text.substr(0, 60) + "'", name_hint(text.substr(0, 60), known));
}

// Factor that turns a wavelength of the header into micron.
double micron_per(const Value& v) {
  static const std::pair<const char*, double> known[] = {{"micrometers", 1},
                                                         {"micrometer", 1},
                                                         {"um", 1},
                                                         {"microns", 1},
                                                         {"nanometers", 1e-3},
                                                         {"nanometer", 1e-3},
                                                         {"nm", 1e-3},
                                                         {"millimeters", 1e3},
                                                         {"mm", 1e3},
                                                         {"centimeters", 1e4},
                                                         {"cm", 1e4},
                                                         {"meters", 1e6},
                                                         {"m", 1e6}};
  const std::string text = canonical(v.text);
  for (const auto& [name, factor] : known)
    if (text == name) return factor;
  throw Error(v.where, "unknown wavelength unit '" + v.text.substr(0, 60) + "'",
              "known: Micrometers, Nanometers, Millimeters, Centimeters, Meters");
}

void read_wavelengths(Keys& keys, EnviHeader& h) {
  const Value* unit = keys.find("wavelength units");
  for (const auto& [name, target] : {std::pair{"wavelength", &h.wavelength_um}, std::pair{"fwhm", &h.fwhm_um}}) {
    const Value* v = keys.find(name);
    if (!v) continue;
    if (!unit)
      throw Error(v->where, strf("'%s' is given without 'wavelength units'", name),
                  "add 'wavelength units = Micrometers' or what they are in");
    const double factor = micron_per(*unit);
    const std::vector<std::string> items = list_of(v->text);
    if (items.size() != h.bands)
      throw Error(v->where, strf("'%s' has %zu values for %zu bands", name, items.size(), h.bands));
    for (const std::string& item : items) {
      const double value = number_of(item, *v) * factor;
      if (!(value > 0) || !std::isfinite(value))
        throw Error(v->where, strf("'%s': %s is not positive", name, item.c_str()));
      target->push_back(value);
    }
  }
}

// The classes of a classification. Names decide how many there are; colours may be missing.
void read_classes(Keys& keys, EnviHeader& h) {
  const Value* count = keys.find("classes");
  const Value* names = keys.find("class names");
  const Value* lookup = keys.find("class lookup");
  if (!names) return;
  for (std::string& name : list_of(names->text)) h.classes.push_back({std::move(name), {}});
  if (count && static_cast<size_t>(integer_of(count->text, *count, 0, kMaxExtent)) != h.classes.size())
    throw Error(names->where, strf("'class names' has %zu names for %s classes", h.classes.size(),
                                   count->text.substr(0, 20).c_str()));
  if (!lookup) return;
  const std::vector<std::string> items = list_of(lookup->text);
  if (items.size() != 3 * h.classes.size())
    throw Error(lookup->where, strf("'class lookup' has %zu numbers for %zu classes", items.size(), h.classes.size()),
                "red, green and blue of each class");
  for (size_t i = 0; i < items.size(); ++i)
    h.classes[i / 3].rgb[i % 3] = static_cast<uint8_t>(integer_of(items[i], *lookup, 0, 255));
}

}  // namespace

EnviHeader parse_envi_header(std::string_view text, const std::string& file_name) {
  if (const size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw Error(Where{file_name, 0, 0, {}, static_cast<long long>(zero)}, "is not a text file",
                "an ENVI header is expected");
  Keys keys(Splitter(text, file_name).run(), file_name);
  EnviHeader h;
  const auto extent = [&](const char* key) {
    const Value& v = keys.at(key);
    return static_cast<size_t>(integer_of(v.text, v, 1, kMaxExtent));
  };
  h.samples = extent("samples");
  h.lines = extent("lines");
  h.bands = extent("bands");
  h.type = type_of(keys.at("data type"));
  h.interleave = interleave_of(keys.at("interleave"));
  const Value& order = keys.at("byte order");
  h.big_endian = integer_of(order.text, order, 0, 1) == 1;
  if (const Value* v = keys.find("header offset"))
    h.header_offset = static_cast<size_t>(integer_of(v->text, *v, 0, 1LL << 40));
  size_t bytes = 0;
  if (__builtin_mul_overflow(h.samples * h.lines, h.bands * size_of(h.type), &bytes) || bytes > size_t{1} << 60)
    throw Error(keys.at("samples").where,
                strf("%zu samples x %zu lines x %zu bands is more than any file holds", h.samples, h.lines, h.bands));
  keys.find("file type");  // the size of the file and its classes decide
  if (const Value* v = keys.find("description")) h.description = v->text;
  if (const Value* v = keys.find("band names")) {
    h.band_names = list_of(v->text);
    if (h.band_names.size() != h.bands)
      throw Error(v->where, strf("'band names' has %zu names for %zu bands", h.band_names.size(), h.bands));
  }
  read_wavelengths(keys, h);
  if (const Value* v = keys.find("data units")) h.data_units = v->text;
  if (const Value* v = keys.find("map info")) h.map_info = list_of(v->text);
  if (const Value* v = keys.find("coordinate system string")) h.coordinate_system = v->text;
  if (const Value* v = keys.find("data ignore value")) h.ignore_value = number_of(v->text, *v);
  if (const Value* v = keys.find("default bands")) {
    for (const std::string& item : list_of(v->text))
      h.default_bands.push_back(static_cast<int>(integer_of(item, *v, 1, static_cast<long long>(h.bands))));
    if (h.default_bands.size() != 1 && h.default_bands.size() != 3)
      throw Error(v->where, "'default bands' must name one band or three");
  }
  read_classes(keys, h);
  if (const Value* v = keys.find("acquisition time")) h.acquisition_time = v->text;
  if (const Value* v = keys.find("sun azimuth")) h.sun_azimuth_deg = number_of(v->text, *v);
  if (const Value* v = keys.find("sun elevation")) h.sun_elevation_deg = number_of(v->text, *v);
  h.extra = keys.rest();
  return h;
}

std::string envi_header_path(const std::string& image) {
  if (image.ends_with(".hdr")) return image;
  const std::string appended = image + ".hdr";
  if (file_exists(appended)) return appended;
  const size_t dot = image.find_last_of("./");
  if (dot != std::string::npos && image[dot] == '.')
    if (const std::string replaced = image.substr(0, dot) + ".hdr"; file_exists(replaced)) return replaced;
  if (!file_exists(image)) file_size(image);  // names the real fault: missing, a directory
  throw Error(Where{image, 0, 0, {}, -1}, "has no ENVI header beside it", "expected " + appended);
}

EnviHeader read_envi_header(const std::string& path) {
  const std::string header = envi_header_path(path);
  return parse_envi_header(read_text(header, kMaxHeaderBytes), header);
}

}  // namespace suite
