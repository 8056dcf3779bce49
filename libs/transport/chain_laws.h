// What chains of scatterings are drawn by (techniques/volume_chains.h): how many there are, and where.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

// How many scatterings: with the weights t^n / n! of Poisson's law for n of them on a way of depth t, and a tail that
// falls slowly. Chains leave the straight way: those of many scatterings run on long ones, where that many are no
// rarity, and must not be drawn as rarely as on the straight one; a few would bring all of their light.
class LinkCount {
 public:
  // albedo: of single scattering; least, most: numbers that are drawn.
  LinkCount(double depth, double albedo, int least, int most)
      : depth_(depth), falls_(std::clamp(kFalls * albedo, 0.1, kFalls)), least_(least), most_(most) {
    double sum = 0, p = 1;
    for (int n = 0; n <= most; ++n) {
      if (n > 0) p *= depth / n;
      if (n == least) first_ = p;
      if (n >= least) sum += p;
    }
    first_ *= (1 - kTail) / sum;
    tail_ = kTail * (1 - falls_) / (1 - std::pow(falls_, most - least + 1));
  }
  double probability(int links) const {
    double p = first_, tail = tail_;
    for (int n = least_ + 1; n <= links; ++n) p *= depth_ / n, tail *= falls_;
    return p + tail;
  }
  // u: in [0, 1).
  int draw(double u) const {
    int links = least_;
    for (double p = first_, tail = tail_; links < most_ && u >= p + tail; tail *= falls_) {
      u -= p + tail;
      p *= depth_ / ++links;
    }
    return links;
  }

 private:
  // In the ocean of particles of b / c = 0.9 (physics_transport_ocean) 0.2 or 0.3 and 0.9 to 1 are alike.
  static constexpr double kTail = 0.2, kFalls = 0.95;
  double depth_, falls_, first_ = 0, tail_;
  int least_, most_;
};

// At what share x of the way that it may stand on the next one of some scatterings stands. With t the depth that this
// way has more than the one of the same height towards the light, the light that comes on from there goes as exp(-t x);
// with m scatterings more that run about as steeply as the light and share what is left of the height, as (1 - x)^m.
// Where t is small that is the density, else exp(-(t + m) x), and in either case something even beside it.
class LinkPlace {
 public:
  // more: t, of either sign; others: m.
  LinkPlace(double more, int others)
      : together_(std::fabs(more) < kSmall ? others + 1 : 0), falls_(std::clamp(more + others, -kMost, kMost)) {
    if (together_ == 0 && std::fabs(falls_) < kEven) together_ = 1;
  }
  double draw(Vec2 u) const {
    if (u.y < kEvenly) return u.x;
    if (together_ > 0) return 1 - std::pow(1 - u.x, 1.0 / together_);
    return std::clamp(-std::log1p(u.x * std::expm1(-falls_)) / falls_, 0.0, 1.0);
  }
  double density(double x) const {
    return kEvenly + (1 - kEvenly) * (together_ > 0 ? together_ * std::pow(1 - x, together_ - 1)
                                                    : falls_ * std::exp(-falls_ * x) / -std::expm1(-falls_));
  }

 private:
  // Each of n scatterings costs a factor of 1 - kEvenly where its law is right.
  static constexpr double kEvenly = 0.05, kSmall = 0.5, kMost = 30, kEven = 1e-6;
  int together_;  // m + 1 where the density goes as (1 - x)^m, else 0
  double falls_;
};

}  // namespace suite
