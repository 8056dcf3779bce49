// A scattering model as a user describes it and a scene stores it: a name, numbers, curves, data. No spectral state
// yet; baking it for a state gives a ScatterModel (models.h).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "spectral/curve.h"

namespace suite {

namespace sqt {
class Bundle;
}

struct ModelSpec {
  std::string model;                          // a row of models(), e.g. "lambert"
  std::map<std::string, double> numbers;      // e.g. "roughness" -> 0.2
  std::map<std::string, Curve> curves;        // e.g. "reflectance" -> curve; a plain number becomes a constant
  std::map<std::string, std::string> texts;   // e.g. "file" -> name of the SQT in the scene
  std::shared_ptr<const sqt::Bundle> bundle;  // resolved data of model "sqt", null otherwise
};

// A material: what a `usemtl` name or a map's class stands for.
struct Material {
  std::string id;  // unique alpha-numeric identifier
  std::string description;
  ModelSpec surface;                      // reflection and transmission of both sides
  double temperature_k = 0;               // constant temperature; 0 = none given, the material does not emit
  std::map<std::string, double> thermal;  // conductivity_w_m_k, density_kg_m3, specific_heat_j_kg_k, thickness_m
  // Media that begin behind and in front of the surface, indices into Scene::media. With a medium and without a model
  // the surface is an index-matched boundary: rays pass.
  static constexpr uint32_t kNoMedium = 0xffffffffu;
  uint32_t inside = kNoMedium, outside = kNoMedium;
  bool bounds_medium() const { return inside != kNoMedium || outside != kNoMedium; }
  bool is_boundary() const { return surface.model.empty() && bounds_medium(); }
};

}  // namespace suite
