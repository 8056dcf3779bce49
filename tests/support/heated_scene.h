// Small scenes whose temperatures weather makes, for tests.
#pragma once
#include "heat/heat_balance.h"
#include "support/radiometry_kit.h"

namespace suite::test {

// Lambert with one reflectance in sunlight and another in the thermal infrared.
inline Material warmed(const std::string& id, double albedo, double emissivity) {
  ModelSpec s;
  s.model = "lambert";
  s.curves = {
      {"reflectance", Curve({0.2, 4, 4.01, 100}, {albedo, albedo, 1 - emissivity, 1 - emissivity}, Outside::hold)},
      {"transmittance", Curve::constant(0)}};
  return material(id, s);
}

// Layers of the temperature `model: heat`, from the front down, with its numbers and texts.
inline TemperatureSpec heat_of(std::vector<SlabLayer> layers, std::map<std::string, double> numbers = {},
                               std::map<std::string, std::string> texts = {}) {
  TemperatureSpec spec;
  spec.model = "heat";
  spec.layers = std::move(layers);
  spec.numbers = std::move(numbers);
  spec.texts = std::move(texts);
  return spec;
}

// A scene made ready for its balance; material i waits for temperature i.
class BalancedScene {
 public:
  BalancedScene(std::vector<Mesh> meshes, std::vector<Material> materials, std::vector<TemperatureSpec> temperatures,
                const HeatSpec& spec) {
    auto made = scene_of(std::move(meshes), std::move(materials));
    for (uint32_t m = 0; m < temperatures.size(); ++m) made->temperatures.push_back({m, std::move(temperatures[m])});
    scene = std::move(made);
    tracer = std::make_unique<const Tracer>(scene, std::nullopt, spec.span);
    optics = heat_optics(*scene, used_materials(*tracer), [](const std::string& w) { std::printf("%s\n", w.c_str()); });
    elements = std::make_unique<const Elements>(*tracer, optics.has_heat, spec.elements, spec.span.begin);
    faces = std::make_unique<const HeatFaces>(*elements, optics);
  }
  HeatResult solve(const WeatherLoads& loads, const HeatSpec& spec) const {
    return solve_heat(*tracer, *elements, *faces, optics, loads, spec);
  }
  // Elements of a material.
  std::vector<uint32_t> of(uint32_t material) const {
    std::vector<uint32_t> out;
    for (uint32_t e = 0; e < elements->size(); ++e)
      if ((*elements)[e].material == material) out.push_back(e);
    return out;
  }

  std::shared_ptr<const Scene> scene;
  std::unique_ptr<const Tracer> tracer;
  HeatOptics optics;
  std::unique_ptr<const Elements> elements;
  std::unique_ptr<const HeatFaces> faces;
};

// The weather's own clock and sun.
inline HeatWeather as_it_is(const Weather& weather) {
  return {weather, [](double t) { return t; }, [&weather](double t) { return weather.sun(t); }};
}

}  // namespace suite::test
