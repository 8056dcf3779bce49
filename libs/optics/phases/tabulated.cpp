// A phase function given as a table of angles and values, such as Mie calculations print; any scale, it is normalised.
// Assumes: the same at all wavelengths; linear in the cosine between entries, so that sampling is exact.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "optics/models/common.h"
#include "optics/phases/cosine_table.h"
#include "optics/phases/rows.h"

namespace suite {

namespace {

class Tabulated final : public PhaseFunction {
 public:
  Tabulated(const ModelSpec& spec, const SpectralState&) {
    std::vector<double> cosine, value;
    read(spec.texts.at("table"), cosine, value);
    table_.emplace(std::move(cosine), std::move(value));
    if (!table_->valid()) throw Error("phase function 'tabulated': the values are all zero, or too large");
  }
  void eval(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), finite_float(table_->at(c))); }
  void pdf(double c, std::span<float> p) const override { eval(c, p); }
  double sample(double u, int) const override { return table_->sample(u); }
  void asymmetry(std::span<float> g) const override {
    std::fill(g.begin(), g.end(), static_cast<float>(table_->asymmetry()));
  }
  bool spectrally_uniform() const override { return true; }

 private:
  // "angle_deg value, angle_deg value, ..." from 0 to 180 ascending; stored by ascending cosine.
  static void read(const std::string& text, std::vector<double>& cosine, std::vector<double>& value) {
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
      cosine.push_back(std::cos(angle * kDegree));
      value.push_back(f);
    }
    if (before != 180) throw Error("phase function 'tabulated': the table ends before 180 deg");
    std::reverse(cosine.begin(), cosine.end());
    std::reverse(value.begin(), value.end());
  }
  std::optional<CosineTable> table_;
};

}  // namespace

PhaseRow tabulated_row() {
  using P = Parameter;
  return {{"tabulated", "a table over the scattering angle, for example from a Mie calculation", "1/sr",
           make_phase<Tabulated>},
          {{"table", P::Kind::text, "deg, any", "angle_deg value, angle_deg value, ... from 0 to 180", 0, 0}},
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
