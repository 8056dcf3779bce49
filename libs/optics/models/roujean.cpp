// Natural ground: constant, volume and geometric kernels of Roujean, as of POLDER and SEVIRI products.
// Assumes: what kernel_ground.h says (where a sum is cut at 0, totals err by up to 0.2 %); kernels are 0 with sun and
// view at the zenith. Based on: J.-L. Roujean, M. Leroy, P.-Y. Deschamps, "A bidirectional reflectance model of the
// Earth's surface for the correction of remote sensing data", JGR 97(D18), 1992, equations 2 (f1) and 8 (f2).
#include <cmath>

#include "optics/models/kernel_ground.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

struct RoujeanKernels {
  double volume, geometry;
  RoujeanKernels(Dir o, Dir i) {
    const double to = std::hypot(o.x, o.y) / o.z, ti = std::hypot(i.x, i.y) / i.z;
    // Relative azimuth, 0 towards the light: the hot spot.
    const double phi = to > 0 && ti > 0 ? std::fabs(std::atan2(o.x * i.y - o.y * i.x, o.x * i.x + o.y * i.y)) : 0;
    const double between = std::hypot(o.x / o.z - i.x / i.z, o.y / o.z - i.y / i.z);
    geometry = ((kPi - phi) * std::cos(phi) + std::sin(phi)) * to * ti / (2 * kPi) - (to + ti + between) / kPi;
    const double phase = angle_between(o, i);
    volume = 4 / (3 * kPi * (o.z + i.z)) * ((kPi / 2 - phase) * std::cos(phase) + std::sin(phase)) - 1.0 / 3;
  }
};

class Roujean final : public KernelGround<RoujeanKernels> {
 public:
  Roujean(const ModelSpec& spec, const SpectralState& state) : KernelGround("roujean", spec, state) {}
};

}  // namespace

ModelRow roujean_row() {
  using P = Parameter;
  return {{"roujean", "natural ground, volume and geometric kernels (Roujean, Leroy & Deschamps 1992)", "1/sr",
           make_model<Roujean>},
          {{"isotropic", P::Kind::curve, "1", "weight of the constant, k0", 0, 1},
           {"geometry", P::Kind::curve, "1", "weight of the geometric kernel, k1", -1, 1},
           {"volume", P::Kind::curve, "1", "weight of the volume kernel, k2", -1, 1},
           bpdf_parameter()},
          true,
          []() -> std::vector<ModelSpec> {
            // Bare soil and vegetation in size, red and near infrared.
            const Curve level({0.58, 0.865}, {0.24, 0.3}, Outside::hold),
                geometry({0.58, 0.865}, {0.03, 0.03}, Outside::hold), volume({0.58, 0.865}, {0.1, 0.4}, Outside::hold);
            return {{"roujean", {}, {{"isotropic", level}, {"geometry", geometry}, {"volume", volume}}, {}, nullptr},
                    {"roujean",
                     {},
                     {{"isotropic", Curve::constant(0.2)},
                      {"geometry", Curve::constant(0.02)},
                      {"volume", Curve::constant(0.3)}},
                     {{"bpdf", "litvinov"}},
                     nullptr}};
          }};
}

}  // namespace suite
