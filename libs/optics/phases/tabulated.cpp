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

// Numbers of a text, separated by blanks and commas.
class NumberText {
 public:
  NumberText(const std::string& text, std::string name)
      : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), name_(std::move(name)) {}
  bool more() {
    while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\n' || *at_ == ',')) ++at_;
    return at_ < end_;
  }
  double next(const char* what, const char* form) {
    more();
    double x = 0;
    const auto [stop, code] = std::from_chars(at_, end_, x);
    if (code != std::errc() || !std::isfinite(x))
      throw Error(strf("phase function 'tabulated': %s expected at character %td of the %s", what, at_ - begin_ + 1,
                       name_.c_str()),
                  form);
    at_ = stop;
    return x;
  }
  // Of the next angle, ascending from 0 to 180 deg. What stands behind it is read first: numbers may be missing.
  double cosine(double angle) {
    if (!(angle > before_ && angle <= 180))
      throw Error(strf("phase function 'tabulated': the angle %g is not ascending from 0 to 180", angle));
    if (before_ < 0 && angle != 0) throw Error("phase function 'tabulated': the " + name_ + " starts above 0 deg");
    before_ = angle;
    return std::cos(angle * kDegree);
  }
  double angle() const { return before_; }
  void end() const {
    if (before_ != 180) throw Error("phase function 'tabulated': the " + name_ + " ends before 180 deg");
  }

 private:
  const char *begin_, *at_, *end_;
  std::string name_;
  double before_ = -1;
};

class Tabulated final : public PhaseFunction {
 public:
  Tabulated(const ModelSpec& spec, const SpectralState&) {
    std::vector<double> cosine, value;
    read(spec.texts.at("table"), cosine, value);
    table_.emplace(std::move(cosine), std::move(value));
    if (!table_->valid()) throw Error("phase function 'tabulated': the values are all zero, or too large");
    if (const auto matrix = spec.texts.find("matrix"); matrix != spec.texts.end() && !matrix->second.empty())
      read_matrix(matrix->second);
  }
  void eval(double c, std::span<float> p) const override { std::fill(p.begin(), p.end(), finite_float(table_->at(c))); }
  void pdf(double c, std::span<float> p) const override { eval(c, p); }
  double sample(double u, int) const override { return table_->sample(u); }
  void asymmetry(std::span<float> g) const override {
    std::fill(g.begin(), g.end(), static_cast<float>(table_->asymmetry()));
  }
  bool spectrally_uniform() const override { return true; }
  ScatterModel::Polarised polarised(double c, std::span<PlaneBlocks> b) const override {
    if (matrix_.empty()) return PhaseFunction::polarised(c, b);
    const auto above = std::upper_bound(cosine_.begin(), cosine_.end(), c) - cosine_.begin();
    const size_t i = std::clamp<size_t>(static_cast<size_t>(above), 1, cosine_.size() - 1);
    const double t = std::clamp((c - cosine_[i - 1]) / (cosine_[i] - cosine_[i - 1]), 0.0, 1.0);
    b[0] = matrix_[i - 1] * (1 - t) + matrix_[i] * t;
    return {true, 0};
  }

 private:
  // "angle_deg value, angle_deg value, ..." from 0 to 180 ascending; stored by ascending cosine.
  static void read(const std::string& text, std::vector<double>& cosine, std::vector<double>& value) {
    const char* const form = "angle_deg value, angle_deg value, ... from 0 to 180";
    NumberText numbers(text, "table");
    while (numbers.more()) {
      const double angle = numbers.next("an angle", form), f = numbers.next("a value", form);
      cosine.push_back(numbers.cosine(angle));
      if (f < 0) throw Error(strf("phase function 'tabulated': the value at %g deg is negative", numbers.angle()));
      value.push_back(f);
    }
    numbers.end();
    std::reverse(cosine.begin(), cosine.end());
    std::reverse(value.begin(), value.end());
  }
  // Elements over P11 in the plane of scattering, one line an angle: P12 P22 P33 P34 P44.
  void read_matrix(const std::string& text) {
    const char* const form = "angle_deg P12 P22 P33 P34 P44 over P11, ... from 0 to 180";
    constexpr double kLeast = -1e-3;  // of a coherency's eigenvalue, which printed digits may cost
    NumberText numbers(text, "matrix");
    while (numbers.more()) {
      const double angle = numbers.next("an angle", form);
      PlaneBlocks b;
      for (double* x : {&b.b, &b.a2, &b.c, &b.d, &b.c2}) *x = numbers.next("an element", form);
      cosine_.push_back(numbers.cosine(angle));
      if (least_coherency(b.matrix()) < kLeast)
        throw Error(strf("phase function 'tabulated': the matrix at %g deg is none of a scatterer", numbers.angle()),
                    "elements are over P11; where they are, a sign is wrong: nothing polarises more than all light");
      matrix_.push_back(b);
    }
    numbers.end();
    std::reverse(cosine_.begin(), cosine_.end());
    std::reverse(matrix_.begin(), matrix_.end());
  }
  std::optional<CosineTable> table_;
  std::vector<double> cosine_;
  std::vector<PlaneBlocks> matrix_;  // empty: not known
};

}  // namespace

PhaseRow tabulated_row() {
  using P = Parameter;
  return {
      {"tabulated", "a table over the scattering angle, for example from a Mie calculation", "1/sr",
       make_phase<Tabulated>},
      {{"table", P::Kind::text, "deg, any", "angle_deg value, angle_deg value, ... from 0 to 180", 0, 0},
       {"matrix", P::Kind::text, "deg, 1",
        "angle_deg P12 P22 P33 P34 P44, ... from 0 to 180: scattering matrix over P11 in the plane of scattering, for "
        "polarisation",
        0, 0, false}},
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
