#include "air/shells.h"

#include "base/error.h"

namespace suite {

Shells::Shells(Vec3 zero, double curvature, std::vector<double> heights)
    : zero_(zero), curvature_(curvature), heights_(std::move(heights)) {
  if (heights_.size() < 2)
    throw Error(strf("%zu heights bound no layer of air", heights_.size()), "at least two, ascending");
  for (size_t i = 0; i < heights_.size(); ++i) {
    if (!std::isfinite(heights_[i])) throw Error(strf("height %zu of the air is not finite", i + 1));
    if (i > 0 && !(heights_[i] > heights_[i - 1]))
      throw Error(strf("heights of the air are not ascending: %.17g m, then %.17g m", heights_[i - 1], heights_[i]));
    if (!(1 + curvature_ * heights_[i] > 0))
      throw Error(strf("a height of the air lies below the centre of the Earth: %.17g m", heights_[i]));
  }
}

Shells Shells::flat(std::vector<double> heights) { return Shells({}, 0, std::move(heights)); }

Shells Shells::round(Vec3 centre, double radius, std::vector<double> heights) {
  if (!(radius > 0) || !std::isfinite(radius) || !finite(centre))
    throw Error(strf("the radius of the Earth is not positive: %g m", radius));
  return Shells(centre + Vec3{0, 0, radius}, 1 / radius, std::move(heights));
}

double Shells::lowest_height(Vec3 from, Dir d, double distance) const {
  Line l = line(from, d);
  double lowest = l.height, shift = 0;
  if (l.height > heights_.back() && l.slope < 0) {
    shift = std::min(approach(l), distance);
    l = line_from(from, d, shift);
    lowest = std::min(lowest, l.height);
  }
  const double end = distance - shift;
  if (curvature_ == 0) return l.slope < 0 ? std::min(lowest, l.level + end * l.slope) : lowest;
  if (l.turn <= 0) return lowest;  // from here on it rises
  return l.turn < end ? l.lowest() : std::min(lowest, l.height_at(end));
}

double Shells::way_down_to(Vec3 from, Dir d, double height) const {
  const Line l = line(from, d);
  const double above = l.above(height), disc = l.discriminant(above);
  if (!(l.slope < 0) || !(disc >= 0)) return std::numeric_limits<double>::infinity();
  return l.on_the_way_down(above, std::sqrt(disc));
}

double Shells::way_up_to(Vec3 from, Dir d, double height) const {
  const Line l = line(from, d);
  const double above = l.above(height), disc = l.discriminant(above);
  if (!(l.slope > 0) || !(disc >= 0)) return std::numeric_limits<double>::infinity();
  return l.on_the_way_up(above, std::sqrt(disc));
}

}  // namespace suite
