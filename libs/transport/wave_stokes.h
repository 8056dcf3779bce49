// Definitions of wave.h: the Mueller matrices of events, for algebras that carry polarisation.
#pragma once
#include <algorithm>

#include "light/polarised_air.h"
#include "transport/wave.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* Wave<Surfaces, Space, Throughputs, Estimator>::polarise(const PathNode& node, Dir in,
                                                                              const Continuation* dirac) {
  if constexpr (kStokes) {
    const Path& path = paths[node.path];
    polarisation.matrices.resize(bins);
    const Dir out = -path.direction;
    ScatterModel::Polarised of;
    bool scattered = false;
    if constexpr (Space::kScatters)
      if (node.event) {
        of = space.mueller(node.path, out, in, polarisation.matrices);
        scattered = true;
      }
    if (!scattered)
      of = surfaces.mueller(node.path, out, in, dirac ? dirac->lobe : -1, path.knot, polarisation.matrices);
    polarisation.event = {{polarisation.matrices.data(), of.grey ? 1 : bins}, static_cast<float>(of.unknown)};
    return &polarisation.event;
  }
  return nullptr;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* Wave<Surfaces, Space, Throughputs, Estimator>::polarise_emission(uint32_t p) {
  if constexpr (kStokes) {
    const Path& path = paths[p];
    double u[3];
    for (uint32_t i = 0; i < 3; ++i)
      u[i] = path.stream.hashed(path.sample, dimensions::of_emission(path.order() - 1, i));
    polarisation.matrices.resize(bins);
    const auto of = surfaces.emission_mueller(p, -path.direction, {u[0], u[1]}, u[2], path.knot, polarisation.matrices);
    polarisation.event = {{polarisation.matrices.data(), of.grey ? 1 : bins}, static_cast<float>(of.unknown)};
    return &polarisation.event;
  }
  return nullptr;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
const float* Wave<Surfaces, Space, Throughputs, Estimator>::polarise_air(AirWay way, Vec3 from, Dir d, double distance,
                                                                         const float* radiance) {
  auto& air = polarisation.air;
  if constexpr (requires { space.polarised_air(); }) {
    for (std::vector<float>* row : {&air.I, &air.Q, &air.U}) row->resize(bins);
    const PolarisedAir::Light to{air.I, air.Q, air.U};
    air.unknown = way == AirWay::sky ? space.polarised_air().sky(from, d, to)
                                     : space.polarised_air().along(from, d, distance, to);
    for (size_t i = 0; i < bins; ++i) {
      air.I[i] = std::max(0.0f, radiance[i] + air.I[i]);
      const float over = air.I[i] > 0 ? 1 / air.I[i] : 0;
      air.Q[i] *= over, air.U[i] *= over;
    }
    return air.I.data();
  }
  return radiance;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::lit_by_air(Contribution& c) {
  if constexpr (requires { space.polarised_air(); }) {
    const auto& air = polarisation.air;
    auto& [matrices, aside, event, unused] = polarisation;
    const bool one = c.polarised && c.polarised->matrices.size() == 1;
    matrices.resize(bins);
    const Mueller first = c.polarised ? matrices[0] : Mueller::identity();
    for (size_t i = 0; i < bins; ++i) {
      const Mueller& m = c.polarised && !one ? matrices[i] : first;
      const Stokes s = m * Stokes{1, double{air.Q[i]}, double{air.U[i]}, 0};
      for (int k = 0; k < 4; ++k) matrices[i](k, 0) = s[static_cast<size_t>(k)];
    }
    event = {matrices, c.polarised ? event.unknown : 0};
    c.polarised = &event;
    c.unknown = static_cast<float>(air.unknown);
  }
}

}  // namespace suite
