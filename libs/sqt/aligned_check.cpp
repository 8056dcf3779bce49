// The invariants of decoded data of the aligned method; see aligned.h.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sqt/aligned_tables.h"

namespace suite::sqt {

void check_aligned(const AlignedData& d) {
  auto require = [](bool condition, const char* what) {
    if (!condition) throw Error(std::string("inconsistent SQT data: ") + what);
  };
  const AlignedLayout& l = d.layout;
  const AlignedTotals& t = d.totals;
  require(l.channels > 0 && l.channels == d.function.wavelength_um.size(), "number of channels");
  require(!l.theta.empty() && l.phi_count > 0 && t.phi_count > 0 && !t.theta.empty(), "no views");
  require(t.phi_count == l.phi_count, "azimuths of totals are not those of views");
  require(l.phi_count == 1 || !d.function.isotropic, "views of isotropic data at several azimuths");
  for (size_t i = 1; i < l.theta.size(); ++i) require(l.theta[i] > l.theta[i - 1], "view angles do not ascend");
  for (size_t i = 1; i < t.theta.size(); ++i) require(t.theta[i] > t.theta[i - 1], "angles of totals do not ascend");
  for (size_t i = 1; i < t.magnitude_um.size(); ++i)
    require(t.magnitude_um[i] > t.magnitude_um[i - 1], "wavelengths of totals do not ascend");
  for (const double um : d.function.wavelength_um)
    require(std::binary_search(t.magnitude_um.begin(), t.magnitude_um.end(), um), "a wavelength has no total");
  require(t.magnitudes.size() == t.theta.size() * t.phi_count * t.magnitude_um.size(), "number of totals");
  require(t.log2_scale.size() == t.theta.size() * t.phi_count * l.channels, "number of scales");
  if (t.delta_kind != Dirac::none) {
    require(d.function.quantity == Quantity::bsdf, "a Dirac lobe of something that is no surface");
    require(t.delta_kind != Dirac::through || l.sheets == 2, "a Dirac lobe on a side without data");
    require(t.delta.size() == t.theta.size() * t.phi_count * l.channels, "number of Dirac totals");
    require(t.magnitude_um.size() == l.channels, "a Dirac lobe with totals finer than channels");
    for (const float m : t.delta) require(std::isfinite(m) && m >= 0 && m <= 1.001f, "a Dirac total is out of range");
  }
  for (const float m : t.magnitudes) require(std::isfinite(m) && m >= 0, "a total is negative or not finite");
  for (const float s : t.log2_scale) require(std::isfinite(s) && std::fabs(s) <= 200, "a scale is not finite");
  require(d.sheets.size() == static_cast<size_t>(l.sheets) && (l.sheets == 1 || l.sheets == 2), "number of sheets");
  for (const AlignedSheet& s : d.sheets) {
    require(!s.leaves.empty() && s.plane.size() >= s.leaves.size() * l.width() * AlignedSheet::kStride &&
                s.inverse_area.size() == s.leaves.size() && s.mass.size() >= s.leaves.size() * padded_row(l.width()),
            "number of leaf values");
  }
}

}  // namespace suite::sqt
