// Detectors of images from text, under even light.
#pragma once
#include <string>

#include "sensor/detectors/detectors.h"

namespace suite::test {

// A detector of `keys`, "kind: emccd, em_gain: 300, ..."; quantum efficiency 1 unless they say.
inline ReadDetector detector_of(const std::string& keys) {
  const std::string qe = keys.find("quantum_efficiency") == std::string::npos ? "quantum_efficiency: 1, " : "";
  const Params params = Params::parse_text("detector: {" + qe + keys + "}", "detector.yaml");
  SensorContext context;
  context.curve = [](const Params& p) {
    if (p.kind() == Params::Kind::map)
      return Curve(p.at("wavelength_um").as_numbers(), p.at("value").as_numbers(), Outside::zero);
    return Curve::constant(p.as_number());
  };
  auto made = read_detector(params, context);
  params.reject_unread();
  return *made;
}

// The same mean electrons on every pixel of an array of 10 um pixels, for 1 s.
inline ArrayLight even_light(uint32_t columns, uint32_t rows, double electrons, uint64_t read_out = 0) {
  ArrayLight light;
  light.columns = columns, light.rows = rows;
  light.electrons.assign(size_t{columns} * rows, electrons);
  light.exposure = 1;
  light.pitch = {1e-5, 1e-5};
  light.read_out = read_out;
  for (uint32_t r = 0; r < rows; ++r)
    for (uint32_t c = 0; c < columns; ++c) light.sites.push_back({hash_of(r, c), c, 0, false});
  return light;
}

}  // namespace suite::test
