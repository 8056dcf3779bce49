// What the air does between the sensor and what it sees first: means over the samples that met something, per band.
#include <vector>

#include "transport/truth/truth.h"

namespace suite {

namespace {

// The way of light from the first thing met to the sensor.
Vec3 start_of(const FirstMeeting& first) { return first.at->position + first.out * first.distance; }

// One of the parts of the line of sight (Atmosphere::parts).
class AirPart final : public TruthCollector {
 public:
  using Part = std::span<float> Atmosphere::Parts::*;
  AirPart(const TruthContext& c, Part part, std::string name, std::string unit)
      : context_(c), part_(part), name_(std::move(name)), unit_(std::move(unit)) {}
  size_t slots() const override { return context_.bands.size(); }
  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    for (const Band& b : context_.bands) names.push_back(name_ + " " + b.name + " [" + unit_ + "]");
    return names;
  }
  void add(const TruthSample& s, double* sums) const override {
    const Atmosphere* air = context_.environment.atmosphere.get();
    if (!s.first || !air) return;
    thread_local std::vector<float> rows[4];
    for (std::vector<float>& row : rows) row.resize(context_.state.size());
    const Atmosphere::Parts parts{rows[0], rows[1], rows[2], rows[3]};
    if (air->parts(start_of(*s.first), -s.first->out, s.first->distance, parts))
      context_.projection.add(parts.*part_, {sums, context_.bands.size()});
  }
  void finish(const double* sums, const TruthCounts& n, double* v) const override {
    if (!(n.hits > 0) || !context_.environment.atmosphere) return;
    for (size_t b = 0; b < context_.bands.size(); ++b) v[b] = sums[b] / n.hits;
  }

 private:
  TruthContext context_;
  Part part_;
  std::string name_, unit_;
};

std::unique_ptr<const TruthCollector> water(const TruthContext& context) {
  return std::make_unique<SimpleCollector>(
      context, 1, std::vector<std::string>{"water vapour [kg/m2]"},
      [](const TruthContext& c, const TruthSample& s, double* sum) {
        if (s.first && c.environment.atmosphere)
          sum[0] += c.environment.atmosphere->water(start_of(*s.first), -s.first->out, s.first->distance);
      },
      [](const TruthContext& c, const double* sum, const TruthCounts& n, double* v) {
        if (n.hits > 0 && c.environment.atmosphere) v[0] = sum[0] / n.hits;
      });
}

}  // namespace

void add_air_rows(std::vector<TruthRow>& table) {
  using Parts = Atmosphere::Parts;
  const auto row = [&](const char* name, const char* summary, const char* unit, AirPart::Part part,
                       const char* column) {
    table.push_back({name, summary, unit, [=](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                       return std::make_unique<AirPart>(c, part, column, unit);
                     }});
  };
  constexpr const char* radiance = "W/(m2 sr um)";
  row("air_transmittance", "of real air, from the sensor to the first hits, per band", "1", &Parts::transmittance,
      "air transmittance");
  row("air_thermal", "what that way of air emits towards the sensor, unscattered", radiance, &Parts::thermal,
      "air thermal");
  row("air_single", "what it scatters once of sun and moon", radiance, &Parts::single, "air single");
  row("air_multiple", "the rest of its light over the even ground, scattered more often", radiance, &Parts::multiple,
      "air multiple");
  table.push_back({"air_water", "water vapour on that way", "kg/m2", water});
}

}  // namespace suite
