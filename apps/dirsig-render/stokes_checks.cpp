#include "stokes_checks.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "base/run_app.h"
#include "transport/channels.h"

namespace suite {

void check_stokes(const Simulation& sim, const Sensor& sensor) {
  if (!ChannelPlan(sensor.channels()).of_stokes()) return;
  if (const auto names = sensor.channels(); std::find(names.begin(), names.end(), "depolarised") == names.end())
    throw Error(
        "sensor '" + sensor.name() + "' sees polarisation, and nothing would say what part of its light is known",
        "add the channel `depolarised`");
  const SourceSpecs& sources = sim.sources;
  if (sources.has_air() && !sources.air)
    throw Error("sensor '" + sensor.name() + "' sees polarisation, and the light of this air is known without it",
                "give air with a `profile`; or leave the air out");
  if (sim.output.type == OutputSpec::Type::uint16)
    throw Error("sensor '" + sensor.name() + "': Q, U and V have signs, which whole numbers of 16 bits do not hold",
                "output type: float32 or float64");
  for (const Task& task : sensor.tasks())
    for (const Capture& capture : task.captures)
      if (const ImageWishes wishes = sensor.wishes(capture); wishes.quantity == Quantity::brightness_temperature)
        throw Error(wishes.where, "Q, U and V are no light that has a temperature",
                    "units: radiance or toa_reflectance");
}

void DepolarisedLight::take(const Delivery& delivery) {
  const auto channels = delivery.sensor.channels();
  const auto at = static_cast<size_t>(std::find(channels.begin(), channels.end(), "depolarised") - channels.begin());
  if (at == channels.size()) return;
  const CaptureResult& r = delivery.result;
  Sum& sum = of_[delivery.sensor.name()];
  const size_t each = r.bins * r.bands;
  for (size_t i = 0; i < r.problems(); ++i)
    for (size_t v = 0; v < each; ++v) {
      const double* const values = &r.radiance[i * r.values_per_problem() + v];
      sum.all += values[0], sum.depolarised += values[at * each];
    }
}

void DepolarisedLight::report() const {
  constexpr double kMuch = 0.01;
  for (const auto& [sensor, sum] : of_)
    if (sum.all > 0 && sum.depolarised > kMuch * sum.all)
      emit({Dr::stokes_depolarised,
            strf("sensor '%s': %.1f %% of the light passed surfaces or media of which no Mueller matrix is known; it "
                 "counts as depolarised there (channel `depolarised`)",
                 sensor.c_str(), 100 * sum.depolarised / sum.all)});
}

}  // namespace suite
