// One line per phase function file: the row it adds to the table in phase_function.cpp.
#pragma once
#include "optics/phase_function.h"

namespace suite {

PhaseRow hg_row();
PhaseRow double_hg_row();
PhaseRow rayleigh_row();
PhaseRow tabulated_row();
PhaseRow sqt_phase_row();
PhaseRow fournier_forand_row();
PhaseRow petzold_row();
PhaseRow sea_phase_row();
PhaseRow leaves_row();

template <class Phase>
std::unique_ptr<const PhaseFunction> make_phase(const ModelSpec& spec, const SpectralState& state) {
  return std::make_unique<Phase>(spec, state);
}

}  // namespace suite
