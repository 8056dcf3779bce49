#include "sqt/view_lanes.h"

#include <cmath>

#include "sqt/portable_math.h"

namespace suite::sqt {

ViewLanes::ViewLanes(const AlignedLayout& layout)
    : reflects(layout.frame == LobeFrame::half || layout.frame == LobeFrame::retro), views(layout.views()) {
  const size_t n = padded_row(views);
  x.resize(n, 0), y.resize(n, 0), z.resize(n, 0), weight.resize(n, 0);
  for (size_t i = 0; i < layout.theta.size(); ++i)
    for (size_t j = 0; j < layout.phi_count; ++j) {
      // Portable, unlike the sine and cosine of the library.
      const double turn = static_cast<double>(j) / static_cast<double>(layout.phi_count);
      const auto cosine = [](double angle) { return portable_cos_pi(std::llround(angle * 0x1p40 / kPi), 1LL << 40); };
      const double sine = cosine(layout.theta[i] - kPi / 2), side = layout.frame == LobeFrame::retro ? -1 : 1;
      const size_t v = i * layout.phi_count + j;
      x[v] = static_cast<float>(side * sine * cosine(2 * kPi * turn));
      y[v] = static_cast<float>(side * sine * cosine(2 * kPi * turn - kPi / 2));
      z[v] = static_cast<float>(cosine(layout.theta[i]));
      weight[v] = static_cast<float>(sine + 0.05);
    }
}

}  // namespace suite::sqt
