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

// The layers of a bin, from the top.
class BinLayers {
 public:
  explicit BinLayers(const AirColumn& column)
      : column_(column),
        layers_(column.layers() - column.ground),
        moments_(layers_.size()),
        scattered_(layers_.size() * column.kinds.size()) {}

  void set(size_t bin) {
    bin_ = bin;
    const std::span<const double> heights = column_.shells.heights();
    for (size_t n = 0; n < layers_.size(); ++n) {
      const size_t l = layer_below(n), at = l * column_.bins + bin;
      const double extinction = double{column_.extinction[at]}, all = mix(n, at);
      layers_[n].depth = extinction * (heights[l + 1] - heights[l]);
      layers_[n].albedo = extinction > 0 ? std::min(1.0, all / extinction) : 0;
      layers_[n].moments = moments_[n];
    }
  }
  void set_emission(bool on) {
    for (size_t n = 0; n < layers_.size(); ++n) {
      const size_t l = layer_below(n);
      layers_[n].planck_top = on ? double{column_.blackbody[(l + 1) * column_.bins + bin_]} : 0;
      layers_[n].planck_bottom = on ? double{column_.blackbody[l * column_.bins + bin_]} : 0;
    }
  }
  // Phase function of every layer for a view.
  void phases(const Sight& sight, std::vector<double>& out) const {
    out.assign(layers_.size(), 0.0);
    for (size_t n = 0; n < out.size(); ++n)
      for (size_t k = 0; k < column_.kinds.size(); ++k)
        out[n] += scattered_[n * column_.kinds.size() + k] * double{sight.phase[k * column_.bins + bin_]};
  }
  std::span<const DiffuseLayer> layers() const { return layers_; }
  size_t layer_below(size_t n) const { return column_.layers() - 1 - n; }
  // Vertical depth from the ground up to a place.
  double depth_below(DiffusePlace place) const {
    double sum = 0;
    for (size_t n = static_cast<size_t>(place.layer); n < layers_.size(); ++n)
      sum += layers_[n].depth * (n == static_cast<size_t>(place.layer) ? 1 - place.fraction : 1);
    return sum;
  }

 private:
  // Moments of the layer, and the kinds' shares of what it scatters. -> what it scatters, 1/m
  double mix(size_t n, size_t at) {
    const size_t kinds = column_.kinds.size();
    double all = 0;
    for (size_t k = 0; k < kinds; ++k) all += scattered_[n * kinds + k] = double{column_.kinds[k].scattering[at]};
    std::vector<double>& m = moments_[n];
    m.clear();
    if (!(all > 0)) return 0;
    for (size_t k = 0; k < kinds; ++k) {
      double& share = scattered_[n * kinds + k];
      share /= all;
      const std::vector<double>& of = column_.kinds[k].moments[bin_];
      if (m.size() < of.size()) m.resize(of.size(), 0.0);
      for (size_t i = 0; i < of.size(); ++i) m[i] += share * of[i];
    }
    m[0] = 1;
    return all;
  }

  const AirColumn& column_;
  size_t bin_ = 0;
  std::vector<DiffuseLayer> layers_;
  std::vector<std::vector<double>> moments_;
  std::vector<double> scattered_;  // [layer][kind]
};

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

class Solver {
 public:
  Solver(const AirColumn& column, std::span<const Sight> sights, std::span<const Sun> suns, int streams,
         std::span<CorrectionBins> out)
      : column_(column), sights_(sights), suns_(suns), out_(out), ordinates_(streams), layers_(column) {
    // Straight down or up there is but the mean over azimuth.
    level_ = std::ranges::all_of(sights, [](const Sight& s) { return s.cosine == 1; });
  }

  void bin(size_t i, bool emits) {
    layers_.set(i);
    layers_.set_emission(false);
    for (const Sun& sun : suns_) lit(sun, i, &sun == suns_.data());
    if (emits) warm(i);
  }

