#include "air/column.h"

#include <algorithm>
#include <cmath>

#include "air/axis.h"
#include "air/gas_intervals.h"
#include "air/molecules.h"
#include "air/particle_phase.h"
#include "air/refraction.h"
#include "base/parallel.h"
#include "spectral/planck.h"

namespace suite {

namespace {

// Mean of what runs exponentially between two values, linearly where one is 0.
double mean_of(double a, double b) {
  if (!(a > 0 && b > 0) || std::fabs(a - b) < 1e-6 * (a + b)) return 0.5 * (a + b);
  return (a - b) / std::log(a / b);
}

// Whether two bins are g-points of one interval.
bool same_interval(const Bin& a, const Bin& b) { return a.low_um == b.low_um && a.high_um == b.high_um; }

// The intervals of a state: the first bin of each, and the end of the last.
std::vector<size_t> intervals_of(const SpectralState& state) {
  std::vector<size_t> first;
  for (size_t i = 0; i < state.size(); ++i)
    if (i == 0 || !same_interval(state.bins[i - 1], state.bins[i])) first.push_back(i);
  first.push_back(state.size());
  return first;
}

// Particles change slowly with wavelength: where only their extinction is wanted, they are asked for at steps of this
// share of a wavelength.
constexpr double kParticleStep = 0.01;

// The gases of an air at its levels.
class GasesAtLevels {
 public:
  GasesAtLevels(const AirSpec& spec, std::span<const AirLevel> levels) : spec_(spec) {
    if (spec.gases)
      intervals_ = shared_gas_intervals(spec.gases, levels, spec.points);
    else
      none_ = std::make_shared<const GasPoints>(GasPoints{{1.0}, std::vector<float>(levels.size(), 0.0f)});
  }
  // Of one interval. No gas at all where there is no provider.
  std::shared_ptr<const GasPoints> points(const Bin& bin) const {
    if (!intervals_) return none_;
    if (bin.low_um < spec_.gases->low_um() || bin.high_um > spec_.gases->high_um())
      throw Error(spec_.where,
                  strf("gases are known from %.4g to %.4g um, and a band reaches from %.4g to %.4g um",
                       spec_.gases->low_um(), spec_.gases->high_um(), bin.low_um, bin.high_um),
                  "`gases: none` leaves them out");
    return intervals_->points(bin.low_um, bin.high_um);
  }

 private:
  const AirSpec& spec_;
  std::shared_ptr<GasIntervals> intervals_;
  std::shared_ptr<const GasPoints> none_;
};

class Baker {
 public:
  Baker(const AirSpec& spec, const SpectralState& state, ColumnParts parts)
      : spec_(spec),
        state_(state),
        parts_(parts),
        levels_(air_levels(spec)),
        gases_(spec, levels_),
        column_{shells(), state.size(), {}, {}, {}, {}, {}, 0} {
    const double ground = spec.height_of_ground();
    while (column_.ground + 2 < levels_.size() && levels_[column_.ground].height < ground - 1) ++column_.ground;
    if (spec.refraction)
      for (const AirLevel& l : levels_)
        column_.refractivity.push_back(refractivity(state.reference_um, l.pressure, l.temperature));
    column_.extinction.assign(layers() * bins(), 0.0f);
    column_.blackbody.resize(levels_.size() * bins());
    for (size_t l = 0; l < layers(); ++l)
      column_.water.push_back(precipitable_water({"", {levels_[l], levels_[l + 1]}}) / (high(l) - low(l)));
    for (size_t i = 0; i < bins(); ++i) middles_.push_back(state.bins[i].center_um());
  }
  AirColumn bake() {
    const std::vector<size_t> first = intervals_of(state_);
    parallel_for(0, first.size() - 1, 1, [&](size_t begin, size_t end) {
      for (size_t n = begin; n < end; ++n) bake_interval(first[n], first[n + 1]);
    });
    if (spec_.molecules) add_molecules();
    add_aerosol();
    for (const AirSpec::Cloud& cloud : spec_.clouds)
      add_particles(cloud.particles, [&](double low, double high) {
        return low >= cloud.base - 1 && high <= cloud.top + 1 ? cloud.content : 0;
      });
    return std::move(column_);
  }

