#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/rgl/rgl.h"

namespace suite {

namespace {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");

constexpr double kLastTheta = 89.9 * kDegree;  // of the viewer: functions have no values on the horizon

class Tensors {
 public:
  void floats(const std::string& name, std::vector<uint64_t> shape, std::span<const float> values) {
    fields_.push_back({name, 10, std::move(shape), std::as_bytes(values)});
  }
  void bytes(const std::string& name, std::string_view text) {
    fields_.push_back({name, 1, {text.size()}, std::as_bytes(std::span(text))});
  }
  // The data must still be there.
  std::vector<std::byte> file() const {
    std::vector<std::byte> out;
    auto raw = [&out](const void* data, size_t n) {
      const auto* from = static_cast<const std::byte*>(data);
      out.insert(out.end(), from, from + n);
    };
    auto put = [&raw](auto value) { raw(&value, sizeof value); };
    raw("tensor_file\0\1\0", 14);
    put(static_cast<uint32_t>(fields_.size()));
    uint64_t offset = out.size();
    for (const Field& f : fields_) offset += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    for (const Field& f : fields_) {
      put(static_cast<uint16_t>(f.name.size()));
      raw(f.name.data(), f.name.size());
      put(static_cast<uint16_t>(f.shape.size()));
      put(f.type);
      put(offset);
      for (const uint64_t s : f.shape) put(s);
      offset += f.data.size();
    }
    for (const Field& f : fields_) raw(f.data.data(), f.data.size());
    return out;
  }

 private:
  struct Field {
    std::string name;
    uint8_t type;
    std::vector<uint64_t> shape;
    std::span<const std::byte> data;
  };
  std::vector<Field> fields_;
};

std::vector<float> evenly(double first, double last, size_t n) {
  std::vector<float> list(n);
  for (size_t i = 0; i < n; ++i)
    list[i] = static_cast<float>(first + (last - first) * static_cast<double>(i) / static_cast<double>(n - 1));
  return list;
}

// One slice: all half vectors of one direction of the viewer. values: [channel][azimuth][polar angle]; luminance: what
// draws are made from, the mean value times the solid angle that a step of the table has.
void fill_slice(const sqt::Function& function, Dir view, double phi, size_t side, float* values, float* luminance) {
  const size_t channels = function.info().wavelength_um.size();
  std::vector<double> f(channels);
  for (size_t y = 0; y < side; ++y)
    for (size_t x = 0; x < side; ++x) {
      const double u = static_cast<double>(x) / static_cast<double>(side - 1),
                   v = static_cast<double>(y) / static_cast<double>(side - 1), theta_m = 0.5 * kPi * u * u;
      const Dir m = dir_from_angles(theta_m, (2 * v - 1) * kPi + phi);
      const double cos_d = dot(view, m);
      const Dir light = 2 * cos_d * m - view;
      double mean = 0;
      if (light.z > 0 && cos_d > 0) {
        function.value(view, light, f);
        for (size_t c = 0; c < channels; ++c) {
          const double w = f[c] > 0 ? f[c] * light.z : 0;  // nan: no data
          values[(c * side + y) * side + x] = static_cast<float>(w);
          mean += w / static_cast<double>(channels);
        }
      }
      luminance[y * side + x] = static_cast<float>(mean * u * std::sin(theta_m) * std::max(cos_d, 0.0));
    }
}

}  // namespace

std::vector<std::byte> rgl_of(const sqt::Function& function, const std::string& description, const RglSize& size) {
  const sqt::Function::Info& info = function.info();
  if (info.domain != sqt::Domain::hemisphere || info.quantity != sqt::Quantity::bsdf)
    throw Error("'" + info.name + "' is no BRDF over the hemisphere: a .bsdf holds nothing else", "write .csv");
  if (info.wavelength_um != std::vector<double>{0.65, 0.55, 0.45} &&
      !std::is_sorted(info.wavelength_um.begin(), info.wavelength_um.end()))
    throw Error("the wavelengths of '" + info.name + "' do not ascend, as those of a .bsdf do", "write .csv");
  SUITE_CHECK(size.theta >= 2 && size.phi >= 3 && size.side >= 2);
  const std::vector<float> theta = evenly(0, kLastTheta, size.theta),
                           phi = info.isotropic ? std::vector<float>{0} : evenly(-kPi, kPi, size.phi);
  const size_t channels = info.wavelength_um.size(), slices = phi.size() * theta.size(), area = size.side * size.side;
  std::vector<float> values(slices * channels * area), luminance(slices * area);
  parallel_for(0, slices, 1, [&](size_t begin, size_t end) {
    for (size_t s = begin; s < end; ++s) {
      const double azimuth = phi[s / theta.size()];
      // Half vectors of isotropic data are counted from the viewer's azimuth.
      fill_slice(function, dir_from_angles(theta[s % theta.size()], azimuth), info.isotropic ? azimuth : 0, size.side,
                 &values[s * channels * area], &luminance[s * area]);
    }
  });
  const std::vector<float> ones(slices * 4, 1);
  std::vector<float> nm;
  for (const double um : info.wavelength_um) nm.push_back(static_cast<float>(um * 1000));
  const char no = 0;
  Tensors file;
  file.bytes("description", description);
  file.bytes("jacobian", {&no, 1});
  file.floats("phi_i", {phi.size()}, phi);
  file.floats("theta_i", {theta.size()}, theta);
  file.floats("ndf", {2, 2}, std::span(ones).first(4));
  file.floats("sigma", {2, 2}, std::span(ones).first(4));
  file.floats("vndf", {phi.size(), theta.size(), 2, 2}, ones);
  file.floats("luminance", {phi.size(), theta.size(), size.side, size.side}, luminance);
  const bool rgb = info.wavelength_um == std::vector<double>{0.65, 0.55, 0.45};  // what a reader calls R, G, B
  if (!rgb) file.floats("wavelengths", {channels}, nm);
  file.floats(rgb ? "rgb" : "spectra", {phi.size(), theta.size(), channels, size.side, size.side}, values);
  return file.file();
}

}  // namespace suite
