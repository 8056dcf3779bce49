#include "scheduler/points_in_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/interrupt.h"
#include "light/far_points.h"
#include "sensor/point_images.h"

namespace suite {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

class PointsInView {
 public:
  PointsInView(const Primed& primed, const SeesPoints& sensor, const Polarimetry* polarimetry, const Capture& capture,
               CaptureResult& result)
      : primed_(primed),
        sensor_(sensor),
        polarimetry_(polarimetry),
        capture_(capture),
        result_(result),
        projection_(primed.projection()),
        star_column_(static_cast<size_t>(std::find(result.truth_names.begin(), result.truth_names.end(), "star") -
                                         result.truth_names.begin())) {
    if (star_column_ < result.truth_names.size()) marks_.assign(result.problems(), 0.0);
  }

  void add(const FarPoints& all, uint16_t light, std::vector<SeenPoint>& seen) {
    Contribution direct;
    direct.light = light;
    shares_.assign(result_.channels, behind(0));
    for (size_t c = 1; c < result_.channels; ++c) {
      const int component = primed_.channels.component(c);
      shares_[c] =
          component > 0 ? behind(component) : behind(0) * static_cast<double>(primed_.channels.share(c, direct));
    }
    for (const FarPoint& point : all.points) {
      constexpr double kGrace = 0.5;  // s
      stop_point(kGrace);
      add(all, point, seen);
    }
  }

 private:
  // Component of the Stokes vector that the sensor makes of unpolarised light of intensity 1.
  double behind(int component) const {
    const Polarimetry* const how = polarimetry_;
    if (how && how->analyser) return (*how->analyser)(static_cast<size_t>(component), 0);
    return component == 0 ? 1 : 0;
  }

  void add(const FarPoints& all, const FarPoint& point, std::vector<SeenPoint>& seen) {
    std::vector<double> above;
    given_.clear();
    SeenPoint found{point.name, point.v, 0, 0, std::vector<double>(result_.bands, 0.0)};
    double weight = 0, time = -1;
    Vec3 origin;
    const auto direction_at = [&](double t) { return all.direction_at(point, t); };
    sensor_.image_point(capture_, direction_at, std::pow(10, -0.4 * point.v), [&](const PointShare& s) {
      if (above.empty()) above = all.irradiance(point, primed_.state());
      // Shares of one moment have one line of sight.
      if (weight == 0 || s.time != time || !(s.origin == origin))
        look(above, time = s.time, origin = s.origin, direction_at(s.time));
      take(s, found);
      weight += s.weight;
      const Capture::Place at = capture_.place_of(s.problem);
      found.column += s.weight * (at.column + 0.5), found.row += s.weight * (at.row + 0.5);
    });
    if (!(weight > 0) || std::none_of(found.irradiance.begin(), found.irradiance.end(), [](double e) { return e > 0; }))
      return;
    mark(seen.size() + 1);
    found.column /= weight, found.row /= weight;
    for (double& e : found.irradiance) e /= weight;
    seen.push_back(std::move(found));
  }

  // What arrives of a point along a line of sight, per bin.
  void look(const std::vector<double>& above, double time, Vec3 origin, Dir d) {
    arriving_.assign(above.size(), 0.0);
    if (is_hidden(time, origin, d)) return;
    std::vector<float> T(above.size(), 1.0f);
    if (const auto& air = primed_.kit.environment->atmosphere) air->transmittance(origin, d, kFar, T);
    for (size_t k = 0; k < above.size(); ++k) arriving_[k] = above[k] * static_cast<double>(T[k]);
  }

  bool is_hidden(double time, Vec3 origin, Dir d) const {
    if (const auto& earth = primed_.kit.environment->earth) {
      if (earth->meet(origin, d, kFar)) return true;
    } else if (d.z < 0) {
      const Vec3 from = origin + Vec3{0, 0, 6371e3};
      const double along = dot(from, d);
      if (along < 0 && dot(from, from) - along * along < 6371e3 * 6371e3) return true;
    }
    Ray ray{origin, d, time};
    uint8_t blocked = 0;
    TraceStatistics statistics;
    primed_.tracer->occluded({&ray, 1}, {&kFar, 1}, {&blocked, 1}, false, statistics);
    return blocked;
  }

  void take(const PointShare& s, SeenPoint& found) {
    per_bin_.resize(arriving_.size());
    for (size_t k = 0; k < arriving_.size(); ++k)
      per_bin_[k] =
          static_cast<float>(s.weight * arriving_[k] * (s.spectral.empty() ? 1.0 : static_cast<double>(s.spectral[k])));
    sums_.assign(result_.bands, 0.0);
    projection_.add(per_bin_, sums_);
    double* const row = &result_.radiance[s.problem * result_.values_per_problem()];
    for (size_t c = 0; c < result_.channels; ++c)
      for (size_t b = 0; b < result_.bands; ++b) row[c * result_.bins * result_.bands + b] += shares_[c] * sums_[b];
    for (size_t b = 0; b < result_.bands; ++b) found.irradiance[b] += sums_[b];
    if (!marks_.empty()) given_[s.problem] += std::accumulate(sums_.begin(), sums_.end(), 0.0);
  }

  // Pixels that the point gives more of than others do, where it leaves a share of its light that is worth the name.
  void mark(size_t row) {
    constexpr double kLeast = 0.01;
    double whole = 0;
    for (const auto& [problem, light] : given_) whole += light;
    for (const auto& [problem, light] : given_) {
      if (!(light >= kLeast * whole && light > marks_[problem])) continue;
      marks_[problem] = light;
      result_.truth[problem * result_.truth_names.size() + star_column_] = static_cast<double>(row);
    }
  }

  const Primed& primed_;
  const SeesPoints& sensor_;
  const Polarimetry* const polarimetry_;  // null: the sensor tells no polarisation
  const Capture& capture_;
  CaptureResult& result_;
  const BandProjection& projection_;
  std::vector<double> shares_;    // of channels
  std::vector<double> arriving_;  // W/(m2 um), per bin
  std::vector<float> per_bin_;
  std::vector<double> sums_;
  const size_t star_column_;        // of the truth
  std::vector<double> marks_;       // most light that a point gives, by problem; empty: nobody asks
  std::map<size_t, double> given_;  // by problem, of the point at hand
};

}  // namespace

void add_points(const Primed& primed, Sensor& sensor, const Capture& capture, CaptureResult& result) {
  auto* const sees = dynamic_cast<SeesPoints*>(&sensor);
  if (!sees || !sees->sees_points(capture) || !primed.pipeline.leaves_points()) return;
  std::vector<SeenPoint> seen;
  bool any = false;
  PointsInView view(primed, *sees, sensor.polarimetry(), capture, result);
  const auto& lights = primed.kit.environment->lights;
  for (size_t i = 0; i < lights.size(); ++i)
    if (const FarPoints* points = lights[i]->points()) any = true, view.add(*points, static_cast<uint16_t>(i), seen);
  if (any) sees->take_points(capture, std::move(seen));
}

}  // namespace suite
