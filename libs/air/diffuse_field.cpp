#include "air/diffuse_field.h"

#include <algorithm>
#include <cmath>

#include "air/discrete_ordinates.h"
#include "base/parallel.h"
#include "math/falling.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kPeak = 1e-4;  // a forward peak below it does not matter
constexpr double kThin = 1e-7;  // as does scattering of such a depth
// Of the table; 19 azimuths over a half circle are carried for 1300 bins in 60 layers, never fewer than 9 (18 around).
constexpr size_t kMostBytes = 256u << 20;

// Directions of the table: denser towards the horizon, where ways are long.
DiffuseSource::Axes axes_of(const AirColumn& column, std::span<const AirBeam> beams) {
  DiffuseSource::Axes axes;
  axes.cosines = {-1,    -0.9, -0.78, -0.65, -0.5, -0.36, -0.24, -0.14, -0.06, -0.015,
                  0.015, 0.06, 0.14,  0.24,  0.36, 0.5,   0.65,  0.78,  0.9,   1};
  if (beams.empty()) return axes;
  const size_t one = column.layers() * 2 * axes.cosines.size() * column.bins * sizeof(float);
  if (beams.size() == 1) axes.symmetric = azimuth(beams[0].direction);
  axes.azimuths = std::clamp<size_t>(kMostBytes / one, axes.symmetric ? 9 : 18, axes.symmetric ? 19 : 36);
  return axes;
}

// One bin at a time; one of these a thread.
class BinSolver {
 public:
  BinSolver(const AirSpec& spec, const AirColumn& column, const SpectralState& state, std::span<const AirBeam> beams,
            const std::vector<std::vector<double>>& depths, const std::vector<std::vector<float>>& phases,
            DiffuseSource& to, DiffuseReport* report)
      : column_(column),
        beams_(beams),
        depths_(depths),
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
        own_(2 * layers_.size() * to.directions()) {}

