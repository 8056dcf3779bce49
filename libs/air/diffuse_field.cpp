#include "air/diffuse_field.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "air/discrete_ordinates.h"
#include "air/ordinate_angles.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "math/falling.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kPeak = 1e-4;  // a forward peak below it does not matter
constexpr double kThin = 1e-7;  // as does scattering of such a depth

// One bin at a time; one of these a thread.
class BinSolver {
 public:
  BinSolver(const AirSpec& spec, const AirColumn& column, const SpectralState& state, std::span<const AirBeam> beams,
            const BeamDepths& depths, const std::vector<std::vector<float>>& phases, const RoundWays& ways,
            DiffuseSource& to, DiffuseReport* report)
      : column_(column),
        beams_(beams),
        depths_(depths.of_beams),
        suns_(depths.of_suns),
        phases_(phases),
        to_(to),
        report_(report),
        ground_albedo_(state.sample(spec.ground_albedo)),
        solver_(spec.streams),
        angles_(spec.streams, downward(to.axes().cosines)),
        layers_(column.layers() - column.ground),
        moments_(layers_.size(), std::vector<double>(static_cast<size_t>(spec.streams) + 1)),
        ground_temperature_(spec.ground_temperature),
        state_(state),
        ground_(to.axes().cosines.size()),
        own_(2 * layers_.size() * to.directions()),
        even_(layers_.size(), ground_.size()),
        gain_(layers_.size(), ground_.size()) {
    if (ways.round) round_.emplace(*ways.round, *ways.flat, static_cast<size_t>(spec.streams));
  }

  void solve(size_t bin) {
    bin_ = bin;
    if (!lay_out()) return;
    // Emission goes with the first beam, or alone.
    for (size_t b = 0; b < std::max<size_t>(1, beams_.size()); ++b) {
      set_beam(b);
      solver_.solve(problem_);
      for (size_t n = 0; n < layers_.size(); ++n)
        for (int end = 0; end < 2; ++end) tabulate(b, n, end);
      report(round_ ? bend(b) : RoundFluxes{});
      if (peaked_) add_peak(b);
      for (size_t n = 0; n < layers_.size(); ++n)
        for (int end = 0; end < 2; ++end)
          for (size_t d = 0; d < to_.directions(); ++d)
            to_.at(from_top(n), end, d)[bin_] += static_cast<float>(own(n, end, d));
    }
    if (to_.low_sun()) relight();
    // What lies below the ground is as its lowest layer.
    for (size_t l = 0; l < column_.ground; ++l)
      for (size_t d = 0; d < to_.directions(); ++d)
        for (int end = 0; end < 2; ++end) to_.at(l, end, d)[bin_] = to_.at(column_.ground, 0, d)[bin_];
  }

 private:
  // The cosines of the light that comes along the table's ways.
  static std::vector<double> downward(std::vector<double> cosines) {
    for (double& c : cosines) c = -c;
    return cosines;
  }
  // Layers of the column from the top, the n-th one.
  size_t from_top(size_t n) const { return column_.layers() - 1 - n; }
  double at(const std::vector<float>& values, size_t row) const { return values[row * column_.bins + bin_]; }

  // False when nothing scatters.
  bool lay_out() {
    double scattered_depth = 0;
    peaked_ = false;
    for (size_t n = 0; n < layers_.size(); ++n) {
      const size_t l = from_top(n);
      DiffuseLayer& layer = layers_[n];
      const double k = at(column_.extinction, l), thickness = height(l + 1) - height(l);
      std::vector<double>& chi = moments_[n];
      std::fill(chi.begin(), chi.end(), 0.0);
      double scattering = 0;
      for (const AirColumn::Kind& kind : column_.kinds) {
        const double s = at(kind.scattering, l);
        const std::vector<double>& own = kind.moments[bin_];
        for (size_t i = 0; i < std::min(chi.size(), own.size()); ++i) chi[i] += s * own[i];
        scattering += s;
      }
      for (double& c : chi) c = scattering > 0 ? std::clamp(c / scattering, -1.0, 1.0) : 0;
      chi[0] = 1;
      layer = {};
      layer.depth = k * thickness;
      layer.albedo = k > 0 ? std::clamp(scattering / k, 0.0, 1.0) : 0;
      layer.moments = chi;
      layer.planck_top = at(column_.blackbody, l + 1);
      layer.planck_bottom = at(column_.blackbody, l);
      scattered_depth += layer.depth * layer.albedo;
      peaked_ = peaked_ || (layer.albedo > 0 && chi.back() * layer.albedo > kPeak);
    }
    problem_ = {};
    problem_.layers = layers_;
    problem_.ground_albedo = ground_albedo_[bin_];
    const Bin& bin = state_.bins[bin_];
    const double blackbody =
        ground_temperature_ > 0
            ? planck_band_radiance(bin.low_um, bin.high_um, ground_temperature_) / (bin.high_um - bin.low_um)
            : at(column_.blackbody, column_.ground);
    problem_.ground_emission = (1 - problem_.ground_albedo) * blackbody;
    return scattered_depth > kThin;
  }
  double height(size_t level) const { return column_.shells.heights()[level]; }

