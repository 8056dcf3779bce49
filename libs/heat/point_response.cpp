#include "heat/point_response.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "heat/slab_batch.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kHat = 100;               // W/m2
constexpr double kSettledResponse = 1e-3;  // K
constexpr int kResponseTurns = 60;
constexpr float kNothing = 0.01f;  // W/m2

double lost(const FaceTraits& traits, const FaceWeather& weather, double kelvin) {
  return traits.emissivity * kStefanBoltzmann * kelvin * kelvin * kelvin * kelvin +
         loss_to_air(traits, weather, kelvin);
}

}  // namespace

double mean_loss(const PointResponse::Around& around) {
  double least = INFINITY, most = 0;
  for (size_t m = 0; m < around.kelvin.size(); ++m) {
    const double T = double{around.kelvin[m]};
    const double slope =
        lost(around.traits, around.weather[m], T + 0.5) - lost(around.traits, around.weather[m], T - 0.5);
    least = std::min(least, slope), most = std::max(most, slope);
  }
  return std::max((least + most) / 2, 1e-3);
}

PointResponse::PointResponse(const HeatedMaterial& material, double step, size_t steps, double loss, double kelvin)
    : loss_(loss) {
  // Two of them, of which one has a hat of flux at the first moment; about a temperature at which nothing flows.
  SlabBatch batch(material.layers, 2);
  batch.start(0, kelvin);
  const FaceBalance behind = back_balance(material.behind);
  size_t at = 0;
  const BatchLoads loads = [&](double begin, double, const SlabBatch&, FaceLines& top, FaceLines& bottom) {
    if (begin <= 0) at = 0;
    for (size_t e = 0; e < 2; ++e) {
      StepLine flux{loss * kelvin, loss * kelvin};
      if (e == 1 && at == 0) flux.begin += kHat;
      if (e == 1 && at + 1 == steps) flux.end += kHat;
      top.constant[e] = flux, top.linear[e] = {loss, loss};
      bottom.linear[e] = {behind.linear, behind.linear};
      bottom.constant[e] = {behind.linear * kelvin, behind.linear * kelvin};
    }
    ++at;
  };
  PeriodicOptions options;
  options.tolerance = 1e-7, options.most_sweeps = 2000;
  std::vector<float> after(steps);
  find_periodic(batch, 0, std::vector<double>(steps, step), loads, options,
                [&](size_t k) { after[(k + 1) % steps] = static_cast<float>((batch.top(1) - batch.top(0)) / kHat); });
  kernel_ = after;
  kernel_.insert(kernel_.end(), after.begin(), after.end());
}

bool PointResponse::above(const Around& around, std::span<const float> q, std::span<float> kelvin) const {
  const size_t n = kernel_.size() / 2;
  SUITE_CHECK_EQ(q.size(), n + 1);
  std::ranges::fill(kelvin, 0.0f);
  // The ends are one moment.
  std::vector<float> more(q.begin(), q.end() - 1), d(n, 0.0f), next(n);
  more[0] = (q.front() + q.back()) / 2;
  if (std::ranges::all_of(more, [](float x) { return std::fabs(x) < kNothing; })) return true;
  std::vector<double> before(n);
  for (size_t m = 0; m < n; ++m) before[m] = lost(around.traits, around.weather[m], double{around.kelvin[m]});
  for (int turn = 0; turn < kResponseTurns; ++turn) {
    std::ranges::fill(next, 0.0f);
    for (size_t m = 0; m < n; ++m) {
      const double off = double{d[m]};
      const double beyond =
          off == 0 ? 0
                   : lost(around.traits, around.weather[m], double{around.kelvin[m]} + off) - before[m] - loss_ * off;
      const auto flux = static_cast<float>(double{more[m]} - beyond);
      if (flux == 0) continue;
      const float* answer = &kernel_[n - m];
      for (size_t k = 0; k < n; ++k) next[k] += flux * answer[k];
    }
    float change = 0;
    bool sound = true;
    for (size_t m = 0; m < n; ++m) {
      sound = sound && std::isfinite(next[m]);
      change = std::max(change, std::fabs(next[m] - d[m]));
    }
    d.swap(next);
    if (!sound) return false;
    if (change >= static_cast<float>(kSettledResponse)) continue;
    std::ranges::copy(d, kelvin.begin());
    kelvin[n] = d[0];
    return true;
  }
  return false;
}

}  // namespace suite
