// Light forwards, for tests of light that is asked for backwards: from the sun through a smooth interface to a grid on
// a floor, by code that shares nothing with the suite but vectors.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite::test {

// Snell's law by angles: the direction behind an interface of a ray along d; n: unit normal against it; eta: index
// behind over in front. transmittance: of unpolarised light, by Fresnel's formulas of sines and tangents.
struct Forward {
  Vec3 direction;
  double transmittance = 0;
};
inline Forward forward_refract(Vec3 d, Vec3 n, double eta) {
  const double c = std::fmin(1.0, -dot(d, n)), incident = std::acos(c), s = std::sin(incident) / eta;
  if (s >= 1) return {};
  const double refracted = std::asin(s);
  Forward f;
  const Vec3 along = d + n * c;  // in the surface
  const double len = length(along);
  f.direction = n * -std::cos(refracted) + (len > 0 ? along * (s / len) : Vec3{});
  if (incident < 1e-6) {
    f.transmittance = 4 * eta / ((1 + eta) * (1 + eta));
    return f;
  }
  const double less = incident - refracted, more = incident + refracted;
  const double rs = std::sin(less) / std::sin(more), rp = rs * std::cos(more) / std::cos(less);  // of the tangents
  f.transmittance = 1 - 0.5 * (rs * rs + rp * rp);
  return f;
}

// Flux on a square grid of cells around the origin of the plane z = floor.
struct FluxMap {
  int cells;     // a side
  double width;  // m
  double floor;  // m
  std::vector<double> flux = std::vector<double>(static_cast<size_t>(cells) * static_cast<size_t>(cells));
  // Whether it falls onto the grid.
  bool add(Vec3 from, Vec3 direction, double amount) {
    const double t = (floor - from.z) / direction.z, x = (from.x + t * direction.x) / width + 0.5,
                 y = (from.y + t * direction.y) / width + 0.5;
    if (x < 0 || x >= 1 || y < 0 || y >= 1) return false;
    flux[static_cast<size_t>(y * cells) * static_cast<size_t>(cells) + static_cast<size_t>(x * cells)] += amount;
    return true;
  }
  double cell_area() const { return width * width / (cells * cells); }
};

// One wave: a sin(kx x + ky y + phase), m and 1/m.
struct Wave {
  double a, kx, ky, phase;
};

// The square of surface that is lit: its middle, its side and rays a side.
struct Lit {
  double x, y, side;  // m
  int steps;
};
// A parallel beam of irradiance 1 (on a plane facing it) from `sun` through a surface of waves about z = 0 that does
// not shadow itself, onto several floors; eta: water over air. Returns how many rays of the outermost hundredth of the
// square still fall onto a map: 0, or what lies outside of the square is missed.
inline int light_waves(std::span<FluxMap> maps, const std::vector<Wave>& waves, Vec3 sun, double eta, const Lit& lit) {
  const double h = lit.side / lit.steps;
  const int rim = lit.steps / 100;
  const auto steps = static_cast<size_t>(lit.steps);
  const auto x_of = [&](int i) { return lit.x + (i + 0.5) * h - lit.side / 2; };
  // Sines and cosines of kx x + phase, by wave and column.
  std::vector<double> sines, cosines;
  for (const Wave& w : waves)
    for (int i = 0; i < lit.steps; ++i) {
      const double phase = w.kx * x_of(i) + w.phase;
      sines.push_back(std::sin(phase)), cosines.push_back(std::cos(phase));
    }
  int missed = 0;
  for (int j = 0; j < lit.steps; ++j) {
    const double y = lit.y + (j + 0.5) * h - lit.side / 2;
    std::vector<double> sine_y, cosine_y;  // of ky y, by wave
    for (const Wave& w : waves) sine_y.push_back(std::sin(w.ky * y)), cosine_y.push_back(std::cos(w.ky * y));
    for (int i = 0; i < lit.steps; ++i) {
      const double x = x_of(i);
      double z = 0, zx = 0, zy = 0;
      for (size_t k = 0; k < waves.size(); ++k) {
        const Wave& w = waves[k];
        const double s = sines[k * steps + static_cast<size_t>(i)], c = cosines[k * steps + static_cast<size_t>(i)];
        const double sine = s * cosine_y[k] + c * sine_y[k], cosine = c * cosine_y[k] - s * sine_y[k];
        z += w.a * sine, zx += w.a * w.kx * cosine, zy += w.a * w.ky * cosine;
      }
      const Vec3 up{-zx, -zy, 1};
      const double flux = dot(sun, up) * h * h;
      if (flux <= 0) continue;
      const Forward f = forward_refract(-sun, normalized(up), eta);
      const bool outermost = std::min({i, j, lit.steps - 1 - i, lit.steps - 1 - j}) < rim;
      for (FluxMap& map : maps) missed += map.add({x, y, z}, f.direction, flux * f.transmittance) && outermost;
    }
  }
  return missed;
}

// The same beam on a sphere: what passes it by two refractions, and (beside) what passes beside it. Rays of one
// distance from the beam's middle are refracted alike and turned about it: `rings` of equal areas, twice as many rays
// in each.
inline void light_sphere(FluxMap& map, Vec3 centre, double radius, Vec3 sun, double eta, int rings) {
  const Frame across = Frame::around(-sun);
  const int around = 2 * rings;
  const double area = kPi * radius * radius / rings / around;
  std::vector<double> sines, cosines;
  for (int j = 0; j < around; ++j)
    sines.push_back(std::sin(2 * kPi * j / around)), cosines.push_back(std::cos(2 * kPi * j / around));
  for (int k = 0; k < rings; ++k) {
    const double share = (k + 0.5) / rings;
    const Vec3 in = across.x * (radius * std::sqrt(share)) + sun * (radius * std::sqrt(1 - share)), n = in / radius;
    const Forward first = forward_refract(-sun, n, eta);
    const Vec3 out = in - first.direction * (2 * dot(in, first.direction));
    const Forward second = forward_refract(first.direction, out / -radius, 1 / eta);
    if (!(second.transmittance > 0)) continue;
    const double out_across = dot(out, across.x), across_on = dot(second.direction, across.x);
    const Vec3 out_along = sun * dot(out, sun), along_on = sun * dot(second.direction, sun);
    // Every ring begins elsewhere (golden section), lest their rays stand in lines.
    const double turn = 2 * kPi / around * std::fmod(0.6180339887 * k, 1.0), s = std::sin(turn), c = std::cos(turn);
    for (size_t j = 0; j < sines.size(); ++j) {
      const Vec3 e = across.x * (cosines[j] * c - sines[j] * s) + across.y * (sines[j] * c + cosines[j] * s);
      map.add(centre + out_along + e * out_across, along_on + e * across_on,
              area * first.transmittance * second.transmittance);
    }
  }
  // Beside it, on the floor: lines towards the sun that miss the sphere.
  const int fine = 4 * rings / 5;
  const double g = map.width / fine;
  for (int j = 0; j < fine; ++j)
    for (int i = 0; i < fine; ++i) {
      const Vec3 p{(i + 0.5) * g - map.width / 2, (j + 0.5) * g - map.width / 2, map.floor}, to = centre - p;
      const double along = dot(to, sun), off2 = dot(to, to) - along * along;
      if (off2 > radius * radius || along < 0) map.add(p + sun, -sun, sun.z * g * g);
    }
}

}  // namespace suite::test