 private:
  void lit(const Sun& sun, size_t i, bool first) {
    secants_.resize(layers_.layers().size());
    for (size_t n = 0; n < secants_.size(); ++n) {
      const double depth = layers_.layers()[n].depth;
      const double slant = sun.depths[(n + 1) * column_.bins + i] - sun.depths[n * column_.bins + i];
      secants_[n] = depth > 1e-12 ? slant / depth : 1 / sun.cosine;
    }
    const DiffuseBeam beam{1, sun.cosine, secants_, {}};
    if (first) {
      DiffuseProblem problem{layers_.layers(), beam, 0, 0, 0};
      if (level_) problem.azimuth_tolerance = INFINITY;
      ordinates_.solve(problem);
    } else {
      ordinates_.set_beam(beam);
    }
    const double direct = std::exp(-sun.depths[secants_.size() * column_.bins + i]);
    const double total = ordinates_.black_irradiance() / sun.cosine, albedo = ordinates_.spherical_albedo();
    ordinates_.set_ground(0, 0);
    for (const size_t v : sun.views) {
      layers_.phases(sights_[v], phases_);
      out_[v].path[i] = radiance(sights_[v], phases_);
      out_[v].down_direct[i] = direct, out_[v].down_total[i] = total;
      out_[v].spherical_albedo[i] = albedo;
    }
    ordinates_.set_ground(0, 1);
    for (const size_t v : sun.views) {
      layers_.phases(sights_[v], phases_);
      out_[v].up_total[i] = radiance(sights_[v], phases_) - out_[v].path[i];
      out_[v].up_direct[i] = std::exp(-layers_.depth_below(sights_[v].place) / sights_[v].cosine);
    }
  }

  void warm(size_t i) {
    layers_.set_emission(true);
    DiffuseProblem problem;
    problem.layers = layers_.layers();
    ordinates_.solve(problem);
    const double down = ordinates_.black_irradiance() / kPi;
    for (size_t v = 0; v < sights_.size(); ++v) {
      out_[v].emission_up[i] = radiance(sights_[v], {});
      out_[v].emission_down[i] = down;
    }
  }

  double radiance(const Sight& s, std::span<const double> phases) const {
    return ordinates_.radiance(s.place, s.cosine, s.travel, phases);
  }

  const AirColumn& column_;
  std::span<const Sight> sights_;
  std::span<const Sun> suns_;
  std::span<CorrectionBins> out_;
  DiscreteOrdinates ordinates_;
  BinLayers layers_;
  bool level_ = false;
  std::vector<double> secants_, phases_;
};

// Whether the air of a bin shines at all beside the sun.
bool shines(const AirColumn& column, const SpectralState& state, size_t i) {
  double most = 0;
  for (size_t l = column.ground; l <= column.layers(); ++l)
    most = std::max(most, double{column.blackbody[l * column.bins + i]});
  return most > kDarkest * kSunSolidAngle / kPi * planck_radiance(state.bins[i].center_um(), kSunRadiance);
}

}  // namespace

std::vector<CorrectionBins> air_correction(const AirSpec& air, const SpectralState& state,
                                           std::span<const CorrectionView> views) {
  const AirColumn column = bake_column(air, state);
  const std::vector<Sight> sights = sights_of(column, air.height_of_scene(), views);
  const std::vector<Sun> suns = suns_of(column, sights);
  const std::vector<double> zeros(state.size(), 0.0);
  std::vector<CorrectionBins> out(views.size(), {zeros, zeros, zeros, zeros, zeros, zeros, zeros, zeros});
  constexpr size_t kAtOnce = 16;
  parallel_for(0, (state.size() + kAtOnce - 1) / kAtOnce, 1, [&](size_t begin, size_t end) {
    Solver solver(column, sights, suns, air.streams, out);
    for (size_t i = begin * kAtOnce; i < std::min(state.size(), end * kAtOnce); ++i)
      solver.bin(i, shines(column, state, i));
  });
  return out;
}

}  // namespace suite
