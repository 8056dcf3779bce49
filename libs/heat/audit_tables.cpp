#include <algorithm>
#include <cmath>

#include "heat/audit_walk.h"

namespace suite {

namespace {

// Coefficients of powers, at a temperature.
template <class Arrays>
std::vector<double> at_kelvin(const Arrays& coefficients, double kelvin, bool slope) {
  std::vector<double> out(coefficients[0].size(), 0.0);
  for (size_t p = 0; p < coefficients.size(); ++p)
    for (size_t i = 0; i < out.size(); ++i)
      out[i] +=
          coefficients[p][i] * std::pow(kelvin, static_cast<double>(p)) * (slope ? static_cast<double>(p + 1) : 1);
  return out;
}

double between(const std::vector<double>& times, const std::vector<double>& values, double t) {
  const auto after = std::upper_bound(times.begin(), times.end(), t) - times.begin();
  if (after == 0) return values.front();
  if (after == static_cast<std::ptrdiff_t>(times.size())) return values.back();
  const auto k = static_cast<size_t>(after);
  return values[k - 1] + (values[k] - values[k - 1]) * (t - times[k - 1]) / (times[k] - times[k - 1]);
}

}  // namespace

AuditTables::AuditTables(const AuditedScene& scene, const SolvedSurfaces& solved)
    : solved_(solved),
      moments_(solved.history.moments),
      begin_(solved.loads.begin),
      end_(begin_),
      behind_(scene.faces.size()) {
  constexpr double kDay = 86400;
  for (const double step : solved.loads.steps) end_ += step;
  step_ = (end_ - begin_) / static_cast<double>(moments_ - 1);
  past_ = scene.periodic ? end_ - begin_ : std::min(end_ - begin_, std::ceil(kDay / step_ - 0.5) * step_);
  const Histories& kelvin = solved.history.kelvin;
  for (size_t face = 0; face < kelvin.rows(); ++face)
    for (size_t k = 0; k < moments_; ++k)
      reference_ += kelvin.at(face, k) / static_cast<double>(kelvin.rows() * moments_);
  for (uint32_t g = 0; g < solved.groups.size(); ++g) {
    const SurfaceGroup& group = solved.groups[g];
    double mean = 0;
    for (uint32_t i = 0; i < group.front_rows.size(); ++i) {
      behind_[group.front_rows[i]] = {g, i, false};
      if (!group.back_rows.empty()) behind_[group.back_rows[i]] = {g, i, true};
      for (size_t k = 0; k < moments_; ++k)
        mean +=
            solved.history.kelvin_at(group.front_rows[i], k) / static_cast<double>(moments_ * group.front_rows.size());
    }
    Column column{&group, {}, {}, {}};
    if (!group.layers.empty()) {
      const SlabGrid grid = make_slab_grid(group.layers, SlabBatchOptions{}.resolution, !group.back_rows.empty());
      column.capacity = at_kelvin(grid.heat, mean, true);
      column.conductance = at_kelvin(grid.conductance, mean, false);
      column.source = grid.source;
    }
    columns_.push_back(std::move(column));
  }
}

// Before a span that does not repeat its first day does.
double AuditTables::wrapped(double t) const {
  if (t >= begin_ && t <= end_) return t;
  return t - std::floor((t - begin_) / past_) * past_;
}

double AuditTables::position(double t) const {
  return std::clamp((t - begin_) / (end_ - begin_), 0.0, 1.0) * static_cast<double>(moments_ - 1);
}

double AuditTables::mirrored(uint32_t face, double t) const {
  if (solved_.sun.beam_by_mirrors.rows() == 0) return 0;
  return at(solved_.sun.beam_by_mirrors, face, t) * at(solved_.weather.direct, 0, t);
}

FaceTraits AuditTables::traits(uint32_t face) const {
  const Behind& b = behind_[face];
  const SurfaceGroup& group = *columns_[b.group].group;
  return b.back ? group.back_of(b.element) : group.front_of(b.element);
}

FaceWeather AuditTables::air(double t) const {
  const AirSeries& air = solved_.loads.air;
  if (air.repeat) {
    const double length = air.times.back() - air.times.front();
    t -= std::floor((t - air.times.front()) / length) * length;
  }
  FaceWeather w;
  w.air_kelvin = between(air.times, air.kelvin, t), w.wind = between(air.times, air.wind, t);
  w.vapour_pressure = between(air.times, air.vapour_pressure, t), w.pressure = air.pressure;
  return w;
}

}  // namespace suite
