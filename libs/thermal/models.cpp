#include "thermal/models.h"

#include <algorithm>
#include <cmath>

#include "base/named_numbers.h"
#include "spectral/planck.h"
#include "thermal/models/rows.h"

namespace suite {

const Registry<TemperatureRow>& temperature_models() {
  static const Registry<TemperatureRow> table(
      "temperature model", "",
      {constant_temperature_row(), tabulated_temperature_row(), slab_temperature_row(), heat_temperature_row()});
  return table;
}

void check_temperature(TemperatureSpec& spec, const Where& where) {
  const TemperatureRow& row = temperature_models().find(spec.model, where);
  const std::string model = "temperature model '" + row.name + "'";
  std::vector<Parameter> numbers, texts;
  for (const Parameter& p : row.parameters) (p.kind == Parameter::Kind::text ? texts : numbers).push_back(p);
  check_numbers(model, numbers, spec.numbers, where);
  const std::vector<std::string> known = names_of(texts);
  for (const auto& [name, text] : spec.texts)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(where, model + " has no text '" + name + "'", name_hint(name, known));
  if (!row.takes_table && !(spec.times.empty() && spec.kelvins.empty())) throw Error(where, model + " takes no table");
  if (!row.takes_layers && !spec.layers.empty()) throw Error(where, model + " takes no layers");
  if (spec.loads.empty() && spec.load_times.empty()) return;
  if (row.name != "slab") throw Error(where, model + " takes no loads");
  try {
    loads_of(spec);
  } catch (const Error& e) {
    throw Error(where, "loads: " + e.message(), e.hint());
  }
}

std::unique_ptr<const TemperatureModel> make_temperature_model(const TemperatureSpec& spec, const Where& where) {
  TemperatureSpec checked = spec;
  check_temperature(checked, where);
  try {
    return temperature_models().find(spec.model).make(checked);
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw Error(where, e.message(), e.hint(), e.code());
  }
}

namespace {

double number_of(const TemperatureSpec& spec, const char* name, double otherwise) {
  const auto at = spec.numbers.find(name);
  return at == spec.numbers.end() ? otherwise : at->second;
}

}  // namespace

double inner_power(const TemperatureSpec& spec) {
  return std::max(0.0, number_of(spec, "source_w_m2", 0)) + std::max(0.0, number_of(spec, "deep_flux_w_m2", 0));
}

double emissivity_of(const TemperatureSpec& spec) { return number_of(spec, "emissivity", 0.95); }

double hottest_given(const TemperatureSpec& spec) {
  double most = 0;
  if (!spec.model.empty())
    for (const Parameter& p : temperature_models().find(spec.model).parameters)
      if (p.unit == "K") most = std::max(most, number_of(spec, p.name.c_str(), 0));
  for (const double kelvin : spec.kelvins) most = std::max(most, kelvin);
  constexpr double kMost = 1e4;  // that a slab may have
  const double power = inner_power(spec);
  if (power > 0) most = std::max(most, std::pow(power / (emissivity_of(spec) * kStefanBoltzmann), 0.25));
  return std::min(most, kMost);
}

namespace {

class ModelField final : public TemperatureField {
 public:
  ModelField(std::shared_ptr<const TemperatureModel> model, LoadsAt loads)
      : model_(std::move(model)), loads_(std::move(loads)) {
    SUITE_CHECK(model_ && (loads_ || !model_->needs_loads()));
  }
  double kelvin(const HeatedPlace& place, double time) const override {
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

Loads loads_of(const TemperatureSpec& spec) {
  if (spec.loads.empty() && spec.load_times.empty()) return {};
  return LoadTable::function(std::make_shared<const LoadTable>(
      spec.load_times, spec.loads, spec.loads_repeat ? LoadTable::Outside::repeat : LoadTable::Outside::refuse));
}

SolvedField::SolvedField(const TemperatureSpec& spec, double begin, double end) {
  SUITE_CHECK(begin <= end);
  const double span = end - begin, apart = std::max(60.0, span / 1e5);
  const auto steps = static_cast<size_t>(std::ceil(span / apart));
  for (size_t k = 0; k <= steps; ++k) times_.push_back(k == steps ? end : begin + apart * static_cast<double>(k));
  // Loads have kinks at their rows, of which a periodic table has some in every period.
  if (!spec.load_times.empty()) {
    const double first = spec.load_times.front(), period = spec.load_times.back() - first;
    const bool repeat = spec.loads_repeat && period > 0;
    const double from = repeat ? std::floor((begin - first) / period) : 0,
                 to = repeat ? std::floor((end - first) / period) : 0;
    if ((to - from + 1) * static_cast<double>(spec.load_times.size()) < 1e6)
      for (int n = 0; n <= static_cast<int>(to - from); ++n)
        for (const double t : spec.load_times) {
          const double at = t + (from + n) * period;
          if (at > begin && at < end) times_.push_back(at);
        }
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  }
  kelvins_.resize(times_.size());
  make_temperature_model(spec)->kelvin(times_, loads_of(spec), kelvins_);
  const auto [low, high] = std::minmax_element(kelvins_.begin(), kelvins_.end());
  coldest_ = *low, hottest_ = *high;
}

double SolvedField::kelvin(const HeatedPlace&, double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) return kelvins_.front();
  if (after == times_.end()) return kelvins_.back();
  const auto k = static_cast<size_t>(after - times_.begin());
  return kelvins_[k - 1] + (kelvins_[k] - kelvins_[k - 1]) * (time - times_[k - 1]) / (times_[k] - times_[k - 1]);
}

}  // namespace suite
