// Rational polynomial coefficients (RPC00B): where a place on the Earth lies in a picture.
//
// Based on: NGA STDI-0002, Compendium of Controlled Extensions for NITF, Appendix E (RPC00B, order of the terms); C. V.
// Tao, Y. Hu, "A comprehensive study of the rational function model for photogrammetric processing", PE&RS 67(12), 2001
// (iterated, regularised least squares).
#pragma once
#include <array>
#include <optional>
#include <span>

#include "motion/scene_frame.h"

namespace suite {

// A place and where it is in the picture; (0, 0) is the centre of the first pixel, as RPC00B counts.
struct SightedPlace {
  Geodetic place;
  double line = 0, sample = 0;
};

struct Rpc {
  using Terms = std::array<double, 20>;
  struct Scale {
    double offset = 0, scale = 1;
  };
  Scale line, sample, latitude_deg, longitude_deg, height_m;
  Terms line_numerator{}, line_denominator{}, sample_numerator{}, sample_denominator{};
  double rms = 0, largest = 0;  // pixels, of the places that it was fitted to

  // x = sample, y = line.
  Vec2 image(const Geodetic& place) const;
};

// ridge: of the unknowns against numbers of order 1; more of it follows noise less. Nothing where no coefficients
// follow the places: fewer than 80 of them, or a denominator that comes near to zero.
inline constexpr double kRpcRidge = 1e-6;
std::optional<Rpc> fit_rpc(std::span<const SightedPlace> places, double ridge = kRpcRidge);

}  // namespace suite
