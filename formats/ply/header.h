// The header of a PLY file: which elements it has, of which properties.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace suite::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
size_t size_of(Type type);  // bytes

struct Property {
  std::string name;
  Type type = Type::float32;
  bool list = false;
  Type count_type = Type::uint8;  // of a list
};

struct Element {
  std::string name;
  size_t count = 0;
  std::vector<Property> properties;
  // The number of the first property with one of these names, or -1.
  int find(std::initializer_list<const char*> names) const;
};

struct Header {
  enum class Format { ascii, little, big } format = Format::ascii;
  std::vector<Element> elements;
  size_t bytes = 0;  // where the values begin
  int lines = 0;     // lines of the header
};

// Error, with its line: not PLY, an unknown statement or type, properties before an element, no end within 1 MiB.
Header header_of(std::string_view text, const std::string& file);

}  // namespace suite::ply
