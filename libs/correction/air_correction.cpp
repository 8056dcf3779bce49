#include "correction/air_correction.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"
#include "air/discrete_ordinates.h"
#include "base/parallel.h"
#include "math/vec.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kDarkest = 1e-7;       // of sunlight, below which emission of the air is left out
constexpr double kSunRadiance = 5.8e3;  // K: of a body as bright as the sun, seen as large as it is
constexpr double kSunSolidAngle = 6.8e-5;

// Views that share a sun, and what each needs beside the solution.
struct Sight {
  CorrectionView view;
  DiffusePlace place;  // of the sensor; layers counted from the top
  double cosine = 1, sun_cosine = 1;
  double travel = 0;         // azimuth in which its light travels, from that in which the beam does
  std::vector<float> phase;  // [kind][bin], 1/sr
};

double checked(double value, double low, double high, const char* what) {
  if (!(value >= low && value <= high))
    throw Error(strf("a correction for the air cannot have a %s of %g deg", what, value),
                strf("%g to %g deg are possible", low, high));
  return value;
}

// Where a height is among the layers, by the share of the layer: between levels the air is even.
DiffusePlace place_of(const AirColumn& column, double height) {
  const std::span<const double> heights = column.shells.heights();
  if (!(height > heights[column.ground]))
    throw Error(strf("a sensor %g m above sea level is not above the ground (%g m)", height, heights[column.ground]));
  if (height >= heights.back()) return {0, 0};
  const size_t layer = column.shells.layer_of(height);
  const double below = (height - heights[layer]) / (heights[layer + 1] - heights[layer]);
  return {static_cast<int>(column.layers() - 1 - layer), 1 - below};
}

std::vector<Sight> sights_of(const AirColumn& column, double scene_height, std::span<const CorrectionView> views) {
  std::vector<Sight> sights;
  for (const CorrectionView& v : views) {
    Sight s{v, place_of(column, v.height - scene_height), 1, 1, 0, {}};
    s.sun_cosine = std::cos(checked(v.sun_zenith, 0, 89, "zenith angle of the sun") * kDegree);
    s.cosine = std::cos(checked(v.view_zenith, 0, 75, "zenith angle of the sensor") * kDegree);
    s.travel = (checked(v.azimuth, -360, 360, "relative azimuth") + 180) * kDegree;
    const double sines = std::sqrt((1 - s.cosine * s.cosine) * (1 - s.sun_cosine * s.sun_cosine));
    const double angle = std::clamp(-s.sun_cosine * s.cosine + sines * std::cos(s.travel), -1.0, 1.0);
    s.phase.resize(column.kinds.size() * column.bins);
    for (size_t k = 0; k < column.kinds.size(); ++k) {
      const PhaseFunction& phase = *column.kinds[k].phase;
      const std::span<float> row{&s.phase[k * column.bins], column.bins};
      phase.eval(angle, phase.spectrally_uniform() ? row.first(1) : row);
      if (phase.spectrally_uniform()) std::fill(row.begin(), row.end(), row[0]);
    }
    sights.push_back(std::move(s));
  }
  return sights;
}

// The layers of a bin, from the top. Thin neighbours are one layer: within it their order is forgotten, which changes
// light by some quarter of the square of its slant depth.
class BinLayers {
 public:
  // kept: layers that sensors stand in, which stay alone. thin: depth of layers that become one.
  BinLayers(const AirColumn& column, std::vector<bool> kept, double thin)
      : column_(column), kept_(std::move(kept)), thin_(thin), scattered_(kept_.size() * column.kinds.size()) {}

