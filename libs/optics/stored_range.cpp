#include "optics/stored_range.h"

#include <algorithm>

#include "sqt/bundle.h"

namespace suite {

bool StoredRange::covers(double low, double high) const {
  return outside != Outside::error || (low >= low_um * (1 - 1e-9) && high <= high_um * (1 + 1e-9));
}

StoredRange stored_range(const ModelSpec& spec) {
  std::vector<double> um = spec.bundle->info().function.wavelength_um;
  std::sort(um.begin(), um.end());
  StoredRange range{um.front() * (1 - StoredRange::kAlone), um.back() * (1 + StoredRange::kAlone), Outside::error};
  if (const size_t n = um.size(); n > 1) {
    range.low_um = std::max(0.0, um[0] - 0.5 * (um[1] - um[0]));
    range.high_um = um[n - 1] + 0.5 * (um[n - 1] - um[n - 2]);
  }
  const auto rule = spec.texts.find("outside");
  if (rule == spec.texts.end()) return range;
  for (const Outside known : {Outside::error, Outside::hold, Outside::zero})
    if (rule->second == to_text(known)) {
      range.outside = known;
      return range;
    }
  throw Error("'" + rule->second + "' says nothing about what holds outside the stored wavelengths",
              "error, hold or zero");
}

std::string beyond_stored(const ModelSpec& spec, double low_um, double high_um) {
  if (!spec.bundle) return {};
  const StoredRange range = stored_range(spec);
  if (range.covers(low_um, high_um)) return {};
  return strf("'%s' stands for %g to %g um", spec.texts.at("file").c_str(), range.low_um, range.high_um);
}

void require_stored(const ModelSpec& spec, double low_um, double high_um, const char* what) {
  if (const std::string text = beyond_stored(spec, low_um, high_um); !text.empty())
    throw Error(strf("%s 'sqt': %s, asked for %g to %g um", what, text.c_str(), low_um, high_um),
                "declare 'outside: hold' or 'zero', or fit data of these wavelengths");
}

}  // namespace suite
