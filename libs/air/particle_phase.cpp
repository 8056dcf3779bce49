#include "air/particle_phase.h"

#include <algorithm>

#include "air/phase_grid.h"
#include "base/error.h"
#include "optics/phases/cosine_table.h"

namespace suite {

namespace {

class ParticlePhase final : public PhaseFunction {
 public:
  ParticlePhase(const ParticleOptics& optics, std::span<const size_t> knots) : size_(optics.size()) {
    const std::span<const double> cosines = phase_cosines();
    // Angle by angle, so that eval reads two rows.
    values_.resize(cosines.size() * size_);
    for (size_t w = 0; w < size_; ++w) {
      const std::span<const float> phase = optics.phase(w);
      for (size_t i = 0; i < cosines.size(); ++i) values_[i * size_ + w] = phase[i];
      asymmetry_.push_back(static_cast<float>(optics.asymmetry(w)));
    }
    for (const size_t k : knots) {
      SUITE_CHECK(k < size_);
      const std::span<const float> phase = optics.phase(k);
      tables_.emplace_back(std::vector<double>(cosines.begin(), cosines.end()),
                           std::vector<double>(phase.begin(), phase.end()));
    }
  }
  void eval(double c, std::span<float> p) const override {
    const std::span<const double> cosines = phase_cosines();
    const size_t above = static_cast<size_t>(std::upper_bound(cosines.begin(), cosines.end(), c) - cosines.begin());
    const size_t i = std::clamp<size_t>(above, 1, cosines.size() - 1);
    const float t = static_cast<float>(std::clamp((c - cosines[i - 1]) / (cosines[i] - cosines[i - 1]), 0.0, 1.0));
    const float *a = &values_[(i - 1) * size_], *b = a + size_;
    for (size_t w = 0; w < size_; ++w) p[w] = a[w] + (b[w] - a[w]) * t;
  }
  double sample(double u, int knot) const override { return tables_[static_cast<size_t>(knot)].sample(u); }
  void pdf(double c, std::span<float> p) const override {
    for (size_t k = 0; k < tables_.size(); ++k) p[k] = static_cast<float>(tables_[k].at(c));
  }
  void asymmetry(std::span<float> g) const override { std::copy(asymmetry_.begin(), asymmetry_.end(), g.begin()); }
  bool spectrally_uniform() const override { return size_ == 1; }

 private:
  size_t size_;
  std::vector<float> values_, asymmetry_;
  std::vector<CosineTable> tables_;
};

}  // namespace

std::unique_ptr<const PhaseFunction> particle_phase(const ParticleOptics& optics, std::span<const size_t> knots) {
  SUITE_CHECK(optics.size() > 0);
  return std::make_unique<ParticlePhase>(optics, knots);
}

}  // namespace suite
