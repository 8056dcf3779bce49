#include "scene/mesh_builder.h"

#include <array>
#include <cmath>
#include <functional>

#include "math/polygon.h"

namespace suite {

namespace {
constexpr double kFarthest = 1e15;  // of the file's units
}

size_t MeshBuilder::HashOfPlace::operator()(const Vec3& v) const {
  size_t h = 0;
  for (const double c : {v.x, v.y, v.z}) h = (h ^ std::hash<double>()(c)) * 0x9E3779B97F4A7C15u;
  return h ^ (h >> 29);
}

void MeshBuilder::part(std::string group, std::string material, int line) {
  if (!mesh_.runs.empty() && !new_run_ && next_.group == group && next_.material == material) return;
  next_ = {std::move(group), std::move(material), 0, line};
  new_run_ = true;
}

bool MeshBuilder::is_place(Vec3 v, const Where& where) {
  if (std::fabs(v.x) < kFarthest && std::fabs(v.y) < kFarthest && std::fabs(v.z) < kFarthest) return true;
  add("SP203", where, strf("(%g, %g, %g) is no place, or absurdly far away", v.x, v.y, v.z));
  return false;
}

uint32_t MeshBuilder::vertex(Vec3 v, const Where& where) {
  const Vec3 place{v.x + 0.0, v.y + 0.0, v.z + 0.0};  // -0 is the same place as 0
  const auto [at, fresh] = shared_.try_emplace(place, static_cast<uint32_t>(mesh_.positions.size()));
  if (fresh) mesh_.positions.push_back(place);
  if (mesh_.positions.size() > kNone - 4) throw Error(where, "more than 2^32 - 4 vertices");
  return at->second;
}

void MeshBuilder::triangle(uint32_t a, uint32_t b, uint32_t c) {
  if (new_run_) {
    next_.first_triangle = static_cast<uint32_t>(mesh_.indices.size() / 3);
    mesh_.runs.push_back(next_);
    new_run_ = false;
  }
  mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
}

void MeshBuilder::polygon(std::span<const uint32_t> corners, const Where& where) {
  if (corners.size() < 3) return add("SP202", where, strf("%zu corners", corners.size()));
  if (corners.size() == 3) return triangle(corners[0], corners[1], corners[2]);
  ring_.clear();
  for (const uint32_t c : corners) ring_.push_back(mesh_.positions[c]);
  bool clean = true;
  for (const auto& t : split_polygon(ring_, clean))
    triangle(corners[static_cast<size_t>(t[0])], corners[static_cast<size_t>(t[1])],
             corners[static_cast<size_t>(t[2])]);
  if (!clean) add("SP206", where, strf("a polygon of %zu corners", corners.size()));
}

void MeshBuilder::holed_polygon(std::vector<uint32_t> corners, std::vector<size_t> ring_ends, const Where& where) {
  if (ring_ends.size() < 2) return polygon(corners, where);
  mesh_.holed.push_back({next_.group, next_.material, std::move(corners), std::move(ring_ends), where});
}

SourceMesh MeshBuilder::take() {
  if (mesh_.runs.empty()) mesh_.runs.push_back({"", "", 0, 0});
  return std::move(mesh_);
}

}  // namespace suite
