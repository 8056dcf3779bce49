#include "light/kinds/sky.h"

#include <algorithm>
#include <cmath>

#include "math/quick_angle.h"
#include "spectral/planck.h"

namespace suite {

namespace {
constexpr size_t kMaxTable = size_t{1} << 28;

// Cosine and sine of an angle in 0..2 pi; small ones by series, to the last digit or so.
Vec2 turned(double angle) {
  if (angle > 0.1) return {std::cos(angle), std::sin(angle)};
  const double q = angle * angle;
  return {1 - q * (1 / 2.0 - q * (1 / 24.0 - q * (1 / 720.0 - q * (1 / 40320.0)))),
          angle * (1 - q * (1 / 6.0 - q * (1 / 120.0 - q * (1 / 5040.0))))};
}

SpectralState one_wavelength() {
  SpectralState one;
  one.low_um = 1, one.high_um = 1.1, one.reference_um = 1.05;
  one.bins = {{1, 1.1}};
  one.knots = {0};
  return one;
}
}  // namespace

namespace {
void check_stokes(const SkyStokes& s) {
  if (s.zeniths < 2 || s.azimuths < 1 || s.q.size() != s.zeniths * s.azimuths || s.u.size() != s.q.size())
    throw Error(strf("a sky's tables of q and u, of %zu and %zu values, are not %zu zeniths by %zu azimuths",
                     s.q.size(), s.u.size(), s.zeniths, s.azimuths));
  for (size_t i = 0; i < s.q.size(); ++i)
    if (!(std::hypot(s.q[i], s.u[i]) <= 1 + 1e-9))
      throw Error(strf("a sky's degree of polarisation is %g", std::hypot(s.q[i], s.u[i])), "0 to 1");
}
}  // namespace

Sky::Sky(const SkySpec& directions) : Sky(directions, one_wavelength()) {}

Sky::Sky(const SkySpec& spec, const SpectralState& state)
    : theta_max_(spec.full_sphere ? kPi : kPi / 2),
      full_sphere_(spec.full_sphere),
      cells_(spec.cells),
      polarisation_(spec.polarisation),
      stokes_(spec.stokes) {
  if (stokes_) check_stokes(*stokes_);
  if (!spec.layers.empty())
    bake_layers(spec, state);
  else
    bake_table(spec, state);
  nature_.far = nature_.wide = true;
  nature_.drawn = tabulated();
}

void Sky::bake_table(const SkySpec& spec, const SpectralState& state) {
  spectrum_ = state.sample(spec.radiance);
  if (spec.radiance.min() < 0) throw Error("the sky's radiance is negative");
  if (spec.table.empty()) return;
  const size_t directions = spec.zeniths * spec.azimuths;
  channels_ = std::max<size_t>(1, spec.wavelength_um.size());
  if (spec.zeniths < (cells_ ? 1 : 2) || spec.azimuths < 1 || spec.table.size() != directions * channels_)
    throw Error(strf("a sky table of %zu values is not %zu zeniths by %zu azimuths by %zu wavelengths",
                     spec.table.size(), spec.zeniths, spec.azimuths, channels_));
  if (!std::is_sorted(spec.wavelength_um.begin(), spec.wavelength_um.end()))
    throw Error("the wavelengths of a sky table are not ascending");
  table_.resize(spec.table.size());
  for (size_t c = 0; c < channels_; ++c)
    for (size_t i = 0; i < directions; ++i) {
      const double v = spec.table[c * directions + i];
      if (!(v >= 0) || !std::isfinite(v)) throw Error("a sky table holds a negative or infinite value");
      table_[i * channels_ + c] = static_cast<float>(v);
    }
  rows_ = cells_ ? spec.zeniths : spec.zeniths - 1;
  columns_ = spec.azimuths;
  const std::vector<double>& x = spec.wavelength_um;
  for (const Bin& bin : state.bins) {
    const auto above = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), bin.center_um()) - x.begin());
    if (above == 0)
      mix_.push_back({0, 0, 0});
    else if (above == x.size())
      mix_.push_back({static_cast<uint32_t>(channels_ - 1), static_cast<uint32_t>(channels_ - 1), 0});
    else
      mix_.push_back({static_cast<uint32_t>(above - 1), static_cast<uint32_t>(above),
                      static_cast<float>((bin.center_um() - x[above - 1]) / (x[above] - x[above - 1]))});
  }
  bake_density();
}

