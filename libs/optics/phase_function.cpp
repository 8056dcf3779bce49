#include "optics/phase_function.h"

#include <cmath>

#include "optics/phases/rows.h"

namespace suite {

Dir scattered_direction(Dir out, double cos_scatter, double u) {
  // Travel arrives along -in and leaves along out: in = -(out turned by the scattering angle).
  const Frame f = Frame::around(out);
  const double s = std::sqrt(std::max(0.0, (1 - cos_scatter) * (1 + cos_scatter))), phi = 2 * kPi * u;
  return -normalized(f.to_world({s * std::cos(phi), s * std::sin(phi), cos_scatter}));
}

ScatterModel::Polarised PhaseFunction::polarised(double, std::span<PlaneBlocks> b) const {
  b[0] = {1, 0, 0, 0, 0, 0};
  return {};
}

const Registry<PhaseRow>& phases() {
  static const Registry<PhaseRow> table("phase function", "OP111",
                                        {hg_row(), double_hg_row(), rayleigh_row(), tabulated_row(), sqt_phase_row(),
                                         fournier_forand_row(), petzold_row(), sea_phase_row(), leaves_row()});
  return table;
}

void check_phase(ModelSpec& spec, const Where& where) {
  check_parameters(spec, phases().find(spec.model, where).parameters, "phase function", where);
}

std::unique_ptr<const PhaseFunction> bake_phase(const ModelSpec& spec, const SpectralState& state) {
  return phases().find(spec.model).make(spec, state);
}

}  // namespace suite
