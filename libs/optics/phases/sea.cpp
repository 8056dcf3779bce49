// Phase functions of natural waters: particles alone (fournier_forand, petzold), and the mixture of molecules with two
// kinds of particles that a body of water is (sea).
// Based on: sea_particles.h; molecules of water with their depolarisation, X. Zhang, L. Hu, M.-X. He, "Scattering by
// pure seawater: effect of salinity", Opt. Express 17, 2009, equation 1.
#include <algorithm>
#include <array>
#include <optional>

#include "optics/models/common.h"
#include "optics/phases/henyey_greenstein.h"
#include "optics/phases/rows.h"
#include "optics/phases/sea_particles.h"

namespace suite {

namespace {

// One table for all wavelengths.
class OneTable final : public PhaseFunction {
 public:
  explicit OneTable(CosineTable table) : table_(std::move(table)) {}
  void eval(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), finite_float(table_.at(c))); }
  void pdf(double c, std::span<float> p) const override { eval(c, p); }
  double sample(double u, int) const override { return table_.sample(u); }
  void asymmetry(std::span<float> g) const override {
    std::fill(g.begin(), g.end(), static_cast<float>(table_.asymmetry()));
  }
  bool spectrally_uniform() const override { return true; }

 private:
  CosineTable table_;
};

// By its backscatter, or by index and slope where that is 0.
CosineTable forand_of(const ModelSpec& spec) {
  const double backscatter = spec.numbers.at("backscatter"), index = spec.numbers.at("index");
  const double slope = spec.numbers.at("slope");
  if (backscatter > 0) {
    if (backscatter < kLeastBackscatter)
      throw Error(strf("phase function 'fournier_forand': backscatter %g", backscatter),
                  strf("%g to %g, or 0 and index and slope", kLeastBackscatter, kMostBackscatter));
    if (index > 0 || slope > 0)
      throw Error("phase function 'fournier_forand' takes backscatter, or index and slope, not both");
    const SeaParticles p = sea_particles(backscatter);
    return fournier_forand_table(p.index, p.slope);
  }
  if (!(index >= 1.005 && slope >= 3.01))
    throw Error("phase function 'fournier_forand' needs backscatter, or index and slope",
                "index 1.005 to 1.4, slope 3.01 to 4.95");
  return fournier_forand_table(index, slope);
}

std::unique_ptr<const PhaseFunction> make_forand(const ModelSpec& spec, const SpectralState&) {
  return std::make_unique<OneTable>(forand_of(spec));
}
std::unique_ptr<const PhaseFunction> make_petzold(const ModelSpec&, const SpectralState&) {
  return std::make_unique<OneTable>(petzold_table());
}

CosineTable particles_of(const std::string& kind, double backscatter, double g) {
  if (kind == "petzold") return petzold_table();
  if (kind == "hg") return hg_table(g);
  if (kind != "fournier_forand")
    throw Error("phase function 'sea': unknown particles '" + kind + "'", "fournier_forand, petzold or hg");
  const SeaParticles p = sea_particles(backscatter);
  return fournier_forand_table(p.index, p.slope);
}

class Sea final : public PhaseFunction {
 public:
  Sea(const ModelSpec& spec, const SpectralState& state)
      : first_(state.sample(spec.curves.at("particles"))),
        second_(state.sample(spec.curves.at("minerals"))),
        tables_{particles_of(spec.texts.count("kind") ? spec.texts.at("kind") : "fournier_forand",
                             spec.numbers.at("backscatter"), spec.numbers.at("g")),
                particles_of("fournier_forand", spec.numbers.at("mineral_backscatter"), 0)},
        molecules_(
            bake_phase({"rayleigh", {{"depolarisation", spec.numbers.at("depolarisation")}}, {}, {}, nullptr}, state)),
        knots_(state.knots) {
    // Float rounding of shares that add up to 1.
    for (size_t i = 0; i < first_.size(); ++i) {
      const double sum = double(first_[i]) + second_[i];
      if (sum > 1 + 1e-5)
        throw Error(strf("phase function 'sea': particles and minerals are %g of the scattering at %g um", sum,
                         state.bins[i].center_um()),
                    "at most 1 together");
      if (sum > 1) first_[i] = std::max(0.0f, 1 - second_[i]);
    }
  }
  void eval(double c, std::span<float> p) const override {
    const Parts parts = at(c);
    for (size_t i = 0; i < p.size(); ++i) p[i] = value(parts, i);
  }
  void pdf(double c, std::span<float> p) const override {
    const Parts parts = at(c);
    for (size_t k = 0; k < p.size(); ++k) p[k] = value(parts, knots_[k]);
  }
  double sample(double u, int knot) const override {
    const size_t i = knots_[static_cast<size_t>(knot)];
    const double first = first_[i], second = second_[i];
    if (u < first) return tables_[0].sample(u / first);
    if (u < first + second) return tables_[1].sample((u - first) / second);
    return molecules_->sample(std::min((u - first - second) / (1 - first - second), 1 - 1e-16), knot);
  }
  void asymmetry(std::span<float> g) const override {
    for (size_t i = 0; i < g.size(); ++i)
      g[i] = static_cast<float>(first_[i] * tables_[0].asymmetry() + second_[i] * tables_[1].asymmetry());
  }
  bool spectrally_uniform() const override {
    const auto same = [](const std::vector<float>& v) {
      return std::all_of(v.begin(), v.end(), [&](float x) { return x == v.front(); });
    };
    return same(first_) && same(second_);
  }

