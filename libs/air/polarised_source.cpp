#include "air/polarised_source.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "air/phase_grid.h"
#include "air/stokes_field.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "math/falling.h"

namespace suite {

namespace {

constexpr double kThin = 1e-7;   // scattering of such a depth does not matter
constexpr double kLeast = 1e-4;  // nor do coefficients of matrices below it
// Polarisation is that of molecules, so smooth that more change I, Q and U by less than 0.04 % of I, at 8 times the
// cost (tests/physics/light/polarised_air_test.cpp).
constexpr int kMostStreams = 8;

// Denser towards the zenith, where modes fall with the sine, and the horizon, where ways are long.
const std::vector<double>& cosines_of_ways() {
  static const std::vector<double> all = [] {
    std::vector<double> up = {0.01, 0.04, 0.1, 0.18, 0.28, 0.4, 0.52, 0.64, 0.75, 0.84, 0.91, 0.96, 0.99, 1}, both;
    for (size_t k = up.size(); k-- > 0;) both.push_back(-up[k]);
    both.insert(both.end(), up.begin(), up.end());
    return both;
  }();
  return all;
}

// The matrices of the kinds of a column, for all bins or one a bin; none: it depolarises, or its matrix is not known.
using Matrices = std::vector<std::vector<GreekMatrix>>;

std::vector<GreekMatrix> matrices_of(const AirColumn& column, const PhaseFunction& phase, size_t degrees) {
  const size_t bins = column.bins;
  std::vector<PlaneBlocks> one(bins), all;
  std::vector<float> values(bins);
  bool grey = phase.spectrally_uniform();
  for (const double c : phase_cosines()) {
    const auto of = phase.polarised(c, one);
    if (of.unknown > 0) return {};
    const bool even = phase.spectrally_uniform();
    grey = grey && of.grey;
    phase.eval(c, even ? std::span(values).first(1) : std::span(values));
    for (size_t b = 0; b < bins; ++b) all.push_back(one[of.grey ? 0 : b] * double{values[even ? 0 : b]});
  }
  std::vector<GreekMatrix> matrices;
  std::vector<PlaneBlocks> of_bin(phase_cosines().size());
  for (size_t b = 0; b < (grey ? 1 : bins); ++b) {
    for (size_t k = 0; k < of_bin.size(); ++k) of_bin[k] = all[k * bins + b];
    GreekMatrix& m = matrices.emplace_back(GreekMatrix::tabulated(phase_cosines(), of_bin, degrees));
    const auto small = [](const GreekMatrix::Degree& d) {
      return std::max({std::fabs(d.a1), std::fabs(d.a2), std::fabs(d.a3), std::fabs(d.b1)}) < kLeast;
    };
    while (m.degrees.size() > 1 && small(m.degrees.back())) m.degrees.pop_back();
  }
  return matrices;
}

struct Setting {
  const AirSpec& spec;
  const AirColumn& column;
  std::span<const AirBeam> beams;
  std::span<const std::vector<double>> depths;
  std::vector<float> ground_albedo;
  Matrices matrices;
  int streams = kMostStreams;
  std::vector<std::vector<StokesFunctions>> ways;  // [order][cosine], of the light along them
};

// One bin at a time; one of these a thread.
class PolarisedBins {
 public:
  PolarisedBins(const Setting& setting, PolarisedSource& to)
      : s_(setting),
        to_(to),
        vector_(to.shape().kept == StokesParts::all ? StokesField::Light::circular : StokesField::Light::polarised,
                setting.streams),
        scalar_(StokesField::Light::intensity, setting.streams),
        layers_(setting.column.layers() - setting.column.ground),
        matrices_(layers_.size()),
        own_(2 * layers_.size()) {}

  void solve(size_t bin) {
    bin_ = bin;
    if (!lay_out()) return;
    for (size_t b = 0; b < s_.beams.size(); ++b) {
      const AirBeam& beam = s_.beams[b];
      problem_.beam = beam_.through(s_.column, s_.depths[b], bin, beam.direction.z, beam.irradiance[bin]);
      vector_.solve(problem_), scalar_.solve(problem_);
      for (size_t m = 0; m < std::min(to_.shape().orders, static_cast<size_t>(vector_.orders())); ++m) {
        const StokesFunctions of_sun(static_cast<int>(m), -beam.direction.z, static_cast<size_t>(s_.streams));
        for (size_t c = 0; c < to_.shape().cosines.size(); ++c) tabulate(b, m, c, of_sun);
      }
    }
  }

 private:
  size_t from_top(size_t n) const { return s_.column.layers() - 1 - n; }
  double at(const std::vector<float>& values, size_t row) const { return values[row * s_.column.bins + bin_]; }
  const GreekMatrix* matrix_of(size_t kind) const {
    const auto& of = s_.matrices[kind];
    return of.empty() ? nullptr : &of[of.size() == 1 ? 0 : bin_];
  }

