#include "detection/detectors.h"

#include "base/required.h"

namespace suite {

const Registry<LidarDetectorRow>& lidar_detectors() {
  static const Registry<LidarDetectorRow> rows(
      "kind of detector", "",
      {waveform_detector_row(), linear_detector_row(), geiger_detector_row(), photon_counting_detector_row()});
  return rows;
}

std::unique_ptr<LidarDetector> make_lidar_detector(const Params& params, const PulseShape& pulse) {
  const Params kind = required(params, "kind", lidar_detectors().names());
  const LidarDetectorRow& row = lidar_detectors().find(kind.as_text(), kind.where());
  std::unique_ptr<LidarDetector> made = row.make(params, pulse);
  made->set_name(params.name("name", row.name));
  return made;
}

}  // namespace suite
