#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "formats/samples/samples.h"
#include "math/vec.h"

namespace suite {

std::string samples_text(const sqt::Function& function, std::span<const double> zenith, std::span<const Dir> in) {
  const sqt::Function::Info& info = function.info();
  if (!info.isotropic || info.quantity != sqt::Quantity::bsdf)
    throw Error("'" + info.name + "' is no isotropic BSDF: raw sample text has outgoing directions of azimuth 0 only",
                "write .csv");
  const bool sphere = info.domain == sqt::Domain::sphere;
  std::string text = std::string(sphere ? "RAWBS10A " : "RAWBH10A ") + info.name + '\n';
  auto list = [&text](std::span<const double> values) {
    text += strf("%zu", values.size());
    for (const double v : values) text += strf(" %.17g", v);
    text += '\n';
  };
  // The format's wavelengths ascend; colours are kept from red to blue.
  std::vector<size_t> order(info.wavelength_um.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return info.wavelength_um[a] < info.wavelength_um[b]; });
  std::vector<double> um;
  for (const size_t c : order) um.push_back(info.wavelength_um[c]);
  list(um);
  list(zenith);
  std::vector<double> f(info.wavelength_um.size());
  for (size_t o = 0; o < zenith.size(); ++o)
    for (const Dir& d : in) {
      function.value(dir_from_angles(zenith[o], 0), normalized(d), f);  // a reader normalises
      text += strf("%zu %.17g %.17g %.17g", o, d.x, d.y, d.z);
      for (const size_t c : order) text += strf(" %.17g", f[c]);
      text += '\n';
    }
  return text;
}

}  // namespace suite