void Sky::bake_layers(const SkySpec& spec, const SpectralState& state) {
  const size_t rows = std::max<size_t>(2, spec.zeniths), bins = state.size();
  if (rows * bins > kMaxTable)
    throw Error(strf("a thermal sky of %zu zenith angles and %zu wavelengths is too large", rows, bins));
  channels_ = bins;
  rows_ = rows - 1;
  columns_ = 1;
  theta_max_ = kPi / 2;
  full_sphere_ = cells_ = false;
  spectrum_.assign(bins, 1.0f);
  table_.assign(rows * bins, 0.0f);
  for (uint32_t i = 0; i < bins; ++i) mix_.push_back({i, i, 0});
  std::vector<double> transmitted(rows * bins, 1.0), sum(rows * bins, 0.0);
  for (const ThermalLayer& layer : spec.layers) {
    if (!(layer.temperature_k > 0) || !std::isfinite(layer.temperature_k))
      throw Error(strf("a layer of the sky at %g K", layer.temperature_k));
    if (layer.optical_depth.min() < 0) throw Error("a layer of the sky has a negative optical depth");
    for (size_t i = 0; i < bins; ++i) {
      const Bin& b = state.bins[i];
      const double depth = layer.optical_depth.mean(b.low_um, b.high_um),
                   blackbody = planck_band_radiance(b.low_um, b.high_um, layer.temperature_k) / (b.high_um - b.low_um);
      for (size_t r = 0; r < rows; ++r) {
        // At the horizon itself any absorbing layer is opaque.
        const double cosine =
            r + 1 == rows ? 0 : std::cos(theta_max_ * static_cast<double>(r) / static_cast<double>(rows_));
        const double absorbed = depth == 0 ? 0 : cosine == 0 ? 1 : -std::expm1(-depth / cosine);
        double& T = transmitted[r * bins + i];
        sum[r * bins + i] += T * absorbed * blackbody;
        T *= 1 - absorbed;
      }
    }
  }
  std::transform(sum.begin(), sum.end(), table_.begin(), [](double v) { return static_cast<float>(v); });
  bake_density();
}

double Sky::cell_solid_angle(size_t row) const {
  return (edges_[row] - edges_[row + 1]) * 2 * kPi / static_cast<double>(columns_);
}

double Sky::cell_mean(size_t r, size_t c, size_t channel) const {
  auto at = [&](size_t row, size_t column) {
    return static_cast<double>(table_[(row * columns_ + column) * channels_ + channel]);
  };
  if (cells_) return at(r, c);
  const size_t n = (c + 1) % columns_;
  return 0.25 * (at(r, c) + at(r, n) + at(r + 1, c) + at(r + 1, n));
}

