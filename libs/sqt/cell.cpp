#include "sqt/cell.h"

#include <algorithm>
#include <cmath>
#ifdef __BMI2__
#include <immintrin.h>
#endif

namespace suite::sqt {

namespace {

// Latitude of the faces' southern corners in units of 1/nside rings, and their longitude in units of pi/4.
constexpr int kRing[12] = {2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4};
constexpr int kLongitude[12] = {1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7};

#ifdef __BMI2__
uint32_t spread(uint32_t v) { return _pdep_u32(v, 0x55555555u); }  // bits of v to the even places
uint32_t gather(uint32_t r) { return _pext_u32(r, 0x55555555u); }  // the even bits of r
#else
uint32_t spread(uint32_t v) {  // bits of v to the even places
  uint64_t r = v;
  r = (r | (r << 8)) & 0x00FF00FFu;
  r = (r | (r << 4)) & 0x0F0F0F0Fu;
  r = (r | (r << 2)) & 0x33333333u;
  r = (r | (r << 1)) & 0x55555555u;
  return static_cast<uint32_t>(r);
}
uint32_t gather(uint32_t r) {  // the even bits of r
  r &= 0x55555555u;
  r = (r | (r >> 1)) & 0x33333333u;
  r = (r | (r >> 2)) & 0x0F0F0F0Fu;
  r = (r | (r >> 4)) & 0x00FF00FFu;
  r = (r | (r >> 8)) & 0x0000FFFFu;
  return r;
}
#endif

inline double below_one(double v) { return std::min(std::max(v, 0.0), 0x1.fffffffffffffp-1); }

}  // namespace

namespace {

// Azimuth in right angles, [0, 4).
double quarter_exact(double x, double y) {
  const double quarter = std::atan2(y, x) * (2 / kPi);
  return quarter < 0 ? quarter + 4 : quarter;
}
// The same by the Taylor series of atan within tan(pi/8), without branches; 0 for x = y = 0.
inline double quarter_fast(double x, double y) {
  const double ax = std::fabs(x), ay = std::fabs(y);
  const double low = std::min(ax, ay), high = std::max(ax, ay);
  const bool upper = low > 0.41421356237309503 * high;  // beyond pi/8: atan t = pi/4 - atan((1 - t) / (1 + t))
  const double n = upper ? high - low : low, m = upper ? high + low : high;
  const double t = n / std::max(m, 1e-300), t2 = t * t, t4 = t2 * t2, t8 = t4 * t4;
  const double series = ((1 - t2 * (1.0 / 3)) + t4 * (1.0 / 5 - t2 * (1.0 / 7))) +
                        t8 * (((1.0 / 9 - t2 * (1.0 / 11)) + t4 * (1.0 / 13 - t2 * (1.0 / 15))) + t8 * (1.0 / 17));
  double q = (2 / kPi) * t * series;
  q = upper ? 0.5 - q : q;
  q = ay > ax ? 1 - q : q;
  q = x < 0 ? 2 - q : q;
  return y < 0 ? 4 - q : q;
}

// s2 = 1 - z^2.
inline FacePoint from_azimuth(double quarter, double z, double s2) {
  quarter = quarter >= 4 ? 0 : quarter;
  const double z_abs = std::fabs(z);
  if (z_abs <= 2.0 / 3) {  // equatorial belt: lines of constant x and y are straight in (azimuth, z)
    const double up = 0.5 + quarter + 0.75 * z, down = 0.5 + quarter - 0.75 * z;
    const int iu = static_cast<int>(up), id = static_cast<int>(down);
    const int face = iu == id ? (iu & 3) | 4 : id < iu ? id & 3 : (iu & 3) + 8;
    return {face, below_one(up - iu), below_one(1 - (down - id))};
  }
  // Polar caps; 1 - |z| from the horizontal part, which keeps its digits at the pole.
  const int q = std::min(3, static_cast<int>(quarter));
  const double within = quarter - q;
  const double r = std::sqrt(3 * s2 / (1 + z_abs));
  const double a = std::min(1.0, within * r), b = std::min(1.0, (1 - within) * r);
  if (z > 0) return {q, below_one(1 - b), below_one(1 - a)};
  return {q + 8, below_one(a), below_one(b)};
}

}  // namespace

FacePoint face_point(Dir d) { return from_azimuth(quarter_exact(d.x, d.y), d.z, d.x * d.x + d.y * d.y); }
FacePoint face_point_fast(Dir d) { return from_azimuth(quarter_fast(d.x, d.y), d.z, d.x * d.x + d.y * d.y); }
FacePoint face_point_fast(double x, double y, double z, double s2) { return from_azimuth(quarter_fast(x, y), z, s2); }

namespace {

// Height, distance from the axis, and azimuth in units of pi/4.
struct Cylinder {
  double z, s, eighths;
};
inline Cylinder cylinder(FacePoint p) {
  const double ring = kRing[p.face] - p.x - p.y;  // 0 at the north pole, 4 at the south pole
  double width = 1, z, s;
  if (ring < 1 || ring > 3) {
    width = ring < 1 ? ring : 4 - ring;
    const double t = width * width / 3;
    z = ring < 1 ? 1 - t : t - 1;
    s = std::sqrt(t * (2 - t));
  } else {
    z = (2 - ring) * (2.0 / 3);
    s = std::sqrt((1 - z) * (1 + z));
  }
  return {z, s, width > 1e-15 ? kLongitude[p.face] + (p.x - p.y) / width : 0};
}

}  // namespace

Dir direction(FacePoint p) {
  const Cylinder c = cylinder(p);
  const double phi = (kPi / 4) * c.eighths;
  return {c.s * std::cos(phi), c.s * std::sin(phi), c.z};
}

Dir direction_fast(FacePoint p) {
  // Cosine and sine of the nearest multiple of pi/4, turned by the rest (at most pi/8, Taylor).
  constexpr double h = 0.70710678118654752;
  constexpr double kCos[10] = {h, 1, h, 0, -h, -1, -h, 0, h, 1}, kSin[10] = {-h, 0, h, 1, h, 0, -h, -1, -h, 0};
  const Cylinder c = cylinder(p);
  const int n = static_cast<int>(c.eighths + 1.5);  // azimuths from -pi/4 to 2 pi
  const double r = (c.eighths + 1 - n) * (kPi / 4), r2 = r * r, r4 = r2 * r2;
  const double sine = r * ((1 - r2 * (1.0 / 6)) + r4 * ((1.0 / 120 - r2 * (1.0 / 5040)) + r4 * (1.0 / 362880)));
  const double cosine =
      (1 - r2 * 0.5) + r4 * ((1.0 / 24 - r2 * (1.0 / 720)) + r4 * (1.0 / 40320 - r2 * (1.0 / 3628800)));
  return {c.s * (kCos[n] * cosine - kSin[n] * sine), c.s * (kSin[n] * cosine + kCos[n] * sine), c.z};
}

CellXY xy_of(CellId cell) {
  const int order = cell.order();
  const uint32_t index = cell.index(), within = index & ((1u << (2 * order)) - 1);
  return {static_cast<int>(index >> (2 * order)), gather(within), gather(within >> 1)};
}

CellId cell_at(int order, CellXY at) {
  return CellId::of(order, (static_cast<uint32_t>(at.face) << (2 * order)) + spread(at.x) + (spread(at.y) << 1));
}

CellId cell_of(FacePoint p, int order) {
  const double n = static_cast<double>(1u << order);
  return cell_at(order, {p.face, static_cast<uint32_t>(p.x * n), static_cast<uint32_t>(p.y * n)});
}

void directions_in(CellId cell, int side, double* x, double* y, double* z) {
  struct Turned {
    double eighths = NAN, cosine = 0, sine = 0;
  };
  std::array<Turned, 63> diagonals;  // points of one have nearly, in the equatorial belt mostly exactly, one azimuth
  const CellXY c = xy_of(cell);
  const double n = static_cast<double>(1u << cell.order());
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const Cylinder at = cylinder({c.face, (c.x + (i + 0.5) / side) / n, (c.y + (j + 0.5) / side) / n});
      Turned& turned = diagonals[static_cast<size_t>(i - j + side - 1)];
      if (turned.eighths != at.eighths) {
        const double phi = (kPi / 4) * at.eighths;
        turned = {at.eighths, std::cos(phi), std::sin(phi)};
      }
      const auto k = static_cast<size_t>(j * side + i);
      x[k] = at.s * turned.cosine, y[k] = at.s * turned.sine, z[k] = at.z;
    }
}

