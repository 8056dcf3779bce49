// The throughputs of paths and the light that they have gathered, as spectra: the algebra that the path kernel computes
// in. A path scatters, is attenuated and turns (its frame of reference; nothing to do for spectra), and shines when
// light arrives.
//
// Spectra are not multiplied when it happens. A path keeps a short chain of steps, numbers times spectra that stand
// elsewhere, and folds it when the chain is full or the path ends: one pass over the wavelengths for many events, no
// memory that grows with the length of a path. With T the throughput and L the light gathered so far,
//   turn of the chain:  T <- scale a T          light:  L <- L + scale a b T.
// States of one bin compute with numbers, at once.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "math/vec.h"
#include "transport/contribution.h"

namespace suite {

class SpectralThroughputs {
 public:
  // width: paths that run together; targets: sums of light a path keeps apart (1..65535).
  SpectralThroughputs(size_t width, size_t bins, size_t targets);

  size_t bins() const { return bins_; }
  size_t targets() const { return targets_; }
  // A path starts with a weight and, if not null, a spectrum of weights that outlives it.
  void begin(uint32_t p, float weight, const float* weights) {
    Chain& c = chains_[p];
    c = {};
    if (bins_ == 1) {
      throughput_[size_t{p} * stride_] = weights ? weight * *weights : weight;
      for (size_t t = 0; t < targets_; ++t) light_[(size_t{p} * targets_ + t) * stride_] = 0;
      return;
    }
    c.scale = weight;
    if (weights) add_turn(c, p, weights);
  }
  // T as it stands, times a share, to go back to: T <- what was kept; L stays.
  struct Kept {
    std::vector<float> spectrum;
  };
  void keep(uint32_t p, float share, Kept& to) {
    const std::span<const float> T = throughput(p);
    to.spectrum.resize(bins_);
    for (size_t i = 0; i < bins_; ++i) to.spectrum[i] = share * T[i];
  }
  // The same of what was kept: weakened on the way, times a number.
  static void attenuate(Kept& kept, float scale, std::span<const float> t) {
    for (size_t i = 0; i < kept.spectrum.size(); ++i) kept.spectrum[i] *= scale * t[i];
  }
  void resume(uint32_t p, const Kept& from) {
    settle(p);
    std::copy(from.spectrum.begin(), from.spectrum.end(), &throughput_[size_t{p} * stride_]);
  }
  // T <- T w: scattered, w over its density.
  void scatter(uint32_t p, const Factor& w, const Event&) { multiply(p, w); }
  // T <- T t: weakened on the way.
  void attenuate(uint32_t p, const Factor& t) { multiply(p, t); }
  // Before the scattering: into the plane of the event, in which polarisation is told; spectra have none.
  void turn(uint32_t, const Event&) {}

  // Memory for spectra that stand nowhere else: kDense a path. take() hands them out one after the other; they stay
  // until make_room(), which folds the chain, and all that points to them must stand in the chain by then.
  static constexpr uint32_t kDense = 8;
  bool has_room(uint32_t p, uint32_t count) const { return chains_[p].dense + count <= kDense; }
  void make_room(uint32_t p) {
    if (bins_ > 1) stand(p);
    chains_[p].dense = 0;
  }
  std::span<float> take(uint32_t p) { return {&dense_[(size_t{p} * kDense + chains_[p].dense++) * stride_], bins_}; }
  // The last one taken was not needed.
  void give_back(uint32_t p) { --chains_[p].dense; }

  // L[target] += scale factor radiance T; second: another target that gets the same, kNone = none.
  static constexpr uint16_t kNone = 0xffff;
  void shine(uint32_t p, const Factor& factor, float scale, const float* radiance, uint16_t target,
             uint16_t second = kNone) {
    if (bins_ == 1) return shine_number(p, factor, scale, radiance, target, second);
    Chain& c = chains_[p];
    if (c.steps == kSteps) fold(p);
    step(p, c.steps++) = {factor.spectrum, radiance, c.scale * (factor.scale * scale), target, second};
  }

  // L of a path.
  std::span<const float> light(uint32_t p, size_t target = 0) {
    if (bins_ > 1 && (!chains_[p].light || chains_[p].steps > 0)) fold(p);
    return {&light_[(size_t{p} * targets_ + target) * stride_], bins_};
  }
  // T of a path as it stands.
  std::span<const float> throughput(uint32_t p) {
    settle(p);
    return {&throughput_[size_t{p} * stride_], bins_};
  }

 protected:
  // L[target] += scale factor radiance s T at once, s one value a bin that need not stay.
  void shine_now(uint32_t p, const Factor& factor, float scale, const float* radiance, std::span<const float> s,
                 uint16_t target);

 private:
  static constexpr uint32_t kSteps = 16;
  static constexpr uint16_t kTurn = 0xfffe;  // target of steps that change T
  struct Step {
    const float *a, *b;  // null = ones
    float scale;         // that of T included
    uint16_t target, second;
  };
  struct Chain {
    uint32_t steps = 0, dense = 0;
    bool light = false;  // L stands in memory; else it is 0
    // T now is scale times the turns among the steps times t u, which are from before; t: the path's own memory, or a
    // spectrum that stands elsewhere.
    float scale = 1;
    const float *t = nullptr, *u = nullptr;  // null = ones; u: only with t
  };
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  using Spectra = std::unique_ptr<float[], Free>;
  static Spectra spectra(size_t floats);

  Step& step(uint32_t p, uint32_t i) { return steps_[size_t{p} * kSteps + i]; }
  void add_turn(Chain& c, uint32_t p, const float* by) { step(p, c.steps++) = {by, nullptr, 1, kTurn, kNone}; }
  void multiply(uint32_t p, const Factor& f) {
    if (bins_ == 1) {
      float& T = throughput_[size_t{p} * stride_];
      T *= f.spectrum ? f.scale * *f.spectrum : f.scale;
      return;
    }
    Chain& c = chains_[p];
    c.scale *= f.scale;
    if (f.spectrum) {
      if (c.steps == kSteps) fold(p);
      add_turn(c, p, f.spectrum);
    }
    // Numbers and spectra that make up for each other must not run out of what a float can be.
    constexpr float kFar = 0x1p20f;
    if (!(c.scale > 1 / kFar && c.scale < kFar)) settle(p);
  }
  void shine_number(uint32_t p, const Factor& f, float scale, const float* radiance, uint16_t target, uint16_t second) {
    const float x = f.scale * scale * (f.spectrum ? *f.spectrum : 1) * (radiance ? *radiance : 1) *
                    throughput_[size_t{p} * stride_];
    light_[(size_t{p} * targets_ + target) * stride_] += x;
    if (second != kNone) light_[(size_t{p} * targets_ + second) * stride_] += x;
  }
  // Brings L to memory, of the chain's steps, and T to few factors.
  void fold(uint32_t p);
  void turn_by(uint32_t p, const float* by);
  // The same, and T but for its scale where nothing changes it: no step points elsewhere.
  void stand(uint32_t p);
  // All of it: nothing points elsewhere.
  void settle(uint32_t p);

  size_t bins_, stride_, targets_;
  std::vector<Chain> chains_;
  std::vector<Step> steps_;
  Spectra dense_, throughput_, light_;
};

}  // namespace suite
