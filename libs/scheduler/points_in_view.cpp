#include "scheduler/points_in_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/interrupt.h"
#include "light/far_points.h"
#include "light/night/stars.h"
#include "scheduler/point_sight.h"
#include "sensor/point_images.h"
#include "transport/channels.h"
#include "transport/flat_mirrors.h"

namespace suite {

namespace {

class PointsInView {
 public:
  PointsInView(const Primed& primed, const SeesPoints& sensor, const Polarimetry* polarimetry, const Capture& capture,
               CaptureResult& result)
      : primed_(primed),
        sight_(primed),
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
    for (const FarPoint& point : all.points) {
      constexpr double kGrace = 0.5;  // s
      stop_point(kGrace);
      set_shares(light, false);
      add(all, point, nullptr, seen);
      for (const Dir& mirror : sight_.mirrors()) {
        set_shares(light, true);
        add(all, point, &mirror, seen);
      }
    }
  }

 private:
  // Component of the Stokes vector that the sensor makes of unpolarised light of intensity 1.
  double behind(int component) const {
    const Polarimetry* const how = polarimetry_;
    if (how && how->analyser) return (*how->analyser)(static_cast<size_t>(component), 0);
    return component == 0 ? 1 : 0;
  }

  void set_shares(uint16_t light, bool mirrored) {
    Contribution c;
    c.light = light;
    if (mirrored) c.order = c.smooth = 1, c.events = by_surface | by_dirac;
    shares_.assign(result_.channels, behind(0));
    for (size_t i = 1; i < result_.channels; ++i) {
      const int component = primed_.channels.component(i);
      shares_[i] = component > 0 ? behind(component) : behind(0) * static_cast<double>(primed_.channels.share(i, c));
    }
  }

  // mirror: the normal of that in which the point is looked for; null = none.
  void add(const FarPoints& all, const FarPoint& point, const Dir* mirror, std::vector<SeenPoint>& seen) {
    std::vector<double> above;
    given_.clear();
    SeenPoint found{point.name, point.v, 0, 0, std::vector<double>(result_.bands, 0.0)};
    double weight = 0, time = -1;
    Vec3 origin;
    const auto direction_at = [&](double t, Vec3 from) {
      const Dir d = all.direction_at(point, {t, from});
      return mirror ? FlatMirrors::mirrored(d, *mirror) : d;
    };
    sensor_.image_point(capture_, direction_at, std::pow(10, -0.4 * point.v), [&](const PointShare& s) {
      if (above.empty()) above = twinkling(all, point, {s.time, s.origin});
      // Shares of one moment have one line of sight.
      if (weight == 0 || s.time != time || !(s.origin == origin))
        look(above, {time = s.time, origin = s.origin, direction_at(s.time, s.origin),
                     all.direction_at(point, {s.time, s.origin}), mirror != nullptr});
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

  // Above the air, in the mean of the exposure.
  std::vector<double> twinkling(const FarPoints& all, const FarPoint& point, const PointLook& look) const {
    std::vector<double> above = all.irradiance(point, primed_.state(), look);
    const double factor = all.scintillation_of(static_cast<size_t>(&point - all.points.data()),
                                               {sensor_.aperture(capture_), capture_.window.begin, capture_.window.end,
                                                look.from, all.direction_at(point, look)});
    for (double& e : above) e *= factor;
    return above;
  }

  // What arrives of a point along a line of sight, per bin.
  void look(const std::vector<double>& above, const PointSight::Sightline& sight) {
    const std::span<const double> share = sight_.look(sight);
    arriving_.resize(above.size());
    for (size_t k = 0; k < above.size(); ++k) arriving_[k] = above[k] * share[k];
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
  PointSight sight_;
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

namespace {

// Materials of smooth surfaces that have no images of far points. none: whether no surface has.
std::set<std::string> without_images(const Tracer& tracer, const Optics& optics, bool none) {
  const Scene& scene = tracer.scene();
  const FlatMirrors flat(tracer, optics);
  std::set<std::string> names;
  const auto smooth = [&](uint32_t material) {
    const ScatterModel* const model = material == kNone ? nullptr : optics.material(material).model;
    return model && model->has_delta();
  };
  const auto of = [&](const TracedObject& o) {
    std::vector<uint32_t> all;
    if (o.material_override != kNone)
      all.push_back(o.material_override);
    else if (o.primitive != kNone)
      all.push_back(scene.primitives[o.primitive].material);
    else
      for (const Part& part : scene.meshes[o.mesh].parts) all.push_back(part.material);
    std::erase_if(all, [&](uint32_t material) { return !smooth(material); });
    return all;
  };
  const auto is_smooth = [&](const TracedObject& o) { return !of(o).empty(); };
  tracer.each("smooth surfaces", is_smooth, [&](uint32_t number, const TracedObject& object) {
    Hit hit;
    hit.object = number;
    if (none || !flat.has(hit))
      for (const uint32_t material : of(object)) names.insert("'" + scene.materials[material].id + "'");
  });
  return names;
}

}  // namespace

std::optional<Diagnostic> diagnose_points(const Tracer& tracer, const Environment& environment, const Optics& optics,
                                          const Sensor& sensor) {
  if (!dynamic_cast<const SeesPoints*>(&sensor)) return std::nullopt;
  size_t count = 0;
  const FarPoint* brightest = nullptr;
  for (const auto& light : environment.lights)
    if (const FarPoints* points = light->points())
      for (const FarPoint& p : points->points) {
        if (p.moving || p.direction.z < 0) continue;
        ++count;
        if (!brightest || p.v < brightest->v) brightest = &p;
      }
  if (count == 0) return std::nullopt;
  const bool stokes = ChannelPlan(sensor.channels()).of_stokes();
  const std::set<std::string> names = without_images(tracer, optics, stokes || tracer.periodic());
  if (names.empty()) return std::nullopt;
  std::string listed;
  for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
  constexpr double kCell = 3.05e-3;  // sr, 10 square degrees
  const double bright = brightest->scale * kVegaIrradiance * flux_of(brightest->v);
  return Diagnostic{
      Dr::caustics_not_found,
      strf(
          "sensor '%s': stars and planets (%zu) have no images in smooth surfaces (%s)%s: there each is spread over a "
          "cell of 3 degrees, the brightest (%s, V = %.2f) as some %.2g W/(m2 sr um) at 0.55 um in place of a glint of "
          "%.2g W/(m2 um) times the reflectance; the mean is right, the glints are left out",
          sensor.name().c_str(), count, listed.c_str(),
          stokes              ? " seen by a polarimeter"
          : tracer.periodic() ? " of a scene that repeats itself"
                              : " that are curved, move or look in too many directions",
          brightest->name.c_str(), brightest->v, bright / kCell, bright)};
}

}  // namespace suite
