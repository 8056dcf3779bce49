// Particles as a phase function of libs/optics: what media and paths ask for.
#pragma once
#include <memory>
#include <span>

#include "air/particles.h"
#include "optics/phase_function.h"

namespace suite {

// One phase function per entry of `optics`, linear in the cosine over the grid; sample and pdf follow those at `knots`,
// indices of entries (SpectralState::knots). Polarises where the optics know its matrices, which are linear in the
// cosine as well; else it depolarises. Error: no entries, a knot beyond them.
std::unique_ptr<const PhaseFunction> particle_phase(const ParticleOptics& optics, std::span<const size_t> knots);

}  // namespace suite
