#include "formats/air_lut/air_lut.h"

namespace suite {

namespace {

std::vector<double> ascending(const Params& p, const LutAxis& axis) {
  std::vector<double> values = p.kind() == Params::Kind::scalar ? std::vector{p.as_number()} : p.as_numbers();
  if (values.empty()) throw p.error("there are no values", "give at least one, or leave the key out");
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= axis.low && values[i] <= axis.high))
      throw p.error(strf("%g is outside the valid range", values[i]),
                    strf("give values from %g to %g %s", axis.low, axis.high, axis.unit));
    if (i > 0 && !(values[i] > values[i - 1]))
      throw p.error(strf("%g follows %g", values[i], values[i - 1]), "values ascend");
  }
  return values;
}

KernelSpec kernel_of(const Params& p) {
  KernelSpec spec;
  const LutAxis radii{"radii_km", "km", 1e-3, 1000, {}};
  spec.radii = {0.03, 0.1, 0.3, 1, 2, 5, 10, 30};
  if (const auto given = p.find("radii_km")) spec.radii = ascending(*given, radii);
  for (double& r : spec.radii) r *= 1e3;
  spec.photons = static_cast<uint32_t>(p.integer("photons", 64, 10000000, spec.photons));
  spec.seed = static_cast<uint64_t>(p.integer("seed", 0, 1LL << 53, 1));
  p.reject_unread();
  return spec;
}

LutRequest request_of(const Params& root) {
  root.at("air_lut").as_integer(1, 1);
  LutRequest request;
  request.text = root.where();
  for (size_t a = 0; a < kLutAxes; ++a) {
    LutAxis& axis = request.axes[a];
    request.where[a] = root.where();
    if (const auto given = root.find(axis.name)) {
      axis.values = ascending(*given, axis);
      request.where[a] = given->where();
    }
  }
  if (!root.find("solar_zenith")) {  // no default would be right
    if (const auto near = root.misspelt("solar_zenith")) throw *near;
    throw root.error("the key 'solar_zenith' is missing", "give the zenith angles of the sun, degrees");
  }
  request.sensor = root.text("sensor", std::string());
  request.fineness.widest_um = 1e-3 * root.number_in("widest_bin_nm", 0, 1000, "nm", 0);
  request.fineness.streams = static_cast<int>(root.integer("streams", 4, 64, 16));
  if (request.fineness.streams % 2) throw root.at("streams").error("streams are even", "4, 6, 8, ... 64");
  request.check = root.boolean("check", true);
  request.zarr = root.boolean("zarr", false);
  if (const auto given = root.find("kernel")) request.kernel = kernel_of(*given);
  root.reject_unread();
  return request;
}

}  // namespace

LutRequest read_lut_request(const std::string& path) { return request_of(Params::parse_file(path)); }
LutRequest parse_lut_request(std::string_view text, const std::string& file_name) {
  return request_of(Params::parse_text(text, file_name));
}

}  // namespace suite