  // emits: whether the black bodies of the levels are wanted.
  void set(size_t bin, bool emits) {
    bin_ = bin;
    layers_.clear(), first_.clear();
    moments_.resize(kept_.size());
    const double thin = emits ? 0.1 * thin_ : thin_;
    double depth = INFINITY;
    bool alone = true;
    for (size_t n = 0; n < kept_.size(); ++n) {
      const double own = depth_of(n);
      if (alone || kept_[n] || depth + own > thin) first_.push_back(n), depth = 0;
      depth += own;
      alone = kept_[n];
    }
    for (size_t g = 0; g < first_.size(); ++g) layers_.push_back(joined(g, emits));
  }
  // Phase function of every layer for a view.
  void phases(const Sight& sight, std::vector<double>& out) const {
    out.assign(layers_.size(), 0.0);
    for (size_t g = 0; g < out.size(); ++g)
      for (size_t k = 0; k < column_.kinds.size(); ++k)
        out[g] += scattered_[g * column_.kinds.size() + k] * double{sight.phase[k * column_.bins + bin_]};
  }
  std::span<const DiffuseLayer> layers() const { return layers_; }
  // Number of the first level of a layer, counted in the column's from the top; that of the ground for one beyond.
  size_t level(size_t g) const { return g < first_.size() ? first_[g] : kept_.size(); }
  // Of a place among the column's layers: that of a sensor, which stands in a kept one or at the top.
  DiffusePlace place(DiffusePlace of) const {
    const auto at = std::ranges::upper_bound(first_, static_cast<size_t>(of.layer));
    return {static_cast<int>(at - first_.begin()) - 1, of.fraction};
  }
  // Vertical depth from the ground up to a place among `layers`.
  double depth_below(DiffusePlace at) const {
    double sum = 0;
    for (size_t g = static_cast<size_t>(at.layer); g < layers_.size(); ++g)
      sum += layers_[g].depth * (g == static_cast<size_t>(at.layer) ? 1 - at.fraction : 1);
    return sum;
  }

 private:
  size_t below(size_t n) const { return column_.layers() - 1 - n; }
  double thickness(size_t n) const {
    const std::span<const double> heights = column_.shells.heights();
    return heights[below(n) + 1] - heights[below(n)];
  }
  double depth_of(size_t n) const { return double{column_.extinction[below(n) * column_.bins + bin_]} * thickness(n); }
  DiffuseLayer joined(size_t g, bool emits) {
    const size_t kinds = column_.kinds.size(), end = level(g + 1);
    const std::span parts = std::span(scattered_).subspan(g * kinds, kinds);
    std::ranges::fill(parts, 0.0);
    DiffuseLayer to;
    double all = 0;
    for (size_t n = first_[g]; n < end; ++n) {
      to.depth += depth_of(n);
      for (size_t k = 0; k < kinds; ++k)
        parts[k] += double{column_.kinds[k].scattering[below(n) * column_.bins + bin_]} * thickness(n);
    }
    for (size_t k = 0; k < kinds; ++k) all += parts[k];
    to.albedo = to.depth > 0 ? std::min(1.0, all / to.depth) : 0;
    to.moments = mix(g, all);
    if (emits) set_planck(g, to);
    return to;
  }
  double planck(size_t level) const {  // from the top
    return double{column_.blackbody[(column_.layers() - level) * column_.bins + bin_]};
  }
  // Several layers together emit what they did apart: levels high up are warm, but hardly any air is there.
  void set_planck(size_t g, DiffuseLayer& to) const {
    to.planck_top = planck(first_[g]);
    to.planck_bottom = planck(level(g + 1));
    if (level(g + 1) - first_[g] == 1 || !(to.depth > 0)) return;
    double sum = 0;
    for (size_t n = first_[g]; n < level(g + 1); ++n) sum += 0.5 * (planck(n) + planck(n + 1)) * depth_of(n);
    to.planck_top = to.planck_bottom = sum / to.depth;
  }
  // Moments of a layer; its parts become shares of what it scatters.
  std::span<const double> mix(size_t g, double all) {
    const size_t kinds = column_.kinds.size();
    std::vector<double>& m = moments_[g];
    m.clear();
    if (!(all > 0)) return m;
    for (size_t k = 0; k < kinds; ++k) {
      double& share = scattered_[g * kinds + k];
      share /= all;
      const std::vector<double>& of = column_.kinds[k].moments[bin_];
      if (m.size() < of.size()) m.resize(of.size(), 0.0);
      for (size_t i = 0; i < of.size(); ++i) m[i] += share * of[i];
    }
    m[0] = 1;
    return m;
  }

