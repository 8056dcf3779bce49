#include "motion/rpc.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace suite {

namespace {

constexpr size_t kTerms = 20, kUnknowns = 2 * kTerms - 1, kFewest = 80;
constexpr double kLeastDenominator = 0.02;  // 1 at the middle
constexpr int kRounds = 6;

Rpc::Terms terms(double p, double l, double h) {
  return {1,         l,         p,         h,         l * p,     l * h,     p * h,     l * l,     p * p,     h * h,
          p * l * h, l * l * l, l * p * p, l * h * h, l * l * p, p * p * p, p * h * h, l * l * h, p * p * h, h * h * h};
}

double sum(const Rpc::Terms& a, const Rpc::Terms& b) {
  double s = 0;
  for (size_t i = 0; i < kTerms; ++i) s += a[i] * b[i];
  return s;
}

double turned(double longitude, const Rpc::Scale& about) {
  return about.offset + std::remainder(longitude - about.offset, 360);
}
Rpc::Terms terms_at(const Rpc& r, const Geodetic& g) {
  const auto in = [](double x, const Rpc::Scale& s) { return (x - s.offset) / s.scale; };
  return terms(in(g.latitude_deg, r.latitude_deg), in(turned(g.longitude_deg, r.longitude_deg), r.longitude_deg),
               in(g.height_m, r.height_m));
}

Rpc::Scale spanning(double low, double high) {
  const double half = 0.5 * (high - low);
  return {0.5 * (low + high), half > 0 ? half : 1};
}
template <class Of>
Rpc::Scale span_of(std::span<const SightedPlace> places, Of&& of) {
  double low = of(places[0]), high = low;
  for (const SightedPlace& p : places) low = std::min(low, of(p)), high = std::max(high, of(p));
  return spanning(low, high);
}

using Row = std::array<double, kUnknowns + 1>;  // of a matrix, and its right side

// Least squares by Householder reflections; takes the rows apart.
std::array<double, kUnknowns> solved(std::vector<Row>& rows) {
  for (size_t k = 0; k < kUnknowns; ++k) {
    double norm = 0;
    for (size_t i = k; i < rows.size(); ++i) norm += rows[i][k] * rows[i][k];
    norm = std::copysign(std::sqrt(norm), rows[k][k]);
    // The ridge keeps every column from vanishing.
    rows[k][k] += norm;
    for (size_t j = k + 1; j <= kUnknowns; ++j) {
      double s = 0;
      for (size_t i = k; i < rows.size(); ++i) s += rows[i][k] * rows[i][j];
      s /= norm * rows[k][k];
      for (size_t i = k; i < rows.size(); ++i) rows[i][j] -= s * rows[i][k];
    }
    rows[k][k] = -norm;
  }
  std::array<double, kUnknowns> x{};
  for (size_t k = kUnknowns; k-- > 0;) {
    double s = rows[k][kUnknowns];
    for (size_t j = k + 1; j < kUnknowns; ++j) s -= rows[k][j] * x[j];
    x[k] = s / rows[k][k];
  }
  return x;
}

// numerator - value * denominator = 0 for all places, weighted by the denominator of the round before.
void fit(std::span<const Rpc::Terms> at, std::span<const double> value, Rpc::Terms& numerator, Rpc::Terms& denominator,
         double relative) {
  denominator = {1};
  const double ridge = relative * std::sqrt(static_cast<double>(at.size()));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Row> rows(at.size() + kUnknowns, Row{});
    for (size_t i = 0; i < at.size(); ++i) {
      const double weight = 1 / std::max(std::fabs(sum(denominator, at[i])), kLeastDenominator);
      for (size_t t = 0; t < kTerms; ++t) rows[i][t] = weight * at[i][t];
      for (size_t t = 1; t < kTerms; ++t) rows[i][kTerms + t - 1] = -weight * value[i] * at[i][t];
      rows[i][kUnknowns] = weight * value[i];
    }
    for (size_t k = 0; k < kUnknowns; ++k) rows[at.size() + k][k] = ridge;
    const std::array<double, kUnknowns> x = solved(rows);
    std::copy_n(x.begin(), kTerms, numerator.begin());
    std::copy(x.begin() + kTerms, x.end(), denominator.begin() + 1);
  }
}

}  // namespace

Vec2 Rpc::image(const Geodetic& place) const {
  const Terms at = terms_at(*this, place);
  return {sample.offset + sample.scale * sum(sample_numerator, at) / sum(sample_denominator, at),
          line.offset + line.scale * sum(line_numerator, at) / sum(line_denominator, at)};
}

std::optional<Rpc> fit_rpc(std::span<const SightedPlace> places, double ridge) {
  if (places.size() < kFewest) return std::nullopt;
  Rpc r;
  r.longitude_deg = {places[0].place.longitude_deg, 1};
  r.latitude_deg = span_of(places, [](const SightedPlace& p) { return p.place.latitude_deg; });
  r.longitude_deg = span_of(
      places, [about = r.longitude_deg](const SightedPlace& p) { return turned(p.place.longitude_deg, about); });
  r.height_m = span_of(places, [](const SightedPlace& p) { return p.place.height_m; });
  r.line = span_of(places, [](const SightedPlace& p) { return p.line; });
  r.sample = span_of(places, [](const SightedPlace& p) { return p.sample; });
  std::vector<Rpc::Terms> at;
  std::vector<double> line, sample;
  for (const SightedPlace& p : places) {
    at.push_back(terms_at(r, p.place));
    line.push_back((p.line - r.line.offset) / r.line.scale);
    sample.push_back((p.sample - r.sample.offset) / r.sample.scale);
  }
  fit(at, line, r.line_numerator, r.line_denominator, ridge);
  fit(at, sample, r.sample_numerator, r.sample_denominator, ridge);
  for (size_t i = 0; i < at.size(); ++i) {
    if (!(sum(r.line_denominator, at[i]) > kLeastDenominator) ||
        !(sum(r.sample_denominator, at[i]) > kLeastDenominator))
      return std::nullopt;
    const Vec2 p = r.image(places[i].place);
    const double off = std::hypot(p.x - places[i].sample, p.y - places[i].line);
    r.rms += off * off, r.largest = std::max(r.largest, off);
  }
  r.rms = std::sqrt(r.rms / static_cast<double>(at.size()));
  return r;
}

}  // namespace suite