FacePoint point_in(CellId cell, Vec2 u) {
  const CellXY c = xy_of(cell);
  const double n = static_cast<double>(1u << cell.order());
  return {c.face, (c.x + u.x) / n, (c.y + u.y) / n};
}

namespace {

// What lies across edge e (-x, +x, -y, +y) of a face: the other face, its edge, and whether the running coordinate
// turns round. Found from the geometry: shared edges have the same directions at a quarter and three quarters.
struct Across {
  int face, edge;
  bool reversed;
};
FacePoint on_edge(int face, int edge, double s) {
  return edge < 2 ? FacePoint{face, edge == 0 ? 0.0 : 1.0, s} : FacePoint{face, s, edge == 2 ? 0.0 : 1.0};
}
std::array<Across, 48> find_edges() {
  std::array<Across, 48> table{};
  for (int f = 0; f < 12; ++f)
    for (int e = 0; e < 4; ++e) {
      const Dir a = direction(on_edge(f, e, 0.25));
      for (int g = 0; g < 12; ++g)
        for (int h = 0; h < 4; ++h) {
          if (g == f) continue;
          const bool same = length(direction(on_edge(g, h, 0.25)) - a) < 1e-9;
          const bool turned = length(direction(on_edge(g, h, 0.75)) - a) < 1e-9;
          if (same || turned) table[static_cast<size_t>(4 * f + e)] = {g, h, turned};
        }
    }
  return table;
}
const std::array<Across, 48>& edges() {
  static const std::array<Across, 48> table = find_edges();
  return table;
}

}  // namespace

