// What maps and temperature models make of a material at a point: baked for a spectral state once, asked at every hit.
//
// Order: a class map has chosen the material already. curve_index replaces a curve of its model (each curve of the
// family is baked once); else cube mixes the model at the lowest and the highest spectrum of the raster, bin by bin,
// which is exact for models that are linear in that curve, others are refused; else mixture puts other materials side
// by side, each with its own curve_index, cube and temperature. Outside a map that does not extend, the material itself
// holds. Temperature: of a map, else of a model, else constant. A mixture without a temperature of its own emits what
// its parts emit, each polarised as its own matrices say. Based on: Goodenough & Brown, section III-A-3.
#pragma once
#include <memory>
#include <vector>

#include "optics/mixed_model.h"
#include "scene/scene.h"
#include "spectral/blackbody_table.h"
#include "spectral/state.h"
#include "surface/map_lookup.h"

namespace suite {

struct BakedMaterial;

// Curves of a raster of spectra, interpolated to the bins of a state, between a lowest and a highest model.
class BakedCube {
 public:
  // model: whose curve map.parameter the map replaces. Error when the model is not linear in it.
  BakedCube(const PropertyMap& map, const ModelSpec& model, const SpectralState& state);
  // Shares of both models at a place, one value a bin each; false outside the map.
  bool shares(const MapPlace& place, std::span<float> low, std::span<float> high) const;
  bool one_shape() const { return one_shape_; }  // the ratio of w at any two bins never depends on the direction
  const ScatterModel& low() const { return *low_; }
  const ScatterModel& high() const { return *high_; }

 private:
  struct Weight {
    uint32_t channel;
    float weight;
  };
  const PropertyMap& map_;
  std::unique_ptr<const ScatterModel> low_, high_;
  std::vector<float> lowest_, range_;  // per bin; a range of 0 = no difference
  std::vector<uint32_t> first_;        // of each bin's weights; bins + 1
  std::vector<Weight> weights_;
  bool one_shape_ = false;
};

struct MaterialMaps {
  const PropertyMap *mixture = nullptr, *curve_index = nullptr, *temperature = nullptr, *bump = nullptr,
                    *normal = nullptr;
  std::vector<std::unique_ptr<const ScatterModel>> variants;  // curve_index: of the family; null = not in the map
  std::unique_ptr<const BakedCube> cube;
  std::vector<const BakedMaterial*> parts;  // mixture
  std::shared_ptr<const TemperatureField> field;
  uint32_t material = kNone;                        // index of the material they are of
  double constant_k = 0;                            // 0 = none
  bool needs_uv = false;                            // some map is placed by texture coordinates
  std::shared_ptr<const BlackbodyTable> blackbody;  // when map or field
  bool bends() const { return bump || normal; }
  // Whether the surface here differs in more than its normal.
  bool varies() const { return mixture || curve_index || cube || temperature || field; }
};

// The working memory of one interaction whose material varies from point to point; kept from hit to hit.
struct LocalMaterial {
  MixedModel mixed;
  std::vector<std::vector<float>> spectra;  // shares of cubes
  std::vector<float> fractions, totals;
  std::vector<size_t> ends;  // of each material of a mixture, among the parts of `mixed`
  // Of each material of a mixture that emits: its blackbody radiance; where they are not equally warm, over that of the
  // whole, and 0 where it does not emit.
  std::vector<std::vector<float>> glow;
  MixedModel emitting;  // the parts of `mixed` times that
};

}  // namespace suite