  void set_beam(size_t b) {
    if (beams_.empty()) return;
    if (b > 0) {
      problem_.ground_emission = 0;
      for (DiffuseLayer& l : layers_) l.planck_top = l.planck_bottom = 0;
    }
    problem_.beam = beam_through(depths_[b], beams_[b].direction.z, beams_[b].irradiance[bin_]);
  }
  DiffuseBeam beam_through(const std::vector<double>& of_levels, double cosine, float irradiance) {
    return beam_.through(column_, of_levels, bin_, cosine, irradiance);
  }
  // Mean of the diffuse light of all directions in a layer.
  double mean_light(size_t n) const {
    const DiffusePlace middle{static_cast<int>(n), 0.5};
    return solver_.fluxes(middle).mean_intensity - solver_.beam(middle) / (4 * kPi);
  }
  // How bright the layers are under other heights of the only beam.
  void relight() {
    std::vector<double> here(layers_.size());
    for (size_t n = 0; n < here.size(); ++n) here[n] = mean_light(n);
    for (size_t s = 0; s < to_.suns().zenith.size(); ++s) {
      solver_.set_beam(beam_through(suns_[s], std::cos(to_.suns().zenith[s]), beams_[0].irradiance[bin_]));
      for (size_t n = 0; n < here.size(); ++n)
        to_.factor(s, from_top(n))[bin_] =
            here[n] > 0 ? static_cast<float>(std::clamp(mean_light(n) / here[n], 0.0, 1e4)) : 1.0f;
      for (size_t l = 0; l < column_.ground; ++l) to_.factor(s, l)[bin_] = to_.factor(s, column_.ground)[bin_];
    }
  }
  // Source at an end of the n-th layer from the top, in the making.
  double& own(size_t n, int end, size_t direction) {
    return own_[(2 * n + static_cast<size_t>(end)) * to_.directions() + direction];
  }
  double azimuth_from(size_t b, size_t index) const {
    return beams_.empty() ? 0 : to_.azimuth(index) - azimuth(beams_[b].direction);
  }

  // Scattering of what has been scattered before, by the scaled medium.
  void tabulate(size_t b, size_t n, int end) {
    const DiffusePlace place{static_cast<int>(n), end == 0 ? 1.0 : 0.0};
    const auto orders = static_cast<size_t>(solver_.orders());
    air_.resize(ground_.size() * orders);
    solver_.sources(place, angles_, air_, ground_);
    const double scale = solver_.depth_scale(static_cast<int>(n));
    const size_t azimuths = to_.axes().azimuths;
    if (cosines_.size() < orders * azimuths || cosines_of_ != b) {
      cosines_of_ = b;
      cosines_.resize(orders * azimuths);
      for (size_t m = 0; m < orders; ++m)
        for (size_t a = 0; a < azimuths; ++a)
          cosines_[m * azimuths + a] = std::cos(static_cast<double>(m) * azimuth_from(b, a));
    }
    for (size_t c = 0; c < ground_.size(); ++c) {
      double* const row = &own(n, end, to_.direction(c, 0));
      std::fill_n(row, azimuths, solver_.ground_radiance() * ground_[c]);
      even_.at(above_ground(n), end, c) = static_cast<float>(row[0] + air_[c * orders]);
      for (size_t m = 0; m < orders; ++m)
        for (size_t a = 0; a < azimuths; ++a) row[a] += air_[c * orders + m] * cosines_[m * azimuths + a];
      for (size_t a = 0; a < azimuths; ++a) row[a] *= scale;
    }
  }

