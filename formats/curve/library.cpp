// Files of several curves: ENVI spectral libraries and DIRSIG emissivity files; and the choice among all layouts.
// Based on: the header keys of ENVI's spectral library; the two .ems layouts as found in published DIRSIG scenes.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "base/files.h"
#include "formats/curve/internal.h"
#include "math/share.h"

namespace suite {

namespace {

constexpr size_t kMaxValues = 100'000'000;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string trimmed(std::string_view s) {
  const size_t a = s.find_first_not_of(" \t\r\n"), b = s.find_last_not_of(" \t\r\n");
  return a == std::string_view::npos ? "" : std::string(s.substr(a, b - a + 1));
}

bool number(std::string_view text, double& value) {
  const std::string t = trimmed(text);
  const auto [stop, code] = std::from_chars(t.data(), t.data() + t.size(), value);
  return code == std::errc() && stop == t.data() + t.size() && std::isfinite(value);
}

// "key = value" lines; a value in braces may run over lines. Keys in lower case.
std::map<std::string, std::string> header_keys(const std::string& path) {
  const std::string text = read_text(path, size_t{64} << 20);
  if (text.rfind("ENVI", 0) != 0)
    throw Error(Where{path, 1, 1, {}, -1}, "does not start with 'ENVI'",
                "the header of a spectral library is expected");
  std::map<std::string, std::string> keys;
  for (size_t at = text.find('\n'); at != std::string::npos && at + 1 < text.size();) {
    const size_t start = at + 1, equal = text.find('=', start);
    size_t end = std::min(text.find('\n', start), text.size());
    if (equal == std::string::npos || equal > end) {
      at = end == text.size() ? std::string::npos : end;
      continue;
    }
    std::string key = trimmed(std::string_view(text).substr(start, equal - start));
    std::transform(key.begin(), key.end(), key.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const size_t open = text.find_first_not_of(" \t", equal + 1);
    if (open != std::string::npos && text[open] == '{') {
      const size_t close = text.find('}', open);
      if (close == std::string::npos) throw Error(Where{path, 0, 0, {}, -1}, "the list of '" + key + "' has no end");
      keys[key] = text.substr(open + 1, close - open - 1);
      end = std::min(text.find('\n', close), text.size());
    } else {
      keys[key] = trimmed(std::string_view(text).substr(equal + 1, end - equal - 1));
    }
    at = end == text.size() ? std::string::npos : end;
  }
  return keys;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out;
  for (size_t at = 0; at <= list.size();) {
    const size_t comma = std::min(list.find(',', at), list.size());
    out.push_back(trimmed(std::string_view(list).substr(at, comma - at)));
    at = comma + 1;
  }
  return out;
}

struct SliHeader {
  size_t samples = 0, lines = 0, offset = 0;
  int type = 4;
  bool big_endian = false;
  std::vector<double> wavelength_um;
  std::vector<std::string> names;
  double scale = 1;
  std::optional<double> mark;  // of missing values
};

SliHeader read_sli_header(const std::string& path) {
  const auto keys = header_keys(path);
  const Where where{path, 0, 0, {}, -1};
  const auto whole = [&](const char* key, double low, double high, double otherwise) {
    const auto found = keys.find(key);
    double v = otherwise;
    if (found != keys.end() ? !number(found->second, v) || v < low || v > high || v != std::floor(v)
                            : std::isnan(otherwise))
      throw Error(where, strf("'%s' is missing or no whole number from %g to %g", key, low, high));
    return v;
  };
  SliHeader h;
  h.samples = static_cast<size_t>(whole("samples", 1, 1e7, NAN));
  h.lines = static_cast<size_t>(whole("lines", 1, 1e7, NAN));
  whole("bands", 1, 1, 1);
  h.offset = static_cast<size_t>(whole("header offset", 0, 1e9, 0));
  h.type = static_cast<int>(whole("data type", 1, 15, NAN));
  h.big_endian = whole("byte order", 0, 1, 0) == 1;
  if (h.type != 4 && h.type != 5)
    throw Error(where, strf("'data type' %d", h.type), "4 (float32) or 5 (float64) are expected");
  if (h.samples * h.lines > kMaxValues) throw Error(where, "declares too many values");
  const auto wavelength = keys.find("wavelength");
  if (wavelength == keys.end()) throw Error(where, "has no 'wavelength' list");
  std::string unit = keys.count("wavelength units") ? keys.at("wavelength units") : "";
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const double to_um = unit.rfind("micro", 0) == 0 || unit == "um"  ? 1
                       : unit.rfind("nano", 0) == 0 || unit == "nm" ? 1e-3
                                                                    : 0;
  if (to_um == 0)
    throw Error(where, "has 'wavelength units' of '" + unit + "'", "micrometers or nanometers are expected");
  for (const std::string& item : split(wavelength->second)) {
    double w = 0;
    if (!number(item, w)) throw Error(where, "wavelength '" + item.substr(0, 40) + "' is no number");
    h.wavelength_um.push_back(w * to_um);
  }
  if (h.wavelength_um.size() != h.samples)
    throw Error(where, strf("lists %zu wavelengths for %zu samples", h.wavelength_um.size(), h.samples));
  if (keys.count("spectra names")) h.names = split(keys.at("spectra names"));
  if (!h.names.empty() && h.names.size() != h.lines)
    throw Error(where, strf("lists %zu 'spectra names' for %zu lines", h.names.size(), h.lines));
  double factor = 1;
  if (keys.count("reflectance scale factor") && number(keys.at("reflectance scale factor"), factor) && factor > 0)
    h.scale = 1 / factor;
  if (double mark = 0; keys.count("data ignore value") && number(keys.at("data ignore value"), mark)) h.mark = mark;
  return h;
}

template <class Word, class Value>
double decode(const std::byte* at, bool big_endian) {
  Word w;
  std::memcpy(&w, at, sizeof w);
  if (big_endian)
    w = sizeof w == 4 ? static_cast<Word>(__builtin_bswap32(static_cast<uint32_t>(w)))
                      : static_cast<Word>(__builtin_bswap64(w));
  return static_cast<double>(std::bit_cast<Value>(w));
}

}  // namespace

std::vector<NamedRows> read_sli(const std::string& path, const CurveOptions& options) {
  std::string header = path + ".hdr";
  if (!file_exists(header)) header = path.substr(0, path.size() - 4) + ".hdr";
  const SliHeader h = read_sli_header(header);
  const size_t width = h.type == 4 ? 4 : 8, expected = h.offset + h.samples * h.lines * width, size = file_size(path);
  const Where where{path, 0, 0, {}, -1};
  if (size != expected) throw Error(where, strf("has %zu bytes, its header declares %zu", size, expected));
  const std::vector<std::byte> bytes = read_bytes(path);
  std::vector<NamedRows> out;
  for (size_t line = 0; line < h.lines; ++line) {
    std::vector<double> x = h.wavelength_um, y(h.samples);
    for (size_t k = 0; k < h.samples; ++k) {
      const std::byte* at = bytes.data() + h.offset + (line * h.samples + k) * width;
      const double stored =
          width == 4 ? decode<uint32_t, float>(at, h.big_endian) : decode<uint64_t, double>(at, h.big_endian);
      const bool mark = is_mark(stored) || (h.mark && static_cast<float>(stored) == static_cast<float>(*h.mark));
      y[k] = mark ? NAN : stored * h.scale * options.scale;
      if (!mark && !std::isfinite(stored))
        throw Error(where, strf("value %zu of spectrum %zu is not finite", k + 1, line + 1));
    }
    out.push_back({h.names.empty() ? "" : h.names[line], std::move(x), std::move(y), where});
  }
  return out;
}

std::vector<NamedRows> read_ems(const std::string& path, const CurveOptions& options) {
  const std::string text = read_text(path, size_t{1} << 30);
  std::vector<std::string> lines;
  for (size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(trimmed(std::string_view(text).substr(at, end - at)));
    at = end + 1;
  }
  size_t at = 0;
  const auto fault = [&](const std::string& what) {
    return Error(Where{path, static_cast<int>(std::min(at, lines.size() - 1) + 1), 1, {}, -1}, what,
                 "a DIRSIG emissivity file is expected");
  };
  const auto skip_empty = [&] {
    while (at < lines.size() && lines[at].empty()) ++at;
  };
  skip_empty();
  if (at >= lines.size()) throw Error(Where{path, 0, 0, {}, -1}, "is empty");
  double count = 0;
  if (!number(lines[at], count) || count < 1 || count > 100000 || count != std::floor(count))
    throw fault("its first line is no number of curves");
  // 91 weights of the angles 0 to 90 degrees: they describe how a classical solver falls off, which the scattering
  // models of this suite have of their own.
  ++at;
  for (int k = 0; k < 91; ++k, ++at) {
    skip_empty();
    if (double weight = 0; at >= lines.size() || !number(lines[at], weight))
      throw fault("one of 91 angular weights is missing");
  }
  std::vector<NamedRows> out;
  while (out.size() < static_cast<size_t>(count)) {
    while (at < lines.size() && (lines[at].empty() || lines[at] == "CURVE_END")) ++at;
    if (at >= lines.size()) throw fault(strf("%zu curves, %g are declared", out.size(), count));
    const bool newer = lines[at] == "CURVE_BEGIN";
    double index = 0;
    if (!newer && !number(lines[at], index)) throw fault("neither CURVE_BEGIN nor the index of a curve");
    std::vector<double> x, y;
    for (++at; at < lines.size() && (newer || x.size() < 396); ++at) {
      const size_t gap = lines[at].find_first_of(" \t");
      double w = 0, e = 0;
      if (newer && (lines[at] == "CURVE_END" || lines[at] == "CURVE_BEGIN")) break;
      if (lines[at].empty()) continue;
      if (gap == std::string::npos || !number(std::string_view(lines[at]).substr(0, gap), w) ||
          !number(std::string_view(lines[at]).substr(gap), e) || !(w > 0))
        throw fault("a row that is not 'wavelength value'");
      if (!is_share(e)) throw fault(strf("emissivity %g is not between 0 and 1", e));
      x.push_back(newer ? w : 1e4 / w);  // the older layout counts wavenumbers in 1/cm
      y.push_back(as_share(1 - e) * options.scale);
    }
    if (!newer && x.size() != 396) throw fault(strf("%zu of 396 rows", x.size()));
    if (x.empty()) throw fault("a curve without rows");
    out.push_back({strf("%zu", out.size() + 1), std::move(x), std::move(y), Where{path, 0, 0, {}, -1}});
  }
  return out;
}

namespace {

// The rows of each curve of a library; nothing where the file is none.
std::vector<NamedRows> read_named(const std::string& path, const CurveOptions& options) {
  if (ends_with(path, ".sli")) return read_sli(path, options);
  if (ends_with(path, ".ems")) return read_ems(path, options);
  return {};
}

Curve curve_of(NamedRows&& rows, const CurveOptions& options) {
  return curve_of(std::move(rows.um), std::move(rows.value), options, rows.where);
}

}  // namespace

std::vector<Curve> read_curve_family(const std::string& path, const CurveOptions& options) {
  std::vector<Curve> out;
  for (NamedRows& rows : read_named(path, options)) out.push_back(curve_of(std::move(rows), options));
  if (out.empty()) out.push_back(read_table(path, options));
  return out;
}

Curve read_curve(const std::string& path, const CurveOptions& options) {
  std::vector<NamedRows> all = read_named(path, options);
  if (all.empty() && options.spectrum.empty()) return read_table(path, options);
  if (options.spectrum.empty()) return curve_of(std::move(all.front()), options);
  std::vector<std::string> names;
  for (NamedRows& rows : all) {
    if (rows.name == options.spectrum) return curve_of(std::move(rows), options);
    names.push_back(rows.name);
  }
  if (all.empty() && options.spectrum == "1") return read_table(path, options);
  double k = 0;
  if (number(options.spectrum, k) && k >= 1 && k <= static_cast<double>(all.size()) && k == std::floor(k))
    return curve_of(std::move(all[static_cast<size_t>(k) - 1]), options);
  throw Error(
      Where{path, 0, 0, {}, -1}, "has no spectrum '" + options.spectrum + "'",
      names.size() > 1 ? name_hint(options.spectrum, names) : strf("it holds %zu", std::max<size_t>(1, all.size())));
}

}  // namespace suite
