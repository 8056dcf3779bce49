// The table of kinds of detectors of images: one row a kind, one file each.
#pragma once
#include <optional>

#include "base/registry.h"
#include "sensor/detectors/array_detector.h"

namespace suite {

// What key `detector` makes: what lets light in and what reads it. reader null: electrons alone are wanted.
struct ReadDetector {
  DetectorSpec spec;
  std::shared_ptr<const ArrayDetector> reader;
};

// make: fills the spec, which read_light() has been given already, and makes the reader.
using ArrayDetectorRow = RegistryRow<std::shared_ptr<const ArrayDetector>(const Params& params, DetectorSpec& spec)>;
const Registry<ArrayDetectorRow>& array_detectors();

// Reads key `detector`, of kind `ccd` unless it says; nothing when absent. Located Error for anything wrong.
std::optional<ReadDetector> read_detector(const Params& params, const SensorContext& context);

ArrayDetectorRow ccd_row();
ArrayDetectorRow emccd_row();
ArrayDetectorRow photon_counting_row();
ArrayDetectorRow scmos_row();
ArrayDetectorRow qcmos_row();
ArrayDetectorRow spad_row();
ArrayDetectorRow intensifier_row();
ArrayDetectorRow ingaas_row();

}  // namespace suite