CellXY neighbour(CellXY c, int order, size_t e) {
  const uint32_t last = (1u << order) - 1;
  const uint32_t moving = e < 2 ? c.x : c.y, along = e < 2 ? c.y : c.x;
  const bool plus = e & 1;
  if (plus ? moving < last : moving > 0) {
    const uint32_t to = plus ? moving + 1 : moving - 1;
    return e < 2 ? CellXY{c.face, to, c.y} : CellXY{c.face, c.x, to};
  }
  const Across& a = edges()[4 * static_cast<size_t>(c.face) + e];
  const uint32_t side = a.edge & 1 ? last : 0, run = a.reversed ? last - along : along;
  return a.edge < 2 ? CellXY{a.face, side, run} : CellXY{a.face, run, side};
}

std::array<CellId, 4> edge_neighbours(CellId cell) {
  const int order = cell.order();
  const CellXY c = xy_of(cell);
  std::array<CellId, 4> out;
  for (size_t e = 0; e < 4; ++e) out[e] = cell_at(order, neighbour(c, order, e));
  return out;
}

namespace {
// z of the points with x + y = sum in a face.
double height(int face, double sum) {
  const double ring = kRing[face] - sum;
  if (ring < 1) return 1 - ring * ring / 3;
  if (ring > 3) return (4 - ring) * (4 - ring) / 3 - 1;
  return (2 - ring) * (2.0 / 3);
}
}  // namespace

double cosine_integral(CellId cell, bool both_sides) {
  // Over the cell, s = x + y has a triangular density; integrate max(z(s), 0) between the kinks by Gauss-Legendre.
  const CellXY c = xy_of(cell);
  const double h = 1.0 / static_cast<double>(1u << cell.order());
  const double low = (c.x + c.y) * h, mid = low + h, high = mid + h;
  std::array<double, 6> cut{low, mid, high, kRing[c.face] - 1.0, kRing[c.face] - 2.0, kRing[c.face] - 3.0};
  for (double& v : cut) v = std::clamp(v, low, high);
  std::sort(cut.begin(), cut.end());
  constexpr double kNode[2] = {0.33998104358485626, 0.86113631159405258},
                   kWeight[2] = {0.65214515486254614, 0.34785484513745386};
  double sum = 0;
  for (size_t i = 0; i + 1 < cut.size(); ++i) {
    const double half = 0.5 * (cut[i + 1] - cut[i]), center = 0.5 * (cut[i + 1] + cut[i]);
    if (half <= 0) continue;
    for (int k = 0; k < 4; ++k) {
      const double s = center + (k & 1 ? -1 : 1) * kNode[k >> 1] * half;
      const double z = height(c.face, s);
      sum += half * kWeight[k >> 1] * std::max(both_sides ? -z : 0.0, z) * (h - std::fabs(s - mid));
    }
  }
  return kFaceSolidAngle * sum;
}

CellXY mirrored(CellXY c) {
  // phi -> -phi exchanges x and y; polar faces 0..3 go to 3..0, the belt's 4 and 6 stay, 5 and 7 change places.
  const int face = c.face < 4 ? 3 - c.face : c.face >= 8 ? 19 - c.face : 4 + (4 - (c.face - 4)) % 4;
  return {face, c.y, c.x};
}
CellId mirrored(CellId cell) { return cell_at(cell.order(), mirrored(xy_of(cell))); }

}  // namespace suite::sqt
