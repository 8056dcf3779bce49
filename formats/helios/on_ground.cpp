#include "formats/helios/on_ground.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/text_lines.h"
#include "formats/helios/xyz.h"
#include "scene/source_model.h"

namespace suite::helios {

namespace {

using Visit = std::function<void(Vec3)>;
using AddFinding = std::function<void(const char*, const Part&, const std::string&)>;

// The corners of triangles, each as often as it is one; of cubes their centres.
class Corners {
 public:
  explicit Corners(const HeliosFiles& files) : files_(files) {}
  void each(const Part& part, const Visit& visit) {
    Affine3 place = scaling({part.scale, part.scale, part.scale});
    for (const Turn& turn : part.turns) place = rotation(turn.axis, turn.angle_deg * kPi / 180) * place;
    place = translation(part.shift) * place;
    if (part.kind == Part::Kind::terrain) return terrain(part, [&](Vec3 p) { visit(place.point(p)); });
    if (part.y_up) place = place * kFromYUp;
    for (const Vec3& p : listed(part)) visit(place.point(p));
  }

 private:
  const std::vector<Vec3>& listed(const Part& part);
  void terrain(const Part& part, const Visit& visit);

  const HeliosFiles& files_;
  std::map<std::string, std::vector<Vec3>> listed_;
  std::map<std::string, HeliosHeights> terrains_;
};

const std::vector<Vec3>& Corners::listed(const Part& part) {
  const std::string key = part.path + strf("\n%.17g ", part.edge_m) + part.separators;
  const auto [at, fresh] = listed_.try_emplace(key);
  if (!fresh) return at->second;
  if (part.kind == Part::Kind::points) {
    at->second = cubes_of_xyz(files_.text_of(part.path), part.path, part.separators, part.edge_m).centres;
  } else {
    const SourceMesh mesh = files_.mesh_of(part.path);
    for (const uint32_t i : mesh.indices) at->second.push_back(mesh.positions[i]);
  }
  return at->second;
}

// Two triangles between four heights, none where one is missing.
void Corners::terrain(const Part& part, const Visit& visit) {
  const auto [at, fresh] = terrains_.try_emplace(part.path);
  if (fresh) at->second = files_.heights_of(part.path);
  const HeliosHeights& grid = at->second;
  const auto height = [&](size_t column, size_t row) { return grid.heights[row * grid.width + column]; };
  const auto triangle = [&](const size_t(&columns)[3], const size_t(&rows)[3]) {
    for (size_t k = 0; k < 3; ++k)
      if (!std::isfinite(height(columns[k], rows[k]))) return;
    for (size_t k = 0; k < 3; ++k)
      visit({grid.corner[0] + (static_cast<double>(columns[k]) + 0.5) * grid.pixel[0],
             grid.corner[1] - (static_cast<double>(rows[k]) + 0.5) * grid.pixel[1], height(columns[k], rows[k])});
  };
  for (size_t c = 0; c + 1 < grid.width; ++c)
    for (size_t r = 0; r + 1 < grid.height; ++r) {
      triangle({c, c, c + 1}, {r, r + 1, r});
      triangle({c, c + 1, c + 1}, {r + 1, r + 1, r});
    }
}

// Materials of a file by their names: whether they are ground.
std::map<std::string, bool> grounds_of(const std::string& text, const std::string& file) {
  std::map<std::string, bool> found;
  std::string name;
  for (TextLines lines(text, file); lines.next();) {
    if (lines.words() < 2) continue;
    std::string value(lines.word(1));
    if (lines.word(0) == "newmtl") found[name = value] = false;
    std::transform(value.begin(), value.end(), value.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (lines.word(0) == "helios_isGround") found[name] = value == "true" || value == "1";
  }
  return found;
}

// Of the first face of a mesh.
bool mesh_is_ground(const Part& part, const HeliosFiles& files) {
  const std::string text = files.text_of(part.path);
  const std::filesystem::path folder = std::filesystem::path(part.path).parent_path();
  std::map<std::string, bool> grounds;
  std::string material = "default";
  for (TextLines lines(text, part.path); lines.next();) {
    if (lines.word(0) == "f") break;
    if (lines.words() < 2) continue;
    if (lines.word(0) == "usemtl") material = lines.word(1);
    if (lines.word(0) != "mtllib") continue;
    std::string name(lines.word(1));
    for (size_t i = 2; i < lines.words(); ++i) name += " " + std::string(lines.word(i));
    name = (folder / name).generic_string();
    grounds.merge(grounds_of(files.text_of(name), name));
  }
  return grounds[material];
}

bool is_ground(const Part& part, const HeliosFiles& files) {
  if (part.kind == Part::Kind::mesh) return mesh_is_ground(part, files);
  if (part.kind == Part::Kind::voxels) return false;
  if (part.matfile.empty()) return part.kind == Part::Kind::points;  // there points are ground unless said
  const auto grounds = grounds_of(files.text_of(part.matfile), part.matfile);
  const auto at = part.material.empty() ? grounds.begin() : grounds.find(part.material);
  return at != grounds.end() && at->second;
}

struct Plane {
  Vec3 centre, normal;
  double rms = 0;  // distance of the points, m
  double height(Vec3 p) const {
    return centre.z - (normal.x * (p.x - centre.x) + normal.y * (p.y - centre.y)) / normal.z;
  }
};

// Turns the axes of a symmetric matrix until it is diagonal (C. G. J. Jacobi, 1846); the columns of `axes` are them.
void diagonalise(double (&m)[3][3], double (&axes)[3][3]) {
  for (int sweep = 0; sweep < 60; ++sweep)
    for (size_t p = 0; p < 2; ++p)
      for (size_t q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double half = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]), c = std::cos(half), s = std::sin(half);
        for (size_t k = 0; k < 3; ++k) {
          const double a = m[k][p], b = m[k][q], u = axes[k][p], v = axes[k][q];
          m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
          axes[k][p] = c * u - s * v, axes[k][q] = s * u + c * v;
        }
        for (size_t k = 0; k < 3; ++k) {
          const double a = m[p][k], b = m[q][k];
          m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
        }
      }
}

Plane plane_of(const Part& part, Corners& corners) {
  Plane plane;
  double n = 0, m[3][3] = {}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  corners.each(part, [&](Vec3 p) { plane.centre = plane.centre + p, ++n; });
  plane.centre = plane.centre / n;
  corners.each(part, [&](Vec3 p) {
    const Vec3 d = p - plane.centre;
    const double along[3] = {d.x, d.y, d.z};
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) m[i][j] += along[i] * along[j];
  });
  diagonalise(m, axes);
  size_t least = 0;
  for (size_t k = 1; k < 3; ++k)
    if (m[k][k] < m[least][least]) least = k;
  plane.normal = {axes[0][least], axes[1][least], axes[2][least]};
  plane.rms = std::sqrt(std::max(m[least][least], 0.0) / n);
  return plane;
}

