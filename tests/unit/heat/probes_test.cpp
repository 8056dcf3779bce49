// A probe tells of the surface that it lies on, however near the middle of another element is.
#include <gtest/gtest.h>

#include "heat/heat_fluxes.h"
#include "support/heated_scene_kit.h"

namespace suite::probes_test {
namespace {

using namespace test;

TEST(Probes, AreOfTheSurfaceThatTheyLieOn) {
  HeatedScene s;
  const uint32_t meadow = s.heated(0.7, heat()), steel = s.heated(0.5, heat());
  s.plane(40, 40, meadow);
  s.plane(0.2, 0.2, steel, shifted({0.4, 0, 0.3}));
  const HeatKit kit(std::move(s), 4);
  const auto material = [&](Vec3 place) {
    return (*kit.elements)[element_of(*kit.tracer, *kit.elements, place, 0)].material;
  };
  EXPECT_EQ(material({0.1, 0, 0}), meadow);  // the board's middle is 0.4 m off, the meadow's pieces' some 10
  EXPECT_EQ(material({0.4, 0, 0.01}), meadow);
  EXPECT_EQ(material({0.4, 0, 0.3}), steel);
  EXPECT_EQ(material({0.45, 0.05, 0.28}), steel);
  EXPECT_EQ(material({0.4, 0, 1}), steel);  // in the air: the nearest middle
}

}  // namespace
}  // namespace suite::probes_test
