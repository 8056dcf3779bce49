#include "sensor/point_images.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

TrailSteps::TrailSteps(const TimeWindow& w, const std::function<std::optional<Vec2>(double)>& place_at) : window(w) {
  if (!(w.end > w.begin)) return;
  constexpr double kStep = 0.1, kMost = 4096;  // pixels
  constexpr int kPieces = 8;
  double way = 0;
  std::optional<Vec2> before = place_at(w.begin);
  for (int i = 1; i <= kPieces; ++i) {
    const std::optional<Vec2> at = place_at(w.begin + (w.end - w.begin) * i / kPieces);
    if (at && before) way += std::hypot(at->x - before->x, at->y - before->y);
    before = at;
  }
  count = static_cast<int>(std::clamp(std::ceil(way / kStep), 1.0, kMost));
}

std::string points_table(std::span<const SeenPoint> points, std::span<const Band> bands) {
  std::string text =
      "# stars: name in the catalogue, magnitude, centre of its light in pixels, irradiance at the sensor in W/(m2 "
      "um)\n"
      "name,v_mag,column,row";
  for (const Band& band : bands) text += "," + band.name;
  text += "\n";
  for (const SeenPoint& p : points) {
    text += strf("%s,%.2f,%.4f,%.4f", p.name.c_str(), p.v, p.column, p.row);
    for (size_t b = 0; b < bands.size(); ++b) text += strf(",%.6g", p.irradiance.at(b));
    text += "\n";
  }
  return text;
}

}  // namespace suite
