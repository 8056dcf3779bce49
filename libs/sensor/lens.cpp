#include "sensor/lens.h"

#include <cmath>

#include "math/warps.h"

namespace suite {

Vec2 Distortion::distorted(Vec2 i) const {
  const double r2 = i.x * i.x + i.y * i.y, radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {i.x * radial + 2 * p1 * i.x * i.y + p2 * (r2 + 2 * i.x * i.x),
          i.y * radial + p1 * (r2 + 2 * i.y * i.y) + 2 * p2 * i.x * i.y};
}

std::optional<Vec2> Distortion::ideal(Vec2 d) const {
  if (none()) return d;
  Vec2 i = d;
  for (int n = 0; n < 50; ++n) {
    const Vec2 at = distorted(i);
    const double r2 = i.x * i.x + i.y * i.y, radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)),
                 slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));
    const double xx = radial + i.x * i.x * slope + 2 * p1 * i.y + 6 * p2 * i.x,
                 xy = i.x * i.y * slope + 2 * p1 * i.x + 2 * p2 * i.y;
    const double yy = radial + i.y * i.y * slope + 6 * p1 * i.y + 2 * p2 * i.x, determinant = xx * yy - xy * xy;
    // Beyond the fold the picture is turned over: such a solution is not the one that a lens shows.
    if (!(determinant > 0) || !(xx > 0)) return std::nullopt;
    const double ex = d.x - at.x, ey = d.y - at.y;
    if (std::hypot(ex, ey) < 1e-14) return i;
    i.x += (yy * ex - xy * ey) / determinant;
    i.y += (xx * ey - xy * ex) / determinant;
  }
  const Vec2 at = distorted(i);
  if (std::hypot(d.x - at.x, d.y - at.y) < 1e-12) return i;
  return std::nullopt;
}

Dir Lens::look(Vec2 place) const {
  const Vec2 d{place.x / focal_length, place.y / focal_length};
  const Vec2 i = distortion.none() ? d : distortion.ideal(d).value_or(d);  // every place was checked beforehand
  return normalized(Vec3{i.x, -i.y, -1});
}

Vec2 Lens::image_of(Dir direction) const {
  const Vec2 d = distortion.distorted({direction.x / -direction.z, -direction.y / -direction.z});
  return {d.x * focal_length, d.y * focal_length};
}

Vec2 Lens::pupil(double u, double v) const {
  const double inner = obscuration * obscuration, r = 0.5 * aperture * std::sqrt(inner + (1 - inner) * u);
  return {r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v)};
}

Lens read_lens(const Params& p) {
  Lens lens;
  lens.focal_length = p.number_in("focal_length_mm", 1e-3, 1e6, "mm") * 1e-3;
  const auto aperture = p.find("aperture_mm"), number = p.find("f_number");
  if (aperture && number) throw number->error("the aperture is given twice", "aperture_mm or f_number");
  if (aperture) lens.aperture = aperture->as_number_in(1e-6, 1e6, "mm") * 1e-3;
  if (number) lens.aperture = lens.focal_length / number->as_number_in(0.1, 1e6, "(focal length over diameter)");
  lens.obscuration = p.number_in("obscuration", 0, 0.95, "(share of the diameter)", 0);
  lens.throughput = p.number_in("throughput", 1e-9, 1, "(share of the light)", 1);
  lens.cos4 = p.boolean("cos4", false);
  if (const auto focus = p.find("focus_distance_m")) {
    lens.focus_distance = focus->as_number_in(1e-3, 1e9, "m");
    if (!(lens.aperture > 0))
      throw focus->error("a focus distance matters only with an aperture", "give aperture_mm or f_number");
  }
  if (const auto d = p.find("distortion")) {
    lens.distortion.k1 = d->number("k1", 0), lens.distortion.k2 = d->number("k2", 0),
    lens.distortion.k3 = d->number("k3", 0);
    lens.distortion.p1 = d->number("p1", 0), lens.distortion.p2 = d->number("p2", 0);
  }
  return lens;
}

}  // namespace suite
