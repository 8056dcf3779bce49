#include <cmath>
#include <filesystem>
#include <limits>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/cornell/cornell.h"
#include "sqt_fit/symmetry.h"

namespace suite {

namespace {

std::vector<double> read_wavelengths(TextLines& lines) {
  if (!lines.next())
    throw lines.error_at_end("is empty", "number of wavelengths, the wavelengths, then rows of samples");
  const long long count = lines.integer(0, "the number of wavelengths", 1, 10000);
  if (lines.words() != 1) throw lines.error(1, "more than the number of wavelengths on the first line");
  std::vector<double> um;
  while (um.size() < static_cast<size_t>(count)) {
    if (!lines.next()) throw lines.error_at_end(strf("the file ends after %zu of %lld wavelengths", um.size(), count));
    for (size_t i = 0; i < lines.words(); ++i) {
      um.push_back(lines.number_in(i, "a wavelength in nm", 100, 100000) / 1000);
      if (um.size() > static_cast<size_t>(count))
        throw lines.error(i, strf("more than the %lld wavelengths announced", count));
      if (um.size() > 1 && !(um.back() > um[um.size() - 2])) throw lines.error(i, "wavelengths are not ascending");
    }
  }
  return um;
}

}  // namespace

sqt::Samples parse_cornell(std::string_view text, const std::string& file_name) {
  TextLines lines(text, file_name);
  sqt::Samples s;
  s.info.name = std::filesystem::path(file_name).stem().string();
  s.info.wavelength_um = read_wavelengths(lines);
  const size_t channels = s.info.wavelength_um.size();
  while (lines.next()) {
    if (lines.words() != 4 + channels)
      throw lines.error(0, strf("the line has %zu numbers, %zu are wanted", lines.words(), 4 + channels),
                        "theta_i, phi_i, theta_s, phi_s, one value per wavelength");
    double angle[4];
    for (size_t i = 0; i < 4; ++i)
      angle[i] = i % 2 == 0 ? lines.number_in(i, "a polar angle in rad", 0, kPi / 2)
                            : lines.number_in(i, "an azimuth in rad", -2 * kPi, 2 * kPi);
    s.in.push_back(dir_from_angles(angle[0], angle[1]));
    s.out.push_back(dir_from_angles(angle[2], angle[3]));
    for (size_t c = 0; c < channels; ++c) {
      const double v = lines.number(4 + c, "a value", true);
      s.value.push_back(std::isfinite(v) ? v : std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (s.in.empty()) throw lines.error_at_end("holds no samples");
  infer_symmetry(s, sqt::Still::in);
  s.info.source = "Cornell .brdf, value per sr without cosine";
  return s;
}

sqt::Samples read_cornell(const std::string& path) { return parse_cornell(read_text(path), path); }

}  // namespace suite
