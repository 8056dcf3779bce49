// Measured or precomputed temperatures over time, linear in between.
#include "thermal/models/rows.h"

namespace suite {

namespace {

class Tabulated final : public TemperatureModel {
 public:
  explicit Tabulated(const TemperatureSpec& s)
      : table_(s.times, s.kelvins, s.repeat ? LoadTable::Outside::repeat : LoadTable::Outside::refuse) {
    for (const double k : s.kelvins)
      if (!(k >= 1 && k <= 10000)) throw Error(strf("a tabulated temperature of %g K", k), "1 to 10000 K");
  }
  void kelvin(std::span<const double> times, const Loads&, std::span<double> out) const override {
    for (size_t i = 0; i < times.size(); ++i) out[i] = table_.at(times[i]);
  }

 private:
  TimeTable table_;
};

}  // namespace

TemperatureRow tabulated_temperature_row() {
  return {{"tabulated", "temperatures over time, linear in between", "K",
           [](const TemperatureSpec& spec) -> std::unique_ptr<const TemperatureModel> {
             return std::make_unique<Tabulated>(spec);
           }},
          {},
          true,
          false,
          [] {
            return std::vector<TemperatureSpec>{
                {"tabulated", {}, {-100000, 0, 3600, 200000}, {280, 300, 310, 290}, false, {}},
                {"tabulated", {}, {0, 43200, 86400}, {280, 310, 280}, true, {}}};
          }};
}

}  // namespace suite