  // False where nothing that polarises scatters.
  bool lay_out() {
    const AirColumn& column = s_.column;
    double known = 0;
    for (size_t n = 0; n < layers_.size(); ++n) {
      const size_t l = from_top(n);
      const double k = at(column.extinction, l),
                   thickness = column.shells.heights()[l + 1] - column.shells.heights()[l];
      double scattering = 0;
      for (const AirColumn::Kind& kind : column.kinds) scattering += at(kind.scattering, l);
      matrices_[n].degrees.assign(1, {});
      for (size_t i = 0; i < column.kinds.size() && scattering > 0; ++i) {
        const double own = at(column.kinds[i].scattering, l);
        const GreekMatrix* const matrix = matrix_of(i);
        matrices_[n].add(matrix ? *matrix : GreekMatrix::depolarising(column.kinds[i].moments[bin_]), own / scattering);
        if (matrix) known += own * thickness;
      }
      matrices_[n].degrees[0].a1 = 1;
      layers_[n] = {k * thickness, k > 0 ? std::clamp(scattering / k, 0.0, 1.0) : 0, &matrices_[n]};
    }
    problem_ = {};
    problem_.layers = layers_;
    problem_.ground_albedo = s_.ground_albedo[bin_];
    problem_.orders = static_cast<int>(to_.shape().orders);
    return known > kThin;
  }

  // One mode along one way, in all layers.
  void tabulate(size_t b, size_t m, size_t c, const StokesFunctions& of_sun) {
    const StokesFunctions& way = s_.ways[m][c];
    for (size_t n = 0; n < layers_.size(); ++n)
      for (size_t end = 0; end < 2; ++end) {
        const auto place = end == 0 ? StokesField::End::bottom : StokesField::End::top;
        const auto layer = static_cast<int>(n), order = static_cast<int>(m);
        StokesMode& own = own_[2 * n + end];
        own = vector_.source(layer, place, order, way);
        own += -1.0 * StokesMode{scalar_.source(layer, place, order, way).i, 0, 0, 0};
        own = vector_.depth_scale(layer) * own;
      }
    add_peak(b, m, c, of_sun);
    for (size_t l = 0; l < s_.column.layers(); ++l)
      for (size_t end = 0; end < 2; ++end) {
        // What lies below the ground is as its lowest layer.
        const size_t n = l < s_.column.ground ? layers_.size() - 1 : from_top(l);
        const StokesMode& own = own_[2 * n + (l < s_.column.ground ? 0 : end)];
        to_.at(b, l, end, c, m, PolarisedSource::i)[bin_] = static_cast<float>(own.i);
        to_.at(b, l, end, c, m, PolarisedSource::q)[bin_] = static_cast<float>(own.q);
        to_.at(b, l, end, c, m, PolarisedSource::u)[bin_] = static_cast<float>(own.u);
        if (to_.shape().kept == StokesParts::all)
          to_.at(b, l, end, c, m, PolarisedSource::v)[bin_] = static_cast<float>(own.v);
      }
  }

  // Adds what the forward peak, which the scaled medium lets pass, scatters: of diffuse light along the way, and of the
  // beam (as diffuse_field.cpp does).
  void add_peak(size_t b, size_t m, size_t c, const StokesFunctions& of_sun) {
    const double cosine = to_.shape().cosines[c];
    const bool rising = cosine < 0;  // the light, seen from above
    const size_t count = layers_.size();
    StokesMode light;
    const auto ground = static_cast<int>(count);
    if (rising && m == 0) light.i = (vector_.fluxes(ground).up - scalar_.fluxes(ground).up) / kPi;
    for (size_t step = 0; step < count; ++step) {
      const size_t n = rising ? count - 1 - step : step;
      StokesMode of_beam_light;
      const double k = at(s_.column.extinction, from_top(n));
      for (size_t i = 0; i < s_.column.kinds.size() && k > 0; ++i)
        if (const GreekMatrix* const matrix = matrix_of(i))
          of_beam_light += at(s_.column.kinds[i].scattering, from_top(n)) / k *
                           of_beam(*matrix, static_cast<int>(m), s_.ways[m][c], of_sun);
      of_beam_light.i = 0;  // the scalar source has it
      light = through(n, rising, std::fabs(cosine), b, of_beam_light, light);
    }
  }
  // Light enters a layer and leaves it; both ends get their part of the peak.
  StokesMode through(size_t n, bool rising, double cosine, size_t b, const StokesMode& scattered,
                     const StokesMode& light) {
    const size_t first = rising ? 0 : 1;  // end that light enters by: 0 = the lower one
    const double scale = vector_.depth_scale(static_cast<int>(n)), peak = 1 - scale;
    StokesMode source[2],
        more[2];  // per scaled depth, at the entrance and the exit; what the beam's peak adds, per depth
    for (size_t side = 0; side < 2; ++side) {
      const size_t end = side == 0 ? first : 1 - first, level = n + (end == 0 ? 1 : 0);
      const double beam = vector_.beam(static_cast<int>(level)),
                   left = s_.beams[b].irradiance[bin_] * std::exp(-beam_.depth[level]);
      source[side] = own_[2 * n + end];
      source[side] += beam * scattered;
      source[side] = (scale > 0 ? 1 / scale : 0) * source[side];
      more[side] = std::max(0.0, beam - left) * scattered;
    }
    const auto x = static_cast<float>(std::min(1e4, layers_[n].depth * scale / cosine));
    const float keep = exp_falling(x);
    StokesMode leaves = double{keep} * light;
    leaves += x * double{mean_of_even(x, keep)} * source[1];
    leaves += x * 0.5 * double{mean_of_rising(x, keep)} * source[0];
    leaves += -x * 0.5 * double{mean_of_rising(x, keep)} * source[1];
    own_[2 * n + first] += peak * light;
    own_[2 * n + first] += more[0];
    own_[2 * n + 1 - first] += peak * leaves;
    own_[2 * n + 1 - first] += more[1];
    return leaves;
  }