void Sky::bake_density() {
  for (size_t r = 0; r <= rows_; ++r)
    edges_.push_back(std::cos(theta_max_ * static_cast<double>(r) / static_cast<double>(rows_)));
  // Flux of every channel, then of every bin; a channel counts with what its bins give it, each bin normalised to one.
  std::vector<double> flux(channels_, 0.0), share(channels_, 0.0);
  for (size_t r = 0; r < rows_; ++r)
    for (size_t c = 0; c < columns_; ++c)
      for (size_t k = 0; k < channels_; ++k) flux[k] += cell_mean(r, c, k) * cell_solid_angle(r);
  for (size_t i = 0; i < mix_.size(); ++i) {
    const Mix& m = mix_[i];
    const double of_bin = (1 - m.t) * flux[m.a] + m.t * flux[m.b];
    if (!(of_bin > 0) || !(spectrum_[i] > 0)) continue;
    share[m.a] += (1 - m.t) / of_bin;
    share[m.b] += m.t / of_bin;
  }
  double sum = 0;
  for (size_t r = 0; r < rows_; ++r)
    for (size_t c = 0; c < columns_; ++c) {
      double mean = 0;
      for (size_t k = 0; k < channels_; ++k)
        if (share[k] > 0) mean += share[k] * cell_mean(r, c, k);
      cdf_.push_back(sum += mean * cell_solid_angle(r));
    }
  if (!(sum > 0)) {  // black: nothing to draw
    table_.clear();
    cdf_.clear();
    channels_ = 1;
    std::fill(spectrum_.begin(), spectrum_.end(), 0.0f);
    return;
  }
  for (double& v : cdf_) v /= sum;
  cdf_.back() = 1;
  for (size_t cell = 0; cell < cdf_.size(); ++cell)
    densities_.push_back((cdf_[cell] - (cell ? cdf_[cell - 1] : 0.0)) / cell_solid_angle(cell / columns_));
  for (size_t c = 0; c < columns_; ++c) {
    const double phi = 2 * kPi * static_cast<double>(c) / static_cast<double>(columns_);
    turns_.push_back({std::cos(phi), std::sin(phi)});
  }
  for (size_t i = 0, cell = 0; i < cdf_.size(); ++i) {
    while (cdf_[cell] * static_cast<double>(cdf_.size()) <= static_cast<double>(i)) ++cell;
    begins_.push_back(static_cast<uint32_t>(cell));
  }
}

Sky::Place Sky::place_of(Dir d) const {
  double phi = quick_azimuth(d) / (2 * kPi);
  phi -= std::floor(phi);
  return {std::clamp(quick_polar_angle(d) / theta_max_, 0.0, 1.0) * static_cast<double>(rows_),
          phi * static_cast<double>(columns_)};
}

Sky::Corners Sky::corners_of(Place place) const {
  Corners c;
  const auto [row, column] = place;
  const size_t r = row_of(place), k = column_of(place);
  if (cells_) {
    c.at[0] = r * columns_ + k;
    c.weight[0] = 1;
    c.count = 1;
    return c;
  }
  const double fr = row - static_cast<double>(r), fc = column - static_cast<double>(k);
  const size_t n = (k + 1) % columns_,
               at[4] = {r * columns_ + k, r * columns_ + n, (r + 1) * columns_ + k, (r + 1) * columns_ + n};
  const double weight[4] = {(1 - fr) * (1 - fc), (1 - fr) * fc, fr * (1 - fc), fr * fc};
  std::copy_n(at, 4, c.at);
  std::copy_n(weight, 4, c.weight);
  c.count = 4;
  return c;
}

double Sky::relative(Dir d) const {
  if (outside(d)) return 0;
  return table_.empty() ? 1 : relative(place_of(d));
}

double Sky::relative(Place place) const {
  const Corners c = corners_of(place);
  double sum = 0;
  for (int i = 0; i < c.count; ++i) sum += c.weight[i] * static_cast<double>(table_[c.at[i]]);
  return sum;
}

void Sky::add(Dir d, double, float scale, std::span<float> radiance) const {
  if (channels_ == 1) {
    const float s = scale * static_cast<float>(relative(d));
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += s * spectrum_[i];
    return;
  }
  if (outside(d)) return;
  const Corners c = corners_of(place_of(d));
  for (int j = 0; j < c.count; ++j) {
    const float* v = &table_[c.at[j] * channels_];
    const float s = scale * static_cast<float>(c.weight[j]);
    for (size_t i = 0; i < radiance.size(); ++i)
      radiance[i] += s * spectrum_[i] * (v[mix_[i].a] + mix_[i].t * (v[mix_[i].b] - v[mix_[i].a]));
  }
}

