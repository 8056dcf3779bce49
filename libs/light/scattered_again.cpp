#include "light/scattered_again.h"

#include <algorithm>
#include <cmath>

#include "air/discrete_ordinates.h"
#include "air/molecules.h"
#include "air/phase_grid.h"
#include "light/layer_optics.h"
#include "optics/phase_function.h"

namespace suite {

namespace {

constexpr int kStreams = 16;
constexpr double kLevel = 0.01;  // cosine of the most level view

// The layers over the ground, from the top, at the first bin.
class Column {
 public:
  Column(const AtmosphereSpec& spec, const SpectralState& state)
      : baked_(bake_layers(spec, state)), heights_(spec.heights), values_(state.size()) {
    for (double& h : heights_) h -= spec.scene_height;
    if (spec.aerosol) phase_ = bake_phase(spec.aerosol->phase, state);
    const std::vector<double> air = moments([](double c) { return rayleigh_phase(c); }),
                              dust = moments([this](double c) { return dust_at(c); });
    ground_ = 0;
    while (ground_ + 2 < heights_.size() && heights_[ground_ + 1] <= 0) ++ground_;
    // The lowest layer goes on below the first height.
    if (heights_[ground_] > 0 || heights_[ground_ + 1] > 0) heights_[ground_] = std::min(0.0, heights_[ground_ + 1]);
    for (size_t l = top(); l-- > ground_;) {
      const size_t k = l * baked_.bins;
      const double scattered = double{baked_.rayleigh[k]} + double{baked_.aerosol[k]};
      const double share = scattered > 0 ? double{baked_.aerosol[k]} / scattered : 0;
      std::vector<double>& mixed = moments_.emplace_back(air);
      for (size_t i = 0; i < mixed.size(); ++i) mixed[i] += share * (dust[i] - mixed[i]);
      dust_shares_.push_back(share);
      DiffuseLayer& layer = layers_.emplace_back();
      layer.depth = double{baked_.extinction[k]} * (heights_[l + 1] - heights_[l]);
      layer.albedo = baked_.extinction[k] > 0 ? std::min(1.0, scattered / double{baked_.extinction[k]}) : 0;
    }
    for (size_t l = 0; l < layers_.size(); ++l) layers_[l].moments = moments_[l];
  }

  std::span<const DiffuseLayer> layers() const { return layers_; }
  double ground() const { return heights_[ground_]; }
  double top_height() const { return heights_.back(); }

  DiffusePlace place(double z) const {
    const double height = std::clamp(z, ground(), top_height());
    size_t l = top() - 1;
    while (l > ground_ && height < heights_[l]) --l;
    return {static_cast<int>(top() - 1 - l), (heights_[l + 1] - height) / (heights_[l + 1] - heights_[l])};
  }
  // Of each layer at one angle, 1/sr.
  std::vector<double> phases(double cosine) {
    const double air = rayleigh_phase(cosine), dust = dust_at(cosine);
    std::vector<double> all;
    for (const double share : dust_shares_) all.push_back(air + share * (dust - air));
    return all;
  }

 private:
  size_t top() const { return baked_.layers; }
  double dust_at(double cosine) {
    if (!phase_) return 1 / (4 * kPi);
    phase_->eval(std::clamp(cosine, -1.0, 1.0), values_);
    return double{values_[0]};
  }
  template <class Phase>
  static std::vector<double> moments(const Phase& phase) {
    std::vector<float> values;
    for (const double c : phase_cosines()) values.push_back(static_cast<float>(phase(c)));
    std::vector<double> all = legendre_moments(values, kStreams + 1);
    for (size_t l = all.size(); l-- > 0;) all[l] = std::clamp(all[l] / all[0], -1.0, 1.0);
    return all;
  }

  LayerOptics baked_;
  std::vector<double> heights_;
  std::vector<float> values_;
  std::unique_ptr<const PhaseFunction> phase_;
  size_t ground_ = 0;  // layer that stands on it
  std::vector<DiffuseLayer> layers_;
  std::vector<std::vector<double>> moments_;
  std::vector<double> dust_shares_;
};

double first_of(std::span<const float> values) { return double{values[0]}; }

// What the atmosphere's own light and the beam do to a level place at the ground, W/(m2 um), scattered once.
double on_ground(const Atmosphere& lit, const Atmosphere& dark, const Beam& beam, Vec3 at, std::span<float> T,
                 std::span<float> S) {
  constexpr int kRings = 16, kAround = 16;
  const double far = std::numeric_limits<double>::infinity();
  lit.transmittance(at, beam.direction, far, T);
  double sum = double{beam.irradiance[0]} * beam.direction.z * first_of(T);
  // Equal shares of the projected solid angle.
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kAround; ++k) {
      const Dir d = dir_from_angles(std::asin(std::sqrt((i + 0.5) / kRings)), 2 * kPi * (k + 0.5) / kAround);
      lit.path(at, d, far, T, S);
      sum += kPi / (kRings * kAround) * first_of(S);
      dark.path(at, d, far, T, S);
      sum -= kPi / (kRings * kAround) * first_of(S);
    }
  return sum;
}

}  // namespace

ScatteredAgain scattered_again(const AtmosphereSpec& spec, const SpectralState& state, const Beam& beam,
                               const AirView& view, double ground_albedo) {
  ScatteredAgain light;
  if (!(beam.direction.z > 1e-3)) return light;
  const auto lit = make_layered_atmosphere(spec, state, {beam}), dark = make_layered_atmosphere(spec, state, {});
  Column column(spec, state);
  const bool down = view.towards.z < 0;
  if (!down && view.from.z >= column.top_height()) return light;
  const double level = std::copysign(std::max(kLevel, std::fabs(view.towards.z)), down ? -1.0 : 1.0),
               turn = std::sqrt((1 - level * level) / std::max(1e-12, 1 - view.towards.z * view.towards.z));
  const Dir d = normalized(Vec3{view.towards.x * turn, view.towards.y * turn, level});
  const Vec3 from{view.from.x, view.from.y, std::max(view.from.z, column.ground())};
  const double distance = down ? (from.z - column.ground()) / -d.z : std::numeric_limits<double>::infinity();

  std::vector<float> T(state.size()), S(state.size());
  const double ground =
      ground_albedo > 0 ? ground_albedo / kPi * on_ground(*lit, *dark, beam, {from.x, from.y, column.ground()}, T, S)
                        : 0;
  dark->path(from, d, distance, T, S);
  light.once = -first_of(S);
  lit->path(from, d, distance, T, S);
  light.once += first_of(S) + (down ? first_of(T) * ground : 0);

  DiscreteOrdinates field(kStreams);
  DiffuseProblem problem;
  problem.layers = column.layers();
  problem.beam.irradiance = double{beam.irradiance[0]}, problem.beam.cosine = beam.direction.z;
  problem.ground_albedo = ground_albedo;
  field.solve(problem);
  const double turned = std::atan2(d.y, d.x) - std::atan2(beam.direction.y, beam.direction.x);
  light.all = field.radiance(column.place(from.z), -d.z, turned, column.phases(dot(d, beam.direction)));
  return light;
}

}  // namespace suite
