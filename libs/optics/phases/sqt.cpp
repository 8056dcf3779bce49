// A fitted spherical quad-tree as a phase function.
//
// Phase functions here depend on the scattering angle alone, so the tree is read once: at angles that lie closer than
// its finest cells near the forward peak, as means over the azimuth. Between two stored wavelengths the shape is the
// mean of theirs, weighed by nearness; outside the stored range the nearest when that is declared. Normalised: how much
// is scattered is the medium's to say. Based on: Goodenough & Brown, section IV-D (quad-trees for phase functions).
#include <cmath>

#include "optics/models/common.h"
#include "optics/phases/cosine_table.h"
#include "optics/phases/rows.h"
#include "optics/stored_range.h"
#include "sqt/bundle.h"

namespace suite {

namespace {

constexpr int kAzimuths = 32;

// Scattering angles from 180 down to 0 deg: every 0.25 deg, near straight on and straight back ever closer.
std::vector<double> angles() {
  std::vector<double> a;
  for (int i = 0; i <= 720; ++i) {
    const double t = i / 360.0 - 1;  // -1 .. 1, closest at the ends
    a.push_back(90 * (1 - t * (1.5 - 0.5 * t * t)));
  }
  return a;
}

class SqtPhase final : public PhaseFunction {
 public:
  SqtPhase(const sqt::Bundle& bundle, const SpectralState& state) : knots_(state.knots) {
    const size_t channels = bundle.channels();
    const std::vector<double> angle = angles();
    std::vector<double> cosine(angle.size()), f(channels);
    std::vector<std::vector<double>> value(channels, std::vector<double>(angle.size(), 0.0));
    for (size_t i = 0; i < angle.size(); ++i) {
      cosine[i] = i == 0 ? -1 : i + 1 == angle.size() ? 1 : std::cos(angle[i] * kDegree);
      const double sine = std::sin(angle[i] * kDegree);
      for (int k = 0; k < kAzimuths; ++k) {
        // Light arrives along -in and leaves along the pole: straight on is in = -out.
        const double phi = 2 * kPi * (k + 0.5) / kAzimuths;
        bundle.value({0, 0, 1}, {sine * std::cos(phi), sine * std::sin(phi), -cosine[i]}, f);
        for (size_t c = 0; c < channels; ++c) value[c][i] += std::max(0.0, f[c]) / kAzimuths;
      }
    }
    for (size_t c = 0; c < channels; ++c) {
      tables_.emplace_back(cosine, std::move(value[c]));
      if (!tables_.back().valid()) throw Error("phase function 'sqt': the file holds no light in one of its channels");
    }
    std::vector<std::pair<double, size_t>> order;
    for (size_t c = 0; c < channels; ++c) order.push_back({bundle.info().function.wavelength_um[c], c});
    std::sort(order.begin(), order.end());
    for (const Bin& bin : state.bins) {
      const double um = bin.center_um();
      size_t i = 0;
      while (i + 1 < order.size() && order[i + 1].first <= um) ++i;
      const size_t j = um <= order[i].first ? i : std::min(i + 1, order.size() - 1);
      const double t = i == j ? 0 : (um - order[i].first) / (order[j].first - order[i].first);
      mix_.push_back({order[i].second, order[j].second, t});
    }
  }
  void eval(double c, std::span<float> p) const override {
    for (size_t i = 0; i < p.size(); ++i) p[i] = value(c, mix_[i]);
  }
  void pdf(double c, std::span<float> p) const override {
    for (size_t k = 0; k < p.size(); ++k) p[k] = value(c, mix_[knots_[k]]);
  }
  double sample(double u, int knot) const override {
    const Mix& m = mix_[knots_[static_cast<size_t>(knot)]];
    return u < m.t ? tables_[m.high].sample(u / m.t) : tables_[m.low].sample((u - m.t) / (1 - m.t));
  }
  void asymmetry(std::span<float> g) const override {
    for (size_t i = 0; i < g.size(); ++i)
      g[i] = static_cast<float>((1 - mix_[i].t) * tables_[mix_[i].low].asymmetry() +
                                mix_[i].t * tables_[mix_[i].high].asymmetry());
  }
  bool spectrally_uniform() const override { return tables_.size() == 1; }

 private:
  struct Mix {
    size_t low, high;
    double t;
  };
  float value(double c, const Mix& m) const {
    const double low = tables_[m.low].at(c);
    return finite_float(m.t > 0 ? low + (tables_[m.high].at(c) - low) * m.t : low);
  }
  std::vector<CosineTable> tables_;  // per channel
  std::vector<Mix> mix_;             // per bin
  std::vector<size_t> knots_;
};

}  // namespace

PhaseRow sqt_phase_row() {
  using P = Parameter;
  return {{"sqt", "fitted spherical quad-tree of a phase function (Goodenough & Brown 2017)", "1/sr",
           [](const ModelSpec& spec, const SpectralState& state) -> std::unique_ptr<const PhaseFunction> {
             const std::string name = spec.texts.at("file");
             if (!spec.bundle) throw Error("phase function 'sqt': the file '" + name + "' has not been loaded");
             if (spec.bundle->info().function.quantity != sqt::Quantity::phase)
               throw Error("phase function 'sqt': '" + name + "' does not hold a phase function",
                           "fit one, e.g. sqt-fit --model hg:g=0.8");
             if (stored_range(spec).outside == Outside::zero)
               throw Error("phase function 'sqt': 'outside: zero' leaves nothing to normalise", "error or hold");
             for (const Bin& bin : state.bins) require_stored(spec, bin.low_um, bin.high_um, "phase function");
             return std::make_unique<SqtPhase>(*spec.bundle, state);
           }},
          {{"file", P::Kind::text, "", "name of the .sqt file", 0, 0},
           {"outside", P::Kind::text, "",
            "beyond half a spacing from the outermost channels (alone: 5 % of its wavelength): error or hold", 0, 0,
            false}},
          []() -> std::vector<ModelSpec> {  // the tests fit a bundle to it
            return {{"sqt", {}, {}, {{"file", "haze.sqt"}, {"outside", "hold"}}, nullptr}};
          }};
}

}  // namespace suite
