#include "scheduler/air_left_out.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"
#include "scheduler/scene_albedo.h"
#include "scheduler/sensor_diagnostics.h"

namespace suite {

namespace {

// The bin of the shortest wavelength alone, where air scatters most.
SpectralState shortest(const SpectralState& state) {
  SpectralState one = state;
  one.shares.clear();
  one.bins = {*std::min_element(state.bins.begin(), state.bins.end(),
                                [](const Bin& a, const Bin& b) { return a.low_um < b.low_um; })};
  one.bins[0].weight = 1, one.bins[0].g = 0;
  one.knots = {0};
  one.reference_um = one.bins[0].center_um();
  return one;
}

// Depths of scattering of a way: all of it, and what lies below a height.
struct Depths {
  double all = 0, below = 0;
};
Depths scattering(const AirColumn& column, const Ray& ray, double top) {
  const double ground = column.shells.heights()[column.ground];
  const double length = column.shells.way_down_to(ray.origin, ray.direction, ground);
  Depths depths;
  column.shells.walk(ray.origin, ray.direction, length, [&](const Shells::Piece& piece) {
    double rate = 0;
    for (const AirColumn::Kind& kind : column.kinds) rate += double{kind.scattering[piece.layer]};
    const double low = std::min(piece.near_height, piece.far_height),
                 high = std::max(piece.near_height, piece.far_height);
    const double share = high > low ? std::clamp((top - low) / (high - low), 0.0, 1.0) : (low < top ? 1 : 0);
    depths.all += rate * piece.length;
    depths.below += share * rate * piece.length;
  });
  return depths;
}

}  // namespace

std::optional<AirLeftOut> left_out_of_air(const AirSpec& air, const std::shared_ptr<const Scene>& scene,
                                          const Sensor& sensor) {
  if (sensor.states().empty() || sensor.tasks().empty() || sensor.tasks()[0].captures.empty()) return std::nullopt;
  const Capture& capture = sensor.tasks()[0].captures[0];
  const SensorRay middle = middle_ray(sensor, capture, (capture.rows / 2) * capture.columns + capture.columns / 2);
  if (middle.receiver != SensorRay::Receiver::none) return std::nullopt;
  AirLeftOut out;
  const SpectralState one = shortest(sensor.states()[0]);
  out.um = one.bins[0].center_um();
  AirSpec without_gases = air;
  without_gases.gases = nullptr;
  const AirColumn column = bake_column(without_gases, one);
  const double top = scene->bounds.empty() ? 0 : scene->bounds.high.z;
  const Depths depths = scattering(column, middle.ray, top);
  if (!(depths.all > 0)) return std::nullopt;
  const Tracer tracer(scene, std::nullopt, {capture.window.begin, capture.window.begin});
  const SceneAlbedo albedo =
      scene_albedo(tracer, Optics(*scene, one, used_materials(tracer), {.pending = true}), capture.window.begin);
  if (albedo.of_bins.empty()) return std::nullopt;
  const double even = air.ground_of_scene || air.ground_of_any_scene
                          ? double{albedo.of_bins[0]}
                          : air.ground_albedo.mean(one.bins[0].low_um, one.bins[0].high_um);
  out.depth = depths.all;
  out.contrast = std::max(albedo.greatest - even, even - albedo.least);
  out.adjacency = -std::expm1(-depths.all) * out.contrast;
  out.shadows = std::expm1(-depths.below) / std::expm1(-depths.all);
  return out;
}

}  // namespace suite
