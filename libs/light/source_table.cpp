#include "light/source_table.h"

#include <vector>

namespace suite {

std::span<const SourceRow> source_kinds() {
  static const std::vector<SourceRow> rows{
      {"sun", "", "a far disk, or collimated; TSIS-1 spectrum unless one is given",
       "sun: {direction: {zenith_deg: 40, azimuth_deg: 130}, half_angle_deg: 3}\n"},
      {"moon", "", "a far disk with the ROLO irradiance of its phase (Kieffer & Stone 2005)",
       "moon: {direction: {zenith_deg: 60, azimuth_deg: 250}, phase_deg: 30, half_angle_deg: 2}\n"},
      {"sky", "table", "uniform, one table of relative radiance, or one table per wavelength",
       "sky:\n  radiance: 3\n  tables:\n    - {wavelength_um: 0.5, table: [[1, 1, 1], [4, 2, 0.5], [0, 1, 0]]}\n"
       "    - {wavelength_um: 0.6, table: [[0, 0, 0], [0.1, 2, 7], [1, 1, 1]]}\n"},
      {"sky", "clear", "analytic clear sky: Bird & Riordan 1984 irradiances after Perez 1993; needs a sun",
       "sun: {direction: {zenith_deg: 50, azimuth_deg: 180}, collimated: true}\nsky: {kind: clear, water_cm: 2}\n"},
      {"sky", "image", "a panorama (latitude-longitude raster), radiance per channel or a luminance times a spectrum",
       "sky: {kind: image, file: sky.png, radiance: 0.01}\n"},
      {"sky", "thermal", "emission of absorbing layers, radiance per wavelength and zenith angle",
       "sky: {kind: thermal, zeniths: 31, layers: [{temperature_k: 2500, optical_depth: 0.3}, {temperature_k: 2200, "
       "optical_depth: 0.5}]}\n"},
      {"lamps", "point", "a point of intensity W/(sr um), with a table or SQT of its distribution if given",
       "lamps: [{kind: point, position_m: [0.5, -0.3, 2], intensity: 100, distribution: {table: [[1], [0.5], "
       "[0.2]]}}]\n"},
      {"lamps", "spot", "a point that shines into a cone with a smooth rim",
       "lamps: [{kind: spot, position_m: [0.3, 0.4, 3], intensity: 50, outer_deg: 30, axis: [-0.1, -0.1, -1]}]\n"},
      {"lamps", "surface", "everything of one material glows with a radiance W/(m2 sr um)",
       "lamps: [{kind: surface, material: lamp, radiance: 20}]\n"}};
  return rows;
}

}  // namespace suite
