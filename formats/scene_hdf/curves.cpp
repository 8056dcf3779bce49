#include <cmath>

#include "formats/scene_hdf/internal.h"

namespace suite {

void write_curves(h5::Writer& w, const std::string& t, const std::vector<Curve>& curves) {
  w.put(t + "/outside",
        pick(curves,
             [](const Curve& c) {
               return static_cast<uint8_t>(c.is_constant() ? h5::kConstantCurve : static_cast<int>(c.outside()));
             }),
        "1");
  w.put(t + "/points", pick(curves, [](const Curve& c) { return uint64_t{c.value().size()}; }), "1");
  std::vector<double> x, y;
  for (const Curve& c : curves) {
    x.insert(x.end(), c.wavelength_um().begin(), c.wavelength_um().end());
    y.insert(y.end(), c.value().begin(), c.value().end());
  }
  w.put(t + "/wavelength", x, "um");
  w.put(t + "/value", y, "1");
}

std::vector<Curve> read_curves(h5::Reader& r, const std::string& t) {
  const auto outside = r.get<uint8_t>(t + "/outside", "1");
  const auto points = r.get<uint64_t>(t + "/points", "1", 1, static_cast<long long>(outside.size()));
  Stretch<double> x(r, t + "/wavelength", "um"), y(r, t + "/value", "1");
  std::vector<Curve> curves;
  for (size_t k = 0; k < outside.size(); ++k) {
    std::vector<double> wavelength = x.next(points[k]), value = y.next(points[k]);
    if (outside[k] == h5::kConstantCurve && value.size() == 1 && std::isfinite(value[0]))
      curves.push_back(Curve::constant(value[0]));
    else if (outside[k] <= static_cast<uint8_t>(Outside::zero))
      curves.push_back(Curve(std::move(wavelength), std::move(value), static_cast<Outside>(outside[k])));
    else
      r.fail("a curve has an unknown rule outside its range");
  }
  x.finish(), y.finish();
  return curves;
}

}  // namespace suite
