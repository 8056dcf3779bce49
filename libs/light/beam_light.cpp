#include "light/beam_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace suite {

namespace {
constexpr float kShadow = 1e4f;  // depth of a beam in the shadow of the Earth
}

BeamLight::BeamLight(const AirColumn& column, const std::vector<Beam>& beams, const std::vector<BeamTable>& tables)
    : column_(column), beams_(beams), tables_(tables), bins_(column.bins), thin_(column), local_(column, beams) {
  for (const AirColumn::Kind& kind : column_.kinds)
    for (size_t l = 0; l < column_.layers(); ++l) {
      const float* const row = &kind.scattering[l * bins_];
      scatters_.push_back(std::any_of(row, row + bins_, [](float v) { return v > 0; }));
    }
}

// Light comes along -beam and goes on along -d: angles for phase functions, which are looked up where they matter.
void BeamLight::begin(Dir d, AirScratch& s) const {
  for (size_t b = 0; b < beams_.size(); ++b) {
    s.cosines[b] = std::clamp(dot(beams_[b].direction, d), -1.0, 1.0);
    for (std::vector<float>& p : s.phases[b]) p.clear();
    s.near[b].known = false;
  }
}

void BeamLight::add(const Shells::Piece& piece, Vec3 from, Dir d, AirScratch& s, bool& weighed,
                    std::span<const float> T, std::span<float> S) const {
  for (size_t b = 0; b < beams_.size(); ++b) {
    BeamAt &near = s.near[b], &far = s.far[b];
    const std::optional<Growth> grows = growth(b, piece, from, d);
    if (grows && piece.near == 0 && scatter_here(b, piece, *grows, s, S)) continue;
    if (!near.known) look_up(b, from + d * piece.near, piece.near_height, near);
    source(b, piece.layer, s, s.scattered);
    if (grows && scatter_thin(b, piece, *grows, s, T, S)) continue;
    const auto length = static_cast<float>(piece.length);
    if (!std::exchange(weighed, true))
      air_loops::weigh(bins_, &column_.extinction[piece.layer * bins_], length, s.weights());
    look_up(b, from + d * piece.far, piece.far_height, far);
    if (near.lit == far.lit)
      scatter(near, far, length, s.weights(), s, T, S);
    else
      scatter_lit(b, piece, from, d, s, T, S);
    std::swap(near, far);
  }
}

const std::vector<float>& BeamLight::phase_of(size_t b, size_t kind, AirScratch& s) const {
  std::vector<float>& p = s.phases[b][kind];
  if (!p.empty()) return p;
  p.resize(bins_);
  const PhaseFunction& phase = *column_.kinds[kind].phase;
  phase.eval(s.cosines[b], phase.spectrally_uniform() ? std::span(p).first(1) : std::span(p));
  if (phase.spectrally_uniform()) std::fill(p.begin(), p.end(), p[0]);
  return p;
}
bool BeamLight::depth(size_t b, Vec3 p, double height, std::span<float> to) const {
  const bool lit = tables_[b].spread_depth(height, column_.shells.cosine(p, height, beams_[b].direction), to);
  if (!lit) std::fill(to.begin(), to.end(), kShadow);
  return lit;
}
void BeamLight::look_up(size_t b, Vec3 p, double height, BeamAt& at) const {
  at.known = true;
  at.lit = depth(b, p, height, at.depth);
  air_loops::fall(bins_, at.depth.data(), at.light.data());
}

// Scattering times phase function, summed over the kinds, times the irradiance of the beam above the air.
void BeamLight::source(size_t b, size_t layer, AirScratch& s, std::span<float> to) const {
  std::fill(to.begin(), to.end(), 0.0f);
  for (size_t k = 0; k < column_.kinds.size(); ++k) {
    if (scatters_[k * column_.layers() + layer])
      air_loops::multiply_add(bins_, &column_.kinds[k].scattering[layer * bins_], phase_of(b, k, s).data(), to.data());
  }
  for (size_t i = 0; i < bins_; ++i) to[i] *= beams_[b].irradiance[i];
}

// Light of a beam that is scattered once on a way; s.scattered: how.
void BeamLight::scatter(const BeamAt& near, const BeamAt& far, float length, const air_loops::Weights& weights,
                        const AirScratch& s, std::span<const float> T, std::span<float> S) const {
  air_loops::scatter(bins_, s.scattered.data(), length, weights, {near.depth.data(), near.light.data()},
                     {far.depth.data(), far.light.data()}, T.data(), S.data());
}

