// A phase function given as a table of angles and values, such as Mie calculations print; any scale, it is normalised.
// Assumes: the same at all wavelengths; linear in the cosine between entries, so that sampling is exact.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "optics/models/common.h"
#include "optics/phases/rows.h"

namespace suite {

namespace {

class Tabulated final : public PhaseFunction {
 public:
  Tabulated(const ModelSpec& spec, const SpectralState&) {
    read(spec.texts.at("table"));
    cumulative_.assign(cosine_.size(), 0);
    double moment = 0;
    for (size_t i = 1; i < cosine_.size(); ++i) {
      const double a = cosine_[i - 1], b = cosine_[i], fa = value_[i - 1], fb = value_[i];
      cumulative_[i] = cumulative_[i - 1] + kPi * (fa + fb) * (b - a);
      moment += 2 * kPi * (b - a) * (fa * (2 * a + b) + fb * (a + 2 * b)) / 6;
    }
    const double whole = cumulative_.back();
    if (!(whole > 0) || !std::isfinite(whole))
      throw Error("phase function 'tabulated': the values are all zero, or too large");
    for (double& f : value_) f /= whole;
    for (double& c : cumulative_) c /= whole;
    asymmetry_ = moment / whole;
  }
  void eval(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), at(c)); }
  void pdf(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), at(c)); }
  double sample(double u, int) const override {
    const size_t above =
        static_cast<size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), u) - cumulative_.begin());
    const size_t i = std::clamp<size_t>(above, 1, cosine_.size() - 1);
    // Solve 2 pi (fa x + (fb - fa) x^2 / (2 w)) = rest for x in [0, w], without cancellation.
    const double w = cosine_[i] - cosine_[i - 1], fa = value_[i - 1], slope = (value_[i] - fa) / w,
                 rest = (u - cumulative_[i - 1]) / (2 * kPi);
    const double root = fa + std::sqrt(std::max(0.0, fa * fa + 2 * slope * rest));
    return std::clamp(cosine_[i - 1] + (root > 0 ? 2 * rest / root : 0), cosine_[i - 1], cosine_[i]);
  }
  void asymmetry(std::span<float> g) const override { std::fill(g.begin(), g.end(), static_cast<float>(asymmetry_)); }
  bool spectrally_uniform() const override { return true; }

 private:
  // "angle_deg value, angle_deg value, ..." from 0 to 180 ascending; stored by ascending cosine.
  void read(const std::string& text) {
    const char *at = text.data(), *end = at + text.size();
    auto number = [&](const char* what) {
      while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == ',')) ++at;
      double x = 0;
      const auto [stop, code] = std::from_chars(at, end, x);
      if (code != std::errc() || !std::isfinite(x))
        throw Error(
            strf("phase function 'tabulated': %s expected at character %td of the table", what, at - text.data() + 1),
            "angle_deg value, angle_deg value, ... from 0 to 180");
      at = stop;
      return x;
    };
    double before = -1;
    auto more = [&] {
      return text.find_first_not_of(" \t\n,", static_cast<size_t>(at - text.data())) != std::string::npos;
    };
    while (more()) {
      const double angle = number("an angle"), f = number("a value");
      if (!(angle > before && angle <= 180))
        throw Error(strf("phase function 'tabulated': the angle %g is not ascending from 0 to 180", angle));
      if (f < 0) throw Error(strf("phase function 'tabulated': the value at %g deg is negative", angle));
      if (before < 0 && angle != 0) throw Error("phase function 'tabulated': the table starts above 0 deg");
      before = angle;
      cosine_.push_back(std::cos(angle * kDegree));
      value_.push_back(f);
    }
    if (before != 180) throw Error("phase function 'tabulated': the table ends before 180 deg");
    std::reverse(cosine_.begin(), cosine_.end());
    std::reverse(value_.begin(), value_.end());
  }
  float at(double c) const {
    const size_t above = static_cast<size_t>(std::upper_bound(cosine_.begin(), cosine_.end(), c) - cosine_.begin());
    const size_t i = std::clamp<size_t>(above, 1, cosine_.size() - 1);
    const double t = std::clamp((c - cosine_[i - 1]) / (cosine_[i] - cosine_[i - 1]), 0.0, 1.0);
    return finite_float(value_[i - 1] + (value_[i] - value_[i - 1]) * t);
  }
  std::vector<double> cosine_, value_, cumulative_;
  double asymmetry_ = 0;
};

}  // namespace

PhaseRow tabulated_row() {
  using P = ModelParameter;
  return {"tabulated",
          "a table over the scattering angle, for example from a Mie calculation",
          {{"table", P::Kind::text, "deg, any", "angle_deg value, angle_deg value, ... from 0 to 180", 0, 0}},
          make_phase<Tabulated>,
          []() -> std::vector<ModelSpec> {
            return {{"tabulated",
                     {},
                     {},
                     {{"table", "0 100, 5 30, 20 4, 60 0.5, 120 0.1, 140 0.35, 160 0.15, 180 0.3"}},
                     nullptr},
                    {"tabulated", {}, {}, {{"table", "0 0, 90 1, 180 0"}}, nullptr}};
          }};
}

}  // namespace suite
