#include "optics/models/bpdf.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "optics/fresnel_mueller.h"
#include "optics/models/ground.h"

namespace suite {

namespace {

constexpr double kIndex = 1.5;

struct Quantity {
  const char* name;
  double low, high, otherwise;  // otherwise NaN: has to be given
};
struct Form {
  const char *name, *example;
  std::vector<Quantity> quantities;
};
const std::array<Form, 4>& forms() {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static const std::array<Form, 4> table{{
      {"breon", "breon cover 0.6", {{"cover", 0, 1, none}}},
      {"maignan", "maignan c 6.11 ndvi 0.5", {{"c", 0, 100, none}, {"ndvi", -1, 1, none}}},
      {"nadal_breon", "nadal_breon rho 0.0145 beta 120", {{"rho", 0, 1, none}, {"beta", 0, 1e4, none}}},
      {"litvinov",
       "litvinov alpha 0.8 variance 0.146 shadow 1",
       {{"alpha", 0, 100, 0.8}, {"variance", 1e-4, 10, 0.146}, {"shadow", 0, 1, 1}}},
  }};
  return table;
}

double number_of(const std::string& word, const Form& form, const Quantity& q) {
  double x = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (code != std::errc() || end != word.data() + word.size() || !(x >= q.low && x <= q.high))
    throw Error(strf("bpdf '%s': %s is '%s'", form.name, q.name, word.c_str()),
                strf("a number from %g to %g, as in `%s`", q.low, q.high, form.example));
  return x;
}

}  // namespace

Bpdf::Bpdf(const std::string& text) {
  std::istringstream words(text);
  std::string name;
  if (!(words >> name)) return;
  size_t row = 0;
  while (row < forms().size() && name != forms()[row].name) ++row;
  if (row == forms().size()) throw Error("no bpdf is called '" + name + "'", "breon, maignan, nadal_breon or litvinov");
  const Form& form = forms()[row];
  kind_ = static_cast<Kind>(row + 1);
  double* const values[] = {&first_, &second_, &third_};
  for (size_t i = 0; i < form.quantities.size(); ++i) *values[i] = form.quantities[i].otherwise;
  for (std::string key, word; words >> key;) {
    size_t i = 0;
    while (i < form.quantities.size() && key != form.quantities[i].name) ++i;
    if (i == form.quantities.size())
      throw Error("bpdf '" + name + "' has no '" + key + "'", std::string("as in `") + form.example + "`");
    if (!(words >> word)) throw Error("bpdf '" + name + "': " + key + " has no value", form.example);
    *values[i] = number_of(word, form, form.quantities[i]);
  }
  for (size_t i = 0; i < form.quantities.size(); ++i)
    if (std::isnan(*values[i]))
      throw Error("bpdf '" + name + "' needs '" + form.quantities[i].name + "'",
                  std::string("as in `") + form.example + "`");
}

Bpdf::Polarised Bpdf::at(Dir out, Dir in) const {
  const Dir o = up(out), i = up(in);
  const Vec3 middle = o + i;
  const double size = length(middle), cosine = std::clamp(dot(o, middle) / size, 0.0, 1.0);
  const PlaneBlocks f = fresnel_reflection(cosine, kIndex);
  const double mu_o = not_grazing(o).z, mu_i = not_grazing(i).z, sum = mu_o + mu_i;
  double amount = 0;  // of F
  switch (kind_) {
    case Kind::none:
      break;
    case Kind::breon:
      amount = (1 - first_) / (4 * mu_i * mu_o) + first_ / (4 * sum);
      break;
    case Kind::maignan:
      amount = first_ * std::exp(-std::sqrt(1 - cosine * cosine) / std::max(cosine, 1e-6) - second_) / (4 * sum);
      break;
    case Kind::nadal_breon: {
      // The polarised part alone is the fit's: rho (1 - exp(-beta F_p / sum)), F_p = |m12|.
      const double polarised = std::fabs(f.b);
      amount =
          polarised > 1e-12 ? -first_ * std::expm1(-second_ * polarised / sum) / polarised : first_ * second_ / sum;
      break;
    }
    case Kind::litvinov: {
      const double mu_n = middle.z / size, tangent2 = (1 - mu_n * mu_n) / (mu_n * mu_n);
      const double slopes = std::exp(-tangent2 / (2 * second_)) / (2 * kPi * second_);
      // cos(k (pi - scattering angle)): the phase angle is twice that of the facet.
      const double shadow = 0.5 * (1 + std::cos(third_ * 2 * std::acos(cosine)));
      amount = first_ * shadow * shadow * shadow * kPi * slopes / (4 * mu_n * mu_n * mu_n * mu_n * sum);
      break;
    }
  }
  return {amount * f.a, ScatteringPlane(out, in).matrix(f * (1 / f.a))};
}

}  // namespace suite