struct Ground {
  size_t part;
  Box3 bounds;
  std::optional<Plane> plane;
};

class Placer {
 public:
  Placer(std::vector<Part>& parts, const HeliosFiles& files, const AddFinding& add_finding)
      : parts_(parts), files_(files), add_finding_(add_finding), corners_(files) {}
  void run() {
    find_grounds();
    for (Part& part : parts_)
      if (part.on_ground != 0) place(part);
  }

 private:
  void find_grounds();
  Ground* under(Vec3 lowest);
  void place(Part& part);

  std::vector<Part>& parts_;
  const HeliosFiles& files_;
  const AddFinding& add_finding_;
  Corners corners_;
  std::vector<Ground> grounds_;
};

void Placer::find_grounds() {
  for (size_t i = 0; i < parts_.size(); ++i) {
    try {
      if (!is_ground(parts_[i], files_)) continue;
    } catch (const Error& e) {
      add_finding_("SP705", parts_[i], "its materials cannot be read, so it is no ground for others: " + e.message());
      continue;
    }
    Ground ground{i, {}, {}};
    corners_.each(parts_[i], [&](Vec3 p) { ground.bounds.grow(p); });
    if (!ground.bounds.empty()) grounds_.push_back(ground);
  }
}

Ground* Placer::under(Vec3 p) {
  for (Ground& ground : grounds_) {
    const Box3& b = ground.bounds;
    if (p.x >= b.low.x && p.x <= b.high.x && p.y >= b.low.y && p.y <= b.high.y) return &ground;
  }
  return nullptr;
}

void Placer::place(Part& part) {
  if (part.kind == Part::Kind::voxels)
    return add_finding_("SP705", part, "'onGround' of voxels: they stand at their offset, not on the ground");
  Vec3 lowest{0, 0, INFINITY};
  long long all = 0;
  corners_.each(part, [&](Vec3 p) {
    if (p.z < lowest.z) lowest = p;
    ++all;
  });
  if (!all) return;
  Ground* const ground = under(lowest);
  if (!ground)
    return add_finding_(
        "SP707", part,
        "'onGround': no part with a material that says helios_isGround lies below; it stays at its offset, "
        "as there");
  const Part& of = parts_[ground->part];
  if (!ground->plane) ground->plane = plane_of(of, corners_);
  const Plane& plane = *ground->plane;
  if (!(std::abs(plane.normal.z) > 1e-12))
    return add_finding_("SP705", part, "'onGround': the ground '" + of.id + "' is upright; it stays at its offset");
  double above = lowest.z - plane.height(lowest);
  if (part.on_ground != 1) {
    const long long step = part.on_ground < 0 ? 1 : std::max(1LL, all / std::min(part.on_ground, all));
    long long k = 0;
    above = INFINITY;
    corners_.each(part, [&](Vec3 p) {
      if (k++ % step == 0) above = std::min(above, p.z - plane.height(p));
    });
  }
  part.shift.z -= above;
  add_finding_(
      "SP707", part,
      strf("'onGround': moved by %.3f m onto the plane through the ground '%s', as there; that ground is %.3f m (rms) "
           "beside the plane",
           -above, printable(of.id).c_str(), plane.rms));
}

}  // namespace

void put_on_ground(std::vector<Part>& parts, const HeliosFiles& files, const AddFinding& add_finding) {
  Placer(parts, files, add_finding).run();
}

}  // namespace suite::helios
