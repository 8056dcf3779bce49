// Natural ground: isotropic, volumetric (RossThick) and geometric (LiSparse, reciprocal) kernels, as in satellite
// products. Assumes: crowns with h/b = 2 and b/r = 1; and what kernel_ground.h says. Based on: W. Lucht, C. Schaaf, A.
// Strahler, "An algorithm for the retrieval of albedo from space using semiempirical BRDF models", IEEE TGRS 38(2),
// 2000, equations 37-44.
#include <cmath>

#include "optics/models/kernel_ground.h"
#include "optics/models/rows.h"

namespace suite {

namespace {

struct Kernels {
  double volume, geometry;
  Kernels(Dir o, Dir i) {
    const double phase = angle_between(o, i), cos_phase = std::cos(phase);
    volume = ((kPi / 2 - phase) * cos_phase + std::sin(phase)) / (o.z + i.z) - kPi / 4;
    // Overlap of the shadows of spheres whose centres stand two radii high.
    const double sec = 1 / o.z + 1 / i.z, dx = o.x / o.z - i.x / i.z, dy = o.y / o.z - i.y / i.z;
    const double sine = (o.x * i.y - o.y * i.x) / (o.z * i.z);  // tan tan sin(delta phi)
    const double cos_t = std::min(1.0, 2 * std::sqrt(dx * dx + dy * dy + sine * sine) / sec), t = std::acos(cos_t);
    const double overlap = (t - std::sin(t) * cos_t) * sec / kPi;
    geometry = overlap - sec + 0.5 * (1 + cos_phase) / (o.z * i.z);
  }
};

class RossLi final : public KernelGround<Kernels> {
 public:
  RossLi(const ModelSpec& spec, const SpectralState& state) : KernelGround("ross_li", spec, state) {}
};

}  // namespace

ModelRow ross_li_row() {
  using P = Parameter;
  return {{"ross_li", "natural ground, RossThick and LiSparse kernels as in satellite products (Lucht 2000)", "1/sr",
           make_model<RossLi>},
          {{"isotropic", P::Kind::curve, "1", "weight of the constant", 0, 1},
           {"volume", P::Kind::curve, "1", "weight of the RossThick kernel", -1, 1},
           {"geometry", P::Kind::curve, "1", "weight of the LiSparse kernel", -1, 1},
           bpdf_parameter()},
          true,
          []() -> std::vector<ModelSpec> {
            const Curve level({0.4, 0.65, 0.85, 2.0}, {0.04, 0.06, 0.3, 0.25}, Outside::hold);
            const Curve volume({0.4, 0.65, 0.85, 2.0}, {0.02, 0.03, 0.2, 0.1}, Outside::hold);
            const Curve geometry({0.4, 0.65, 0.85, 2.0}, {0.01, 0.012, 0.03, 0.03}, Outside::hold);
            return {{"ross_li",
                     {},
                     {{"isotropic", level}, {"volume", volume}, {"geometry", geometry}},
                     {{"bpdf", "maignan c 6.11 ndvi 0.5"}},
                     nullptr},
                    {"ross_li",
                     {},
                     {{"isotropic", Curve::constant(0.2)},
                      {"volume", Curve::constant(0.1)},
                      {"geometry", Curve::constant(0.1)}},
                     {{"bpdf", "breon cover 0.6"}},
                     nullptr}};
          }};
}

}  // namespace suite
