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

std::span<const PhaseRow> phases() {
  static const std::vector<PhaseRow> table{hg_row(), double_hg_row(), rayleigh_row(), tabulated_row(), sqt_phase_row()};
  return table;
}

const PhaseRow& find_phase(const std::string& name, const Where& where) {
  std::vector<std::string> known;
  for (const PhaseRow& row : phases()) {
    if (row.name == name) return row;
    known.push_back(row.name);
  }
  throw Error(where, "unknown phase function '" + name + "'", name_hint(name, known), "OP111");
}

void check_phase(ModelSpec& spec, const Where& where) {
  check_parameters(spec, find_phase(spec.model, where).parameters, "phase function", where);
}

std::unique_ptr<const PhaseFunction> bake_phase(const ModelSpec& spec, const SpectralState& state) {
  return find_phase(spec.model).make(spec, state);
}

}  // namespace suite