 private:
  size_t bins() const { return state_.size(); }
  size_t layers() const { return levels_.size() - 1; }
  double low(size_t layer) const { return levels_[layer].height; }
  double high(size_t layer) const { return levels_[layer + 1].height; }

  Shells shells() const {
    std::vector<double> heights;
    for (const AirLevel& l : levels_) heights.push_back(l.height - spec_.height_of_scene());
    if (!spec_.round) return Shells::flat(std::move(heights));
    const double radius = spec_.radius + spec_.height_of_scene();
    return Shells::round({0, 0, -radius}, radius, std::move(heights));
  }

  // Absorption by gases, and Planck's function, which the g-points of an interval share. Of these some may be left out.
  void bake_interval(size_t first, size_t end) {
    const Bin& bin = state_.bins[first];
    const std::shared_ptr<const GasPoints> shared = gases_.points(bin);
    const GasPoints& points = *shared;
    for (size_t i = first; i < end; ++i) SUITE_CHECK(state_.bins[i].g < points.count());
    for (size_t l = 0; l < levels_.size(); ++l) {
      const double mean =
          planck_band_radiance(bin.low_um, bin.high_um, levels_[l].temperature) / (bin.high_um - bin.low_um);
      for (size_t i = first; i < end; ++i) {
        column_.blackbody[l * bins() + i] = static_cast<float>(mean);
        if (l + 1 == levels_.size()) continue;
        const auto at = [&](size_t level) {
          return double{points.absorption[level * points.count() + state_.bins[i].g]};
        };
        column_.extinction[l * bins() + i] = static_cast<float>(mean_of(at(l), at(l + 1)));
      }
    }
  }

  void add_molecules() {
    AirColumn::Kind kind;
    if (parts_ == ColumnParts::all) {
      kind.phase = bake_phase({"rayleigh", {{"depolarisation", kDepolarisation}}, {}, {}, nullptr}, state_);
      constexpr double gamma = kDepolarisation / (2 - kDepolarisation);
      kind.moments.assign(bins(), {1, 0, (1 - gamma) / (10 * (1 + 2 * gamma))});
    }
    kind.scattering.resize(layers() * bins());
    for (size_t l = 0; l < layers(); ++l)
      for (size_t i = 0; i < bins(); ++i)
        kind.scattering[l * bins() + i] = static_cast<float>(
            rayleigh_depth(middles_[i], levels_[l].pressure - levels_[l + 1].pressure) / (high(l) - low(l)));
    add(std::move(kind), nullptr);
  }

  void add_aerosol() {
    if (!spec_.aerosol) return;
    const AirSpec::Aerosol& a = *spec_.aerosol;
    const double ground = levels_[column_.ground].height;
    using Region = AerosolProfile::Region;
    for (const Region region : {Region::boundary, Region::free_troposphere, Region::stratosphere}) {
      ParticleSpec kind = a.boundary;
      if (region == Region::free_troposphere) kind = {.name = "free_troposphere", .relative_humidity = 0.5};
      if (region == Region::stratosphere) kind = {.name = "stratosphere", .relative_humidity = 0};
      if (a.one_kind && region != Region::boundary) return;
      add_particles(kind, [&](double bottom, double top) {
        if (!a.one_kind && AerosolProfile::region(0.5 * (bottom + top) - ground) != region) return 0.0;
        return a.profile.depth(bottom - ground, top - ground) / (top - bottom);
      });
    }
  }

