#include "thermal/models.h"

#include <algorithm>
#include <cmath>

#include "thermal/models/rows.h"

namespace suite {

std::span<const TemperatureRow> temperature_models() {
  static const std::vector<TemperatureRow> table{constant_temperature_row(), tabulated_temperature_row(),
                                                 slab_temperature_row()};
  return table;
}

const TemperatureRow& find_temperature_model(const std::string& name, const Where& where) {
  std::vector<std::string> known;
  for (const TemperatureRow& row : temperature_models()) {
    if (row.name == name) return row;
    known.push_back(row.name);
  }
  throw Error(where, "unknown temperature model '" + name + "'", name_hint(name, known));
}

void check_temperature(TemperatureSpec& spec, const Where& where) {
  const TemperatureRow& row = find_temperature_model(spec.model, where);
  const std::string model = "temperature model '" + row.name + "'";
  std::vector<std::string> known;
  for (const TemperatureParameter& p : row.parameters) known.push_back(p.name);
  for (const auto& [name, value] : spec.numbers)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(where, model + " has no parameter '" + name + "'", name_hint(name, known));
  for (const TemperatureParameter& p : row.parameters) {
    const auto given = spec.numbers.find(p.name);
    if (given == spec.numbers.end()) {
      if (p.required) throw Error(where, model + " needs '" + p.name + "'", p.summary);
      if (!std::isnan(p.otherwise)) spec.numbers[p.name] = p.otherwise;
    } else if (!(given->second >= p.low && given->second <= p.high)) {
      throw Error(where, model + strf(": %s = %g is outside its range", p.name.c_str(), given->second),
                  strf("give %g to %g", p.low, p.high));
    }
  }
  if (!row.takes_table && !(spec.times.empty() && spec.kelvins.empty())) throw Error(where, model + " takes no table");
  if (!row.takes_layers && !spec.layers.empty()) throw Error(where, model + " takes no layers");
}

std::unique_ptr<const TemperatureModel> make_temperature_model(const TemperatureSpec& spec, const Where& where) {
  TemperatureSpec checked = spec;
  check_temperature(checked, where);
  try {
    return find_temperature_model(spec.model).make(checked);
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw Error(where, e.message(), e.hint(), e.code());
  }
}

namespace {

class ModelField final : public TemperatureField {
 public:
  ModelField(std::shared_ptr<const TemperatureModel> model, LoadsAt loads)
      : model_(std::move(model)), loads_(std::move(loads)) {
    SUITE_CHECK(model_ && (loads_ || !model_->needs_loads()));
  }
  double kelvin(Vec3 place, double time) const override {
    double kelvin = 0;
    model_->kelvin({&time, 1}, model_->needs_loads() ? loads_(place) : Loads{}, {&kelvin, 1});
    return kelvin;
  }

 private:
  std::shared_ptr<const TemperatureModel> model_;
  LoadsAt loads_;
};

}  // namespace

std::unique_ptr<const TemperatureField> field_of(std::shared_ptr<const TemperatureModel> model, LoadsAt loads) {
  return std::make_unique<ModelField>(std::move(model), std::move(loads));
}

}  // namespace suite
