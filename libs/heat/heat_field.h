// The temperatures of a scene's elements as what the renderer asks for.
#pragma once
#include <cstddef>
#include <span>

#include "heat/heat_balance.h"

namespace suite {

class HeatField final : public TemperatureField {
 public:
  // Elements of the scene's surfaces at rest; the result belongs to them.
  HeatField(std::shared_ptr<const Elements> elements, std::shared_ptr<const HeatResult> result);
  // Of the element at the place. Where there is none, as of what moves, that of the air.
  double kelvin(const HeatedPlace& place, double time) const override;
  // By all that is told (HeatErrors); NaN where there is no element.
  double error(const HeatedPlace& place, double time) const override;
  std::array<double, 2> range() const override { return range_; }

 private:
  std::shared_ptr<const Elements> elements_;
  std::shared_ptr<const HeatResult> result_;
  std::array<double, 2> range_;
};

// What a field asks of a result, as other ranks of the same program are told it.
std::vector<std::byte> packed_field(const HeatResult& result);
HeatResult unpacked_field(std::span<const std::byte> bytes);

}  // namespace suite