  // amount: of extinction at 0.55 um, 1/m, or kg/m3, as the mean between two heights.
  template <class Amount>
  void add_particles(const ParticleSpec& particles, const Amount& amount) {
    const bool all = parts_ == ColumnParts::all;
    const std::vector<double> asked = all ? middles_ : coarse_middles();
    const ParticleOptics optics = particle_optics(particles, asked);
    std::vector<double> unit_extinction(bins()),
        albedo(bins());  // extinction over amount, and the share that is scattered
    for (size_t i = 0; i < bins(); ++i) {
      const AxisPlace at = all ? AxisPlace{i, 0} : place_on(asked, middles_[i]);
      const size_t next = at.s > 0 ? at.i + 1 : at.i;
      unit_extinction[i] = optics.extinction(at.i) + at.s * (optics.extinction(next) - optics.extinction(at.i));
      albedo[i] = optics.albedo(at.i) + at.s * (optics.albedo(next) - optics.albedo(at.i));
    }
    AirColumn::Kind kind;
    kind.scattering.resize(layers() * bins());
    std::vector<float> extinction(layers() * bins());
    bool any = false;
    for (size_t l = 0; l < layers(); ++l) {
      const double here = amount(low(l), high(l));
      any = any || here > 0;
      for (size_t i = 0; i < bins(); ++i) {
        extinction[l * bins() + i] = static_cast<float>(here * unit_extinction[i]);
        kind.scattering[l * bins() + i] = static_cast<float>(here * unit_extinction[i] * albedo[i]);
      }
    }
    if (!any) return;
    if (all) {
      kind.phase = particle_phase(optics, state_.knots);
      for (size_t i = 0; i < bins(); ++i)
        kind.moments.push_back(i > 0 && middles_[i] == middles_[i - 1]
                                   ? kind.moments.back()
                                   : optics.moments(i, static_cast<size_t>(spec_.streams) + 1));
    }
    add(std::move(kind), extinction.data());
  }

  std::vector<double> coarse_middles() const {
    const auto [low, high] = std::minmax_element(middles_.begin(), middles_.end());
    std::vector<double> coarse{*low};
    while (coarse.back() * (1 + kParticleStep) < *high) coarse.push_back(coarse.back() * (1 + kParticleStep));
    if (*high > coarse.back()) coarse.push_back(*high);
    return coarse;
  }

  // extinction: null = what is scattered.
  void add(AirColumn::Kind kind, const float* extinction) {
    for (size_t i = 0; i < column_.extinction.size(); ++i)
      column_.extinction[i] += extinction ? extinction[i] : kind.scattering[i];
    column_.kinds.push_back(std::move(kind));
  }

  static constexpr double kDepolarisation = 0.0279;  // of air, Bates 1984
  const AirSpec& spec_;
  const SpectralState& state_;
  ColumnParts parts_;
  std::vector<AirLevel> levels_;
  GasesAtLevels gases_;
  AirColumn column_;
  std::vector<double> middles_;  // of the bins, um
};

// Makes something of an air; what is wrong with it is told where the air stands.
template <class Make>
auto located(const AirSpec& spec, const Make& make) {
  try {
    return make();
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw Error(spec.where, "the atmosphere: " + e.message(), e.hint());
  }
}

}  // namespace

AirColumn bake_column(const AirSpec& spec, const SpectralState& state, ColumnParts parts) {
  check_air(spec);
  return located(spec, [&] { return Baker(spec, state, parts).bake(); });
}

BeamTable bake_beam_table(const AirSpec& spec, const AirColumn& column) {
  return located(spec, [&] {
    return BeamTable(column.shells, column.shells.heights()[column.ground], column.extinction, column.bins,
                     column.refractivity);
  });
}

SpectralState with_gas_points(const AirSpec& spec, const SpectralState& state) {
  check_air(spec);
  const std::vector<AirLevel> levels = air_levels(spec);
  const GasesAtLevels gases(spec, levels);
  std::vector<std::vector<double>> weights(state.size());
  parallel_for(0, state.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) weights[i] = gases.points(state.bins[i])->weight;
  });
  return with_g_points(state, weights);
}

}  // namespace suite
