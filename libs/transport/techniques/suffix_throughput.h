// The throughput of a suffix by which a technique connects a path with a light: what its events make of the light, from
// a node on towards the light, in that order. Techniques multiply here, spectra as well as the matrices of algebras
// that carry polarisation, and nowhere else.
#pragma once
#include <algorithm>
#include <span>

#include "transport/refracted/way.h"
#include "transport/wave.h"

namespace suite {

// One at a time: matrices and scratch are the wave's.
template <class Wave>
class SuffixThroughput {
 public:
  using Matrices = typename Wave::Matrices;
  // spectrum: memory for it. Of what contribute() hands over it must stay as long as the path's memory does.
  SuffixThroughput(Wave& wave, std::span<float> spectrum) : wave_(wave), spectrum_(spectrum) {}
  std::span<float> spectrum() const { return spectrum_; }
  const Matrices& matrices() const { return wave_.polarisation.suffix; }

  // T <- w, of which nothing is multiplied before it has to be: what matte surfaces make of light stands elsewhere.
  void leave_as_is(const PathNode& node, Dir in) { whole_ = wave_.evaluate(node, in, spectrum_); }
  // T <- T t after that.
  void weaken_as_is(std::span<const float> t) {
    for (size_t b = 0; b < wave_.bins; ++b) spectrum_[b] = (whole_.spectrum ? whole_.spectrum[b] : 1.0f) * t[b];
    whole_.spectrum = spectrum_.data();
  }
  // Whether the memory is part of it.
  bool stands_in_memory() const { return whole_.spectrum == spectrum_.data(); }
  const Factor& as_is() const { return whole_; }
  // T <- w: it begins with the node, which scatters light from `in`.
  void leave(const PathNode& node, Dir in) {
    const Factor w = wave_.evaluate(node, in, wave_.transmission);
    for (size_t b = 0; b < wave_.bins; ++b) spectrum_[b] = w.scale * (w.spectrum ? w.spectrum[b] : 1.0f);
    if constexpr (Wave::kStokes) wave_.polarise(node, in);
  }
  // The same of an event of what fills space, spectrum alone but for the number that belongs to it, which is returned.
  double leave_apart(const PathNode& node, Dir in) {
    const Factor w = wave_.evaluate(node, in, spectrum_);
    if (w.spectrum != spectrum_.data()) std::copy_n(w.spectrum, wave_.bins, spectrum_.data());
    return double{w.scale};
  }
  // T <- one that has been begun, and goes on in this memory.
  void resume(std::span<const float> spectrum, const Matrices& matrices) {
    std::copy(spectrum.begin(), spectrum.end(), spectrum_.begin());
    wave_.polarisation.suffix.begin(matrices);
  }
  // The same of a spectrum that has begun with the node and gone on through what only weakens it,
  void resume(std::span<const float> spectrum, const PathNode& node, Dir in) {
    std::copy(spectrum.begin(), spectrum.end(), spectrum_.begin());
    if constexpr (Wave::kStokes) wave_.polarise(node, in);
  }
  // or with nothing else than that.
  void resume(std::span<const float> spectrum) {
    std::copy(spectrum.begin(), spectrum.end(), spectrum_.begin());
    if constexpr (Wave::kStokes) wave_.polarisation.suffix.begin();
  }

  // T <- T v / density: what fills space at one of its events scatters light from `in` towards `out`.
  void scatter(uint32_t event, Dir out, Dir in, double density) {
    const Factor v = wave_.space.evaluate(event, scattering_cosine(out, in), wave_.transmission);
    const auto scale = static_cast<float>(double{v.scale} / density);
    for (size_t b = 0; b < wave_.bins; ++b) spectrum_[b] *= scale * (v.spectrum ? v.spectrum[b] : 1.0f);
    if constexpr (Wave::kStokes) wave_.polarise_further(event, out, in);
  }
  // The same but for the number that belongs to v's spectrum, which is returned.
  double scatter_apart(uint32_t event, Dir out, Dir in) {
    const Factor v = wave_.space.evaluate(event, scattering_cosine(out, in), wave_.transmission);
    if (v.spectrum)
      for (size_t b = 0; b < wave_.bins; ++b) spectrum_[b] *= v.spectrum[b];
    if constexpr (Wave::kStokes) wave_.polarise_further(event, out, in);
    return double{v.scale};
  }
  // T <- T w: a lobe of a smooth interface passes or reflects light that goes the ways of a knot's.
  void meet(const RefractedEvent& at, int lobe, size_t knot, double time) {
    at.model->delta_weight(at.out_local, lobe, static_cast<int>(knot), wave_.transmission);
    weaken(wave_.transmission);
    if constexpr (Wave::kStokes) wave_.polarise_further(at.hit, at.out, at.in, lobe, static_cast<int>(knot), time);
  }
  // T <- T t: of what does not turn the state of light.
  void weaken(std::span<const float> t) {
    for (size_t b = 0; b < wave_.bins; ++b) spectrum_[b] *= t[b];
  }
  void weaken(float t) {
    for (float& T : spectrum_) T *= t;
  }
  // The way has run `length` m straight on; returns the group index there.
  double follow(const Ray& ray, double length) {
    return wave_.space.follow_way(ray, length, spectrum_, wave_.transmission);
  }

  // Counts a contribution of the wave with this throughput.
  void contribute(Contribution& c) {
    c.factor = {1, spectrum_.data()};
    if constexpr (Wave::kStokes) c.polarised = wave_.polarisation.suffix.event();
    wave_.contribute();
    if constexpr (Wave::kStokes) wave_.hand_over();  // the next suffix has other matrices
  }

 private:
  Wave& wave_;
  std::span<float> spectrum_;
  Factor whole_;
};

}  // namespace suite
