#include "scene/vertex_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

namespace suite {

namespace {

class Smoother {
 public:
  Smoother(const SourceMesh& mesh, bool everywhere, double crease_rad)
      : mesh_(mesh), everywhere_(everywhere), any_edge_(crease_rad >= kPi), cosine_(std::cos(crease_rad)) {}

  VertexNormals run() {
    const size_t corners = mesh_.indices.size();
    places();
    fan_.resize(corners);
    std::iota(fan_.begin(), fan_.end(), 0u);
    for (size_t begin = 0; begin < order_.size();) {
      size_t end = begin;
      while (end < order_.size() && place(order_[end]) == place(order_[begin])) ++end;
      any_edge_ ? join_group(begin, end) : join_over_edges(begin, end);
      begin = end;
    }
    std::vector<Vec3> sum(corners);
    for (uint32_t c = 0; c < corners; ++c)
      if (smoothed(c)) sum[root(c)] += facet(c) * angle(c);
    return vertices(sum);
  }

 private:
  // The triangle's normal, unit or 0.
  Vec3 facet(uint32_t corner) const {
    const size_t t = corner / 3 * 3;
    const Vec3 a = at(t), n = cross(at(t + 1) - a, at(t + 2) - a);
    const double len = length(n);
    return len > 0 && std::isfinite(len) ? n / len : Vec3{};
  }
  double angle(uint32_t corner) const {
    const size_t t = corner / 3 * 3, k = corner % 3;
    const Vec3 p = at(corner), a = at(t + (k + 1) % 3) - p, b = at(t + (k + 2) % 3) - p;
    return std::atan2(length(cross(a, b)), dot(a, b));
  }
  Vec3 at(size_t corner) const { return mesh_.positions[mesh_.indices[corner]]; }
  uint32_t place(uint32_t corner) const { return first_[mesh_.indices[corner]]; }
  uint32_t group(uint32_t corner) const {
    return everywhere_ ? 1 : mesh_.smoothing.empty() ? 0 : mesh_.smoothing[corner / 3];
  }
  bool own(uint32_t corner) const {
    return !everywhere_ && !mesh_.normals.empty() && mesh_.normals[mesh_.indices[corner]] != kNoNormal;
  }
  bool smoothed(uint32_t corner) const { return !own(corner) && group(corner) != 0; }

  // Vertices at one place bit for bit count as one; corners are listed place by place.
  void places() {
    const std::vector<Vec3>& p = mesh_.positions;
    std::vector<uint32_t> order(p.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return std::tie(p[a].x, p[a].y, p[a].z, a) < std::tie(p[b].x, p[b].y, p[b].z, b);
    });
    first_.resize(p.size());
    for (size_t k = 0; k < order.size(); ++k)
      first_[order[k]] = k && p[order[k]] == p[order[k - 1]] ? first_[order[k - 1]] : order[k];
    for (uint32_t c = 0; c < mesh_.indices.size(); ++c)
      if (smoothed(c)) order_.push_back(c);
    std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
      return std::tuple(place(a), group(a), a) < std::tuple(place(b), group(b), b);
    });
  }

  uint32_t root(uint32_t corner) {
    while (fan_[corner] != corner) corner = fan_[corner] = fan_[fan_[corner]];
    return corner;
  }
  // The smaller number stays, so that the result does not depend on the order of the joints.
  void join(uint32_t a, uint32_t b) {
    a = root(a), b = root(b);
    fan_[std::max(a, b)] = std::min(a, b);
  }

  // All corners of one group at one place are one fan.
  void join_group(size_t begin, size_t end) {
    for (size_t k = begin + 1; k < end; ++k)
      if (group(order_[k]) == group(order_[k - 1])) join(order_[k - 1], order_[k]);
  }

  // Corners are one fan when edges that bend little enough lead from one to the other.
  void join_over_edges(size_t begin, size_t end) {
    struct Edge {
      uint32_t group, to, corner;
    };
    std::vector<Edge> edges;
    for (size_t k = begin; k < end; ++k) {
      const uint32_t c = order_[k], t = c / 3 * 3;
      for (const uint32_t other : {t + (c + 1) % 3, t + (c + 2) % 3})
        edges.push_back({group(c), first_[mesh_.indices[other]], c});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.group, a.to, a.corner) < std::tie(b.group, b.to, b.corner);
    });
    // Where more than two facets share an edge each is compared with the next only.
    for (size_t k = 1; k < edges.size(); ++k)
      if (edges[k].group == edges[k - 1].group && edges[k].to == edges[k - 1].to &&
          dot(facet(edges[k].corner), facet(edges[k - 1].corner)) >= cosine_ - 1e-12)
        join(edges[k - 1].corner, edges[k].corner);
  }

  // One output vertex for each source vertex and fan. Flat corners share theirs with no other facet.
  VertexNormals vertices(const std::vector<Vec3>& sum) {
    VertexNormals out;
    out.indices.resize(mesh_.indices.size());
    const auto add = [&](uint32_t v, Vec3 normal) {
      const double len = length(normal);
      out.from.push_back(v);
      out.normals.push_back(len > 0 ? normal / len : Vec3{0, 0, 1});
      return static_cast<uint32_t>(out.from.size() - 1);
    };
    std::vector<uint32_t> kept(mesh_.normals.empty() ? 0 : mesh_.positions.size(), kNone);
    // Open addressing; slots hold output vertices, whose fans are in `fans`.
    const size_t size = std::bit_ceil(2 * order_.size() + 2);
    std::vector<uint32_t> table(size, kNone), fans;
    for (uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const uint32_t v = mesh_.indices[c];
      uint32_t& made = out.indices[c];
      if (own(c)) {
        if (kept[v] == kNone) kept[v] = add(v, oct_decode(mesh_.normals[v]));
        made = kept[v];
      } else if (!smoothed(c)) {
        made = add(v, facet(c));
      } else {
        const uint32_t fan = root(c);
        uint64_t slot = (uint64_t{fan} << 32 | v) * 0xff51afd7ed558ccdull;
        slot = (slot ^ slot >> 32) & (size - 1);
        while (table[slot] != kNone && !(out.from[table[slot]] == v && fans[table[slot]] == fan))
          slot = (slot + 1) & (size - 1);
        if (table[slot] == kNone) table[slot] = add(v, sum[fan]);
        made = table[slot];
        fans.resize(out.from.size(), kNone);
        fans[made] = fan;
      }
    }
    return out;
  }

  const SourceMesh& mesh_;
  const bool everywhere_, any_edge_;
  const double cosine_;
  std::vector<uint32_t> first_;  // of each vertex: the first one at its place
  std::vector<uint32_t> order_;  // corners to smooth, by place and group
  std::vector<uint32_t> fan_;    // of each corner: another of its fan, at last itself
};

}  // namespace

VertexNormals vertex_normals(const SourceMesh& mesh, bool everywhere, double crease_rad) {
  return Smoother(mesh, everywhere, crease_rad).run();
}

}  // namespace suite
