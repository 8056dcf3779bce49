#include "air/air_media.h"

#include <algorithm>

namespace suite {

namespace {

// What the kinds of a layer do together.
class LayerPhase final : public PhaseFunction {
 public:
  LayerPhase(std::shared_ptr<const AirColumn> column, size_t layer, std::span<const size_t> knots)
      : column_(std::move(column)), first_(layer * column_->bins), knots_(knots.begin(), knots.end()) {}

  void eval(double cosine, std::span<float> p) const override {
    sum(p, [&](const PhaseFunction& phase, std::span<float> one) { phase.eval(cosine, one); });
  }
  void asymmetry(std::span<float> g) const override {
    sum(g, [](const PhaseFunction& phase, std::span<float> one) { phase.asymmetry(one); });
  }
  void pdf(double cosine, std::span<float> p) const override {
    float one[kMaxKnots];
    double whole[kMaxKnots] = {};
    std::fill(p.begin(), p.end(), 0.0f);
    for (const AirColumn::Kind& kind : column_->kinds) {
      kind.phase->pdf(cosine, {one, p.size()});
      for (size_t k = 0; k < p.size(); ++k) {
        p[k] += scattering(kind, knots_[k]) * one[k];
        whole[k] += scattering(kind, knots_[k]);
      }
    }
    for (size_t k = 0; k < p.size(); ++k) p[k] = whole[k] > 0 ? static_cast<float>(p[k] / whole[k]) : 0;
  }
  double sample(double u, int knot) const override {
    const size_t bin = knots_[static_cast<size_t>(knot)];
    double whole = 0;
    for (const AirColumn::Kind& kind : column_->kinds) whole += scattering(kind, bin);
    double choice = u * whole;
    const AirColumn::Kind* last = nullptr;
    for (const AirColumn::Kind& kind : column_->kinds) {
      const double s = scattering(kind, bin);
      if (!(s > 0)) continue;
      last = &kind;
      if (choice < s) return kind.phase->sample(choice / s, knot);
      choice -= s;
    }
    return last ? last->phase->sample(0.5, knot) : 2 * u - 1;
  }

  ScatterModel::Polarised polarised(double cosine, std::span<PlaneBlocks> b) const override {
    thread_local std::vector<PlaneBlocks> one;
    thread_local std::vector<float> phase, whole;
    one.resize(b.size()), phase.resize(b.size()), whole.assign(b.size(), 0.0f);
    std::fill(b.begin(), b.end(), PlaneBlocks{0, 0, 0, 0, 0, 0});
    double unknown = 0, all = 0;
    for (const AirColumn::Kind& kind : column_->kinds) {
      const bool uniform = kind.phase->spectrally_uniform();
      kind.phase->eval(cosine, uniform ? std::span(phase).first(1) : std::span(phase));
      const auto of = kind.phase->polarised(cosine, one);
      for (size_t i = 0; i < b.size(); ++i) {
        const float mine = scattering(kind, i) * phase[uniform ? 0 : i];
        b[i] = b[i] + one[of.grey ? 0 : i] * double{mine};
        whole[i] += mine, all += mine, unknown += of.unknown * mine;
      }
    }
    for (size_t i = 0; i < b.size(); ++i)
      b[i] = whole[i] > 0 ? b[i] * (1 / double{whole[i]}) : PlaneBlocks{1, 0, 0, 0, 0, 0};
    return {b.size() == 1, all > 0 ? unknown / all : 0};
  }

 private:
  float scattering(const AirColumn::Kind& kind, size_t bin) const { return kind.scattering[first_ + bin]; }
  template <class Value>
  void sum(std::span<float> to, const Value& value) const {
    thread_local std::vector<float> one, whole;
    one.resize(to.size()), whole.assign(to.size(), 0.0f);
    std::fill(to.begin(), to.end(), 0.0f);
    for (const AirColumn::Kind& kind : column_->kinds) {
      const bool uniform = kind.phase->spectrally_uniform();
      value(*kind.phase, uniform ? std::span(one).first(1) : std::span(one));
      for (size_t i = 0; i < to.size(); ++i) {
        to[i] += scattering(kind, i) * one[uniform ? 0 : i];
        whole[i] += scattering(kind, i);
      }
    }
    for (size_t i = 0; i < to.size(); ++i)
      if (whole[i] > 0) to[i] /= whole[i];
  }

  std::shared_ptr<const AirColumn> column_;
  size_t first_;
  std::vector<size_t> knots_;
};

}  // namespace

std::vector<BakedMedium> air_media(const std::shared_ptr<const AirColumn>& column, const SpectralState& state) {
  std::vector<BakedMedium> media;
  for (size_t l = 0; l < column->layers(); ++l) {
    std::vector<float> absorption(column->bins), scattering(column->bins, 0.0f), blackbody(column->bins);
    for (size_t i = 0; i < column->bins; ++i) {
      const size_t at = l * column->bins + i;
      for (const AirColumn::Kind& kind : column->kinds) scattering[i] += kind.scattering[at];
      absorption[i] = std::max(0.0f, column->extinction[at] - scattering[i]);
      blackbody[i] = 0.5f * (column->blackbody[at] + column->blackbody[at + column->bins]);
    }
    // Air that is too cold to glow at these wavelengths does not.
    constexpr float kDark = 1e-9f;  // W/(m2 sr um)
    if (std::all_of(blackbody.begin(), blackbody.end(), [](float b) { return b < kDark; })) blackbody.clear();
    const bool scatters = std::any_of(scattering.begin(), scattering.end(), [](float s) { return s > 0; });
    media.emplace_back(std::move(absorption), std::move(scattering), std::move(blackbody),
                       scatters ? std::make_unique<LayerPhase>(column, l, state.knots) : nullptr);
  }
  return media;
}

}  // namespace suite