  const Setting& s_;
  PolarisedSource& to_;
  StokesField vector_, scalar_;
  std::vector<StokesAirLayer> layers_;
  std::vector<GreekMatrix> matrices_;
  StokesProblem problem_;
  LayerBeam beam_;
  std::vector<StokesMode> own_;  // at the ends of the layers from the top, in the making
  size_t bin_ = 0;
};

}  // namespace

namespace {
// Of a shape's table; refuses what is too large for a machine that renders as well.
size_t values_of(const PolarisedSource::Shape& s) {
  constexpr double kMost = 2e9;  // bytes
  const double each = 4.0 * 2 * static_cast<double>(s.parts() * s.layers * s.cosines.size() * s.orders),
               many = static_cast<double>(s.beams) * static_cast<double>(s.bins);
  if (each * many > kMost)
    throw Error(
        strf("the polarised light of the air takes %.3g GB: %zu spectral bins times %zu beams, %.0f kB each",
             each * many / 1e9, s.bins, s.beams, each / 1e3),
        strf("at most %.0f bins: fewer bands at a time or a larger spectral_error, fewer layers of the profile, or "
             "`scattering: traced`",
             kMost / each / static_cast<double>(s.beams)));
  return static_cast<size_t>(each * many / 4);
}
}  // namespace

PolarisedSource::PolarisedSource(Shape shape) : shape_(std::move(shape)), table_(values_of(shape_)) {}

PolarisedSource::Place PolarisedSource::place(double cosine) const {
  const std::vector<double>& all = shape_.cosines;
  const auto above = static_cast<size_t>(std::upper_bound(all.begin(), all.end(), cosine) - all.begin());
  const size_t first = std::clamp<size_t>(above, 1, all.size() - 1) - 1;
  return {first, static_cast<float>(std::clamp((cosine - all[first]) / (all[first + 1] - all[first]), 0.0, 1.0))};
}

std::shared_ptr<const PolarisedSource> solve_polarised_source(const AirSpec& spec, const AirColumn& column,
                                                              const SpectralState& state,
                                                              std::span<const AirBeam> beams,
                                                              std::span<const std::vector<double>> depths,
                                                              StokesParts parts) {
  Setting s{spec, column, beams, depths, state.sample(spec.ground_albedo), {}, std::min(spec.streams, kMostStreams),
            {}};
  size_t orders = 0;
  for (const AirColumn::Kind& kind : column.kinds) {
    s.matrices.push_back(matrices_of(column, *kind.phase, static_cast<size_t>(s.streams) + 1));
    for (const GreekMatrix& m : s.matrices.back())
      orders = std::max(orders, std::min(m.degrees.size(), static_cast<size_t>(s.streams)));
  }
  if (orders == 0 || beams.empty()) return nullptr;
  auto source = std::make_shared<PolarisedSource>(
      PolarisedSource::Shape{column.layers(), column.bins, beams.size(), orders, cosines_of_ways(), parts});
  for (size_t m = 0; m < orders; ++m) {
    auto& of_order = s.ways.emplace_back();
    for (const double c : source->shape().cosines)
      of_order.emplace_back(static_cast<int>(m), -c, static_cast<size_t>(s.streams));
  }
  parallel_for(0, column.bins, 4, [&](size_t begin, size_t end) {
    PolarisedBins solver(s, *source);
    for (size_t bin = begin; bin < end; ++bin) stop_point(), solver.solve(bin);
  });
  return source;
}

}  // namespace suite