  const AirColumn& column_;
  std::vector<bool> kept_;  // of the column's layers, from the top
  double thin_;
  size_t bin_ = 0;
  std::vector<size_t> first_;  // of the column's layers, in each of ours
  std::vector<DiffuseLayer> layers_;
  std::vector<std::vector<double>> moments_;
  std::vector<double> scattered_;  // [layer][kind]
};

// The column's layers, from the top, that sensors stand in.
std::vector<bool> layers_of_sensors(const AirColumn& column, std::span<const Sight> sights) {
  std::vector<bool> kept(column.layers() - column.ground, false);
  for (const Sight& s : sights)
    if (s.place.layer > 0 || s.place.fraction > 0) kept[static_cast<size_t>(s.place.layer)] = true;
  return kept;
}

// Depths of a beam at the levels, from the top: [level][bin].
std::vector<double> beam_levels(const AirColumn& column, double sun_cosine) {
  const std::span<const double> heights = column.shells.heights();
  const size_t levels = column.layers() - column.ground + 1;
  const Dir to_sun{std::sqrt(1 - sun_cosine * sun_cosine), 0, sun_cosine};
  std::vector<double> depths(levels * column.bins, 0.0);
  for (size_t n = 1; n < levels; ++n) {
    // As seen from the place on the ground, whose zenith angle is the one that is given.
    const Vec3 at = column.shells.above_zero(heights[column.layers() - n]);
    beam_depth(column.shells, heights[column.ground], column.extinction, at, to_sun,
               {&depths[n * column.bins], column.bins});
  }
  return depths;
}

// A sun and the views under it.
struct Sun {
  double cosine = 1;
  std::vector<double> depths;  // beam_levels
  std::vector<size_t> views;   // indices
};

std::vector<Sun> suns_of(const AirColumn& column, std::span<const Sight> sights) {
  std::vector<Sun> suns;
  for (size_t v = 0; v < sights.size(); ++v) {
    auto sun = std::ranges::find(suns, sights[v].sun_cosine, &Sun::cosine);
    if (sun == suns.end()) {
      suns.push_back({sights[v].sun_cosine, beam_levels(column, sights[v].sun_cosine), {}});
      sun = suns.end() - 1;
    }
    sun->views.push_back(v);
  }
  return suns;
}

// Irradiance of a sun over a bin, roughly: what light of the sun and of the air are to each other.
double rough_sun(const SpectralState& state, size_t i) {
  return kSunSolidAngle * planck_radiance(state.bins[i].center_um(), kSunRadiance);
}

class Solver {
 public:
  Solver(const AirColumn& column, std::span<const Sight> sights, std::span<const Sun> suns, const AirSpec& air,
         double thin, std::span<CorrectionBins> out)
      : column_(column),
        sights_(sights),
        suns_(suns),
        out_(out),
        ordinates_(air.streams),
        layers_(column, layers_of_sensors(column, sights), thin) {
    // Straight down or up there is but the mean over azimuth.
    level_ = std::ranges::all_of(sights, [](const Sight& s) { return s.cosine == 1; });
  }

  // sun: irradiance across the beams.
  void bin(size_t i, double sun, bool emits) {
    layers_.set(i, emits);
    sun_ = sun;
    warmth_ = 0;
    DiffuseProblem problem;
    problem.layers = layers_.layers();
    if (level_) problem.azimuth_tolerance = INFINITY;
    if (emits) {
      ordinates_.solve(problem);
      warm(i);
    }
    for (const Sun& each : suns_) {
      set_secants(each, i);
      problem.beam = {sun_, each.cosine, secants_, {}};
      if (!emits && &each == suns_.data())
        ordinates_.solve(problem);
      else
        ordinates_.set_beam(problem.beam);
      lit(each, i);
    }
  }

