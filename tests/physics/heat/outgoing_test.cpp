// What is rendered of temperatures that were found: frames of thermal bands, put together over the bands, send what the
// balance of heat says that the surfaces send; and their truth is what the balance has.
#include <gtest/gtest.h>

#include <cmath>

#include "heat/heat_field.h"
#include "spectral/planck.h"
#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::outgoing_test {
namespace {

using namespace test;

constexpr double kSurroundings = 290;  // K, air and sky
constexpr uint32_t kLooks = 256;       // rays an element

class Imager final : public RaySensor {
 public:
  Imager(std::vector<Ray> rays, const std::vector<Band>& bands) : RaySensor(std::move(rays), bands, 16, 0.5) {}
  std::span<const std::string> truth() const override { return names_; }

 private:
  std::vector<std::string> names_{"temperature", "temperature_error", "sun_hours", "absorbed_sun", "longwave_received"};
};

// A yard of grey concrete and a hot wall that stands on it, in the sun for half of the time.
HeatedScene yard(double emissivity, double wall) {
  HeatedScene s;
  TemperatureSpec slab = heat({}, {{"convection", "mcadams"}});
  slab.layers = {uniform(0.2, 2000, 900, 1)};
  TemperatureSpec hot = slab;
  hot.numbers["source_w_m2"] = 400;
  s.plane(2, 2, s.heated(emissivity, slab));
  s.plane(2, 1.5, s.heated(wall, hot), with_axes({0, -1, 0}, {0, 0, 1}, {1, 0, 0.75}));
  return s;
}

struct Looked {
  double flux = 0, exact = 0;                                      // W/m2, from the frame; of the balance
  double kelvin = 0, error = 0, hours = 0, sun = 0, received = 0;  // largest differences of truth and balance
};

Looked look(double emissivity, double wall, double time) {
  const HeatKit kit(yard(emissivity, wall), 8);
  HeatSpec spec;
  spec.span = {0, 86400}, spec.step = 3600, spec.paths = 1024;
  WeatherLoads loads =
      still_loads({500, 0, black(kSurroundings), kSurroundings, 1, normalized(Vec3{-1, 0, 2}), 0}, spec.span, 24);
  for (size_t k = 0; k < 12; ++k) loads.direct[k] = 0;
  const auto result = std::make_shared<HeatResult>(kit.solve(loads, spec));
  std::vector<uint32_t> ground;
  std::vector<Ray> rays;
  for (uint32_t e = 0; e < kit.elements->size(); ++e) {
    if ((*kit.elements)[e].material != 0) continue;
    ground.push_back(e);
    for (uint32_t k = 0; k < kLooks; ++k)
      rays.push_back(
          {kit.elements->point(e, {SampleStream(3, 0, e), k, 0}).position + Vec3{0, 0, 5}, {0, 0, -1}, time});
  }
  std::vector<Band> bands;
  for (const auto& [low, high] :
       {std::array{3.0, 8.0}, std::array{8.0, 14.0}, std::array{14.0, 30.0}, std::array{30.0, 100.0}})
    bands.push_back(Band::rectangular(strf("b%zu", bands.size()), (low + high) / 2, high - low));
  JobOptions job;
  job.progress = false;
  job.heating.field = std::make_shared<const HeatField>(
      std::make_shared<const Elements>(*kit.tracer, kit.optics.has_heat, 8, 0), result);
  SkySpec sky{Curve::constant(1), {}, 0, 0, true};
  std::vector<double> um, radiance;
  for (double w = 2.5; w <= 101; w *= 1.005) um.push_back(w), radiance.push_back(planck_radiance(w, kSurroundings));
  sky.radiance = Curve(um, radiance, Outside::hold);
  SourceSpecs sources;
  sources.add(sky);
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Imager>(rays, bands));
  run_job(kit.scene, sources, sensors, job);
  const CaptureResult& r = static_cast<Imager&>(*sensors[0]).result;

  Looked out;
  double area = 0;
  for (size_t i = 0; i < ground.size(); ++i) {
    const uint32_t e = ground[i];
    const double a = (*kit.elements)[e].area, eps = double{result->emissivity[e]};
    const auto row = [&](const std::vector<float>& rows) {
      return result->between_moments({&rows[e * result->moments], result->moments}, time);
    };
    area += a;
    out.exact += a * (eps * black(result->kelvin_at(e, time)) + (1 - eps) * row(result->received));
    for (size_t k = i * kLooks; k < (i + 1) * kLooks; ++k) {
      for (size_t b = 0; b < bands.size(); ++b)
        out.flux += a / kLooks * kPi * r.radiance[k * bands.size() + b] * (bands[b].high_um() - bands[b].low_um());
      const double* truth = &r.truth[k * 5];
      out.kelvin = std::fmax(out.kelvin, std::fabs(truth[0] - result->kelvin_at(e, time)));
      out.error = std::fmax(out.error, std::fabs(truth[1] - result->errors_at(e, time).total()));
      out.hours = std::fmax(out.hours, std::fabs(truth[2] - double{result->sun_hours[e]}));
      out.sun = std::fmax(out.sun, std::fabs(truth[3] - row(result->absorbed)));
      out.received = std::fmax(out.received, std::fabs(truth[4] - row(result->received)));
    }
  }
  out.flux /= area, out.exact /= area;
  return out;
}

TEST(Outgoing, FramesOverAllBandsSendWhatTheBalanceSays) {
  for (const auto& [emissivity, wall] : {std::array{0.95, 0.9}, std::array{0.5, 0.9}, std::array{0.1, 0.8}})
    for (const double time : {3 * 3600.0, 18 * 3600.0}) {
      const Looked l = look(emissivity, wall, time);
      // What of a body's light lies within the bands, at some 300 K.
      const double within = planck_band_radiance(3, 100, 300) * kPi / black(300);
      std::printf(
          "emissivity %.2f at %2.0f h: %.2f W/m2 rendered, %.2f in the balance (%+.2f %%), %.4f of it in the bands\n",
          emissivity, time / 3600, l.flux, l.exact, 100 * (l.flux / l.exact - 1), within);
      EXPECT_NEAR(l.flux / l.exact, 1, 0.02);
      EXPECT_NEAR(l.flux / (l.exact * within), 1, 0.005);
      EXPECT_LT(l.kelvin, 1e-3);
      EXPECT_LT(l.error, 1e-6);
      EXPECT_LT(l.hours, 1e-5);
      EXPECT_LT(l.sun, 1e-3);
      EXPECT_LT(l.received, 1e-3);
    }
}

}  // namespace
}  // namespace suite::outgoing_test