// Nothing where it does not change evenly.
std::optional<BeamLight::Growth> BeamLight::growth(size_t b, const Shells::Piece& piece, Vec3 from, Dir d) const {
  constexpr double kLow = 0.2, kTurn = 0.01;
  if (!column_.refractivity.empty()) return std::nullopt;
  const Dir beam = beams_[b].direction;
  const double near = column_.shells.cosine(from + d * piece.near, piece.near_height, beam),
               far = column_.shells.cosine(from + d * piece.far, piece.far_height, beam);
  if (near < kLow || far < kLow) return std::nullopt;
  const double rise = piece.far_height - piece.near_height,
               share = near / far - 1 + rise * column_.shells.curvature() / (far * far);
  if (std::fabs(share) > kTurn) return std::nullopt;
  return Growth{near, -rise / far, share};
}

// A thin piece; s.near: where it begins. False: not so.
bool BeamLight::scatter_thin(size_t b, const Shells::Piece& piece, const Growth& growth, AirScratch& s,
                             std::span<const float> T, std::span<float> S) const {
  if (!thin_.all(piece.layer, piece.length + std::fabs(growth.way))) return false;
  air_loops::scatter_thin(bins_, &column_.extinction[piece.layer * bins_], static_cast<float>(piece.length),
                          {s.near[b].light.data(), s.near[b].depth.data(), s.scattered.data(),
                           static_cast<float>(growth.way), static_cast<float>(growth.share)},
                          T.data(), S.data());
  s.near[b].known = false;
  return true;
}

std::optional<air_loops::BeamHere> BeamLight::here(size_t b, const Shells::Piece& piece, const Growth& growth,
                                                   double cosine) const {
  if (!local_.keeps_scattering()) return std::nullopt;
  const auto depth = local_.depth(piece.near_height, growth.near);
  if (!depth) return std::nullopt;
  const auto length = static_cast<float>(piece.length);
  return air_loops::BeamHere{*depth, local_.scattered(b, piece.layer, cosine), length,
                             length + static_cast<float>(growth.way), static_cast<float>(growth.share)};
}

std::optional<air_loops::BeamHere> BeamLight::here(size_t b, const Shells::Piece& piece, Vec3 from, Dir d) const {
  const std::optional<Growth> grows = growth(b, piece, from, d);
  if (!grows) return std::nullopt;
  return here(b, piece, *grows, std::clamp(dot(beams_[b].direction, d), -1.0, 1.0));
}

// A piece that begins the way, near the scene's middle, however thin.
bool BeamLight::scatter_here(size_t b, const Shells::Piece& piece, const Growth& growth, AirScratch& s,
                             std::span<float> S) const {
  const auto beam = here(b, piece, growth, s.cosines[b]);
  if (!beam) return false;
  const float* const k = &column_.extinction[piece.layer * bins_];
  thin_.over(piece.layer, piece.length + std::fabs(growth.way), [&](size_t i, size_t n, bool thin) {
    if (thin)
      air_loops::scatter_here<true>(i, n, k, *beam, S.data());
    else
      air_loops::scatter_here<false>(i, n, k, *beam, S.data());
  });
  s.near[b].known = false;
  return true;
}

// The same of a piece that goes into the shadow of the Earth or comes out of it: only the part outside is lit.
void BeamLight::scatter_lit(size_t b, const Shells::Piece& piece, Vec3 from, Dir d, AirScratch& s,
                            std::span<const float> T, std::span<float> S) const {
  const bool near_lit = s.near[b].lit;
  double lit = near_lit ? piece.near : piece.far, dark = near_lit ? piece.far : piece.near;
  const auto at = [&](double t) { return from + d * t; };
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (lit + dark);
    const Vec3 p = at(middle);
    const double height = column_.shells.height(p), cosine = column_.shells.cosine(p, height, beams_[b].direction);
    (tables_[b].seen(height, cosine) ? lit : dark) = middle;
  }
  look_up(b, at(lit), column_.shells.height(at(lit)), s.edge);
  const auto share = static_cast<float>(std::fabs(lit - (near_lit ? piece.near : piece.far)) / piece.length);
  for (size_t i = 0; i < bins_; ++i) {
    s.lit_depth[i] = share * s.depth[i];
    s.lit_keep[i] = exp_falling(s.lit_depth[i]);
    s.dark_T[i] = near_lit ? T[i] : T[i] * exp_falling((1 - share) * s.depth[i]);
  }
  scatter(near_lit ? s.near[b] : s.edge, near_lit ? s.edge : s.far[b], share * static_cast<float>(piece.length),
          {s.lit_depth.data(), s.lit_keep.data(), nullptr, nullptr}, s, s.dark_T, S);
}

}  // namespace suite
