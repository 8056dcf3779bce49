// Walks from surface to surface outside of the path kernel: the sunlight of heat balances, the albedo of scenes,
// photons that look for caustics. How a path is drawn at a surface, what becomes of its light, and how chance ends it.
//
// A path is drawn from the shapes at one of the state's hero wavelengths (knots), chosen evenly. With r_k the density
// of the path at knot k over that at its own, its light counts 1 / mean(r_k) times (one-sample balance heuristic: E.
// Veach & L. Guibas, "Optimally combining sampling techniques for Monte Carlo rendering", SIGGRAPH 1995).
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "optics/scatter_model.h"
#include "spectral/state.h"
#include "trace/tracer.h"

namespace suite {

// Takes paths from surface to surface until all have ended. go_on(path, ray, hit, n) is asked for each at its n-th
// surface, or where it leaves, and returns false when it has ended; after_stage() is called when all were asked once.
// coherent: the first rays run alongside each other.
template <class Path, class GoOn, class AfterStage>
void walk(const Tracer& tracer, std::vector<Path>& going, std::vector<Ray>& rays, std::vector<Hit>& hits, bool coherent,
          TraceStatistics& statistics, const GoOn& go_on, const AfterStage& after_stage) {
  for (uint32_t n = 0; !going.empty(); ++n) {
    hits.resize(rays.size());
    tracer.nearest(rays, hits, coherent && n == 0, statistics);
    size_t kept = 0;
    for (size_t i = 0; i < going.size(); ++i) {
      Path path = going[i];
      Ray ray = rays[i];
      if (!go_on(path, ray, hits[i], n)) continue;
      going[kept] = path, rays[kept] = ray;
      ++kept;
    }
    going.resize(kept), rays.resize(kept);
    after_stage();
  }
}

// Draws how a path goes on, with the first three numbers, and says the weights of all bins and the densities at all
// knots of what was drawn, of a Dirac lobe or not. Nothing: drawn in vain.
inline std::optional<ScatterModel::Sample> draw_reflection(const ScatterModel& model, Dir out,
                                                           const std::array<double, 4>& u, int knot, std::span<float> w,
                                                           std::span<float> p) {
  auto drawn = model.sample(out, {u[0], u[1]}, u[2], knot);
  if (!drawn) return std::nullopt;
  if (drawn->delta) {
    model.delta_weight(out, drawn->lobe, knot, w);
    model.delta_probability(out, drawn->lobe, knot, p);
  } else {
    model.eval(out, drawn->in, w);
    model.pdf(out, drawn->in, p);
  }
  if (!(p[static_cast<size_t>(knot)] > 0)) return std::nullopt;
  return drawn;
}

// What a path remembers of how it was drawn.
struct WalkDensities {
  int knot = 0;                          // whose shapes draw it
  std::array<double, kMaxKnots> ratios;  // r_k
  // u: in [0, 1), chooses the knot.
  void start(double u, size_t knots) {
    knot = std::min(static_cast<int>(u * static_cast<double>(knots)), static_cast<int>(knots) - 1);
    ratios.fill(1);
  }
  // 1 / mean(r_k).
  double weight(size_t knots) const {
    double sum = 0;
    for (size_t k = 0; k < knots; ++k) sum += ratios[k];
    return static_cast<double>(knots) / sum;
  }
};

// The spectra of paths at surfaces; of one thread.
class SurfaceWalk {
 public:
  explicit SurfaceWalk(const SpectralState& state)
      : knots_(state.knots.size()), w_(state.size()), p_(state.knots.size()) {}

  // Draws as draw_reflection() does; weights(): what take() is to multiply by, which may be changed before.
  std::optional<ScatterModel::Sample> draw(const ScatterModel& model, Dir out, const std::array<double, 4>& u,
                                           int knot) {
    return draw_reflection(model, out, u, knot, w_, p_);
  }
  std::span<float> weights() { return w_; }
  // Brings the spectrum of a path and its densities behind what was drawn; returns its largest value.
  double take(WalkDensities& path, std::span<float> T) const {
    const double own = static_cast<double>(p_[static_cast<size_t>(path.knot)]);
    float most = 0;
    for (size_t i = 0; i < T.size(); ++i) {
      T[i] *= static_cast<float>(static_cast<double>(w_[i]) / own);
      most = std::max(most, T[i]);
    }
    for (size_t k = 0; k < knots_; ++k) path.ratios[k] *= static_cast<double>(p_[k]) / own;
    return static_cast<double>(most);
  }
  // Russian roulette: whether a path lives of which a share is left, and what its spectrum is then. u: in [0, 1).
  static bool survives(std::span<float> T, double left, double u) {
    if (!(left < 1)) return true;
    if (!(u < left)) return false;
    for (float& t : T) t = static_cast<float>(static_cast<double>(t) / left);
    return true;
  }

 private:
  size_t knots_;
  std::vector<float> w_, p_;
};

}  // namespace suite
