// Definitions of wave.h: the Mueller matrices of events, for algebras that carry polarisation.
#pragma once
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

}  // namespace suite
