#include "air/greek_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "air/ordinate_angles.h"

namespace suite {

void wigner_d(int m, int n, double x, std::span<double> values) {
  std::fill(values.begin(), values.end(), 0.0);
  const int first = std::max(std::abs(m), std::abs(n)), count = static_cast<int>(values.size());
  if (first >= count) return;
  // The square of the first one: a binomial distribution.
  const int down = std::abs(m - n), up = std::abs(m + n);
  double square = 1;
  for (int i = 1; i <= down; ++i) square *= (1 - x) / 2 * (up + i) / i;
  for (int i = 1; i <= up; ++i) square *= (1 + x) / 2;
  const bool odd = n < m && (m - n) % 2 != 0;
  values[static_cast<size_t>(first)] = (odd ? -1 : 1) * std::sqrt(std::max(0.0, square));
  double before = 0;
  for (int l = first; l + 1 < count; ++l) {
    const double here = values[static_cast<size_t>(l)], k = l + 1;
    double next = x;  // l = 0
    if (l > 0)
      next = ((2.0 * l + 1) * (l * k * x - m * n) * here -
              k * std::sqrt((l * l - m * m) * double(l * l - n * n)) * before) /
             (l * std::sqrt((k * k - m * m) * (k * k - n * n)));
    before = here;
    values[static_cast<size_t>(l) + 1] = next;
  }
}

GreekMatrix GreekMatrix::rayleigh(double depolarisation) {
  const double delta = (1 - depolarisation) / (1 + depolarisation / 2),
               turning = (1 - 2 * depolarisation) / (1 - depolarisation);
  GreekMatrix g;
  g.degrees.resize(3);
  g.degrees[0].a1 = 1;
  g.degrees[1].a4 = 1.5 * delta * turning;
  g.degrees[2].a1 = delta / 2;
  g.degrees[2].a2 = 3 * delta;
  g.degrees[2].b1 = -std::sqrt(6.0) / 2 * delta;
  return g;
}

GreekMatrix GreekMatrix::depolarising(std::span<const double> moments) {
  GreekMatrix g;
  for (size_t l = 0; l < moments.size(); ++l) g.degrees.emplace_back().a1 = static_cast<double>(2 * l + 1) * moments[l];
  return g;
}

GreekMatrix GreekMatrix::tabulated(std::span<const double> cosines, std::span<const PlaneBlocks> blocks, size_t count) {
  GreekMatrix g;
  g.degrees.resize(count);
  std::vector<double> d00(count), d02(count), d22(count), d2m(count);
  const GaussRule rule = gauss_rule(4);
  for (size_t i = 0; i + 1 < cosines.size(); ++i)
    for (size_t k = 0; k < rule.nodes.size(); ++k) {
      const double width = cosines[i + 1] - cosines[i], x = cosines[i] + rule.nodes[k] * width;
      const PlaneBlocks p =
          (blocks[i] * (1 - rule.nodes[k]) + blocks[i + 1] * rule.nodes[k]) * (rule.weights[k] * width);
      wigner_d(0, 0, x, d00), wigner_d(0, 2, x, d02), wigner_d(2, 2, x, d22), wigner_d(2, -2, x, d2m);
      for (size_t l = 0; l < count; ++l) {
        Degree& to = g.degrees[l];
        const double part = static_cast<double>(2 * l + 1) / 2, sum = part * (p.a2 + p.c) * d22[l],
                     difference = part * (p.a2 - p.c) * d2m[l];
        to.a1 += part * p.a * d00[l], to.a4 += part * p.c2 * d00[l];
        to.a2 += (sum + difference) / 2, to.a3 += (sum - difference) / 2;
        to.b1 += part * p.b * d02[l], to.b2 += part * p.d * d02[l];
      }
    }
  const double mean = count > 0 ? g.degrees[0].a1 : 0;
  for (Degree& d : g.degrees)
    if (mean > 0) d = {d.a1 / mean, d.a2 / mean, d.a3 / mean, d.a4 / mean, d.b1 / mean, d.b2 / mean};
  return g;
}

PlaneBlocks GreekMatrix::at(double cosine) const {
  std::vector<double> d00(degrees.size()), d02(d00), d22(d00), d2m(d00);
  wigner_d(0, 0, cosine, d00), wigner_d(0, 2, cosine, d02), wigner_d(2, 2, cosine, d22), wigner_d(2, -2, cosine, d2m);
  PlaneBlocks b{0, 0, 0, 0, 0, 0};
  for (size_t l = 0; l < degrees.size(); ++l) {
    const Degree& g = degrees[l];
    const double sum = (g.a2 + g.a3) * d22[l], difference = (g.a2 - g.a3) * d2m[l];
    b = b + PlaneBlocks{g.a1 * d00[l], g.b1 * d02[l],          (sum - difference) / 2,
                        g.b2 * d02[l], (sum + difference) / 2, g.a4 * d00[l]};
  }
  return b;
}

void GreekMatrix::add(const GreekMatrix& other, double share) {
  if (degrees.size() < other.degrees.size()) degrees.resize(other.degrees.size());
  for (size_t l = 0; l < other.degrees.size(); ++l) {
    const Degree& from = other.degrees[l];
    Degree& to = degrees[l];
    to.a1 += share * from.a1, to.a2 += share * from.a2, to.a3 += share * from.a3, to.a4 += share * from.a4;
    to.b1 += share * from.b1, to.b2 += share * from.b2;
  }
}

Stokes scattered_once(const PlaneBlocks& blocks, Dir k_out, Dir k_in) {
  return ScatteringPlane(k_out, -k_in).matrix(blocks) * Stokes{1, 0, 0, 0};
}

}  // namespace suite
