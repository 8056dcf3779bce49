// How warm the first things met are, and why.
#include <cmath>

#include "thermal/explained_field.h"
#include "transport/truth/truth.h"

namespace suite {

namespace {

double error_squared(const TemperatureField& field, const HeatedPlace& place, double time) {
  const double error = field.error(place, time);
  return error * error;
}
template <double ExplainedField::Cause::*which>
double cause(const TemperatureField& field, const HeatedPlace& place, double time) {
  const auto* explained = dynamic_cast<const ExplainedField*>(&field);
  return explained ? explained->cause(place, time).*which : NAN;
}

// Adds what the field of the temperature says of a place, where it made it (maps come before models) and knows.
template <double (*of)(const TemperatureField&, const HeatedPlace&, double)>
void add_of_field(const TruthContext&, const TruthSample& s, double* sum) {
  const Interaction* at = s.first ? s.first->at : nullptr;
  if (!at || !at->own || at->baked != &at->own->made || !at->own->field) return;
  const double value = of(*at->own->field, at->own->place, s.path.time);
  if (std::isfinite(value)) sum[0] += value, ++sum[1];
}

void mean_of_known(const TruthContext&, const double* sum, const TruthCounts&, double* v) {
  if (sum[1] > 0) v[0] = sum[0] / sum[1];
}
void root_of_known(const TruthContext&, const double* sum, const TruthCounts&, double* v) {
  if (sum[1] > 0) v[0] = std::sqrt(sum[0] / sum[1]);
}

TruthRow row(const char* name, const char* summary, const char* unit, const char* column, SimpleCollector::Add add,
             SimpleCollector::Finish finish) {
  return {name, summary, unit, [column, add, finish](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
            return std::make_unique<SimpleCollector>(c, 2, std::vector<std::string>{column}, add, finish);
          }};
}

}  // namespace

void add_warmth_rows(std::vector<TruthRow>& table) {
  table.push_back(row(
      "temperature", "mean temperature that was rendered, of the first hits that have one", "K", "temperature [K]",
      [](const TruthContext&, const TruthSample& s, double* sum) {
        if (!s.first || !s.first->at->baked || !(s.first->at->baked->kelvin > 0)) return;
        sum[0] += s.first->at->baked->kelvin, ++sum[1];
      },
      mean_of_known));
  table.push_back(
      row("temperature_error",
          "error of temperatures that were found from weather (paths, size of elements, steps, sweeps), root "
          "mean square over the first hits that have one",
          "K", "temperature error [K]", add_of_field<error_squared>, root_of_known));
  table.push_back(row("sun_hours",
                      "hours with the sun on them in the span that temperatures were found for, mean over the first "
                      "hits whose temperatures were",
                      "h", "sun hours [h]", add_of_field<cause<&ExplainedField::Cause::sun_hours>>, mean_of_known));
  table.push_back(row("absorbed_sun", "sunlight that they absorb, all wavelengths, mean over the same hits", "W/m2",
                      "absorbed sunlight [W/m2]", add_of_field<cause<&ExplainedField::Cause::absorbed_sun>>,
                      mean_of_known));
  table.push_back(row("longwave_received", "infrared that arrives at them, all wavelengths, mean over the same hits",
                      "W/m2", "longwave received [W/m2]",
                      add_of_field<cause<&ExplainedField::Cause::longwave_received>>, mean_of_known));
}

}  // namespace suite
