// One temperature for all places and times.
#include <algorithm>

#include "thermal/models/rows.h"

namespace suite {

namespace {

class Constant final : public TemperatureModel {
 public:
  explicit Constant(double kelvin) : kelvin_(kelvin) {}
  void kelvin(std::span<const double>, const Loads&, std::span<double> out) const override {
    std::fill(out.begin(), out.end(), kelvin_);
  }

 private:
  double kelvin_;
};

}  // namespace

TemperatureRow constant_temperature_row() {
  using P = Parameter;
  return {{"constant", "one temperature at all times", "K",
           [](const TemperatureSpec& spec) -> std::unique_ptr<const TemperatureModel> {
             return std::make_unique<Constant>(spec.numbers.at("kelvin"));
           }},
          {{"kelvin", P::Kind::number, "K", "temperature", 1, 10000}},
          false,
          false,
          [] {
            return std::vector<TemperatureSpec>{{"constant", {{"kelvin", 300}}, {}, {}, false, {}}};
          }};
}

}  // namespace suite
