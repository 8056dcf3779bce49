// The temperatures of a scene's elements as what the renderer asks for.
#pragma once
#include <cstddef>
#include <span>

#include "heat/point_heat.h"
#include "thermal/explained_field.h"

namespace suite {

class HeatField final : public ExplainedField {
 public:
  // Elements of the scene's surfaces at rest; the result belongs to them. points: of the same; null = elements as
  // wholes.
  HeatField(std::shared_ptr<const Elements> elements, std::shared_ptr<const HeatResult> result,
            std::shared_ptr<const PointHeat> points = nullptr);
  // Of the element at the place, or of the point. Where there is none, as of what moves, that of the air.
  double kelvin(const HeatedPlace& place, double time) const override;
  // By all that is told (HeatErrors; where points are told without the elements' size); NaN where there is no element.
  double error(const HeatedPlace& place, double time) const override;
  // Of the element.
  Cause cause(const HeatedPlace& place, double time) const override;
  std::array<double, 2> range() const override { return range_; }

 private:
  std::shared_ptr<const Elements> elements_;
  std::shared_ptr<const HeatResult> result_;
  std::shared_ptr<const PointHeat> points_;
  std::array<double, 2> range_;
};

// What a field asks of a result, as other ranks of the same program are told it.
std::vector<std::byte> packed_field(const HeatResult& result);
HeatResult unpacked_field(std::span<const std::byte> bytes);

}  // namespace suite
