#include "heat/heat_field.h"

#include <algorithm>
#include <cmath>

namespace suite {

HeatField::HeatField(std::shared_ptr<const Elements> elements, std::shared_ptr<const HeatResult> result)
    : elements_(std::move(elements)), result_(std::move(result)) {
  const auto [low, high] = std::minmax_element(result_->kelvin.begin(), result_->kelvin.end());
  const auto [cold, warm] = std::minmax_element(result_->air_kelvin.begin(), result_->air_kelvin.end());
  range_ = {double{std::min(*low, *cold)}, double{std::max(*high, *warm)}};
}

double HeatField::kelvin(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material);
  return element ? result_->kelvin_at(*element, time) : result_->air_at(time);
}

double HeatField::error(const HeatedPlace& place, double time) const {
  const std::optional<uint32_t> element = elements_->at(place, place.material);
  return element ? result_->error_at(*element, time) : NAN;
}

}  // namespace suite
