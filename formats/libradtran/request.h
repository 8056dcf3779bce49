// What an input file of uvspec asks for.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

struct LibradtranRequest {
  enum class Quantity { absolute, transmittance, reflectivity, brightness };
  enum class Per { nanometre, wavenumber };
  bool thermal = false;
  Quantity quantity = Quantity::absolute;
  Per per = Per::nanometre;
  std::vector<std::string> columns;    // of a row
  bool radiance_lines = false;         // after each row, lines of radiances over angles (no output_user)
  std::vector<double> umu, phi;        // phi: degrees
  double phi0 = 0;                     // degrees
  std::optional<double> solar_zenith;  // degrees
  std::optional<size_t> levels;        // where zout lists them
};
LibradtranRequest parse_libradtran_request(std::string_view input, const std::string& name);

}  // namespace suite
