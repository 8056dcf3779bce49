// HEALPix cells against the reference library, and the properties everything else relies on.
#include <chealpix.h>
#include <gtest/gtest.h>

#include <set>

#include "math/sampling.h"
#include "math/warps.h"
#include "sqt/cell.h"
#include "sqt/tree.h"

namespace suite::sqt::cell_test {
namespace {

Dir random_dir(Pcg32& rng) { return uniform_sphere({rng.uniform(), rng.uniform()}); }

TEST(Cell, IndexAgreesWithReferenceAtEveryOrder) {
  Pcg32 rng(1);
  for (int order = 0; order <= kMaxOrder; ++order)
    for (int i = 0; i < 20000; ++i) {
      const Dir d = random_dir(rng);
      double v[3] = {d.x, d.y, d.z};
      long expected = 0;
      vec2pix_nest(1L << order, v, &expected);
      ASSERT_EQ(cell_of(d, order).index(), expected) << order << " " << d.x << " " << d.y << " " << d.z;
    }
}

TEST(Cell, GridsOfDirectionsAreThoseOfTheirPoints) {
  for (const int side : {1, 4, 12, 16})
    for (uint32_t i = 0; i < cell_count(3); ++i) {
      std::vector<double> x(256), y(256), z(256);
      const CellId cell = CellId::of(3, i);
      directions_in(cell, side, x.data(), y.data(), z.data());
      for (int k = 0; k < side * side; ++k) {
        const auto n = static_cast<size_t>(k);
        ASSERT_EQ(direction_in(cell, {(k % side + 0.5) / side, (k / side + 0.5) / side}), (Dir{x[n], y[n], z[n]}))
            << i << ' ' << side << ' ' << k;
      }
    }
}

TEST(Cell, CentresAgreeWithReference) {
  for (int order = 0; order <= 6; ++order)
    for (uint32_t i = 0; i < cell_count(order); ++i) {
      double v[3];
      pix2vec_nest(1L << order, i, v);
      EXPECT_LT(length(center_of(CellId::of(order, i)) - Dir{v[0], v[1], v[2]}), 1e-13);
    }
}

TEST(Cell, PointsSurviveTheRoundTrip) {
  Pcg32 rng(2);
  for (int i = 0; i < 200000; ++i) {
    Dir d = random_dir(rng);
    if (i % 4 == 0) d = dir_from_angles(1e-7 * rng.uniform(), 6.28 * rng.uniform());  // near the pole
    EXPECT_LT(length(direction(face_point(d)) - d), 1e-13);
  }
}

TEST(Cell, FastPointsAreTheSamePoints) {
  Pcg32 rng(6);
  for (int i = 0; i < 200000; ++i) {
    const Dir d = random_dir(rng);
    const FacePoint a = face_point(d), b = face_point_fast(d);
    EXPECT_LT(length(direction(b) - d), 2e-8);
    if (a.face == b.face) {
      EXPECT_LT(std::fabs(a.x - b.x) + std::fabs(a.y - b.y), 2e-8);
    }
  }
  for (const Dir d : {Dir{0, 0, 1}, Dir{0, 0, -1}, Dir{1, 0, 0}, Dir{-1, 0, 0}, Dir{0, 1, 0}, Dir{0, -1, 0}})
    EXPECT_LT(length(direction(face_point_fast(d)) - d), 2e-8);
}

TEST(Cell, CodeHoldsOrderAndIndex) {
  for (int order = 0; order <= kMaxOrder; ++order)
    for (const uint32_t index : {0u, cell_count(order) / 3, cell_count(order) - 1}) {
      const CellId id = CellId::of(order, index);
      EXPECT_EQ(id.order(), order);
      EXPECT_EQ(id.index(), index);
      EXPECT_EQ(cell_at(order, xy_of(id)), id);
      if (order > 0) {
        EXPECT_EQ(id.parent().child(index % 4), id);
      }
    }
}

// The unit square maps to a cell with constant density: equal parts of the square have equal solid angle, measured by
// where uniform directions of the sphere fall in face coordinates.
TEST(Cell, FaceCoordinatesAreUniform) {
  Pcg32 rng(3);
  std::vector<double> seen(12 * 16, 0.0);
  const int n = 480000;
  for (int i = 0; i < n; ++i) {
    const FacePoint p = face_point(random_dir(rng));
    ++seen[static_cast<size_t>(p.face * 16 + static_cast<int>(4 * p.y) * 4 + static_cast<int>(4 * p.x))];
  }
  double chi = 0;
  for (const double s : seen) chi += (s - n / 192.0) * (s - n / 192.0) / (n / 192.0);
  EXPECT_LT(chi, 191 + 4 * std::sqrt(2 * 191.0));
}

TEST(Cell, NeighboursTouchAndAreMutual) {
  for (const int order : {0, 1, 3, 5})
    for (uint32_t i = 0; i < cell_count(order); ++i) {
      const CellId id = CellId::of(order, i);
      std::set<uint32_t> seen;
      for (const CellId n : edge_neighbours(id)) {
        seen.insert(n.code);
        const auto back = edge_neighbours(n);
        EXPECT_NE(std::find(back.begin(), back.end(), id), back.end());
        if (order > 1) {
          EXPECT_LT(angle_between(center_of(id), center_of(n)), 2.2 * std::sqrt(cell_solid_angle(order)));
        }
      }
      EXPECT_EQ(seen.size(), 4u);
    }
}

TEST(Cell, MirrorImageIsTheCellOfTheMirroredDirection) {
  Pcg32 rng(4);
  for (int i = 0; i < 100000; ++i) {
    const Dir d = random_dir(rng);
    const int order = i % 9;
    EXPECT_EQ(mirrored(cell_of(d, order)), cell_of(Dir{d.x, -d.y, d.z}, order));
  }
}

TEST(Cell, CosineIntegralsAddUp) {
  for (int order = 0; order <= 6; ++order) {
    double upper = 0, both = 0;
    for (uint32_t i = 0; i < cell_count(order); ++i) {
      upper += cosine_integral(CellId::of(order, i));
      both += cosine_integral(CellId::of(order, i), true);
    }
    EXPECT_NEAR(upper, kPi, 1e-12);
    EXPECT_NEAR(both, 2 * kPi, 1e-12);
  }
}

TEST(Tree, FindsTheLeafThatHoldsADirection) {
  // Refine towards one direction.
  const Dir target = dir_from_angles(0.7, 1.1);
  std::vector<CellId> leaves;
  for (uint32_t f = 0; f < 12; ++f) {
    CellId cell = CellId::of(0, f);
    if (cell_of(target, 0) != cell) {
      leaves.push_back(cell);
      continue;
    }
    for (int order = 1; order <= 9; ++order) {
      const CellId next = cell_of(target, order);
      for (uint32_t k = 0; k < 4; ++k)
        if (cell.child(k) != next) leaves.push_back(cell.child(k));
      cell = next;
    }
    leaves.push_back(cell);
  }
  const Tree tree(leaves);
  Pcg32 rng(5);
  for (int i = 0; i < 100000; ++i) {
    const Dir d = i % 2 ? random_dir(rng) : normalized(target + random_dir(rng) * 0.01);
    const int leaf = tree.leaf(face_point(d));
    ASSERT_GE(leaf, 0);
    const CellId id = tree.cell(static_cast<size_t>(leaf));
    EXPECT_EQ(cell_of(d, id.order()), id);
  }
}

}  // namespace
}  // namespace suite::sqt::cell_test
