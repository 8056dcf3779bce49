#include "optics/scatter_model.h"

#include <algorithm>

namespace suite {

std::optional<ScatterModel::Factored> ScatterModel::factored(Dir, Dir) const { return std::nullopt; }
void ScatterModel::delta_weight(Dir, int, int, std::span<float> weight) const {
  std::fill(weight.begin(), weight.end(), 0.0f);
}
void ScatterModel::delta_probability(Dir, int, int, std::span<float> probability) const {
  std::fill(probability.begin(), probability.end(), 0.0f);
}
ScatterModel::Polarised ScatterModel::mueller(Dir, Dir, std::span<Mueller> m) const {
  m[0] = Mueller::depolariser();
  return {};
}
ScatterModel::Polarised ScatterModel::delta_mueller(Dir, int, int, std::span<Mueller> m) const {
  m[0] = Mueller::depolariser();
  return {};
}

}  // namespace suite
