#include "transport/media/air_light.h"

#include <algorithm>

namespace suite {

namespace {
constexpr float kThin = 2e-2f;  // depths up to which series of three terms hold to the last bits of a float

float exp_thin(float x) { return 1 - x * (1 - x * (0.5f - x * (1 / 6.0f))); }  // exp(-x)
float mean_thin(float x) { return 1 - x * (0.5f - x * (1 / 6.0f)); }           // (1 - exp(-x)) / x
}  // namespace

double place_in_fall(double u, double fall) {
  if (fall < 0) return 1 - place_in_fall(1 - u, -fall);
  return fall > 0 ? std::min(1.0, -std::log1p(-u * -std::expm1(-fall)) / fall) : u;
}

AirLight::AirLight(const Atmosphere* air, size_t bins) : air_(air) {
  if (!air) return;
  for (auto* v : {&left_, &passed_, &grow_, &keep_, &fall_, &source_}) v->resize(bins);
  beams_.resize(air->beams());
  for (Scattered& b : beams_)
    for (auto* v : {&b.light, &b.depth, &b.slope, &b.near}) v->resize(bins);
}

void AirLight::begin() {
  layer_ = kNone;
  std::fill(left_.begin(), left_.end(), 1.0f);
  std::fill(passed_.begin(), passed_.end(), 0.0f);
}

void AirLight::enter(uint32_t layer, Vec3 from, Dir direction) {
  if (layer != kNone && layer != layer_) {
    extinction_ = air_->extinction(layer);
    air_->source(layer, from, direction, source_);
    for (size_t b = 0; b < beams_.size(); ++b) {
      Scattered& s = beams_[b];
      air_->beam(b, layer, from, direction, {s.light, s.depth, s.slope});
      for (size_t i = 0; i < s.near.size(); ++i) s.near[i] = std::exp(-s.depth[i]);
    }
  }
  layer_ = layer;
}

void AirLight::pass(double length, std::span<const float> depth, std::span<const float> emission, double u,
                    std::span<double> sent, std::span<double> place) {
  const auto way = static_cast<float>(std::min(length, kLongestInAir));
  add_warm(way, depth, emission, sent);
  fall_ = grow_;
  std::fill(place.begin(), place.end(), u);
  if (layer_ != kNone)
    for (Scattered& b : beams_) add_beam(b, way, sent, place);
  for (size_t i = 0; i < place.size(); ++i) {
    const double v = place[i], x = fall_[i];
    place[i] =
        std::fabs(x) < kThin ? v - 0.5 * x * v * (1 - v) * (1 - x * (1 / 3.0) * (1 - 2 * v)) : place_in_fall(v, x);
  }
  for (size_t i = 0; i < left_.size(); ++i) left_[i] *= keep_[i];
}

void AirLight::add_warm(float way, std::span<const float> depth, std::span<const float> emission,
                        std::span<double> sent) {
  for (size_t i = 0; i < sent.size(); ++i) {
    float x = depth[i], e = emission[i];
    if (layer_ != kNone) {
      const float tau = extinction_[i] * way;
      passed_[i] += tau;
      x += tau;
      e += tau * source_[i];
    }
    const bool thin = x < kThin;
    grow_[i] = x;
    keep_[i] = thin ? exp_thin(x) : std::exp(-x);
    sent[i] = left_[i] * e * (thin ? mean_thin(x) : (1 - keep_[i]) / x);
  }
}

// What a beam adds to the sum; and whether the place lies in this part, drawn anew with what is left of the number.
void AirLight::add_beam(Scattered& b, float way, std::span<double> sent, std::span<double> left_to_draw) {
  for (size_t i = 0; i < sent.size(); ++i) {
    const float rise = b.slope[i] * way, x = grow_[i] + rise, t = b.depth[i];
    const float mean = std::fabs(x) < kThin ? b.near[i] * mean_thin(x) : (b.near[i] - std::exp(-t - x)) / x;
    const double part = left_[i] * b.light[i] * way * mean;
    sent[i] += part;
    if (!left_to_draw.empty() && part > 0) {
      const double share = part / sent[i];
      double& u = left_to_draw[i];
      const bool here = u < share;
      u = here ? u / share : (u - share) / (1 - share);
      if (here) fall_[i] = x;
    }
    // From far below the beam's own light the series could never come back.
    b.depth[i] = t + rise;
    b.near[i] = std::fabs(rise) < kThin && b.near[i] > 1e-30f ? b.near[i] * exp_thin(rise) : std::exp(-b.depth[i]);
  }
}

void AirLight::transmittance(std::span<float> T) const {
  for (size_t i = 0; i < T.size(); ++i) T[i] = std::exp(-passed_[i]);
}

void AirLight::bend(Vec3 from, Dir direction, std::span<float> T) const {
  if (air_->bends()) air_->transmittance(from, direction, std::numeric_limits<double>::infinity(), T);
}

}  // namespace suite
