// Damaged point clouds: one Error or points, never anything else.
#include "formats/las/las.h"

#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/las_kit.h"

namespace suite::format_las_las_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const PointCloud cloud = parse_las(bytes, "fuzz.las", report);
  if (cloud.kind.size() != cloud.places.size()) throw std::runtime_error("a class is missing");
  for (const Vec3& p : cloud.places)
    if (!finite(p)) throw std::runtime_error("a place that is none came out");
}

std::vector<test::LasPoint> points() {
  std::vector<test::LasPoint> all;
  for (int k = 0; k < 40; ++k) all.push_back({500000.0 + k, 5600000, k * 0.5, k % 7, k == 9});
  return all;
}

TEST(FuzzLas, Old) { test::fuzz(test::bytes_of(test::las(points())), read_and_check, 1); }
TEST(FuzzLas, New) { test::fuzz(test::bytes_of(test::las(points(), 4, 6)), read_and_check, 2); }

}  // namespace
}  // namespace suite::format_las_las_test
