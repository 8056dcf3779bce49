// The fields of a tensor file, and the checks that they make a BRDF.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "formats/rgl/rgl.h"
#include "formats/tensor_file/tensor_file.h"

namespace suite {

namespace {

using Field = TensorFile::Field;
constexpr TensorFile::Type kUint8 = TensorFile::uint8, kFloat32 = TensorFile::float32;

const Field& field_of(const TensorFile& file, const char* name, TensorFile::Type type, size_t rank) {
  return file.field(name, type, rank, "is this an RGL BRDF?");
}

void require_ascending(const TensorFile& file, const Field& f, const std::vector<double>& v, const char* name,
                       double low, double high) {
  for (size_t i = 0; i < v.size(); ++i)
    if (!(v[i] >= low && v[i] <= high && (i == 0 || v[i] > v[i - 1])))
      throw file.fault(f.offset, strf("'%s' is not strictly ascending within %g to %g rad", name, low, high));
}

std::vector<double> widened(const std::vector<float>& v) { return {v.begin(), v.end()}; }

// Anisotropic data cover the whole circle, or a half or a quarter of it that symmetry completes.
void require_whole_circle(const TensorFile& file, const Field& f, const std::vector<double>& phi) {
  if (phi.size() <= 2) return;
  const double parts = 2 * kPi / (phi.back() - phi.front());
  for (const double whole : {1.0, 2.0, 4.0})
    if (std::fabs(parts - whole) < 1e-3) {
      const double start = (phi.front() + kPi) / (kPi / 2);
      if (std::fabs(start - std::round(start)) < 1e-3) return;
    }
  throw file.fault(
      f.offset, strf("'phi_i' covers %g to %g rad, which no symmetry completes to a circle", phi.front(), phi.back()),
      "the whole circle from -pi, half of it, or one quadrant");
}

void require_shape(const TensorFile& file, const Field& f, const char* name, std::initializer_list<size_t> expected) {
  if (!std::equal(f.shape.begin(), f.shape.end(), expected.begin(), expected.end()))
    throw file.fault(f.offset, strf("the shape of '%s' does not fit phi_i, theta_i and the other fields", name));
}
void require_grid(const TensorFile& file, const Field& f, const char* name) {
  if (f.shape[f.shape.size() - 1] < 2 || f.shape[f.shape.size() - 2] < 2)
    throw file.fault(f.offset, strf("'%s' has fewer than 2 x 2 values a slice", name));
}
std::vector<float> non_negative(TensorFile& file, const char* name, const Field& f) {
  std::vector<float> v = file.floats(name, f);
  if (std::any_of(v.begin(), v.end(), [](float x) { return x < 0; }))
    throw file.fault(f.offset, strf("'%s' holds a negative value", name));
  return v;
}

RglBrdf::Tables read_tables(TensorFile& file) {
  RglBrdf::Tables t;
  const Field &phi = field_of(file, "phi_i", kFloat32, 1), &theta = field_of(file, "theta_i", kFloat32, 1);
  t.phi = widened(file.floats("phi_i", phi));
  t.theta = widened(file.floats("theta_i", theta));
  require_ascending(file, phi, t.phi, "phi_i", -2 * kPi - 1e-3, 2 * kPi + 1e-3);
  require_ascending(file, theta, t.theta, "theta_i", 0, kPi / 2 + 1e-3);
  require_whole_circle(file, phi, t.phi);

  const Field &ndf = field_of(file, "ndf", kFloat32, 2), &sigma = field_of(file, "sigma", kFloat32, 2),
              &vndf = field_of(file, "vndf", kFloat32, 4);
  require_grid(file, ndf, "ndf");
  require_grid(file, sigma, "sigma");
  require_grid(file, vndf, "vndf");
  require_shape(file, vndf, "vndf", {t.phi.size(), t.theta.size(), vndf.shape[2], vndf.shape[3]});
  t.ndf_rows = ndf.shape[0], t.ndf_columns = ndf.shape[1];
  t.sigma_rows = sigma.shape[0], t.sigma_columns = sigma.shape[1];
  t.vndf_rows = vndf.shape[2], t.vndf_columns = vndf.shape[3];
  t.ndf = non_negative(file, "ndf", ndf);
  t.sigma = non_negative(file, "sigma", sigma);
  t.vndf = non_negative(file, "vndf", vndf);

  t.spectral = file.has("spectra");
  const char* name = t.spectral ? "spectra" : "rgb";
  const Field& values = field_of(file, name, kFloat32, 5);
  t.wavelength_um = {0.65, 0.55, 0.45};
  if (t.spectral) {
    const Field& w = field_of(file, "wavelengths", kFloat32, 1);
    t.wavelength_um = widened(file.floats("wavelengths", w));
    for (double& x : t.wavelength_um) x /= 1000;
    require_ascending(file, w, t.wavelength_um, "wavelengths", 0.1, 20);
  }
  require_grid(file, values, name);
  require_shape(file, values, name,
                {t.phi.size(), t.theta.size(), t.wavelength_um.size(), values.shape[3], values.shape[4]});
  t.rows = values.shape[3], t.columns = values.shape[4];
  t.values = file.floats(name, values);
  const Field& jacobian = field_of(file, "jacobian", kUint8, 1);
  t.jacobian = file.bytes("jacobian", jacobian)[0] != 0;
  return t;
}

}  // namespace

std::shared_ptr<const RglBrdf> parse_rgl(std::span<const std::byte> bytes, const std::string& file_name) {
  TensorFile file(bytes, file_name);
  RglBrdf::Tables tables = read_tables(file);
  const std::string description = file.bytes("description", field_of(file, "description", kUint8, 1));
  return std::make_shared<const RglBrdf>(std::filesystem::path(file_name).stem().string(), description,
                                         std::move(tables));
}

std::shared_ptr<const RglBrdf> read_rgl(const std::string& path) {
  return parse_rgl(read_bytes(path, size_t{1} << 32), path);
}

}  // namespace suite
