#include "light/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "air/molecules.h"
#include "light/layer_optics.h"
#include "math/share.h"
#include "optics/phase_function.h"

namespace suite {

namespace {

class Layered final : public Atmosphere {
 public:
  Layered(const AtmosphereSpec& s, const SpectralState& state, std::vector<Beam> beams)
      : heights_(checked(s).heights),
        shells_(Shells::flat(in_scene(s))),
        offset_(s.scene_height),
        bins_(state.size()),
        beams_(std::move(beams)) {
    layers_ = heights_.size() - 1;
    above_.assign((layers_ + 1) * bins_, 0);
    if (s.aerosol) phase_ = bake_phase(s.aerosol->phase, state);
    LayerOptics baked = bake_layers(s, state);
    extinction_ = std::move(baked.extinction), rayleigh_ = std::move(baked.rayleigh);
    aerosol_ = std::move(baked.aerosol), source_ = std::move(baked.source);
    for (size_t l = layers_; l-- > 0;)
      for (size_t i = 0; i < bins_; ++i)
        above_[l * bins_ + i] = above_[(l + 1) * bins_ + i] +
                                extinction_[l * bins_ + i] * static_cast<float>(heights_[l + 1] - heights_[l]);
    // Light that comes along the horizon or from below reaches no layer.
    std::erase_if(beams_, [](const Beam& b) { return !(b.direction.z > 1e-6); });
  }

  void transmittance(Vec3 from, Dir d, double distance, std::span<float> T) const override {
    std::fill(T.begin(), T.end(), 0.0f);
    walk(from, d, distance, [&](size_t layer, double, double l) {
      const float* k = &extinction_[layer * bins_];
      const auto length = static_cast<float>(l);
      for (size_t i = 0; i < bins_; ++i) T[i] += k[i] * length;
    });
    for (float& t : T) t = std::exp(-t);
  }

  void path(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S) const override {
    std::fill(T.begin(), T.end(), 1.0f);
    std::fill(S.begin(), S.end(), 0.0f);
    thread_local std::vector<float> phase;
    phase.assign(bins_, 0.0f);
    walk(from, d, distance, [&](size_t layer, double z, double l) {
      for (const Beam& beam : beams_) {
        const double cosine = dot(beam.direction, d);
        if (phase_) phase_->eval(std::clamp(cosine, -1.0, 1.0), phase);
        scatter(layer, z, l, d.z, beam, cosine, phase, T, S);
      }
      const float* k = &extinction_[layer * bins_];
      const float* source = &source_[layer * bins_];
      const auto length = static_cast<float>(l);
      for (size_t i = 0; i < bins_; ++i) {
        S[i] -= T[i] * source[i] * std::expm1(-k[i] * length);
        T[i] *= std::exp(-k[i] * length);
      }
    });
  }

  const Shells& shells() const override { return shells_; }
  std::span<const float> extinction(size_t l) const override { return {&extinction_[l * bins_], bins_}; }
  void source(size_t l, Vec3, Dir, std::span<float> to) const override {
    std::copy_n(&source_[l * bins_], bins_, to.begin());
  }
  size_t beams() const override { return beams_.size(); }
  void beam(size_t b, size_t l, Vec3 from, Dir d, BeamAlong along) const override {
    const Beam& beam = beams_[b];
    const double cosine = dot(beam.direction, d);
    std::fill(along.scattered.begin(), along.scattered.end(), 0.0f);
    if (phase_) phase_->eval(std::clamp(cosine, -1.0, 1.0), along.scattered);
    const float air = static_cast<float>(rayleigh_phase(cosine));
    const auto rise = static_cast<float>(shells_.heights()[l + 1] - from.z),
               slant = static_cast<float>(1 / beam.direction.z), fall = static_cast<float>(-d.z / beam.direction.z);
    const float *k = &extinction_[l * bins_], *r = &rayleigh_[l * bins_], *a = &aerosol_[l * bins_],
                *above = &above_[(l + 1) * bins_];
    for (size_t i = 0; i < bins_; ++i) {
      along.scattered[i] = beam.irradiance[i] * (r[i] * air + a[i] * along.scattered[i]);
      along.depth[i] = (above[i] + k[i] * rise) * slant;
      along.slope[i] = k[i] * fall;
    }
  }

