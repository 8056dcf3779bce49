#include "transport/media/air_light.h"

#include <algorithm>

namespace suite {

AirLight::AirLight(const Atmosphere* air, size_t bins) : air_(air) {
  if (!air) return;
  left_.resize(bins), passed_.resize(bins);
  beams_.resize(air->beams());
  for (Part& b : beams_) b.scattered.resize(bins), b.depth.resize(bins), b.slope.resize(bins);
}

void AirLight::begin() {
  layer_ = kNone;
  std::fill(left_.begin(), left_.end(), 1.0f);
  std::fill(passed_.begin(), passed_.end(), 0.0f);
}

void AirLight::enter(uint32_t layer, Vec3 from, Dir direction) {
  if (layer != kNone && layer != layer_)
    for (size_t b = 0; b < beams_.size(); ++b)
      air_->beam(b, layer, from, direction, {beams_[b].scattered, beams_[b].depth, beams_[b].slope});
  layer_ = layer;
}

void AirLight::shine(size_t part, double length, std::span<const float> depth, std::span<const float> emission,
                     std::span<float> fall, std::span<double> sent) const {
  const size_t n = sent.size();
  const auto way = static_cast<float>(std::min(length, kLongestInAir));
  if (layer_ == kNone) {  // media alone, above the air
    for (size_t i = 0; i < n; ++i) {
      fall[i] = depth[i];
      sent[i] = part == 0 ? left_[i] * emission[i] * mean_falling(0, fall[i]) : 0;
    }
    return;
  }
  const Atmosphere::Layer layer = air_->layer(layer_);
  const float *k = layer.extinction.data(), *source = layer.source.data();
  if (part == 0) {
    for (size_t i = 0; i < n; ++i) {
      const float tau = k[i] * way;
      fall[i] = depth[i] + tau;
      sent[i] = left_[i] * (emission[i] + tau * source[i]) * mean_falling(0, fall[i]);
    }
    return;
  }
  const Part& b = beams_[part - 1];
  for (size_t i = 0; i < n; ++i) {
    fall[i] = depth[i] + (k[i] + b.slope[i]) * way;
    sent[i] = left_[i] * b.scattered[i] * way * mean_falling(b.depth[i], fall[i]);
  }
}

void AirLight::pass(double length, std::span<const float> depth) {
  const size_t n = left_.size();
  if (layer_ == kNone) {
    for (size_t i = 0; i < n; ++i) left_[i] *= std::exp(-depth[i]);
    return;
  }
  const auto way = static_cast<float>(std::min(length, kLongestInAir));
  const float* k = air_->layer(layer_).extinction.data();
  for (size_t i = 0; i < n; ++i) {
    const float tau = k[i] * way;
    passed_[i] += tau;
    left_[i] *= std::exp(-depth[i] - tau);
  }
  for (Part& b : beams_)
    for (size_t i = 0; i < n; ++i) b.depth[i] += b.slope[i] * way;
}

void AirLight::transmittance(std::span<float> T) const {
  for (size_t i = 0; i < T.size(); ++i) T[i] = std::exp(-passed_[i]);
}

}  // namespace suite
