#include <algorithm>
#include <cmath>
#include <filesystem>

#include "formats/pbsdf/pbsdf.h"
#include "sqt_fit/whole_circle.h"

namespace suite {

namespace {

using Type = TensorFile::Type;
constexpr size_t kMatrix = sqt::MuellerBrdf::kMatrix;
constexpr const char* kHint = "a .pbsdf holds theta_h, theta_d, phi_d, wvls and M";

// Axes are rows of one: rank 2, or rank 1.
std::vector<double> axis_of(TensorFile& file, const char* name) {
  const size_t rank = file.has(name) && file.field_rank(name) == 1 ? 1 : 2;
  const TensorFile::Field& f = file.field(name, Type::float32, rank, kHint);
  if (rank == 2 && f.shape[0] != 1) throw file.fault(f.offset, strf("'%s' is not one row", name));
  const std::vector<float> v = file.floats(name, f);
  return {v.begin(), v.end()};
}

std::vector<double> polar_axis(TensorFile& file, const char* name) {
  std::vector<double> a = axis_of(file, name);
  // Files in single precision end a little beyond the horizon.
  for (double& x : a)
    if (x > kPi / 2 && x < kPi / 2 + 1e-3) x = kPi / 2;
  return a;
}

// The frame of the file has its first axis across the plane of scattering, and another sign of V (FORMAT.md).
constexpr StokesConvention kOfFile{"pbsdf", "", {1, -1, -1, -1}};

}  // namespace

std::shared_ptr<const sqt::MuellerBrdf> parse_pbsdf(std::span<const std::byte> bytes, const std::string& file_name) {
  TensorFile file(bytes, file_name);
  const std::vector<double> phi = axis_of(file, "phi_d");
  sqt::MuellerBrdf::Data data;
  data.grid.theta_h = polar_axis(file, "theta_h");
  data.grid.theta_d = polar_axis(file, "theta_d");
  for (const uint16_t nm : file.words("wvls", file.field("wvls", Type::uint16, 1, kHint)))
    data.wavelength_um.push_back(nm / 1000.0);
  const TensorFile::Field& m = file.field("M", Type::float32, 6, kHint);
  const size_t D = data.grid.theta_d.size(), H = data.grid.theta_h.size(), W = data.wavelength_um.size();
  const std::vector<size_t> expected{phi.size(), D, H, W, 4, 4};
  if (m.shape != expected)
    throw file.fault(m.offset, "the shape of 'M' does not fit phi_d, theta_d, theta_h and wvls",
                     "phi_d x theta_d x theta_h x wvls x 4 x 4");
  try {
    const std::vector<sqt::CirclePlace> places = sqt::whole_circle(phi);
    const std::vector<float> raw = file.floats("M", m, TensorFile::Missing::keep);
    const size_t slice = D * H * W * kMatrix;
    data.values.reserve(places.size() * slice);
    for (const sqt::CirclePlace& place : places) {
      data.grid.phi_d.push_back(place.phi);
      for (size_t i = place.from * slice; i < (place.from + 1) * slice; i += kMatrix) {
        Mueller read;
        for (size_t e = 0; e < kMatrix; ++e) read.m[e] = static_cast<double>(raw[i + e]);
        read = converted(read, kOfFile);
        if (place.mirrored) read = sqt::mirror_image(read);
        for (const double x : read.m) data.values.push_back(static_cast<float>(x));
      }
    }
    return std::make_shared<const sqt::MuellerBrdf>(
        std::filesystem::path(file_name).stem().string(),
        "polarised tensor file (.pbsdf), Mueller matrices by half-vector angles, 1/sr", std::move(data));
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw file.fault(m.offset, e.message(), e.hint());
  }
}

}  // namespace suite
