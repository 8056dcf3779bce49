// Leaves that lie every way alike (a spherical distribution of normals) and scatter as bi-Lambertian plates: part of
// what they scatter is reflected, part goes through. Based on: J. Ross, "The Radiation Regime and Architecture of Plant
// Stands", 1981; J. K. Shultis & R. B. Myneni, "Radiative transfer in vegetation canopies with anisotropic scattering",
// JQSRT 39(2), 1988, equation 17: the area scattering function w/(3 pi) (sin b - b cos b) + t/3 cos b of the angle b
// between the directions of travel, divided by pi and by the half of w = r + t that a sphere of leaves intercepts.
#include <cmath>

#include "optics/models/common.h"
#include "optics/phases/cosine_table.h"
#include "optics/phases/rows.h"

namespace suite {

namespace {

constexpr size_t kEntries = 4097;  // linear between them to 1e-7 of the largest value

// What is reflected alone; what goes through is the same about the opposite direction.
CosineTable reflected_table() {
  std::vector<double> cosine, value;
  for (size_t k = 0; k < kEntries; ++k) {
    const double c = -1 + 2 * static_cast<double>(k) / (kEntries - 1), angle = std::acos(c);
    cosine.push_back(c);
    value.push_back(std::max(0.0, std::sin(angle) - angle * c));
  }
  return CosineTable(std::move(cosine), std::move(value));
}

class Leaves final : public PhaseFunction {
 public:
  Leaves(const ModelSpec& spec, const SpectralState& state)
      : through_(state.sample(spec.curves.at("transmitted"))), knots_(state.knots), table_(reflected_table()) {}
  void eval(double c, std::span<float> p) const override {
    for (size_t i = 0; i < p.size(); ++i) p[i] = value(c, i);
  }
  void pdf(double c, std::span<float> p) const override {
    for (size_t k = 0; k < p.size(); ++k) p[k] = value(c, knots_[k]);
  }
  double sample(double u, int knot) const override {
    const double through = through_[knots_[static_cast<size_t>(knot)]];
    return u < through ? -table_.sample(u / through) : table_.sample((u - through) / (1 - through));
  }
  void asymmetry(std::span<float> g) const override {
    for (size_t i = 0; i < g.size(); ++i) g[i] = static_cast<float>((1 - 2 * through_[i]) * table_.asymmetry());
  }
  bool spectrally_uniform() const override {
    return std::all_of(through_.begin(), through_.end(), [&](float x) { return x == through_.front(); });
  }

 private:
  float value(double c, size_t i) const {
    return static_cast<float>((1 - through_[i]) * table_.at(c) + through_[i] * table_.at(-c));
  }
  std::vector<float> through_;
  std::vector<size_t> knots_;
  CosineTable table_;
};

}  // namespace

PhaseRow leaves_row() {
  using P = Parameter;
  return {{"leaves", "leaves that lie every way alike, bi-Lambertian (Ross 1981, Shultis & Myneni 1988)", "1/sr",
           make_phase<Leaves>},
          {{"transmitted", P::Kind::curve, "1", "share of what a leaf scatters that goes through it", 0, 1}},
          []() -> std::vector<ModelSpec> {
            const Curve green({0.4, 0.7, 0.8, 2.0}, {0.2, 0.3, 0.5, 0.45}, Outside::hold);
            return {{"leaves", {}, {{"transmitted", green}}, {}, nullptr},
                    {"leaves", {}, {{"transmitted", Curve::constant(0)}}, {}, nullptr},
                    {"leaves", {}, {{"transmitted", Curve::constant(1)}}, {}, nullptr}};
          }};
}

}  // namespace suite
