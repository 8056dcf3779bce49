// What a simulation makes use of and what it leaves alone, and why: parts of the renderer that a scene, its light and
// its sensors do not ask for are never made.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "light/environment.h"
#include "scene/scene.h"
#include "sensor/sensor.h"
#include "transport/options.h"

namespace suite {

struct FeatureUse {
  std::string name;  // "media"
  bool used = false;
  std::string why;  // one clause
};
// One entry a feature, always the same ones in the same order. scene: as it was loaded. laser_radars: how many look at
// it beside the sensors.
std::vector<FeatureUse> features_of(const Scene& scene, const SourceSpecs& sources,
                                    std::span<const std::unique_ptr<Sensor>> sensors,
                                    const PipelineOptions& options = {}, size_t laser_radars = 0);
// The same as lines of text.
std::string text_of(const std::vector<FeatureUse>& features);
// What a feature is and what it costs when it is not used; nothing for a name that is none.
std::optional<std::string> explain_use(const std::string& feature);
std::vector<std::string> feature_names();
// All that explain_use() knows: these, and techniques that are no feature.
std::vector<std::string> explained_names();

}  // namespace suite