 private:
  struct Parts {
    double first, second, molecules;
  };
  Parts at(double c) const {
    std::array<float, 1> m;
    molecules_->eval(c, m);
    return {tables_[0].at(c), tables_[1].at(c), m[0]};
  }
  float value(const Parts& p, size_t i) const {
    return finite_float(first_[i] * p.first + second_[i] * p.second + (1.0 - first_[i] - second_[i]) * p.molecules);
  }
  std::vector<float> first_, second_;  // shares of the scattering, per bin
  std::array<CosineTable, 2> tables_;
  std::unique_ptr<const PhaseFunction> molecules_;
  std::vector<size_t> knots_;
};

using P = Parameter;

}  // namespace

PhaseRow fournier_forand_row() {
  return {{"fournier_forand",
           "particles in water, sizes by a power law (Fournier & Jonasz 1999); the peak within 1e-6 rad is flat",
           "1/sr", make_forand},
          {{"backscatter", P::Kind::number, "1",
            "share scattered by more than 90 deg (Mobley 2002); 0 = by index, slope", 0, kMostBackscatter, false, 0},
           {"index", P::Kind::number, "1", "refractive index over that of water, 1.005 to 1.4", 0, 1.4, false, 0},
           {"slope", P::Kind::number, "1", "of the size distribution, 3.01 to 4.95", 0, 4.95, false, 0}},
          []() -> std::vector<ModelSpec> {
            return {{"fournier_forand", {{"index", 1.1}, {"slope", 3.5835}}, {}, {}, nullptr},
                    {"fournier_forand", {{"backscatter", 0.005}}, {}, {}, nullptr}};
          }};
}

PhaseRow petzold_row() {
  return {
      {"petzold", "average particle in sea water (Petzold 1972, as tabulated by Mobley 1994)", "1/sr", make_petzold},
      {},
      []() -> std::vector<ModelSpec> {
        return {{"petzold", {}, {}, {}, nullptr}};
      }};
}

PhaseRow sea_phase_row() {
  return {
      {"sea", "molecules of water and two kinds of particles, by their shares of the scattering", "1/sr",
       make_phase<Sea>},
      {{"particles", P::Kind::curve, "1", "share of the first kind in the scattering", 0, 1, false, 0},
       {"kind", P::Kind::text, "", "of the first kind: fournier_forand (unless given), petzold or hg", 0, 0, false},
       {"backscatter", P::Kind::number, "1", "of fournier_forand: share scattered by more than 90 deg",
        kLeastBackscatter, kMostBackscatter, false, 0.0183},
       {"g", P::Kind::number, "1", "of hg: mean cosine", -0.9999, 0.9999, false, 0.924},
       {"minerals", P::Kind::curve, "1", "share of the second kind, a fournier_forand", 0, 1, false, 0},
       {"mineral_backscatter", P::Kind::number, "1", "its share scattered by more than 90 deg", kLeastBackscatter,
        kMostBackscatter, false, 0.02},
       {"depolarisation", P::Kind::number, "1", "of molecules; 0.039 for water", 0, 0.5, false, 0.039}},
      []() -> std::vector<ModelSpec> {
        const Curve more({0.4, 0.8, 2.0}, {0.3, 0.6, 0.7}, Outside::hold);
        return {
            {"sea", {{"backscatter", 0.008}}, {{"particles", more}, {"minerals", Curve::constant(0.2)}}, {}, nullptr},
            {"sea", {}, {{"particles", more}}, {{"kind", "petzold"}}, nullptr},
            {"sea", {}, {{"particles", Curve::constant(1)}}, {{"kind", "hg"}}, nullptr},
            {"sea", {}, {}, {}, nullptr}};
      }};
}

}  // namespace suite
