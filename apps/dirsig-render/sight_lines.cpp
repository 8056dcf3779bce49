#include "sight_lines.h"

#include <algorithm>
#include <array>

namespace suite {

namespace {

constexpr uint32_t kAcross = 20;  // pixels along an edge of a picture whose lines of sight are looked at
constexpr int kRays = 64;         // of a pixel: their mean is the middle of what it sees
constexpr int kLayers = 5;        // heights at which lines of sight are met

double radical_inverse(int index, int base) {
  double value = 0, digit = 1;
  for (; index; index /= base) digit /= base, value += digit * (index % base);
  return value;
}

std::vector<uint32_t> chosen(uint32_t count) {
  std::vector<uint32_t> at;
  const uint32_t n = std::min(count, kAcross + 1);
  for (uint32_t i = 0; i < n; ++i)
    at.push_back(n == 1 ? 0 : static_cast<uint32_t>(uint64_t{i} * (count - 1) / (n - 1)));
  return at;
}

std::optional<SightLine> mean_line(const Sensor& sensor, const Capture& capture, size_t problem) {
  constexpr std::array<int, 8> base{2, 3, 5, 7, 11, 13, 17, 19};
  std::vector<float> spectral(sensor.states()[capture.state].size());
  SightLine mean;
  std::array<double, 8> u{};
  for (int i = 1; i <= kRays; ++i) {
    for (size_t k = 0; k < u.size(); ++k) u[k] = radical_inverse(i, base[k]);
    const SensorRay ray =
        sensor.ray({capture, problem, std::span(u).first(static_cast<size_t>(sensor.numbers())), spectral});
    if (!(ray.weight > 0) || ray.receiver != SensorRay::Receiver::none || !finite(ray.ray.direction))
      return std::nullopt;
    mean.origin += ray.ray.origin / kRays, mean.direction += ray.ray.direction / kRays;
  }
  if (!(length(mean.direction) > 0)) return std::nullopt;
  mean.direction = normalized(mean.direction);
  return mean;
}

// The ground as surfaces of even height.
class Levels {
 public:
  explicit Levels(const GroundPlaces& places) : places_(places) {}
  double height(Vec3 p) const { return places_.on_earth() ? places_.frame().geodetic_from_enu(p).height_m : p.z; }
  Dir up(Vec3 p) const { return places_.on_earth() ? places_.frame().local_axes(p).z : Dir{0, 0, 1}; }
  // Where a line from above first meets a height: Newton's steps do not overshoot, since heights along a line are
  // convex. Nothing where it misses, or begins below.
  std::optional<Vec3> meet(const SightLine& line, double height_m) const {
    Vec3 p = line.origin;
    double above = height(p) - height_m;
    if (!(above > 0)) return std::nullopt;
    for (int i = 0; i < 60; ++i) {
      const double down = -dot(line.direction, up(p));
      if (!(down > 0)) return std::nullopt;
      p += line.direction * (above / down);
      above = height(p) - height_m;
      if (std::fabs(above) < 1e-5) return p;
    }
    return std::nullopt;
  }

 private:
  const GroundPlaces& places_;
};

struct Heights {
  double low = INFINITY, high = -INFINITY;
};
Heights heights_of(const GroundPlaces& places) {
  Heights h;
  for (size_t i = 0; i < places.size(); ++i)
    if (places.known(i)) h.low = std::min(h.low, places.height_m(i)), h.high = std::max(h.high, places.height_m(i));
  return h;
}

void check_against(const GroundPlaces& places, FittedRpc& fit) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places.known(i)) continue;
    const Vec2 at = fit.rpc.image(places.geodetic(i));
    const double off =
        std::hypot(at.x - static_cast<double>(i % places.columns()), at.y - static_cast<double>(i / places.columns()));
    sum += off * off, ++count;
    fit.largest = std::max(fit.largest, off);
  }
  fit.rms = std::sqrt(sum / count);
}

}  // namespace

SightLines::SightLines(uint32_t columns, uint32_t rows) : columns_(columns), rows_(rows) {}

void SightLines::add(const Delivery& d, uint32_t first_row) {
  const Capture& capture = d.sensor.tasks()[d.result.task].captures[d.result.capture];
  for (const uint32_t row : chosen(rows_)) {
    if (row < first_row || row - first_row >= d.result.rows) continue;
    for (const uint32_t column : chosen(columns_)) {
      auto line = mean_line(d.sensor, capture, size_t{row - first_row} * columns_ + column);
      if (!line) continue;
      line->column = column, line->row = row;
      lines_.push_back(*line);
    }
  }
}

bool horizon_in_view(const std::vector<SightLine>& lines, const GroundPlaces& places) {
  const Levels levels(places);
  const double low = heights_of(places).low, least = std::sin(kLeastElevation * kDegree);
  return std::any_of(lines.begin(), lines.end(), [&](const SightLine& line) {
    const auto at = levels.meet(line, low);
    return !at || -dot(line.direction, levels.up(*at)) < least;
  });
}

std::optional<FittedRpc> rpc_of(const std::vector<SightLine>& lines, const GroundPlaces& places) {
  if (!places.on_earth()) return std::nullopt;
  const Levels levels(places);
  Heights h = heights_of(places);
  if (!(h.low <= h.high)) return std::nullopt;
  double far = 0;
  for (const SightLine& line : lines)
    if (const auto at = levels.meet(line, h.low)) far = std::max(far, length(*at - line.origin));
  const double margin = 0.05 * (h.high - h.low) + std::clamp(0.01 * far, 0.1, 500.0);
  h.low -= margin, h.high += margin;
  std::vector<SightedPlace> seen;
  for (const SightLine& line : lines)
    for (int k = 0; k < kLayers; ++k)
      if (const auto at = levels.meet(line, h.low + (h.high - h.low) * k / (kLayers - 1)))
        seen.push_back({places.frame().geodetic_from_enu(*at), double(line.row), double(line.column)});
  // Jitter of few lines is no shape to follow: the ridge that leaves the places of all pixels the least residual.
  std::optional<FittedRpc> best;
  for (const double ridge : {kRpcRidge, 1e-4, 1e-2})
    if (const auto rpc = fit_rpc(seen, ridge)) {
      FittedRpc fit{*rpc};
      check_against(places, fit);
      if (!best || fit.rms < best->rms) best = fit;
    }
  return best;
}

}  // namespace suite
