// What the stored numbers of an image stand for.
// Based on: ENVI's header keys "data gain values", "data offset values", "reflectance scale factor" and "bbl".
#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/envi/envi.h"

namespace suite {

namespace {

std::vector<double> list_of(const EnviHeader& h, const std::string& key, const std::string& file, bool one_per_band) {
  const auto found = std::find_if(h.extra.begin(), h.extra.end(), [&](const auto& e) { return e.first == key; });
  std::vector<double> values;
  if (found == h.extra.end()) return values;
  const Where where{file, 0, 0, {}, -1};
  const std::string& text = found->second;
  const char *at = text.data(), *const end = text.data() + text.size();
  const auto between = [&](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '{' || c == '}'; };
  while (true) {
    while (at < end && (between(*at) || *at == '+')) ++at;
    double value = 0;
    const auto [stop, code] = std::from_chars(at, end, value);
    if (code != std::errc() || !std::isfinite(value))
      throw Error(where, "'" + key + "': '" + std::string(at, std::min<size_t>(40, static_cast<size_t>(end - at))) +
                             "' is not a finite number");
    values.push_back(value);
    for (at = stop; at < end && between(*at);) ++at;
    if (at == end) break;
    if (*at++ != ',') throw Error(where, "'" + key + "': numbers are separated by commas");
  }
  const size_t expected = one_per_band ? h.bands : 1;
  if (values.size() != expected)
    throw Error(where, strf("'%s' has %zu values, %zu are expected", key.c_str(), values.size(), expected));
  return values;
}

}  // namespace

EnviNumbers numbers_of(const EnviHeader& h, const std::string& file) {
  const Where where{file, 0, 0, {}, -1};
  EnviNumbers n;
  n.gain = list_of(h, "data gain values", file, true);
  n.offset = list_of(h, "data offset values", file, true);
  if (std::find(n.gain.begin(), n.gain.end(), 0.0) != n.gain.end())
    throw Error(where, "'data gain values': a gain of 0");
  if (const std::vector<double> factor = list_of(h, "reflectance scale factor", file, false); !factor.empty()) {
    if (!(factor[0] > 0)) throw Error(where, strf("'reflectance scale factor' is %g, not positive", factor[0]));
    if (!n.gain.empty() && factor[0] != 1)
      throw Error(where, "has both 'data gain values' and a 'reflectance scale factor'",
                  "keep the one that makes reflectances of the stored numbers");
    if (n.gain.empty()) n.gain.assign(h.bands, 1 / factor[0]);
  }
  for (const double good : list_of(h, "bbl", file, true)) n.bad.push_back(good == 0);
  return n;
}

}  // namespace suite
