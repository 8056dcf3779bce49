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

SampleGrid samples_for(const PulseLight& light, double step, size_t copies) {
  const SampleGrid grid = samples_within(light.window.start, light.window.stop, step);
  const double all = static_cast<double>(grid.count) * static_cast<double>(light.pixels.size() * copies);
  if (all > static_cast<double>(kMostSamples))
    throw Error(strf("%.4g samples of all pixels", all),
                strf("at most %zu: a shorter gate or longer samples", kMostSamples));
  return grid;
}

void check_step(const Params& p, double step, double width) {
  constexpr double kMost = 1000;
  if (width > kMost * step)
    throw p.error(strf("samples of %g ns for a width of %g ns", step * 1e9, width * 1e9),
                  strf("at most %g samples a width: %g ns or longer", kMost, width * 1e9 / kMost));
}

}  // namespace suite