 private:
  void set_secants(const Sun& sun, size_t i) {
    secants_.resize(layers_.layers().size());
    for (size_t g = 0; g < secants_.size(); ++g) {
      const double depth = layers_.layers()[g].depth;
      const double slant =
          sun.depths[layers_.level(g + 1) * column_.bins + i] - sun.depths[layers_.level(g) * column_.bins + i];
      secants_[g] = depth > 1e-12 ? slant / depth : 1 / sun.cosine;
    }
  }
  // Light of the air itself is in all that is read off; it is taken away again.
  void lit(const Sun& sun, size_t i) {
    const double direct = std::exp(-sun.depths[layers_.level(secants_.size()) * column_.bins + i]);
    const double total = (ordinates_.black_irradiance() - warmth_) / (sun_ * sun.cosine),
                 albedo = ordinates_.spherical_albedo();
    for (const size_t v : sun.views) {
      const Sight& s = sights_[v];
      const DiffusePlace place = layers_.place(s.place);
      layers_.phases(s, phases_);
      ordinates_.set_ground(0, 0);
      const double black = radiance(s, phases_);
      ordinates_.set_ground(0, 1);
      out_[v].path[i] = (black - out_[v].emission_up[i]) / sun_;
      out_[v].up_total[i] = radiance(s, phases_) - black;
      out_[v].up_direct[i] = std::exp(-layers_.depth_below(place) / s.cosine);
      out_[v].down_direct[i] = direct, out_[v].down_total[i] = total;
      out_[v].spherical_albedo[i] = albedo;
    }
  }

  void warm(size_t i) {
    warmth_ = ordinates_.black_irradiance();
    for (size_t v = 0; v < sights_.size(); ++v) {
      out_[v].emission_up[i] = radiance(sights_[v], {});
      out_[v].emission_down[i] = warmth_ / kPi;
    }
  }

  double radiance(const Sight& s, std::span<const double> phases) const {
    return ordinates_.radiance(layers_.place(s.place), s.cosine, s.travel, phases);
  }

  const AirColumn& column_;
  std::span<const Sight> sights_;
  std::span<const Sun> suns_;
  std::span<CorrectionBins> out_;
  DiscreteOrdinates ordinates_;
  BinLayers layers_;
  bool level_ = false;
  double sun_ = 1, warmth_ = 0;  // irradiances across the beam, and of the air on the ground
  std::vector<double> secants_, phases_;
};

// Whether the air of a bin shines at all beside the sun.
bool shines(const AirColumn& column, const SpectralState& state, size_t i) {
  double most = 0;
  for (size_t l = column.ground; l <= column.layers(); ++l)
    most = std::max(most, double{column.blackbody[l * column.bins + i]});
  return most > kDarkest / kPi * rough_sun(state, i);
}

}  // namespace

std::vector<CorrectionBins> air_correction(const AirSpec& air, const SpectralState& state,
                                           std::span<const CorrectionView> views, double thin) {
  const AirColumn column = bake_column(air, state);
  const std::vector<Sight> sights = sights_of(column, air.height_of_scene(), views);
  const std::vector<Sun> suns = suns_of(column, sights);
  const std::vector<double> zeros(state.size(), 0.0);
  std::vector<CorrectionBins> out(views.size(), {zeros, zeros, zeros, zeros, zeros, zeros, zeros, zeros});
  constexpr size_t kAtOnce = 16;
  parallel_for(0, (state.size() + kAtOnce - 1) / kAtOnce, 1, [&](size_t begin, size_t end) {
    Solver solver(column, sights, suns, air, thin, out);
    for (size_t i = begin * kAtOnce; i < std::min(state.size(), end * kAtOnce); ++i)
      solver.bin(i, rough_sun(state, i), shines(column, state, i));
  });
  return out;
}

}  // namespace suite
