// Bodies of media in each other that share an outer face: which of equal priority are told, and which are not.
#include "scene/shared_faces.h"

#include <gtest/gtest.h>

namespace suite::shared_faces_test {
namespace {

// A body of a medium (0: water, 1: oil, 2: fog, of a higher priority).
struct Solid {
  PrimitiveKind kind;
  std::vector<double> parameters;
  uint32_t medium;
  Affine3 place = {};
};

Scene scene_of(const std::vector<Solid>& solids) {
  Scene s;
  s.media.resize(3);
  s.media[0].id = "water", s.media[1].id = "oil", s.media[2].id = "fog", s.media[2].priority = 1;
  s.groups = {{"root", {}}};
  for (const Solid& solid : solids) {
    Material m;
    m.inside = solid.medium;
    s.materials.push_back(m);
    Primitive p;
    p.name = "body " + std::to_string(s.primitives.size());
    p.kind = solid.kind, p.parameters = solid.parameters, p.material = static_cast<uint32_t>(s.materials.size() - 1);
    Placement placement;
    placement.kind = TargetKind::primitive, placement.target = static_cast<uint32_t>(s.primitives.size());
    placement.to_parent = solid.place;
    s.primitives.push_back(p);
    s.groups[0].placements.push_back(placement);
  }
  return s;
}

Solid box(double low, double high, double top, uint32_t medium) {
  return {PrimitiveKind::box, {low, low, 0, high, high, top}, medium};
}

TEST(SharedFaces, OfABodyAndItsContainer) {
  const std::vector<SharedFace> told = shared_faces(scene_of({box(0, 4, 3, 0), box(1, 2, 3, 1)}), 0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].one, "body 1");
  EXPECT_EQ(told[0].other, "body 0");
  EXPECT_EQ(told[0].medium_one, "oil");
  EXPECT_EQ(told[0].medium_other, "water");
  EXPECT_EQ(told[0].at.x, 1.5);
  EXPECT_TRUE(told[0].at.z == 0 || told[0].at.z == 3);
}

TEST(SharedFaces, OfTurnedBodiesCapsAndBalls) {
  const Affine3 turned{{0, 0, 1, 0, 1, 0, -1, 0, 0}, {7, 8, 9}};
  Solid outer = box(0, 4, 3, 0), inner = box(1, 2, 3, 1);
  outer.place = inner.place = turned;
  EXPECT_EQ(shared_faces(scene_of({outer, inner}), 0).size(), 1u);
  const Solid can{PrimitiveKind::cylinder, {0.5, 3, 1}, 1, translation({2, 2, 0})};
  EXPECT_EQ(shared_faces(scene_of({box(0, 4, 3, 0), can}), 0).size(), 1u);
  const Solid ball{PrimitiveKind::sphere, {2}, 0}, same{PrimitiveKind::sphere, {1}, 1, scaling({2, 2, 2})};
  EXPECT_EQ(shared_faces(scene_of({ball, same}), 0).size(), 1u);
}

TEST(SharedFaces, NotWhereNothingIsLeftOpen) {
  const Solid outer = box(0, 4, 3, 0);
  EXPECT_TRUE(shared_faces(scene_of({outer, box(1, 2, 3, 2)}), 0).empty()) << "another priority";
  EXPECT_TRUE(shared_faces(scene_of({outer, box(1, 2, 3, 0)}), 0).empty()) << "the same medium";
  Solid within = box(1, 2, 2.5, 1);
  within.parameters[2] = 0.5;
  EXPECT_TRUE(shared_faces(scene_of({outer, within}), 0).empty()) << "no face in common";
  Solid beside = box(0, 4, 3, 1);
  beside.place = translation({4, 0, 0});
  Solid above = box(0, 4, 3, 1);
  above.place = translation({0, 0, 3});
  EXPECT_TRUE(shared_faces(scene_of({outer, above}), 0).empty()) << "faces of bodies that touch face each other";
  // Beside each other: fronts lie in one plane and have an edge in common, no area.
  EXPECT_TRUE(shared_faces(scene_of({outer, beside}), 0).empty());
  const Solid ball{PrimitiveKind::sphere, {2}, 0}, smaller{PrimitiveKind::sphere, {1}, 1};
  EXPECT_TRUE(shared_faces(scene_of({ball, smaller}), 0).empty());
}

}  // namespace
}  // namespace suite::shared_faces_test
