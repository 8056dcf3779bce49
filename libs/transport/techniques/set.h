// The techniques that a kernel holds beside light sampling and chance: what its surfaces and what fills space can have
// no use for is not in it.
#pragma once
#include <type_traits>

#include "transport/techniques/air_residual.h"
#include "transport/techniques/caustic_guide.h"
#include "transport/techniques/end_guide.h"
#include "transport/techniques/equiangular.h"
#include "transport/techniques/forward_guide.h"
#include "transport/techniques/manifold.h"
#include "transport/techniques/manifold_ways.h"
#include "transport/techniques/side_vertex.h"
#include "transport/techniques/splitting.h"
#include "transport/techniques/volume_chains.h"
#include "transport/techniques/volume_chains_sky.h"

namespace suite {

template <class Wave>
struct Techniques {
  static constexpr bool kModels = Wave::Surfaces::kDense > 0;  // surfaces may be other than matte
  static constexpr bool kMedia = Wave::Space::kMedia, kBack = Wave::Space::kGoesBack;

  std::conditional_t<kModels, Manifold<Wave>, NoManifold<Wave>> manifold;
  std::conditional_t<kMedia, VolumeChains<Wave>, NoVolumeChains<Wave>> chains;
  std::conditional_t<kMedia, ForwardGuide<Wave>, NoForwardGuide<Wave>> guide;
  std::conditional_t<kMedia, EndGuide<Wave>, NoEndGuide<Wave>> ends;
  std::conditional_t<kMedia, Splitting<Wave>, NoSplitting<Wave>> splitting;
  std::conditional_t<kMedia, SideVertex<Wave>, NoSideVertex<Wave>> side;
  std::conditional_t<kMedia, Equiangular<Wave>, NoEquiangular<Wave>> equiangular;
  std::conditional_t<kModels, CausticGuide<Wave>, NoCausticGuide<Wave>> caustics;
  std::conditional_t<kBack, AirResidual<Wave>, NoAirResidual<Wave>> residual;

  void prepare(const KernelContext& context, const Wave& wave) {
    manifold.prepare(context);
    if (context.branches) ends.prepare(context, wave);
    const bool branches = manifold.on() && context.branches;
    splitting.prepare(wave, branches || ends.on());
    chains.prepare(wave, kMedia && branches);
    guide.prepare(kMedia && branches);
    if (context.branches) side.prepare(wave, manifold.on() || ends.on());
    if (context.branches) equiangular.prepare(wave);
    caustics.prepare(context, kMedia && manifold.on());
    residual.prepare(wave);
  }
};

}  // namespace suite
