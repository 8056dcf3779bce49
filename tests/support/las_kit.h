// A LAS file for tests, made byte by byte.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace suite::test {

struct LasPoint {
  double x, y, z;
  int kind = 2;
  bool withheld = false;
};

// scale 0.01 from (500000, 5600000, 0); GeoTIFF keys of an EPSG code unless it is 0.
inline std::string las(const std::vector<LasPoint>& points, int minor = 2, int format = 1, int epsg = 25832) {
  const size_t header = minor == 4 ? 375 : minor == 3 ? 235 : 227, record = epsg ? 54 + 16 : 0;
  constexpr size_t sizes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const size_t size = sizes[format];
  std::string all(header + record + size * points.size(), '\0');
  const auto put = [&](size_t at, auto value) { std::memcpy(all.data() + at, &value, sizeof value); };
  std::memcpy(all.data(), "LASF", 4);
  put(24, uint8_t{1}), put(25, static_cast<uint8_t>(minor));
  put(94, static_cast<uint16_t>(header)), put(96, static_cast<uint32_t>(header + record));
  put(100, static_cast<uint32_t>(epsg != 0)), put(104, static_cast<uint8_t>(format));
  put(105, static_cast<uint16_t>(size));
  if (minor == 4)
    put(247, static_cast<uint64_t>(points.size()));
  else
    put(107, static_cast<uint32_t>(points.size()));
  const double scale[] = {0.01, 0.01, 0.01, 500000, 5600000, 0};
  for (size_t k = 0; k < 6; ++k) put(131 + 8 * k, scale[k]);
  for (size_t c = 0; c < 3; ++c)
    for (size_t k = 0; k < points.size(); ++k) {
      const LasPoint& p = points[k];
      const double v = c == 0 ? p.x : c == 1 ? p.y : p.z;
      double ends[2];  // high, low
      std::memcpy(ends, all.data() + 179 + 16 * c, sizeof ends);
      put(179 + 16 * c, k && ends[0] > v ? ends[0] : v), put(187 + 16 * c, k && ends[1] < v ? ends[1] : v);
    }
  if (epsg) {
    std::memcpy(all.data() + header + 2, "LASF_Projection", 15);
    put(header + 18, uint16_t{34735}), put(header + 20, uint16_t{16});
    const uint16_t keys[] = {1, 1, 0, 1, 3072, 0, 1, static_cast<uint16_t>(epsg)};
    for (size_t k = 0; k < 8; ++k) put(header + 54 + 2 * k, keys[k]);
  }
  for (size_t k = 0; k < points.size(); ++k) {
    const LasPoint& p = points[k];
    const size_t at = header + record + size * k;
    const auto whole = [](double v, double offset) { return static_cast<int32_t>(std::lround((v - offset) / 0.01)); };
    put(at, whole(p.x, 500000)), put(at + 4, whole(p.y, 5600000)), put(at + 8, whole(p.z, 0));
    if (format >= 6)
      put(at + 15, static_cast<uint8_t>(p.withheld ? 4 : 0)), put(at + 16, static_cast<uint8_t>(p.kind));
    else
      put(at + 15, static_cast<uint8_t>(p.kind | (p.withheld ? 0x80 : 0)));
  }
  return all;
}

}  // namespace suite::test
