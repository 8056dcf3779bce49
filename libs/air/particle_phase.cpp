#include "air/particle_phase.h"

#include <algorithm>
#include <array>
#include <mutex>

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
    for (size_t i = 0; i < cosines.size(); ++i)
      for (const CosineTable& table : tables_) densities_.push_back(static_cast<float>(table.values()[i]));
    make_ = optics.matrices();
  }
  void eval(double c, std::span<float> p) const override { between(values_, size_, c, p.data()); }
  double sample(double u, int knot) const override { return tables_[static_cast<size_t>(knot)].sample(u); }
  void pdf(double c, std::span<float> p) const override { between(densities_, tables_.size(), c, p.data()); }
  void asymmetry(std::span<float> g) const override { std::copy(asymmetry_.begin(), asymmetry_.end(), g.begin()); }
  bool spectrally_uniform() const override { return size_ == 1; }
  ScatterModel::Polarised polarised(double c, std::span<PlaneBlocks> b) const override {
    if (!make_) return PhaseFunction::polarised(c, b);
    std::call_once(made_, [this] { make_matrices(); });
    const PhasePlace place = phase_place(c);
    const Elements *low = &matrices_[place.below * size_], *high = low + size_;
    const float t = static_cast<float>(place.share);
    for (size_t w = 0; w < size_; ++w) {
      const auto at = [&](size_t i) { return double{low[w][i] + (high[w][i] - low[w][i]) * t}; };
      b[w] = {1, at(0), at(2), at(3), at(1), at(4)};
    }
    return {size_ == 1, 0};
  }

 private:
  using Elements = std::array<float, 5>;  // P12, P22, P33, P34, P44 over P11
  void make_matrices() const {
    matrices_.resize(phase_cosines().size() * size_);
    for (size_t w = 0; w < size_; ++w) {
      const std::vector<PlaneBlocks> of = make_(w);
      SUITE_CHECK(of.size() == phase_cosines().size());
      for (size_t i = 0; i < of.size(); ++i) {
        const double m[] = {of[i].b, of[i].a2, of[i].c, of[i].d, of[i].c2};
        for (size_t e = 0; e < 5; ++e) matrices_[i * size_ + w][e] = static_cast<float>(m[e]);
      }
    }
  }
  // Rows of n values, one an angle.
  static void between(const std::vector<float>& rows, size_t n, double c, float* __restrict p) {
    const PhasePlace place = phase_place(c);
    const float *a = &rows[place.below * n], *b = a + n, t = static_cast<float>(place.share);
    for (size_t i = 0; i < n; ++i) p[i] = a[i] + (b[i] - a[i]) * t;
  }

  size_t size_;
  std::vector<float> values_, asymmetry_;
  std::vector<float> densities_;  // 1/sr, [angle][knot]
  std::vector<CosineTable> tables_;
  ParticleOptics::Matrices make_;  // empty: not known
  mutable std::once_flag made_;
  mutable std::vector<Elements> matrices_;  // [angle][wavelength]
};

}  // namespace

std::unique_ptr<const PhaseFunction> particle_phase(const ParticleOptics& optics, std::span<const size_t> knots) {
  SUITE_CHECK(optics.size() > 0);
  return std::make_unique<ParticlePhase>(optics, knots);
}

}  // namespace suite
