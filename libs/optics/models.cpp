#include "optics/models.h"

#include "optics/models/rows.h"

namespace suite {

std::span<const ModelRow> models() {
  static const std::vector<ModelRow> table{lambert_row(),    oren_nayar_row(),     leaf_row(), rpv_row(),
                                           ross_li_row(),    ward_row(),           ggx_row(),  mirror_row(),
                                           dielectric_row(), ggx_dielectric_row(), sqt_row()};
  return table;
}

const ModelRow& find_model(const std::string& name, const Where& where) {
  std::vector<std::string> known;
  for (const ModelRow& row : models()) {
    if (row.name == name) return row;
    known.push_back(row.name);
  }
  throw Error(where, "unknown model '" + name + "'", name_hint(name, known), "OP101");
}

namespace {
// " um" of a quantity, nothing of a plain number.
std::string unit_after(const ModelParameter& p) { return p.unit.empty() || p.unit == "1" ? "" : " " + p.unit; }
void check_range(const char* what, const ModelSpec& spec, const ModelParameter& p, double value, const Where& where) {
  if (!(value >= p.low && value <= p.high))
    throw Error(where, strf("%s '%s': %s = %g is outside its range", what, spec.model.c_str(), p.name.c_str(), value),
                strf("give %g to %g", p.low, p.high) + unit_after(p), "OP103");
}
}  // namespace

void check_model(ModelSpec& spec, const Where& where) {
  check_parameters(spec, find_model(spec.model, where).parameters, "model", where);
}

void check_parameters(ModelSpec& spec, std::span<const ModelParameter> parameters, const char* what,
                      const Where& where) {
  std::vector<std::string> known;
  for (const ModelParameter& p : parameters) known.push_back(p.name);
  auto reject = [&](const std::string& name, ModelParameter::Kind kind) {
    for (const ModelParameter& p : parameters)
      if (p.name == name && p.kind == kind) return;
    throw Error(where, std::string(what) + " '" + spec.model + "' has no parameter '" + name + "'",
                name_hint(name, known), "OP102");
  };
  // A number given for a curve parameter is a constant curve.
  for (const ModelParameter& p : parameters)
    if (p.kind == ModelParameter::Kind::curve)
      if (const auto n = spec.numbers.find(p.name); n != spec.numbers.end()) {
        spec.curves[p.name] = Curve::constant(n->second);
        spec.numbers.erase(n);
      }
  for (const auto& [name, value] : spec.numbers) reject(name, ModelParameter::Kind::number);
  for (const auto& [name, value] : spec.curves) reject(name, ModelParameter::Kind::curve);
  for (const auto& [name, value] : spec.texts) reject(name, ModelParameter::Kind::text);
  for (const ModelParameter& p : parameters) {
    const bool given = spec.numbers.count(p.name) || spec.curves.count(p.name) || spec.texts.count(p.name);
    if (!given && p.required)
      throw Error(where, std::string(what) + " '" + spec.model + "' needs '" + p.name + "'",
                  p.summary + (unit_after(p).empty() ? "" : " [" + p.unit + "]"), "OP104");
    if (!given && p.kind == ModelParameter::Kind::number) spec.numbers[p.name] = p.otherwise;
    if (!given && p.kind == ModelParameter::Kind::curve) spec.curves[p.name] = Curve::constant(p.otherwise);
    if (p.kind == ModelParameter::Kind::number) check_range(what, spec, p, spec.numbers.at(p.name), where);
    if (p.kind == ModelParameter::Kind::curve) {
      check_range(what, spec, p, spec.curves.at(p.name).min(), where);
      check_range(what, spec, p, spec.curves.at(p.name).max(), where);
    }
  }
}

std::unique_ptr<const ScatterModel> bake(const ModelSpec& spec, const SpectralState& state) {
  return find_model(spec.model).make(spec, state);
}

}  // namespace suite
