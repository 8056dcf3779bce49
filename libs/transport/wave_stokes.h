// Definitions of wave.h: the Mueller matrices of events, for algebras that carry polarisation.
#pragma once
#include <algorithm>

#include "light/polarised_air.h"
#include "transport/wave.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* Wave<Surfaces, Space, Throughputs, Estimator>::polarise(const PathNode& node, Dir in,
                                                                              const Continuation* dirac) {
  const Path& path = paths[node.path];
  const Dir out = -path.direction;
  polarisation.suffix.begin();
  bool scattered = false;
  if constexpr (Space::kScatters)
    if (node.event) {
      polarise_further(node.path, out, in);
      scattered = true;
    }
  if (!scattered)
    polarisation.suffix.take(
        surfaces.mueller(node.path, out, in, dirac ? dirac->lobe : -1, path.knot, polarisation.suffix.next(bins)));
  return polarisation.suffix.event();
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::polarise_further(uint32_t event, Dir out, Dir in) {
  polarisation.suffix.take(space.mueller(event, out, in, polarisation.suffix.next(bins)));
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::polarise_further(const Hit& hit, Dir out, Dir in, int lobe,
                                                                     int knot, double time) {
  Interaction& at = polarisation.at;
  surface.interact(hit, out, at, time);
  const std::span<Mueller> m = polarisation.suffix.next(bins);
  const auto of = at.baked->model->delta_mueller(at.frame.to_local(out), lobe, knot, m);
  for (Mueller& one : of.grey ? m.first(1) : m)
    if (one != Mueller::depolariser()) one = to_world(one, at.frame, out, in);
  polarisation.suffix.take(of);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* Wave<Surfaces, Space, Throughputs, Estimator>::polarise_emission(uint32_t p) {
  const Path& path = paths[p];
  double u[3];
  for (uint32_t i = 0; i < 3; ++i) u[i] = path.stream.hashed(path.sample, dimensions::of_emission(path.order() - 1, i));
  polarisation.suffix.begin();
  polarisation.suffix.take(
      surfaces.emission_mueller(p, -path.direction, {u[0], u[1]}, u[2], path.knot, polarisation.suffix.next(bins)));
  return polarisation.suffix.event();
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
const float* Wave<Surfaces, Space, Throughputs, Estimator>::polarise_air(AirWay way, Vec3 from, Dir d, double distance,
                                                                         const float* radiance) {
  auto& air = polarisation.air;
  if constexpr (requires { space.polarised_air(); }) {
    for (std::vector<float>* row : {&air.I, &air.Q, &air.U}) row->resize(bins);
    const PolarisedAir& knows = space.polarised_air();
    air.V.resize(knows.tells_v() ? bins : 0);
    const PolarisedAir::Light to{air.I, air.Q, air.U, air.V};
    air.unknown = way == AirWay::sky ? knows.sky(from, d, to) : knows.along(from, d, distance, to);
    for (size_t i = 0; i < bins; ++i) {
      air.I[i] = std::max(0.0f, radiance[i] + air.I[i]);
      const float over = air.I[i] > 0 ? 1 / air.I[i] : 0;
      air.Q[i] *= over, air.U[i] *= over;
      if (!air.V.empty()) air.V[i] *= over;
    }
    return air.I.data();
  }
  return radiance;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::lit_by_air(Contribution& c) {
  if constexpr (requires { space.polarised_air(); }) {
    const auto& air = polarisation.air;
    SuffixMatrices& suffix = polarisation.suffix;
    if (!c.polarised) suffix.begin();
    const std::span<Mueller> light = suffix.next(bins);
    for (size_t i = 0; i < bins; ++i) {
      light[i] = Mueller{};
      const double s[] = {1, air.Q[i], air.U[i], air.V.empty() ? 0 : air.V[i]};
      for (int k = 0; k < 4; ++k) light[i](k, 0) = s[k];
    }
    suffix.take({false, 0});
    c.polarised = suffix.event();
    c.unknown = static_cast<float>(air.unknown);
  }
}

}  // namespace suite