  // Adds what the Earth's being round makes of it; in the scaled medium.
  RoundFluxes bend(size_t b) {
    const size_t count = layers_.size(), orders = static_cast<size_t>(solver_.streams());
    scaled_.resize(count * orders), layers_in_round_.resize(count);
    std::vector<double> of_beam(orders);
    associated_legendre(0, beams_.empty() ? 1 : beams_[b].direction.z, of_beam);
    for (size_t n = 0; n < count; ++n) {
      const auto layer = static_cast<int>(n);
      const double peak = std::min(moments_[n].back(), 1 - 1e-6);
      double* const chi = &scaled_[n * orders];
      for (size_t l = 0; l < orders; ++l) chi[l] = (moments_[n][l] - peak) / (1 - peak);
      const double albedo = solver_.single_albedo(layer) * (1 - peak);
      layers_in_round_[above_ground(n)] = {
          at(column_.extinction, from_top(n)) * solver_.depth_scale(layer), albedo, {chi, orders}};
      for (int end = 0; end < 2; ++end) {
        const DiffusePlace place{layer, end == 0 ? 1.0 : 0.0};
        const double beam = beams_.empty() ? 0 : albedo * solver_.beam(place) / (4 * kPi);
        for (size_t c = 0; c < ground_.size(); ++c) {
          const double* const of_way = round_->legendre(c);
          double phase = 0;
          for (size_t l = 0; l < orders; ++l) phase += static_cast<double>(2 * l + 1) * chi[l] * of_beam[l] * of_way[l];
          even_.at(above_ground(n), end, c) += static_cast<float>(beam * phase + solver_.emission(place));
        }
      }
    }
    even_.ground = solver_.ground_radiance();
    const RoundFluxes fluxes = round_->solve(layers_in_round_, even_, problem_.ground_albedo, gain_);
    for (size_t n = 0; n < count; ++n)
      for (int end = 0; end < 2; ++end)
        for (size_t c = 0; c < ground_.size(); ++c) {
          const double gain = solver_.depth_scale(static_cast<int>(n)) * double{gain_.at(above_ground(n), end, c)};
          double* const row = &own(n, end, to_.direction(c, 0));
          for (size_t a = 0; a < to_.axes().azimuths; ++a) row[a] += gain;
        }
    return fluxes;
  }
  size_t above_ground(size_t n) const { return layers_.size() - 1 - n; }

  // Adds what the forward peak, which the scaled medium lets pass, scatters: of diffuse light, found on its way through
  // the layers, and of the beam.
  void add_peak(size_t b) {
    const std::vector<double>& cosines = to_.axes().cosines;
    for (size_t c = 0; c < cosines.size(); ++c)
      for (size_t a = 0; a < to_.axes().azimuths; ++a) {
        const bool rising = cosines[c] < 0;  // the light, seen from above
        phases_of(b, to_.direction(c, a));
        double light = rising ? solver_.ground_radiance() + gain_.ground : 0;
        const size_t count = layers_.size();
        for (size_t step = 0; step < count; ++step) {
          const size_t n = rising ? count - 1 - step : step;
          light = through(n, to_.direction(c, a), rising, std::fabs(cosines[c]), light);
        }
      }
  }
  void phases_of(size_t b, size_t direction) {
    phase_.assign(column_.kinds.size(), 0);
    for (size_t k = 0; !beams_.empty() && k < phase_.size(); ++k)
      phase_[k] = phases_[b][(direction * phase_.size() + k) * column_.bins + bin_];
  }
  // Light enters a layer and leaves it; both ends get their part of the peak.
  double through(size_t n, size_t direction, bool rising, double cosine, double light) {
    const size_t l = from_top(n);
    const DiffuseLayer& layer = layers_[n];
    const int layer_index = static_cast<int>(n), first = rising ? 0 : 1;  // end that light enters by: 0 = the lower one
    const double scale = solver_.depth_scale(layer_index), peak = 1 - scale;
    double scattered = 0;  // phase function of all kinds, 1/sr, times the albedo
    const double k = at(column_.extinction, l);
    for (size_t i = 0; i < phase_.size(); ++i)
      if (k > 0) scattered += at(column_.kinds[i].scattering, l) / k * phase_[i];
    double source[2], more[2];  // per scaled depth, at the entrance and the exit; what the beam's peak adds, per depth
    for (int side = 0; side < 2; ++side) {
      const int end = side == 0 ? first : 1 - first;
      const DiffusePlace place{layer_index, end == 0 ? 1.0 : 0.0};
      const double beam = beams_.empty() ? 0 : solver_.beam(place),
                   left =
                       beams_.empty() ? 0 : problem_.beam.irradiance * std::exp(-beam_.depth[n + (end == 0 ? 1 : 0)]);
      source[side] = (scale > 0 ? (own(n, end, direction) + scattered * beam) / scale : 0) + solver_.emission(place);
      more[side] = scattered * std::max(0.0, beam - left);
    }
    const auto x = static_cast<float>(std::min(1e4, layer.depth * scale / cosine));
    const float keep = exp_falling(x);
    const double leaves = light * keep + x * (source[1] * mean_of_even(x, keep) +
                                              0.5 * (source[0] - source[1]) * mean_of_rising(x, keep));
    own(n, first, direction) += peak * light + more[0];
    own(n, 1 - first, direction) += peak * leaves + more[1];
    return leaves;
  }

