// Writes small classic netCDF files for tests.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace suite::test {

// A variable of doubles (type 6), of floats (5), of ints (4), or of characters (2, one number a character).
struct NetCdfVariable {
  std::string name;
  std::vector<int> dimensions;
  int type;
  std::vector<double> values;
};

class NetCdfBytes {
 public:
  void number(uint64_t value, int width) {
    for (int i = width; i-- > 0;) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 255));
  }
  void name(const std::string& text) {
    number(text.size(), 4);
    for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
    pad();
  }
  void pad() { bytes.resize((bytes.size() + 3) / 4 * 4); }
  void value(double v, int type) {
    if (type == 6) {
      uint64_t raw;
      std::memcpy(&raw, &v, 8);
      number(raw, 8);
    } else if (type == 5) {
      const float f = static_cast<float>(v);
      uint32_t raw;
      std::memcpy(&raw, &f, 4);
      number(raw, 4);
    } else {
      number(static_cast<uint64_t>(static_cast<int64_t>(v)), type == 4 ? 4 : 1);
    }
  }
  std::vector<std::byte> bytes;
};

inline std::vector<std::byte> netcdf3(const std::vector<size_t>& dimensions,
                                      const std::vector<NetCdfVariable>& variables) {
  const auto header = [&](const std::vector<size_t>& begins) {
    NetCdfBytes out;
    for (const char c : {'C', 'D', 'F', '\1'}) out.number(static_cast<unsigned char>(c), 1);
    out.number(0, 4);
    out.number(10, 4), out.number(dimensions.size(), 4);
    for (size_t d = 0; d < dimensions.size(); ++d) out.name("d" + std::to_string(d)), out.number(dimensions[d], 4);
    out.number(12, 4), out.number(1, 4), out.name("title"), out.number(2, 4), out.name("made by a test");
    out.number(11, 4), out.number(variables.size(), 4);
    for (size_t v = 0; v < variables.size(); ++v) {
      out.name(variables[v].name);
      out.number(variables[v].dimensions.size(), 4);
      for (const int d : variables[v].dimensions) out.number(static_cast<uint64_t>(d), 4);
      out.number(0, 4), out.number(0, 4);  // no attributes
      out.number(static_cast<uint64_t>(variables[v].type), 4);
      out.number(0, 4), out.number(begins[v], 4);
    }
    return out;
  };
  NetCdfBytes data;
  std::vector<size_t> begins(variables.size(), 0);
  const size_t size = header(begins).bytes.size();
  for (size_t v = 0; v < variables.size(); ++v) {
    begins[v] = size + data.bytes.size();
    for (const double x : variables[v].values) data.value(x, variables[v].type);
    data.pad();
  }
  std::vector<std::byte> out = header(begins).bytes;
  out.insert(out.end(), data.bytes.begin(), data.bytes.end());
  return out;
}

inline std::vector<double> characters(const std::string& text) { return {text.begin(), text.end()}; }

// Two bands of REPTRAN with three wavelengths, and a gas that absorbs at the last two.
inline std::vector<std::byte> reptran_bands() {
  return netcdf3({3, 2, 4}, {{"wvl", {0}, 6, {9100, 9600, 10400}},
                             {"wvlmin", {1}, 6, {9000, 10000}},
                             {"wvlmax", {1}, 6, {10000, 11000}},
                             {"nwvl_in_band", {1}, 4, {2, 1}},
                             {"iwvl", {1, 1}, 4, {1, 3, 2, -1}},
                             {"iwvl_weight", {1, 1}, 6, {0.25, 1, 0.75, -1}},
                             {"species_name", {1, 2}, 2, characters("CO2 O3  ")}});
}
inline std::vector<std::byte> reptran_gas() {
  return netcdf3({2, 2, 2, 1}, {{"pressure", {0}, 6, {100000, 100}},
                                {"t_ref", {0}, 6, {280, 240}},
                                {"t_pert", {1}, 6, {-20, 20}},
                                {"vmrs", {3}, 6, {0}},
                                {"wvl_index", {2}, 6, {2, 3}},
                                {"xsec", {1, 3, 2, 0}, 5, {1e-5, 2e-5, 3e-5, 4e-5, 3e-5, 4e-5, 5e-5, 6e-5}}});
}

}  // namespace suite::test
