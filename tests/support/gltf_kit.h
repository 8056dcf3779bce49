// glTF files made in a test: values put into one buffer, which goes into the JSON as a data URI.
#pragma once
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite::test {

class GltfFile {
 public:
  // Each gives the number of its accessor.
  int floats(const std::vector<float>& values, const char* type, int components) {
    return accessor(values, 5126, type, values.size() / static_cast<size_t>(components));
  }
  int places(const std::vector<float>& values) { return floats(values, "VEC3", 3); }
  int indices(const std::vector<uint16_t>& values) { return accessor(values, 5123, "SCALAR", values.size()); }
  // The number of a buffer view that holds these bytes.
  template <class T>
  int view(const std::vector<T>& values) {
    while (bytes_.size() % 4) bytes_.push_back(0);
    views_ += strf("%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", views_.empty() ? "" : ",", bytes_.size(),
                   values.size() * sizeof(T));
    const auto* raw = reinterpret_cast<const unsigned char*>(values.data());
    bytes_.insert(bytes_.end(), raw, raw + values.size() * sizeof(T));
    return view_count_++;
  }
  int raw_accessor(const std::string& json) {
    accessors_ += (accessors_.empty() ? "" : ",") + json;
    return accessor_count_++;
  }
  // rest: what else the file says, as members of the root.
  std::string text(const std::string& rest) const {
    return strf(
               R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":%zu,"uri":"data:application/octet-stream;base64,%s"}],)",
               bytes_.size(), base64().c_str()) +
           "\"bufferViews\":[" + views_ + "],\"accessors\":[" + accessors_ + "]," + rest + "}";
  }
  // The same as a GLB.
  std::string binary(const std::string& rest) const {
    std::string json = strf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":%zu}],)", bytes_.size()) +
                       "\"bufferViews\":[" + views_ + "],\"accessors\":[" + accessors_ + "]," + rest + "}";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string bin(bytes_.begin(), bytes_.end());
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    const auto word = [](size_t v) {
      const auto w = static_cast<uint32_t>(v);
      return std::string(reinterpret_cast<const char*>(&w), 4);
    };
    return "glTF" + word(2) + word(28 + json.size() + bin.size()) + word(json.size()) + "JSON" + json +
           word(bin.size()) + std::string("BIN\0", 4) + bin;
  }

 private:
  template <class T>
  int accessor(const std::vector<T>& values, int component_type, const char* type, size_t count) {
    const int v = view(values);
    return raw_accessor(
        strf(R"({"bufferView":%d,"componentType":%d,"count":%zu,"type":"%s"})", v, component_type, count, type));
  }
  std::string base64() const {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes_.size(); i += 3) {
      uint32_t v = 0;
      for (size_t k = 0; k < 3; ++k) v = v << 8 | (i + k < bytes_.size() ? bytes_[i + k] : 0);
      for (size_t k = 0; k < 4; ++k) out += i + k > bytes_.size() ? '=' : kDigits[v >> (18 - 6 * k) & 63];
    }
    return out;
  }
  std::vector<unsigned char> bytes_;
  std::string views_, accessors_;
  int view_count_ = 0, accessor_count_ = 0;
};

}  // namespace suite::test