double Sky::density(Place place) const { return densities_[row_of(place) * columns_ + column_of(place)]; }

double Sky::density(Dir d) const { return outside(d) ? 0 : density(place_of(d)); }

std::optional<LightSample> Sky::sample(const LightReceiver&, const std::array<double, 4>& u, double) const {
  if (!tabulated()) return std::nullopt;
  const DirectionSample drawn = draw({u[0], u[1]});
  LightSample s;
  s.direction = drawn.direction;
  s.density = drawn.density;
  s.spectrum = spectrum();
  s.scale = s.spectrum ? relative(drawn.direction) : 1;
  if (!(s.scale > 0)) return std::nullopt;
  s.source = source();
  return s;
}

std::optional<LightSample> Sky::sample_member(size_t, double, const LightReceiver&, const std::array<double, 4>&,
                                              double) const {
  throw Bug("a sky has no members");
}

std::optional<LightMet> Sky::met_outside(Dir d, double) const {
  if (outside(d)) return std::nullopt;
  if (table_.empty()) return LightMet{1, spectrum(), 0, source()};
  const Place place = place_of(d);
  return LightMet{spectrum() ? relative(place) : 1, spectrum(), density(place), source()};
}

Stokes Sky::tabulated_stokes(Dir d) const {
  const SkyStokes& s = *stokes_;
  double turns = std::atan2(d.y, d.x) / (2 * kPi);
  turns -= std::floor(turns);
  const double row = std::clamp(polar_angle(d) / theta_max_, 0.0, 1.0) * static_cast<double>(s.zeniths - 1),
               column = turns * static_cast<double>(s.azimuths);
  const size_t r = std::min(s.zeniths - 2, static_cast<size_t>(row)), c = static_cast<size_t>(column) % s.azimuths,
               n = (c + 1) % s.azimuths;
  const double fr = row - static_cast<double>(r), fc = column - std::floor(column);
  const auto mean = [&](const std::vector<double>& of) {
    const double* const at = &of[r * s.azimuths];
    return (1 - fr) * ((1 - fc) * at[c] + fc * at[n]) + fr * ((1 - fc) * at[s.azimuths + c] + fc * at[s.azimuths + n]);
  };
  return {1, mean(s.q), mean(s.u), 0};
}

Stokes Sky::stokes(uint32_t, Dir k, double) const {
  if (stokes_) return tabulated_stokes(-k);
  SUITE_CHECK(polarisation_.has_value());
  const double c = dot(polarisation_->sun, -k), degree = polarisation_->most * (1 - c * c) / (1 + c * c);
  const Mueller m = ScatteringPlane(k, polarisation_->sun).matrix({1, -degree, 0, 0, 0, 0});
  return {1, m(1, 0), m(2, 0), 0};
}

DirectionSample Sky::draw(Vec2 u) const {
  const size_t last = cdf_.size() - 1;
  size_t cell = begins_[std::min(last, static_cast<size_t>(u.x * static_cast<double>(cdf_.size())))];
  while (cell < last && cdf_[cell] <= u.x) ++cell;
  const double before = cell ? cdf_[cell - 1] : 0, probability = cdf_[cell] - before;
  const size_t row = cell / columns_;
  // Uniform in solid angle inside the cell; what is left of u.x after choosing the cell is uniform again.
  const double x = std::clamp((u.x - before) / probability, 0.0, 1.0);
  const double z = edges_[row] + (edges_[row + 1] - edges_[row]) * x, s = std::sqrt(std::max(0.0, 1 - z * z));
  const Vec2 edge = turns_[cell % columns_], on = turned(2 * kPi * u.y / static_cast<double>(columns_));
  return {{s * (edge.x * on.x - edge.y * on.y), s * (edge.y * on.x + edge.x * on.y), z}, densities_[cell]};
}

}  // namespace suite
