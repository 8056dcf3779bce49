#include "optics/models.h"

#include "math/share.h"
#include "optics/models/ground.h"
#include "optics/models/rows.h"

namespace suite {

const Registry<ModelRow>& models() {
  static const Registry<ModelRow> table(
      "model", "OP101",
      {lambert_row(), oren_nayar_row(), leaf_row(), rpv_row(), ross_li_row(), roujean_row(), ward_row(), ggx_row(),
       mirror_row(), dielectric_row(), ggx_dielectric_row(), priest_germer_row(), beard_maxwell_row(), shell_row(),
       sqt_row(), sea_row(), coated_row()});
  return table;
}

void check_model(ModelSpec& spec, const Where& where) {
  const ModelRow& row = models().find(spec.model, where);
  check_parameters(spec, row.parameters, "model", where);
  if (const auto bpdf = spec.texts.find("bpdf"); bpdf != spec.texts.end()) check_bpdf(spec.model, bpdf->second, where);
}

namespace {

// Values that were computed, as one minus another, may be off by rounding.
Curve without_rounding(const Curve& c) {
  if (c.min() >= 0 && c.max() <= 1) return c;
  if (c.is_constant()) return Curve::constant(as_share(c.min()));
  std::vector<double> y = c.value();
  for (double& v : y) v = as_share(v);
  return Curve(c.wavelength_um(), std::move(y), c.outside());
}

bool is_a_share(const Parameter& p) { return p.low == 0 && p.high == 1; }

}  // namespace

void check_parameters(ModelSpec& spec, std::span<const Parameter> parameters, const char* what, const Where& where) {
  const std::string of = std::string(what) + " '" + spec.model + "'";
  auto reject = [&](const std::string& name, Parameter::Kind kind) {
    for (const Parameter& p : parameters)
      if (p.name == name && p.kind == kind) return;
    throw Error(where, of + " has no parameter '" + name + "'", name_hint(name, names_of(parameters)), "OP102");
  };
  // A number given for a curve parameter is a constant curve.
  for (const Parameter& p : parameters)
    if (p.kind == Parameter::Kind::curve)
      if (const auto n = spec.numbers.find(p.name); n != spec.numbers.end()) {
        spec.curves[p.name] = Curve::constant(n->second);
        spec.numbers.erase(n);
      }
  for (const auto& [name, value] : spec.numbers) reject(name, Parameter::Kind::number);
  for (const auto& [name, value] : spec.curves) reject(name, Parameter::Kind::curve);
  for (const auto& [name, value] : spec.texts) reject(name, Parameter::Kind::text);
  for (const Parameter& p : parameters) {
    const bool given = spec.numbers.count(p.name) || spec.curves.count(p.name) || spec.texts.count(p.name);
    if (!given && p.required)
      throw Error(where, of + " needs '" + p.name + "'",
                  p.summary + (p.unit.empty() || p.unit == "1" ? "" : " [" + p.unit + "]"), "OP104");
    if (!given && p.kind == Parameter::Kind::number) spec.numbers[p.name] = p.otherwise;
    if (!given && p.kind == Parameter::Kind::curve) spec.curves[p.name] = Curve::constant(p.otherwise);
    if (is_a_share(p) && p.kind == Parameter::Kind::number) spec.numbers[p.name] = as_share(spec.numbers.at(p.name));
    if (is_a_share(p) && p.kind == Parameter::Kind::curve)
      spec.curves[p.name] = without_rounding(spec.curves.at(p.name));
    if (p.kind == Parameter::Kind::number) check_range(of, p, spec.numbers.at(p.name), where, "OP103");
    if (p.kind == Parameter::Kind::curve) {
      check_range(of, p, spec.curves.at(p.name).min(), where, "OP103");
      check_range(of, p, spec.curves.at(p.name).max(), where, "OP103");
    }
  }
}

std::unique_ptr<const ScatterModel> bake(const ModelSpec& spec, const SpectralState& state) {
  return models().find(spec.model).make(spec, state);
}

}  // namespace suite
