#include "sensor/detectors/detectors.h"

namespace suite {

const Registry<ArrayDetectorRow>& array_detectors() {
  static const Registry<ArrayDetectorRow> rows("kind of detector", "",
                                               {ccd_row(), emccd_row(), photon_counting_row(), scmos_row(), qcmos_row(),
                                                spad_row(), intensifier_row(), ingaas_row()});
  return rows;
}

std::optional<ReadDetector> read_detector(const Params& params, const SensorContext& context) {
  const auto p = params.find("detector");
  if (!p) return std::nullopt;
  const auto kind = p->find("kind");
  const ArrayDetectorRow& row =
      kind ? array_detectors().find(kind->as_text(), kind->where()) : *array_detectors().look_up("ccd");
  ReadDetector made;
  read_light(*p, context, made.spec);
  made.reader = row.make(*p, made.spec);
  return made;
}

}  // namespace suite
