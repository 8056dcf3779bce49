// Small analytic functions to fit, for tests of the quad-tree.
#pragma once
#include <cmath>
#include <functional>
#include <limits>

#include "sqt_fit/aligned_fit.h"
#include "sqt_fit/paper_fit.h"

namespace suite::test {

// Any function of two directions with `channels` channels, each scaled by 1 / (1 + channel).
class Analytic final : public sqt::Function {
 public:
  using F = std::function<double(Dir out, Dir in)>;
  Analytic(F f, size_t channels = 1, sqt::Domain domain = sqt::Domain::hemisphere,
           sqt::Quantity quantity = sqt::Quantity::bsdf, bool isotropic = true)
      : f_(std::move(f)) {
    info_.name = "analytic";
    for (size_t c = 0; c < channels; ++c) info_.wavelength_um.push_back(0.65 - 0.1 * static_cast<double>(c));
    info_.domain = domain;
    info_.quantity = quantity;
    info_.isotropic = info_.bilateral = isotropic;
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const bool below = info_.quantity == sqt::Quantity::bsdf &&
                       (!(out.z > 0) || (info_.domain == sqt::Domain::hemisphere && !(in.z > 0)));
    const double v = below ? std::numeric_limits<double>::quiet_NaN() : f_(out, in);
    for (size_t c = 0; c < f.size(); ++c) f[c] = v / (1.0 + static_cast<double>(c));
  }
  Info& info() { return info_; }

 private:
  F f_;
  Info info_;
};

inline double glossy_value(Dir out, Dir in, double width) {
  const Dir h = normalized(out + in);
  return 0.1 +
         0.3 * std::exp(-(1 - h.z * h.z) / (h.z * h.z * width * width)) / (width * width * std::max(0.2, in.z + out.z));
}
inline Analytic glossy(double width = 0.15, size_t channels = 2) {
  return Analytic([width](Dir out, Dir in) { return 0.5 * glossy_value(out, in, width); }, channels);
}
inline double henyey_greenstein(double cosine, double g) {
  return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

inline sqt::AlignedSource::Options small_options() {
  sqt::AlignedSource::Options o;
  o.views = 9;
  o.base_order = 4;
  o.max_order = 7;
  o.detail = 1e-5;
  return o;
}
inline sqt::AlignedFit small_fit(const sqt::Function& f, double quality = 0.1) {
  return sqt::encode_aligned(sqt::AlignedSource(f, small_options()), quality);
}
inline sqt::PaperData small_paper(const sqt::Function& f) {
  sqt::PaperOptions o;
  o.order = 4;
  o.views = 5;
  o.threshold = 0.2;
  o.samples_per_cell_side = 2;
  return sqt::fit_paper(f, o);
}

}  // namespace suite::test
