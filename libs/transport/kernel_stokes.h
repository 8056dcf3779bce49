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

}  // namespace suite
