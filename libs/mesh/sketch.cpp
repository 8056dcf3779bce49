#include "mesh/sketch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "scene/primitives.h"

namespace suite {

namespace {

// Materials of the triangles of a mesh.
std::vector<uint32_t> materials_of(const Mesh& mesh) {
  std::vector<uint32_t> all(mesh.triangle_count(), kNone);
  for (const Part& p : mesh.parts) std::fill_n(all.begin() + p.first_triangle, p.triangle_count, p.material);
  return all;
}

Vec3 corner(const Mesh& m, size_t index) {
  const float* p = &m.positions[3 * size_t{m.indices[index]}];
  return {p[0], p[1], p[2]};
}

double area_of(const Mesh& m, size_t t) {
  const Vec3 a = corner(m, 3 * t);
  return 0.5 * length(cross(corner(m, 3 * t + 1) - a, corner(m, 3 * t + 2) - a));
}

// Triangles in the order of their materials.
void order(Sketch& s) {
  std::vector<uint32_t> by(s.material.size());
  std::iota(by.begin(), by.end(), 0u);
  std::stable_sort(by.begin(), by.end(), [&](uint32_t a, uint32_t b) { return s.material[a] < s.material[b]; });
  std::vector<uint32_t> indices, material;
  for (const uint32_t t : by) {
    material.push_back(s.material[t]);
    for (size_t k = 0; k < 3; ++k) indices.push_back(s.indices[3 * size_t{t} + k]);
  }
  s.indices = std::move(indices), s.material = std::move(material);
}

Sketch all_of(const Mesh& m) {
  Sketch s;
  s.positions.assign(m.positions.begin(), m.positions.begin() + static_cast<ptrdiff_t>(3 * m.vertex_count()));
  s.indices.assign(m.indices.begin(), m.indices.end());
  s.material = materials_of(m);
  return s;
}

// Corners within cells of this edge are one.
Sketch clustered(const Mesh& m, const std::vector<uint32_t>& materials, const Box3& box, double cell) {
  Sketch s;
  std::unordered_map<uint64_t, uint32_t> number;
  std::vector<uint32_t> to(m.vertex_count());
  std::vector<Vec3> sum;
  std::vector<uint32_t> count;
  const auto key = [&](double v, double low) { return static_cast<uint64_t>((v - low) / cell) & 0x1fffff; };
  for (size_t v = 0; v < to.size(); ++v) {
    const float* p = &m.positions[3 * v];
    const uint64_t k = key(p[0], box.low.x) << 42 | key(p[1], box.low.y) << 21 | key(p[2], box.low.z);
    to[v] = number.try_emplace(k, static_cast<uint32_t>(sum.size())).first->second;
    if (to[v] == sum.size()) sum.push_back({}), count.push_back(0);
    sum[to[v]] = sum[to[v]] + Vec3{p[0], p[1], p[2]}, ++count[to[v]];
  }
  for (size_t i = 0; i < sum.size(); ++i) {
    sum[i] = sum[i] * (1.0 / count[i]);
    for (const double x : {sum[i].x, sum[i].y, sum[i].z}) s.positions.push_back(static_cast<float>(x));
  }
  for (size_t v = 0; v < to.size(); ++v) {
    const float* p = &m.positions[3 * v];
    s.moved = std::max(s.moved, length(sum[to[v]] - Vec3{p[0], p[1], p[2]}));
  }
  std::unordered_set<uint64_t>
      known;  // triangles that are there, by a hash of their corners: a chance twin is one less
  for (size_t t = 0; t < m.triangle_count(); ++t) {
    std::array<uint64_t, 3> c{to[m.indices[3 * t]], to[m.indices[3 * t + 1]], to[m.indices[3 * t + 2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    std::array<uint64_t, 3> sorted = c;
    std::sort(sorted.begin(), sorted.end());
    const uint64_t hash =
        (sorted[0] * 0x9e3779b97f4a7c15u ^ sorted[1]) * 0xbf58476d1ce4e5b9u ^ sorted[2] * 0x94d049bb133111ebu;
    if (!known.insert(hash).second) continue;
    for (const uint64_t i : c) s.indices.push_back(static_cast<uint32_t>(i));
    s.material.push_back(materials[t]);
  }
  return s;
}

double area_of(const Sketch& s) {
  double area = 0;
  const auto at = [&](size_t i) {
    const float* p = &s.positions[3 * size_t{s.indices[i]}];
    return Vec3{p[0], p[1], p[2]};
  };
  for (size_t t = 0; t < s.material.size(); ++t)
    area += 0.5 * length(cross(at(3 * t + 1) - at(3 * t), at(3 * t + 2) - at(3 * t)));
  return area;
}

// Every n-th triangle, larger by n.
Sketch thinned(const Mesh& m, const std::vector<uint32_t>& materials, size_t most) {
  Sketch s;
  s.thinned = true;
  const size_t step = (m.triangle_count() + most - 1) / most;
  const double grow = std::sqrt(static_cast<double>(step));
  for (size_t t = 0; t < m.triangle_count(); t += step) {
    const std::array<Vec3, 3> c{corner(m, 3 * t), corner(m, 3 * t + 1), corner(m, 3 * t + 2)};
    const Vec3 middle = (c[0] + c[1] + c[2]) * (1.0 / 3);
    for (const Vec3& p : c) {
      const Vec3 q = middle + (p - middle) * grow;
      s.moved = std::max(s.moved, length(q - p));
      s.indices.push_back(static_cast<uint32_t>(s.positions.size() / 3));
      for (const double x : {q.x, q.y, q.z}) s.positions.push_back(static_cast<float>(x));
    }
    s.material.push_back(materials[t]);
  }
  return s;
}

// A surface of columns x rows quadrangles; place(u, v): u and v from 0 to 1.
template <class Place>
void add_grid(Sketch& s, int columns, int rows, const Place& place) {
  const auto first = static_cast<uint32_t>(s.positions.size() / 3);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const Vec3 p = place(static_cast<double>(c) / columns, static_cast<double>(r) / rows);
      for (const double x : {p.x, p.y, p.z}) s.positions.push_back(static_cast<float>(x));
    }
  const auto at = [&](int c, int r) { return first + static_cast<uint32_t>(r * (columns + 1) + c); };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      for (const uint32_t i : {at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r), at(c + 1, r + 1), at(c, r + 1)})
        s.indices.push_back(i);
}

// A ring or disk at a height, and the side of a cone.
void add_cone(Sketch& s, int around, double r0, double z0, double r1, double z1) {
  add_grid(s, around, 1, [&](double u, double v) {
    const double r = r0 + (r1 - r0) * v, a = 2 * kPi * u;
    return Vec3{r * std::cos(a), r * std::sin(a), z0 + (z1 - z0) * v};
  });
}

void add_rectangle(Sketch& s, Vec3 low, Vec3 u, Vec3 v) {
  add_grid(s, 1, 1, [&](double a, double b) { return low + u * a + v * b; });
}

void add_box(Sketch& s, Vec3 low, Vec3 high) {
  const Vec3 d = high - low, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
  add_rectangle(s, low, y, x), add_rectangle(s, low, x, z), add_rectangle(s, low, z, y);
  add_rectangle(s, low + z, x, y), add_rectangle(s, low + y, z, x), add_rectangle(s, low + x, y, z);
}

}  // namespace

Sketch sketch_of(const Mesh& m, size_t most) {
  const size_t n = m.triangle_count();
  Sketch s;
  if (n <= most) {
    s = all_of(m);
  } else {
    const std::vector<uint32_t> materials = materials_of(m);
    const Box3 box = box_of_positions(m);
    const Vec3 size = box.size();
    const double longest = std::max({size.x, size.y, size.z});
    double area = 0;
    for (size_t t = 0; t < n; ++t) area += area_of(m, t);
    // A plane surface has two triangles a cell.
    double cell = std::max(std::sqrt(2 * area / static_cast<double>(most)), longest / 0x1ffff0);
    const Box3 local{box.low - m.origin, box.high - m.origin};
    for (int pass = 0;;
         ++pass, cell *= 1.05 * std::sqrt(static_cast<double>(s.material.size()) / static_cast<double>(most))) {
      s = clustered(m, materials, local, cell);
      if (s.material.size() <= most || !(cell < longest) || pass > 20) break;
    }
    if (s.material.size() > most || area_of(s) < 0.5 * area) s = thinned(m, materials, most);
  }
  s.origin = m.origin, s.before = n;
  order(s);
  return s;
}

Sketch sketch_of(const Primitive& p, double reach, int around) {
  Sketch s;
  const std::vector<double>& a = p.parameters;
  switch (p.kind) {
    case PrimitiveKind::plane: {
      const double x = a[0] > 0 ? a[0] / 2 : reach, y = a[1] > 0 ? a[1] / 2 : reach;
      add_rectangle(s, {-x, -y, 0}, {2 * x, 0, 0}, {0, 2 * y, 0});
      break;
    }
    case PrimitiveKind::disk:
      add_cone(s, around, a[0], 0, a[1], 0);
      break;
    case PrimitiveKind::box: {
      const double r = is_layer(a) ? reach : 0;
      add_box(s, {a[0] - r, a[1] - r, a[2]}, {a[3] + r, a[4] + r, a[5]});
      break;
    }
    case PrimitiveKind::sphere:
      add_grid(s, around, around / 2, [&](double u, double v) {
        const double r = a[0] * std::sin(kPi * v);
        return Vec3{r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), -a[0] * std::cos(kPi * v)};
      });
      break;
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder: {
      const bool cone = p.kind == PrimitiveKind::cone;
      const double r1 = cone ? a[1] : a[0], height = cone ? a[2] : a[1];
      add_cone(s, around, a[0], 0, r1, height);
      if (cone ? a[3] != 0 : a[2] != 0) add_cone(s, around, 0, 0, a[0], 0), add_cone(s, around, r1, height, 0, height);
      break;
    }
    case PrimitiveKind::sinusoid:
      add_grid(s, 2 * around, 2 * around, [&](double u, double v) {
        const double x = (u - 0.5) * a[0], y = (v - 0.5) * a[1];
        double z = 0;
        for (size_t i = 2; i + 3 < a.size(); i += 4) z += a[i] * std::sin(a[i + 1] * x + a[i + 2] * y + a[i + 3]);
        return Vec3{x, y, z};
      });
      break;
  }
  s.before = s.indices.size() / 3;
  s.material.assign(s.before, p.material);
  return s;
}

}  // namespace suite
