// ENVI images out: the cube streamed line by line into a temporary file, the header made last, both renamed on commit.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "base/files.h"
#include "base/run_app.h"
#include "formats/envi/envi.h"

namespace suite {

namespace {

// Text inside braces must not close them; an item of a list must not contain a comma either.
std::string in_braces(std::string text, bool item) {
  for (char& c : text) {
    if (c == '{')
      c = '(';
    else if (c == '}')
      c = ')';
    else if (c == '\n' && item)
      c = ' ';
    else if (c == '\r')
      c = ' ';
    else if (c == ',' && item)
      c = ';';
  }
  return text;
}

std::string list_text(const std::vector<std::string>& items) {
  std::string text = "{";
  for (size_t i = 0; i < items.size(); ++i) text += (i ? ", " : "") + in_braces(items[i], true);
  return text + "}";
}
std::string list_text(const std::vector<double>& items) {
  std::string text = "{";
  for (size_t i = 0; i < items.size(); ++i) text += (i ? ", " : "") + strf("%.9g", items[i]);
  return text + "}";
}

void check_header(const std::string& path, const EnviHeader& h) {
  const auto fail = [&](const std::string& what) { throw Error(Where{path, 0, 0, {}, -1}, what); };
  for (const size_t extent : {h.samples, h.lines, h.bands})
    if (extent < 1 || extent > 2147483647)
      fail(strf("an image of %zu samples x %zu lines x %zu bands cannot be written", h.samples, h.lines, h.bands));
  const auto count = [&](const char* what, size_t n) {
    if (n && n != h.bands) fail(strf("%zu %s for %zu bands", n, what, h.bands));
  };
  count("band names", h.band_names.size());
  count("wavelengths", h.wavelength_um.size());
  count("widths (fwhm)", h.fwhm_um.size());
  for (const int b : h.default_bands)
    if (b < 1 || static_cast<size_t>(b) > h.bands) fail(strf("default band %d of %zu bands", b, h.bands));
  if (!h.default_bands.empty() && h.default_bands.size() != 1 && h.default_bands.size() != 3)
    fail("default bands must be one or three");
  if (h.sun_azimuth_deg && !std::isfinite(*h.sun_azimuth_deg)) fail("the sun's azimuth is not a number");
  if (h.sun_elevation_deg && !std::isfinite(*h.sun_elevation_deg)) fail("the sun's elevation is not a number");
  for (const auto& [key, value] : h.extra)
    if (key.empty() || key.find_first_of("={}\n") != std::string::npos || value.find('\n') != std::string::npos)
      fail("the extra key '" + key + "' cannot be written in an ENVI header");
}

std::string class_text(const std::vector<EnviClass>& classes) {
  if (classes.empty()) return {};
  std::vector<std::string> names;
  std::vector<double> colours;
  for (const EnviClass& c : classes) {
    names.push_back(c.name);
    colours.insert(colours.end(), c.rgb.begin(), c.rgb.end());
  }
  return strf("classes = %zu\n", classes.size()) + "class lookup = " + list_text(colours) +
         "\nclass names = " + list_text(names) + "\n";
}

std::string header_text(const EnviHeader& h) {
  std::string description = h.description;
  if (!description.empty()) description += '\n';
  description += strf("suite %s", kVersion);
  if (!command_line().empty()) description += ": " + command_line();
  std::string t = "ENVI\n";
  t += "description = {" + in_braces(description, false) + "}\n";
  t += strf("samples = %zu\nlines = %zu\nbands = %zu\nheader offset = 0\nfile type = ENVI %s\n", h.samples, h.lines,
            h.bands, h.classes.empty() ? "Standard" : "Classification");
  t += strf("data type = %d\ninterleave = %s\nbyte order = 0\n", static_cast<int>(h.type),
            h.interleave == Interleave::bsq   ? "bsq"
            : h.interleave == Interleave::bil ? "bil"
                                              : "bip");
  if (!h.band_names.empty()) t += "band names = " + list_text(h.band_names) + "\n";
  if (!h.wavelength_um.empty() || !h.fwhm_um.empty()) t += "wavelength units = Micrometers\n";
  if (!h.wavelength_um.empty()) t += "wavelength = " + list_text(h.wavelength_um) + "\n";
  if (!h.fwhm_um.empty()) t += "fwhm = " + list_text(h.fwhm_um) + "\n";
  if (!h.data_units.empty()) t += "data units = " + in_braces(h.data_units, true) + "\n";
  if (!h.map_info.empty()) t += "map info = " + list_text(h.map_info) + "\n";
  if (!h.coordinate_system.empty()) t += "coordinate system string = {" + in_braces(h.coordinate_system, false) + "}\n";
  if (h.ignore_value) t += strf("data ignore value = %.17g\n", *h.ignore_value);
  if (!h.default_bands.empty()) {
    std::vector<double> bands(h.default_bands.begin(), h.default_bands.end());
    t += "default bands = " + list_text(bands) + "\n";
  }
  t += class_text(h.classes);
  if (!h.acquisition_time.empty()) t += "acquisition time = " + in_braces(h.acquisition_time, true) + "\n";
  if (h.sun_azimuth_deg) t += strf("sun azimuth = %.9g\n", *h.sun_azimuth_deg);
  if (h.sun_elevation_deg) t += strf("sun elevation = %.9g\n", *h.sun_elevation_deg);
  for (const auto& [key, value] : h.extra) t += key + " = " + value + "\n";
  return t;
}

template <class T>
void store(double value, std::byte* to) {
  if constexpr (std::is_integral_v<T>) {
    // The upper limit of a 64-bit type is no double; its power of two is, and lies just outside.
    const double low = static_cast<double>(std::numeric_limits<T>::min()),
                 above = std::ldexp(1.0, std::numeric_limits<T>::digits);
    if (!(value >= low && value < above) || value != std::floor(value))
      throw Error(strf("the value %g does not fit the integer type of the image", value), "write a floating type");
  }
  const T converted = static_cast<T>(value);
  std::memcpy(to, &converted, sizeof(T));
}

void store(double value, EnviType type, std::byte* to) {
  switch (type) {
    case EnviType::uint8:
      return store<uint8_t>(value, to);
    case EnviType::int16:
      return store<int16_t>(value, to);
    case EnviType::int32:
      return store<int32_t>(value, to);
    case EnviType::float32:
      return store<float>(value, to);
    case EnviType::float64:
      return store<double>(value, to);
    case EnviType::uint16:
      return store<uint16_t>(value, to);
    case EnviType::uint32:
      return store<uint32_t>(value, to);
    case EnviType::int64:
      return store<int64_t>(value, to);
    case EnviType::uint64:
      return store<uint64_t>(value, to);
  }
  throw Bug("ENVI type without a writer");
}

}  // namespace

struct EnviWriter::Impl {
  Impl(const std::string& p, EnviHeader h) : path(p), header(std::move(h)), image(path), text(path + ".hdr") {}
  std::string path;
  EnviHeader header;
  AtomicFile image, text;
  size_t written = 0;  // lines
};

EnviWriter::EnviWriter(const std::string& path, EnviHeader header) {
  check_header(path, header);
  impl_ = std::make_unique<Impl>(path, std::move(header));
  impl_->image.reserve(impl_->header.values() * size_of(impl_->header.type));
}
EnviWriter::~EnviWriter() = default;

void EnviWriter::append(std::span<const double> rows) {
  const EnviHeader& h = impl_->header;
  const size_t width = h.samples * h.bands, size = size_of(h.type);
  SUITE_CHECK_EQ(rows.size() % width, size_t{0});
  const size_t count = rows.size() / width;
  SUITE_CHECK_LE(count, h.lines - impl_->written);
  const auto gather = [&](std::vector<std::byte>& raw, size_t from, size_t stride) {
    for (size_t i = 0; i * size < raw.size(); ++i) store(rows[from + i * stride], h.type, raw.data() + i * size);
  };
  if (h.interleave == Interleave::bsq) {
    std::vector<std::byte> raw(count * h.samples * size);
    for (size_t b = 0; b < h.bands; ++b) {
      gather(raw, b, h.bands);
      impl_->image.write_at((b * h.lines + impl_->written) * h.samples * size, raw);
    }
  } else {
    std::vector<std::byte> raw(h.interleave == Interleave::bip ? width * size : h.samples * size);
    for (size_t line = 0; line < count; ++line) {
      if (h.interleave == Interleave::bip) {
        gather(raw, line * width, 1);
        impl_->image.write(raw);
        continue;
      }
      for (size_t b = 0; b < h.bands; ++b) {
        gather(raw, line * width + b, h.bands);
        impl_->image.write(raw);
      }
    }
  }
  impl_->written += count;
}

EnviHeader& EnviWriter::header() { return impl_->header; }

void EnviWriter::commit() {
  SUITE_CHECK_EQ(impl_->written, impl_->header.lines);
  check_header(impl_->path, impl_->header);
  impl_->text.write(header_text(impl_->header));
  // Everything that can fail for want of space happens before anything is renamed. The old header goes first: an image
  // without a header is plainly incomplete, an image with the header of another one is not.
  impl_->text.close();
  impl_->image.close();
  std::remove((impl_->path + ".hdr").c_str());
  impl_->image.commit();
  try {
    impl_->text.commit();
  } catch (const Error&) {
    std::remove(impl_->path.c_str());
    throw;
  }
}

void write_envi(const std::string& path, const EnviHeader& header, std::span<const double> values) {
  SUITE_CHECK_EQ(values.size(), header.values());
  EnviWriter writer(path, header);
  writer.append(values);
  writer.commit();
}

}  // namespace suite
