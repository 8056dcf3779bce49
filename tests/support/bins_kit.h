// Sensors that take chosen bins, and bands by steps of 0.1 nm, for tests of the choice.
#pragma once
#include <cmath>
#include <functional>

#include "scheduler/bins.h"
#include "sensor/sensors.h"
#include "support/radiometry_kit.h"

namespace suite::test {

// Problem i looks along rays[i].
class BinSensor : public RaySensor {
 public:
  BinSensor(std::vector<Ray> rays, const std::vector<Band>& bands, uint32_t paths, double error, double step_um = 0)
      : RaySensor(std::move(rays), bands, paths), chosen_(state_for(bands, error, step_um, 0, 4)) {}
  std::span<const SpectralState> states() const override { return {&chosen_, 1}; }
  void take_state(size_t, SpectralState with_bins) override { chosen_ = std::move(with_bins); }
  const SpectralState& state() const { return chosen_; }

 private:
  SpectralState chosen_;
};

inline SourceSpecs sun_of(const Curve& irradiance) {
  SourceSpecs s;
  s.add(SunSpec{{{0, 0, 1}, 0.00465, irradiance}});
  return s;
}

// Band means of a function of wavelength by midpoints of small steps, 0.1 nm unless told; shares no code with bins.
inline double by_small_steps(const Band& band, const std::function<double(double)>& value, double step_um = 1e-4) {
  double sum = 0, whole = 0;
  const auto steps = static_cast<int>(std::ceil((band.high_um() - band.low_um()) / step_um));
  for (int i = 0; i < steps; ++i) {
    const double um = band.low_um() + (band.high_um() - band.low_um()) * (i + 0.5) / steps;
    const double response = band.response.at(um);
    sum += response * value(um), whole += response;
  }
  return sum / whole;
}

// The largest relative error of a product of curves over all bands, as the bins of a state give it. The bins see the
// curves as averages over bins. least: products below this share of the first curve are passed over.
inline double error_of(const SpectralState& state, std::span<const Band> bands, const std::vector<Curve>& curves,
                       double step_um = 1e-4, double least = 0) {
  const BandProjection projection(state, bands);
  double worst = 0;
  for (size_t b = 0; b < bands.size(); ++b) {
    double got = 0;
    for (size_t k = 0; k < state.size(); ++k) {
      double product = projection.weight(b, k);
      for (const Curve& c : curves) product *= c.mean(state.bins[k].low_um, state.bins[k].high_um);
      got += product;
    }
    const double right = by_small_steps(
        bands[b],
        [&](double um) {
          double product = 1;
          for (const Curve& c : curves) product *= c.at(um);
          return product;
        },
        step_um);
    if (right < least * by_small_steps(
                            bands[b], [&](double um) { return curves[0].at(um); }, step_um))
      continue;
    worst = std::max(worst, std::fabs(got / right - 1));
  }
  return worst;
}

}  // namespace suite::test
