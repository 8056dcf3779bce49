// Definitions of kernel.h: the Mueller matrices of events, for algebras that carry polarisation.
#pragma once
#include "transport/kernel.h"

namespace suite {

// Of a node that scatters light from `in`; dirac: a continuation along a Dirac lobe, else null. It stays until the next
// one is asked for: what refers to it has to be handed over first.
template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* PathKernel<Surfaces, Space, Throughputs, Estimator>::polarise(const NodeAt& node, Dir in,
                                                                                    const Continuation* dirac) {
  if constexpr (kStokes) {
    const Path& path = paths_[node.path];
    matrices_.resize(bins_);
    const Dir out = -path.direction;
    ScatterModel::Polarised of;
    bool scattered = false;
    if constexpr (Space::kScatters)
      if (node.event) {
        of = space_.mueller(node.path, out, in, matrices_);
        scattered = true;
      }
    if (!scattered) of = surfaces_.mueller(node.path, out, in, dirac ? dirac->lobe : -1, path.knot, matrices_);
    polarised_ = {{matrices_.data(), of.grey ? 1 : bins_}, static_cast<float>(of.unknown)};
    return &polarised_;
  }
  return nullptr;
}

// Of what a warm surface sends out.
template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* PathKernel<Surfaces, Space, Throughputs, Estimator>::polarise_emission(uint32_t p) {
  if constexpr (kStokes) {
    const Path& path = paths_[p];
    double u[3];
    for (uint32_t i = 0; i < 3; ++i)
      u[i] = path.stream.hashed(path.sample, dimensions::of_emission(path.order() - 1, i));
    matrices_.resize(bins_);
    const auto of = surfaces_.emission_mueller(p, -path.direction, {u[0], u[1]}, u[2], path.knot, matrices_);
    polarised_ = {{matrices_.data(), of.grey ? 1 : bins_}, static_cast<float>(of.unknown)};
    return &polarised_;
  }
  return nullptr;
}

// Of a side flight: what the node makes of the light from there times what the place there makes of its light.
template <class Surfaces, class Space, class Throughputs, class Estimator>
const PolarisedEvent* PathKernel<Surfaces, Space, Throughputs, Estimator>::polarise_aside(const Side& side) {
  if constexpr (kStokes && kGuides) {
    const NodeAt& node = nodes_[side.node];
    polarise(node, side.path.direction);
    matrices_aside_.resize(bins_);
    const auto of =
        space_.mueller(space_.side(node.path), -side.path.direction, side.sample.direction, matrices_aside_);
    const bool grey = polarised_.matrices.size() == 1, all = grey && of.grey;
    const Mueller first = matrices_[0];
    for (size_t i = 0; i < (all ? 1 : bins_); ++i)
      matrices_[i] = (grey ? first : matrices_[i]) * matrices_aside_[of.grey ? 0 : i];
    const float unknown = 1 - (1 - polarised_.unknown) * (1 - static_cast<float>(of.unknown));
    polarised_ = {{matrices_.data(), all ? 1 : bins_}, unknown};
    return &polarised_;
  }
  return nullptr;
}

}  // namespace suite
