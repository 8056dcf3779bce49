// Scattering by molecules, with the depolarisation of real air.
// Based on: A. Bucholtz, "Rayleigh-scattering calculations for the terrestrial atmosphere", Appl. Opt. 34(15), 1995,
// equations 12-13. The distribution of the cosine is a cubic with one real root, inverted in closed form.
#include <cmath>

#include "optics/models/common.h"
#include "optics/phases/rows.h"

namespace suite {

namespace {

class Rayleigh final : public PhaseFunction {
 public:
  Rayleigh(const ModelSpec& spec, const SpectralState&) {
    const double depolarisation = spec.numbers.at("depolarisation");
    gamma_ = depolarisation / (2 - depolarisation);
    delta_ = (1 - depolarisation) / (1 + depolarisation / 2);
    turning_ = (1 - 2 * depolarisation) / (1 - depolarisation);
  }
  void eval(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), value(c)); }
  void pdf(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), value(c)); }
  double sample(double u, int) const override {
    // c^3 + a c = b
    const double a = 3 * (1 + 3 * gamma_) / (1 - gamma_), b = (u - 0.5) * 8 * (1 + 2 * gamma_) / (1 - gamma_);
    const double root = 2 * std::sqrt(a / 3) * std::sinh(std::asinh(1.5 * b / a * std::sqrt(3 / a)) / 3);
    return std::clamp(root, -1.0, 1.0);
  }
  void asymmetry(std::span<float> g) const override { std::fill(g.begin(), g.end(), 0.0f); }
  // Hansen & Travis, "Light scattering in planetary atmospheres", Space Sci. Rev. 16, 1974, equations 2.15-2.16.
  ScatterModel::Polarised polarised(double c, std::span<PlaneBlocks> b) const override {
    const double along = 0.75 * delta_ * (1 + c * c), turned = 1.5 * delta_ * c, all = along + 1 - delta_;
    b[0] = PlaneBlocks{all, -0.75 * delta_ * (1 - c * c), turned, 0, along, turned * turning_} * (1 / all);
    return {true, 0};
  }
  bool spectrally_uniform() const override { return true; }

 private:
  float value(double c) const {
    return static_cast<float>(3 / (16 * kPi * (1 + 2 * gamma_)) * (1 + 3 * gamma_ + (1 - gamma_) * c * c));
  }
  double gamma_, delta_, turning_;
};

}  // namespace

PhaseRow rayleigh_row() {
  using P = Parameter;
  return {{"rayleigh", "molecules (Rayleigh 1871; depolarisation after Bucholtz 1995)", "1/sr", make_phase<Rayleigh>},
          {{"depolarisation", P::Kind::number, "1", "depolarisation factor; 0.0279 for air", 0, 0.5, false, 0}},
          []() -> std::vector<ModelSpec> {
            return {{"rayleigh", {}, {}, {}, nullptr}, {"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr}};
          }};
}

}  // namespace suite