  void solve(size_t bin) {
    bin_ = bin;
    if (!lay_out()) return;
    // Emission goes with the first beam, or alone.
    for (size_t b = 0; b < std::max<size_t>(1, beams_.size()); ++b) {
      set_beam(b);
      solver_.solve(problem_);
      report();
      for (size_t n = 0; n < layers_.size(); ++n)
        for (int end = 0; end < 2; ++end) tabulate(b, n, end);
      if (peaked_) add_peak(b);
      for (size_t n = 0; n < layers_.size(); ++n)
        for (int end = 0; end < 2; ++end)
          for (size_t d = 0; d < to_.directions(); ++d)
            to_.at(from_top(n), end, d)[bin_] += static_cast<float>(own(n, end, d));
    }
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
    const double cosine = beams_[b].direction.z;
    depth_.resize(layers_.size() + 1);
    for (size_t n = 0; n <= layers_.size(); ++n) depth_[n] = depths_[b][(column_.layers() - n) * column_.bins + bin_];
    secants_.assign(layers_.size(), 1 / std::max(cosine, 0.05));
    tops_.assign(layers_.size(), -1);
    for (size_t n = 0; n < layers_.size(); ++n) {
      const double fall = depth_[n + 1] - depth_[n];
      if (layers_[n].depth > 1e-12 && std::isfinite(fall) && fall != 0) secants_[n] = fall / layers_[n].depth;
      if (!std::isfinite(depth_[n])) tops_[n] = 0;
    }
    if (std::isfinite(depth_[0])) tops_[0] = std::exp(-depth_[0]);
    problem_.beam = {beams_[b].irradiance[bin_], cosine, secants_, tops_};
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
      for (size_t m = 0; m < orders; ++m)
        for (size_t a = 0; a < azimuths; ++a) row[a] += air_[c * orders + m] * cosines_[m * azimuths + a];
      for (size_t a = 0; a < azimuths; ++a) row[a] *= scale;
    }
  }

  // Adds what the forward peak, which the scaled medium lets pass, scatters: of diffuse light, found on its way through
  // the layers, and of the beam.
  void add_peak(size_t b) {
    const std::vector<double>& cosines = to_.axes().cosines;
    for (size_t c = 0; c < cosines.size(); ++c)
      for (size_t a = 0; a < to_.axes().azimuths; ++a) {
        const bool rising = cosines[c] < 0;  // the light, seen from above
        phases_of(b, to_.direction(c, a));
        double light = rising ? solver_.ground_radiance() : 0;
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
                   left = beams_.empty() ? 0 : problem_.beam.irradiance * std::exp(-depth_[n + (end == 0 ? 1 : 0)]);
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

  void report() {
    if (!report_) return;
    const DiffuseFluxes ground = solver_.fluxes({static_cast<int>(layers_.size()) - 1, 1}),
                        top = solver_.fluxes({0, 0});
    const auto add = [&](std::vector<float>& to, double value) { to[bin_] += static_cast<float>(value); };
    add(report_->direct, ground.direct), add(report_->down, ground.down), add(report_->up, ground.up);
    add(report_->top_up, top.up);
    report_->spherical_albedo[bin_] = static_cast<float>(solver_.spherical_albedo());
    report_->ground_albedo[bin_] = ground_albedo_[bin_];
  }

  const AirColumn& column_;
  std::span<const AirBeam> beams_;
  const std::vector<std::vector<double>>& depths_;  // per beam [level][bin]
  const std::vector<std::vector<float>>& phases_;   // per beam, as of phases_of
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
  std::vector<double> depth_, secants_, tops_, air_, phase_;
  std::vector<double> ground_, own_;
  std::vector<double> cosines_;  // of order times azimuth of the table, for a beam
  size_t cosines_of_ = static_cast<size_t>(-1);
};

// Depth of a beam at the levels over the scene's origin, infinite in the shadow of the Earth; [level][bin].
std::vector<double> depths_of(const AirColumn& column, const AirBeam& beam, const BeamTable& table) {
  std::vector<double> depths((column.layers() + 1) * column.bins);
  std::vector<float> row(column.bins);
  for (size_t level = 0; level <= column.layers(); ++level) {
    // The beam may have come to the top through the air below, where the sun is under the horizon.
    const double below = level == column.layers() ? 1e-3 : 0;
    const bool lit = table.spread_depth(column.shells.heights()[level] - below, beam.direction.z, row);
    for (size_t i = 0; i < column.bins; ++i) depths[level * column.bins + i] = lit ? row[i] : INFINITY;
  }
  return depths;
}

// Phase functions between a beam and the directions of the table; [direction][kind][bin], 1/sr.
std::vector<float> phases_of(const AirColumn& column, const AirBeam& beam, const DiffuseSource& source) {
  const std::vector<double>& cosines = source.axes().cosines;
  std::vector<float> phases(source.directions() * column.kinds.size() * column.bins);
  for (size_t c = 0; c < cosines.size(); ++c)
    for (size_t a = 0; a < source.axes().azimuths; ++a) {
      const double sine = std::sqrt(std::max(0.0, 1 - cosines[c] * cosines[c])), azimuth = source.azimuth(a);
      const Dir d{sine * std::cos(azimuth), sine * std::sin(azimuth), cosines[c]};
      for (size_t k = 0; k < column.kinds.size(); ++k) {
        const PhaseFunction& phase = *column.kinds[k].phase;
        const std::span<float> row{&phases[(source.direction(c, a) * column.kinds.size() + k) * column.bins],
                                   column.bins};
        const bool uniform = phase.spectrally_uniform();
        phase.eval(std::clamp(dot(beam.direction, d), -1.0, 1.0), uniform ? row.first(1) : row);
        if (uniform) std::fill(row.begin(), row.end(), row[0]);
      }
    }
  return phases;
}

}  // namespace

std::shared_ptr<const DiffuseSource> solve_diffuse_field(const AirSpec& spec, const AirColumn& column,
                                                         const SpectralState& state, std::span<const AirBeam> beams,
                                                         std::span<const BeamTable> tables, DiffuseReport* report) {
  if (column.kinds.empty()) return nullptr;
  std::vector<std::vector<double>> depths;
  for (size_t b = 0; b < beams.size(); ++b) depths.push_back(depths_of(column, beams[b], tables[b]));
  auto source = std::make_shared<DiffuseSource>(column.layers(), column.bins, axes_of(column, beams));
  std::vector<std::vector<float>> phases;
  for (const AirBeam& beam : beams) phases.push_back(phases_of(column, beam, *source));
  if (report)
    for (auto* row : {&report->direct, &report->down, &report->up, &report->top_up, &report->spherical_albedo,
                      &report->ground_albedo})
      row->assign(column.bins, 0.0f);
  parallel_for(0, column.bins, 4, [&](size_t begin, size_t end) {
    BinSolver solver(spec, column, state, beams, depths, phases, *source, report);
    for (size_t bin = begin; bin < end; ++bin) solver.solve(bin);
  });
  return source;
}

}  // namespace suite
