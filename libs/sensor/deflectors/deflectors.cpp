#include "base/required.h"
#include "sensor/deflectors/deflector.h"

namespace suite {

const Registry<DeflectorRow>& deflectors() {
  static const Registry<DeflectorRow> rows(
      "kind of deflector", "",
      {fixed_deflector_row(), galvo_row(), triangle_row(), sweep_row(), polygon_row(), palmer_row(), risley_row(),
       fibre_row(), line_array_row(), flash_row(), rotating_head_row()});
  return rows;
}

std::unique_ptr<Deflector> make_deflector(const Params& params) {
  const Params kind = required(params, "kind", deflectors().names());
  return deflectors().find(kind.as_text(), kind.where()).make(params);
}

}  // namespace suite