 private:
  static std::vector<double> in_scene(const AtmosphereSpec& s) {
    std::vector<double> heights = s.heights;
    for (double& h : heights) h -= s.scene_height;
    return heights;
  }
  static const AtmosphereSpec& checked(const AtmosphereSpec& s) {
    const size_t layers = s.heights.size() < 2 ? 0 : s.heights.size() - 1;
    if (layers < 1 || layers > 200)
      throw Error(strf("an atmosphere of %zu heights", s.heights.size()),
                  "give 2 to 201 heights, which bound its layers");
    for (size_t i = 0; i < s.heights.size(); ++i)
      if (!std::isfinite(s.heights[i]) || (i && !(s.heights[i] > s.heights[i - 1])))
        throw Error("the heights of the atmosphere are not ascending");
    if (!s.temperature_k.empty() && s.temperature_k.size() != layers)
      throw Error(strf("the atmosphere has %zu layers and %zu temperatures", layers, s.temperature_k.size()));
    for (const double t : s.temperature_k)
      if (!(t > 0) || !std::isfinite(t)) throw Error(strf("a layer of the atmosphere at %g K", t));
    if (!(s.pressure >= 0 && s.pressure <= 2e5))
      throw Error(strf("a pressure of %g Pa at sea level is not between 0 and 2e5", s.pressure));
    if (const auto& a = s.aerosol) {
      if (!(a->depth_550 >= 0) || !std::isfinite(a->depth_550)) throw Error("the aerosol's optical depth is negative");
      if (!(a->scale_height > 0)) throw Error("the aerosol's scale height must be positive");
      if (!is_share(a->albedo.min()) || !is_share(a->albedo.max()))
        throw Error("the aerosol's albedo is not between 0 and 1");
    }
    for (const AtmosphereSpec::Gas& g : s.gases) {
      if (!g.layers.empty() && g.layers.size() != layers)
        throw Error(strf("gas '%s' has %zu layers, the atmosphere %zu", g.name.c_str(), g.layers.size(), layers));
      if (g.layers.empty() && !(g.scale_height > 0))
        throw Error("gas '" + g.name + "': the scale height must be positive");
      for (const Curve& c : g.layers)
        if (c.min() < 0) throw Error("gas '" + g.name + "' has a negative optical depth");
      if (g.layers.empty() && g.column.min() < 0) throw Error("gas '" + g.name + "' has a negative optical depth");
    }
    return s;
  }

  // Calls visit(layer, height at the near end, length) for the pieces of a segment, from `from` on.
  template <class Visit>
  void walk(Vec3 from, Dir d, double distance, Visit visit) const {
    double z = from.z + offset_, s = 0;
    const double end = std::min(distance, kLongestInAir);
    if (z >= heights_.back()) {
      if (!(d.z < 0)) return;
      s = (z - heights_.back()) / -d.z;
      z = heights_.back();
    }
    auto layer = static_cast<long>(std::upper_bound(heights_.begin(), heights_.end(), z) - heights_.begin()) - 1;
    if (d.z < 0 && layer >= 0 && z == heights_[static_cast<size_t>(layer)]) --layer;
    layer = std::clamp(layer, 0L, static_cast<long>(layers_) - 1);
    while (s < end) {
      const auto i = static_cast<size_t>(layer);
      double out = end;
      if (d.z > 0)
        out = std::min(end, s + (heights_[i + 1] - z) / d.z);
      else if (d.z < 0 && i > 0)
        out = std::min(end, s + (heights_[i] - z) / d.z);
      visit(i, z, out - s);
      if (out >= end) return;
      s = out;
      layer += d.z > 0 ? 1 : -1;
      if (layer == static_cast<long>(layers_)) return;
      z = heights_[d.z > 0 ? i + 1 : i];
    }
  }

  // Adds what a piece of length l scatters once: with t the depth of the beam at the near end and x the growth of total
  // depth along the piece, the integral of exp(-t - x s / l) over it is l (exp(-t) - exp(-t - x)) / x.
  void scatter(size_t layer, double z, double l, double mu, const Beam& beam, double cosine,
               std::span<const float> phase, std::span<const float> T, std::span<float> S) const {
    const float air = static_cast<float>(rayleigh_phase(cosine));
    const auto rise = static_cast<float>(heights_[layer + 1] - z), slant = static_cast<float>(1 / beam.direction.z),
               length = static_cast<float>(l);
    const auto growth = static_cast<float>(l * (1 - mu / beam.direction.z));
    const float *k = &extinction_[layer * bins_], *r = &rayleigh_[layer * bins_], *a = &aerosol_[layer * bins_],
                *above = &above_[(layer + 1) * bins_];
    for (size_t i = 0; i < bins_; ++i) {
      const float mean = mean_falling((above[i] + k[i] * rise) * slant, k[i] * growth);
      S[i] += T[i] * beam.irradiance[i] * (r[i] * air + a[i] * phase[i]) * length * mean;
    }
  }

  std::vector<double> heights_;  // above sea level
  Shells shells_;                // in the scene
  double offset_;
  size_t bins_, layers_ = 0;
  std::vector<Beam> beams_;
  std::unique_ptr<const PhaseFunction> phase_;
  // Per layer and bin: 1/m; emission is the blackbody times the absorbed share. above_: vertical depth above a height.
  std::vector<float> extinction_, rayleigh_, aerosol_, source_, above_;
};

}  // namespace

std::unique_ptr<const Atmosphere> make_layered_atmosphere(const AtmosphereSpec& spec, const SpectralState& state,
                                                          std::vector<Beam> beams) {
  return std::make_unique<Layered>(spec, state, std::move(beams));
}

}  // namespace suite
