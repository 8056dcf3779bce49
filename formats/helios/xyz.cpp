#include "formats/helios/xyz.h"

#include <algorithm>
#include <cmath>

#include "base/text_lines.h"
#include "scene/voxel_mesh.h"

namespace suite::helios {

namespace {

constexpr double kMostCells = 33554432;  // 2^25
constexpr size_t kMostFaces = 1u << 20;
constexpr double kFarthest = 1e9;  // m

std::vector<Vec3> points_of(std::string_view text, const std::string& file, const std::string& separators) {
  const std::string between = separators + " \t\r";
  TextLines lines(text, file);
  std::vector<Vec3> points;
  while (lines.next_raw()) {
    const std::string_view line = lines.line();
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(between); at != line.npos && words.size() < 3;) {
      const size_t end = std::min(line.find_first_of(between, at), line.size());
      words.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(between, end);
    }
    if (words.empty() || words[0].starts_with('#') || words[0].starts_with("//")) continue;
    lines.set_words(std::move(words));
    const auto number = [&](size_t i, const char* what) { return lines.number_in(i, what, -kFarthest, kFarthest); };
    points.push_back({number(0, "x"), number(1, "y"), number(2, "z")});
  }
  if (points.empty()) throw lines.error_at_end("a point cloud without a point", "rows of x y z");
  return points;
}

}  // namespace

Cubes cubes_of_xyz(std::string_view text, const std::string& file, const std::string& separators, double edge_m) {
  const std::vector<Vec3> points = points_of(text, file, separators);
  Box3 box;
  for (const Vec3& p : points) box.grow(p);
  const Vec3 size = box.high - box.low;
  std::array<uint32_t, 3> cells{};
  const double along[3] = {size.x, size.y, size.z};
  double all = 1;
  for (size_t a = 0; a < 3; ++a) all *= std::max(1.0, std::ceil(along[a] / edge_m));
  if (!(all <= kMostCells))
    throw Error(Where{file, 0, 0, {}, -1}, strf("%.3g cells of %g m", all, edge_m), "a larger voxelSize");
  for (size_t a = 0; a < 3; ++a) cells[a] = static_cast<uint32_t>(std::max(1.0, std::ceil(along[a] / edge_m)));
  std::vector<uint16_t> full(static_cast<size_t>(all), 0);
  Cubes made;
  made.points = points.size();
  for (const Vec3& p : points) {
    const double off[3] = {p.x - box.low.x, p.y - box.low.y, p.z - box.low.z};
    size_t cell[3];
    for (size_t a = 0; a < 3; ++a) cell[a] = std::min<size_t>(static_cast<size_t>(off[a] / edge_m), cells[a] - 1);
    uint16_t& here = full[(cell[2] * cells[1] + cell[1]) * cells[0] + cell[0]];
    here = 1;
  }
  for (size_t x = 0; x < cells[0]; ++x)
    for (size_t y = 0; y < cells[1]; ++y)
      for (size_t z = 0; z < cells[2]; ++z)
        if (full[(z * cells[1] + y) * cells[0] + x])
          made.centres.push_back(box.low + edge_m * Vec3{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                                                         static_cast<double>(z) + 0.5});
  const Affine3 place{{edge_m, 0, 0, 0, edge_m, 0, 0, 0, edge_m}, box.low};
  const SourceMesh mesh = voxel_faces(cells, place, full, {1});
  if (mesh.indices.size() / 3 > kMostFaces)
    throw Error(Where{file, 0, 0, {}, -1}, strf("%zu faces of cubes", mesh.indices.size() / 3), "a larger voxelSize");
  for (const Vec3& p : mesh.positions) made.obj += strf("v %.17g %.17g %.17g\n", p.x, p.y, p.z);
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    made.obj += strf("f %u %u %u\n", mesh.indices[i] + 1, mesh.indices[i + 1] + 1, mesh.indices[i + 2] + 1);
  return made;
}

}  // namespace suite::helios
