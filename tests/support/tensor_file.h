// Tensor files ("RGL .bsdf") built in memory, for tests of the reader.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace suite::test {

class TensorFileBuilder {
 public:
  void floats(const std::string& name, std::vector<uint64_t> shape, const std::vector<float>& values) {
    add(name, 10, std::move(shape), values.data(), values.size() * sizeof(float));
  }
  void words(const std::string& name, const std::vector<uint16_t>& values) {
    add(name, 3, {values.size()}, values.data(), values.size() * sizeof(uint16_t));
  }
  void bytes(const std::string& name, const std::string& text) {
    add(name, 1, {text.size()}, text.data(), text.size());
  }

  // Other values of a field of floats, of the same shape.
  void replace_floats(const std::string& name, const std::vector<float>& values) {
    for (Field& f : fields_)
      if (f.name == name) f.data.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  }

  std::vector<std::byte> build() const {
    size_t head = 18;
    for (const Field& f : fields_) head += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    std::string out("tensor_file\0\1\0", 14);
    put(out, static_cast<uint32_t>(fields_.size()));
    uint64_t offset = head;
    for (const Field& f : fields_) {
      put(out, static_cast<uint16_t>(f.name.size()));
      out += f.name;
      put(out, static_cast<uint16_t>(f.shape.size()));
      put(out, f.type);
      put(out, offset);
      for (const uint64_t s : f.shape) put(out, s);
      offset += f.data.size();
    }
    for (const Field& f : fields_) out += f.data;
    std::vector<std::byte> bytes(out.size());
    std::memcpy(bytes.data(), out.data(), out.size());
    return bytes;
  }

 private:
  struct Field {
    std::string name;
    uint8_t type;
    std::vector<uint64_t> shape;
    std::string data;
  };
  template <class T>
  static void put(std::string& out, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    out.append(raw, sizeof(T));
  }
  void add(const std::string& name, uint8_t type, std::vector<uint64_t> shape, const void* data, size_t size) {
    fields_.push_back({name, type, std::move(shape), std::string(static_cast<const char*>(data), size)});
  }
  std::vector<Field> fields_;
};

// A small but complete BRDF: rgb (3 channels) or spectral (w channels), with the given azimuths (1 = isotropic).
inline TensorFileBuilder small_rgl(const std::vector<float>& phi, size_t spectral_channels, float ndf = 2,
                                   float sigma = 0.5f) {
  TensorFileBuilder b;
  const std::vector<float> theta{0.0f, 0.7f, 1.5707963f};
  const size_t p = phi.size(), t = theta.size(), ndf_rows = p > 2 ? 4 : 2,
               c = spectral_channels ? spectral_channels : 3;
  b.bytes("description", "a made-up material");
  b.bytes("jacobian", std::string(1, '\1'));
  b.floats("phi_i", {p}, phi);
  b.floats("theta_i", {t}, theta);
  b.floats("ndf", {ndf_rows, 5}, std::vector<float>(ndf_rows * 5, ndf));
  b.floats("sigma", {ndf_rows, 6}, std::vector<float>(ndf_rows * 6, sigma));
  b.floats("vndf", {p, t, 4, 5}, std::vector<float>(p * t * 20, 1.0f));
  std::vector<float> values;  // a ramp along x (first coordinate), scaled by slice and channel
  for (size_t s = 0; s < p * t; ++s)
    for (size_t k = 0; k < c; ++k)
      for (size_t i = 0; i < 9; ++i)
        values.push_back(static_cast<float>((1.0 + static_cast<double>(i % 3)) * (1.0 + static_cast<double>(k)) *
                                            (1.0 + static_cast<double>(s))));
  b.floats(spectral_channels ? "spectra" : "rgb", {p, t, c, 3, 3}, values);
  if (spectral_channels) {
    std::vector<float> nm;
    for (size_t k = 0; k < c; ++k) nm.push_back(400.0f + 10.0f * static_cast<float>(k));
    b.floats("wavelengths", {c}, nm);
  }
  return b;
}

}  // namespace suite::test
