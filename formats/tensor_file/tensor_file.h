// Tensor files: a list of named arrays, the container of RGL's .bsdf and of .pbsdf (FORMAT.md).
// Based on: the public reader rgl-epfl/brdf-loader, for the layout.
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"

namespace suite {

class TensorFile {
 public:
  enum Type { uint8 = 1, uint16 = 3, float32 = 10 };
  struct Field {
    int type;
    size_t offset, count;
    std::vector<size_t> shape;
  };
  enum class Missing { refuse, keep };  // NaN among the values

  // bytes outlive it. Error: no tensor file, fields that do not fit the file.
  TensorFile(std::span<const std::byte> bytes, const std::string& file);
  bool has(const std::string& name) const { return fields_.count(name) != 0; }
  // Number of dimensions of a field that is there.
  size_t field_rank(const std::string& name) const { return fields_.at(name).shape.size(); }
  // Error unless present, of the type and with `rank` non-zero dimensions. hint: what the file is taken for.
  const Field& field(const std::string& name, Type type, size_t rank, const std::string& hint = {}) const;
  // Error: a value that is not finite (infinite, with Missing::keep).
  std::vector<float> floats(const std::string& name, const Field& f, Missing missing = Missing::refuse);
  std::vector<uint16_t> words(const std::string& name, const Field& f);
  std::string bytes(const std::string& name, const Field& f);
  Error fault(size_t offset, std::string what, std::string hint = {}) const;

 private:
  void read_field();
  ByteReader reader_;
  std::map<std::string, Field> fields_;
};

}  // namespace suite
