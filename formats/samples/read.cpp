#include <cmath>
#include <limits>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/samples/samples.h"
#include "sqt_fit/symmetry.h"

namespace suite {

namespace {

// "count v1 v2 ...": all on one line.
std::vector<double> counted_list(TextLines& lines, const char* what, double low, double high) {
  if (!lines.next()) throw lines.error_at_end(strf("the line of %s is missing", what), "count, then as many numbers");
  const long long count = lines.integer(0, "the count", 1, 100000);
  if (static_cast<size_t>(count) != lines.words() - 1)
    throw lines.error(0, strf("the line says %lld %s and has %zu", count, what, lines.words() - 1));
  std::vector<double> list;
  for (size_t i = 1; i < lines.words(); ++i) {
    list.push_back(lines.number_in(i, what, low, high));
    if (list.size() > 1 && !(list.back() > list[list.size() - 2]))
      throw lines.error(i, strf("%s are not ascending", what));
  }
  return list;
}

}  // namespace

sqt::Samples parse_samples(std::string_view text, const std::string& file_name) {
  TextLines lines(text, file_name);
  const bool sphere = text.starts_with("RAWBS10A");
  if (!lines.next_raw() || (!sphere && !text.starts_with("RAWBH10A")) || lines.words() == 0 ||
      lines.word(0).size() != 8)
    throw lines.error_at_end("is not raw sample text",
                             "the first line starts with RAWBH10A (hemisphere) or RAWBS10A (sphere)");
  sqt::Samples s;
  s.info.name = lines.words() > 1 ? std::string(lines.line().substr(9)) : "unnamed";
  s.info.wavelength_um = counted_list(lines, "wavelengths", 0.01, 1000);
  const std::vector<double> zeniths = counted_list(lines, "zeniths", 0, kPi / 2 - 1e-6);
  const size_t channels = s.info.wavelength_um.size();
  while (lines.next()) {
    if (lines.words() != 4 + channels)
      throw lines.error(0, strf("the line has %zu numbers, %zu are wanted", lines.words(), 4 + channels),
                        "view index, x, y, z, one value per wavelength");
    const size_t view =
        static_cast<size_t>(lines.integer(0, "the view index", 0, static_cast<long long>(zeniths.size()) - 1));
    const Vec3 in{lines.number(1, "x"), lines.number(2, "y"), lines.number(3, "z")};
    if (std::fabs(length(in) - 1) > 1e-3)
      throw lines.error(1, strf("the direction has length %g", length(in)), "a unit vector");
    if (!sphere && in.z < 0) throw lines.error(3, "the direction lies below the surface", "RAWBS10A holds both sides");
    s.out.push_back(dir_from_angles(zeniths[view], 0));
    s.in.push_back(normalized(in));
    for (size_t c = 0; c < channels; ++c) {
      const double v = lines.number(4 + c, "the value", true);
      s.value.push_back(std::isfinite(v) ? v : std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (s.in.empty()) throw lines.error_at_end("holds no samples");
  infer_symmetry(s, sqt::Still::out);
  if (sphere) s.info.domain = sqt::Domain::sphere;
  s.info.source = strf("raw sample text, %s, value per sr without cosine", sphere ? "RAWBS10A" : "RAWBH10A");
  return s;
}

sqt::Samples read_samples(const std::string& path) { return parse_samples(read_text(path), path); }

}  // namespace suite
