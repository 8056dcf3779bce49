// The container: a list of named arrays, and the checks that they make a BRDF.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "base/bytes.h"
#include "base/files.h"
#include "formats/rgl/rgl.h"

namespace suite {

namespace {

constexpr size_t kTypeSize[12] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
constexpr int kUint8 = 1, kFloat32 = 10;

struct Field {
  int type;
  size_t offset, count;
  std::vector<size_t> shape;
};

class TensorFile {
 public:
  TensorFile(std::span<const std::byte> bytes, const std::string& file) : reader_(bytes, file) {
    const auto magic = bytes.size() >= 12 ? reader_.take(12, "the magic") : std::span<const std::byte>{};
    if (magic.empty() || std::memcmp(magic.data(), "tensor_file\0", 12) != 0) {
      reader_.seek(0, "the start");
      throw reader_.error("is not a tensor file: the magic is missing", "an RGL .bsdf file starts with 'tensor_file'");
    }
    const int major = reader_.get<uint8_t>("the version"), minor = reader_.get<uint8_t>("the version");
    if (major != 1 || minor != 0)
      throw reader_.error(strf("tensor file version %d.%d is unknown", major, minor), "version 1.0 is read");
    const uint32_t n = reader_.get<uint32_t>("the number of fields");
    // The smallest field header has 13 bytes.
    if (n > reader_.left() / 13) throw reader_.error(strf("declares %u fields, more than the file can hold", n));
    for (uint32_t i = 0; i < n; ++i) read_field();
  }

  bool has(const std::string& name) const { return fields_.count(name) != 0; }
  // Error unless present, of the type and with `rank` non-zero dimensions.
  const Field& field(const std::string& name, int type, size_t rank) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) throw fault(0, "field '" + name + "' is missing", "is this an RGL BRDF?");
    const Field& f = found->second;
    if (f.type != type) throw fault(f.offset, strf("field '%s' has type %d, expected %d", name.c_str(), f.type, type));
    if (f.shape.size() != rank)
      throw fault(f.offset, strf("field '%s' has %zu dimensions, expected %zu", name.c_str(), f.shape.size(), rank));
    if (f.count == 0) throw fault(f.offset, "field '" + name + "' is empty");
    return f;
  }
  std::vector<float> floats(const std::string& name, const Field& f) {
    reader_.seek(f.offset, name.c_str());
    std::vector<float> v = reader_.get_many<float>(f.count, name.c_str());
    const auto bad = std::find_if(v.begin(), v.end(), [](float x) { return !std::isfinite(x); });
    if (bad != v.end())
      throw fault(f.offset + 4 * static_cast<size_t>(bad - v.begin()),
                  strf("field '%s' holds a value that is not finite", name.c_str()));
    return v;
  }
  std::string bytes(const std::string& name, const Field& f) {
    reader_.seek(f.offset, name.c_str());
    const auto raw = reader_.take(f.count, name.c_str());
    return std::string(reinterpret_cast<const char*>(raw.data()), raw.size());
  }
  Error fault(size_t offset, std::string what, std::string hint = {}) const {
    return Error(Where{reader_.file(), 0, 0, {}, static_cast<long long>(offset)}, std::move(what), std::move(hint));
  }

 private:
  void read_field() {
    const size_t length = reader_.get<uint16_t>("a field name");
    const auto raw = reader_.take(length, "a field name");
    const std::string name(reinterpret_cast<const char*>(raw.data()), raw.size());
    const size_t rank = reader_.get<uint16_t>("a field's rank");
    Field f{reader_.get<uint8_t>("a field's type"), 0, 1, {}};
    if (f.type < 1 || f.type > 11) throw reader_.error(strf("field of unknown type %d", f.type), "types 1 to 11");
    const uint64_t offset = reader_.get<uint64_t>("a field's offset");
    f.shape = reader_.get_many<size_t>(rank, "a field's shape");
    for (const size_t s : f.shape)
      if (__builtin_mul_overflow(f.count, s, &f.count)) throw reader_.error("the shape of a field overflows");
    if (offset > reader_.size() || f.count > (reader_.size() - offset) / kTypeSize[f.type])
      throw reader_.error("a field's data lie beyond the end of the file",
                          strf("it has %zu bytes; is it complete?", reader_.size()));
    f.offset = offset;
    if (!fields_.emplace(name, f).second) throw reader_.error("a field is given twice");
  }

  ByteReader reader_;
  std::map<std::string, Field> fields_;
};

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
  const Field &phi = file.field("phi_i", kFloat32, 1), &theta = file.field("theta_i", kFloat32, 1);
  t.phi = widened(file.floats("phi_i", phi));
  t.theta = widened(file.floats("theta_i", theta));
  require_ascending(file, phi, t.phi, "phi_i", -2 * kPi - 1e-3, 2 * kPi + 1e-3);
  require_ascending(file, theta, t.theta, "theta_i", 0, kPi / 2 + 1e-3);
  require_whole_circle(file, phi, t.phi);

  const Field &ndf = file.field("ndf", kFloat32, 2), &sigma = file.field("sigma", kFloat32, 2),
              &vndf = file.field("vndf", kFloat32, 4);
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
  const Field& values = file.field(name, kFloat32, 5);
  t.wavelength_um = {0.65, 0.55, 0.45};
  if (t.spectral) {
    const Field& w = file.field("wavelengths", kFloat32, 1);
    t.wavelength_um = widened(file.floats("wavelengths", w));
    for (double& x : t.wavelength_um) x /= 1000;
    require_ascending(file, w, t.wavelength_um, "wavelengths", 0.1, 20);
  }
  require_grid(file, values, name);
  require_shape(file, values, name,
                {t.phi.size(), t.theta.size(), t.wavelength_um.size(), values.shape[3], values.shape[4]});
  t.rows = values.shape[3], t.columns = values.shape[4];
  t.values = file.floats(name, values);
  const Field& jacobian = file.field("jacobian", kUint8, 1);
  t.jacobian = file.bytes("jacobian", jacobian)[0] != 0;
  return t;
}

}  // namespace

std::shared_ptr<const RglBrdf> parse_rgl(std::span<const std::byte> bytes, const std::string& file_name) {
  TensorFile file(bytes, file_name);
  RglBrdf::Tables tables = read_tables(file);
  const std::string description = file.bytes("description", file.field("description", kUint8, 1));
  return std::make_shared<const RglBrdf>(std::filesystem::path(file_name).stem().string(), description,
                                         std::move(tables));
}

std::shared_ptr<const RglBrdf> read_rgl(const std::string& path) {
  return parse_rgl(read_bytes(path, size_t{1} << 32), path);
}

}  // namespace suite