  // gained: by the Earth's being round.
  void report(const RoundFluxes& gained) {
    if (!report_) return;
    const DiffuseFluxes ground = solver_.fluxes({static_cast<int>(layers_.size()) - 1, 1}),
                        top = solver_.fluxes({0, 0});
    const auto add = [&](std::vector<float>& to, double value) { to[bin_] += static_cast<float>(value); };
    add(report_->direct, ground.direct), add(report_->down, ground.down + gained.down);
    add(report_->up, ground.up + kPi * gain_.ground);
    const double above = column_.shells.curvature() * (height(column_.layers()) - height(column_.ground)),
                 wider = 1 + above / (1 + column_.shells.curvature() * height(column_.ground));
    add(report_->top_up, (top.up + gained.top_up) * wider * wider);
    report_->spherical_albedo[bin_] = static_cast<float>(solver_.spherical_albedo());
    report_->ground_albedo[bin_] = ground_albedo_[bin_];
  }

  const AirColumn& column_;
  std::span<const AirBeam> beams_;
  const std::vector<std::vector<double>>&depths_, &suns_;  // per beam, and other height of it, [level][bin]
  const std::vector<std::vector<float>>& phases_;          // per beam, as of phases_of
  DiffuseSource& to_;
  DiffuseReport* report_;
  const std::vector<float> ground_albedo_;
  DiscreteOrdinates solver_;
  SourceAngles angles_;
  std::vector<DiffuseLayer> layers_;
  std::vector<std::vector<double>> moments_;
  DiffuseProblem problem_;
  const double ground_temperature_;
  const SpectralState& state_;
  size_t bin_ = 0;
  bool peaked_ = false;
  LayerBeam beam_;
  std::vector<double> air_, phase_;
  std::vector<double> ground_, own_;
  std::optional<RoundLight> round_;
  AirSources even_, gain_;  // means over azimuth, over scaled depth: all sources; what a round Earth adds
  std::vector<double> scaled_;
  std::vector<RoundLayer> layers_in_round_;
  std::vector<double> cosines_;  // of order times azimuth of the table, for a beam
  size_t cosines_of_ = static_cast<size_t>(-1);
};

}  // namespace

std::shared_ptr<const DiffuseSource> solve_diffuse_field(const AirSpec& spec, const AirColumn& column,
                                                         const SpectralState& state, std::span<const AirBeam> beams,
                                                         std::span<const BeamTable> tables, DiffuseReport* report) {
  if (column.kinds.empty()) return nullptr;
  auto source = std::make_shared<DiffuseSource>(column.layers(), column.bins, diffuse_axes(column, beams));
  const BeamDepths depths = beam_depths(column, beams, tables, *source);
  std::vector<std::vector<float>> phases;
  for (const AirBeam& beam : beams) phases.push_back(beam_phases(column, beam, *source));
  if (report)
    for (auto* row : {&report->direct, &report->down, &report->up, &report->top_up, &report->spherical_albedo,
                      &report->ground_albedo})
      row->assign(column.bins, 0.0f);
  const RoundWays ways(column, source->axes().cosines);
  parallel_for(0, column.bins, 4, [&](size_t begin, size_t end) {
    BinSolver solver(spec, column, state, beams, depths, phases, ways, *source, report);
    for (size_t bin = begin; bin < end; ++bin) stop_point(), solver.solve(bin);
  });
  return source;
}

}  // namespace suite
