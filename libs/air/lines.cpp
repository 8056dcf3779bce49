#include "air/lines.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "base/parallel.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr double kSecondRadiation = 1.438776877, kReference = 296, kAtmosphere = 101325;  // cm K, K, Pa
constexpr double kBoltzmann = 1.380649e-23, kLight = 299792458, kAvogadro = 6.02214076e23;
constexpr double kCut = 25, kNear = 2, kCoarse = 0.1;  // cm-1
constexpr double kMlawer[] = {0.1527534276, 0.1491729617, 0.1420961469, 0.1316886544, 0.1181945205, 0.1019300893,
                              0.0832767040, 0.0626720116, 0.0424925000, 0.0046269894, 0.0038279891, 0.0030260086,
                              0.0022199750, 0.0014140010, 0.0005330000, 0.0000750000};

// Weideman's expansion: coefficients by the discrete Fourier transform of its appendix, once.
struct Weideman {
  static constexpr int kTerms = 32;
  double length = std::sqrt(kTerms / std::sqrt(2.0));
  double a[kTerms];
  Weideman() {
    constexpr int m = 2 * kTerms, all = 2 * m;
    for (int n = 1; n <= kTerms; ++n) {
      double sum = 0;
      for (int k = -m + 1; k < m; ++k) {
        const double theta = k * kPi / m, t = length * std::tan(theta / 2);
        sum += std::exp(-t * t) * (length * length + t * t) * std::cos(n * theta);
      }
      a[n - 1] = sum / all;
    }
  }
};

// A line at a pressure and temperature.
struct Shape {
  double middle = 0, strength = 0, doppler = 0, ratio = 0;  // strength: m2 cm-1; doppler: 1/e half width, cm-1

  double at(double distance) const {  // m2
    return strength / (doppler * std::sqrt(kPi)) * voigt(distance / doppler, ratio);
  }
};

Shape shape_of(const LineGas& gas, const SpectralLine& line, double pressure, double temperature) {
  const double atm = pressure / kAtmosphere, cold = kReference / temperature;
  const double lorentz =
      std::pow(cold, line.exponent) * atm * ((1 - gas.share) * line.air_width_cm + gas.share * line.self_width_cm);
  const double boltzmann = std::exp(kSecondRadiation * line.lower_energy_cm * (1 / kReference - 1 / temperature));
  const double stimulated = -std::expm1(-kSecondRadiation * line.wavenumber_cm / temperature) /
                            -std::expm1(-kSecondRadiation * line.wavenumber_cm / kReference);
  const double ratio =
      gas.partition ? gas.partition(line.isotopologue, temperature) : partition_ratio(gas.gas, temperature);
  const double mass = gas.mass ? gas.mass(line.isotopologue) : molar_mass(gas.gas);
  Shape shape;
  shape.middle = line.wavenumber_cm + line.shift_cm * atm;
  shape.strength = 1e-4 * line.intensity * boltzmann * stimulated / ratio;
  shape.doppler = line.wavenumber_cm * std::sqrt(2 * kBoltzmann * temperature * kAvogadro / mass) / kLight;
  shape.ratio = lorentz / shape.doppler;
  return shape;
}

// Adds f(distance from `middle`) - base to the values at low + i step within `reach` of it.
template <class F>
void add_near(std::vector<double>& values, double low, double step, double middle, double reach, const F& f) {
  const double first = std::ceil((middle - reach - low) / step), last = std::floor((middle + reach - low) / step);
  const auto from = static_cast<size_t>(std::max(0.0, first));
  const double end = std::min(last, static_cast<double>(values.size()) - 1);
  for (size_t i = from; static_cast<double>(i) <= end; ++i)
    values[i] += f(low + static_cast<double>(i) * step - middle);
}

// The weights of `points` g-points: Mlawer's, or sums of neighbours.
std::vector<double> weights_of(size_t points) {
  const double sum = std::accumulate(std::begin(kMlawer), std::end(kMlawer), 0.0);
  std::vector<double> weights(points, 0.0);
  for (size_t g = 0; g < std::size(kMlawer); ++g) weights[g * points / std::size(kMlawer)] += kMlawer[g] / sum;
  return weights;
}

// The mean over each g-point's part of the sorted values, ends shared by length.
void mean_over_parts(const std::vector<double>& sorted, const std::vector<double>& weights, float* out) {
  const auto count = static_cast<double>(sorted.size());
  double at = 0;
  size_t i = 0;
  for (size_t g = 0; g < weights.size(); ++g) {
    const double end = g + 1 == weights.size() ? count : std::min(count, at + weights[g] * count);
    double sum = 0, position = at;
    while (position < end && i < sorted.size()) {
      const double next = std::min(end, static_cast<double>(i + 1));
      sum += (next - position) * sorted[i];
      if (next >= static_cast<double>(i + 1)) ++i;
      position = next;
    }
    out[g] = static_cast<float>(sum / (end - at));
    at = end;
  }
}

void check_bake(std::span<const LineGas> gases, const WaterContinuum* continuum, const LineBake& bake) {
  if (gases.empty() || bake.edges_cm.size() < 2) throw Error("lines without a gas or a band", "one of each at least");
  if (!(bake.step_cm > 0)) throw Error(strf("a step of %g cm-1", bake.step_cm), "it is positive");
  for (const LineGas& gas : gases)
    if (!(gas.share >= 0 && gas.share <= 1)) throw Error(strf("a share of %g", gas.share), "0 to 1");
  if (bake.points != 16 && bake.points != 8 && bake.points != 4)
    throw Error(strf("%zu g-points", bake.points), "16, 8 or 4");
  double widest = 0;
  for (size_t i = 1; i < bake.edges_cm.size(); ++i) widest = std::max(widest, bake.edges_cm[i] - bake.edges_cm[i - 1]);
  if (!((bake.edges_cm.back() - bake.edges_cm.front()) / bake.step_cm < 1e9 && widest / bake.step_cm < 2e7))
    throw Error(strf("bands of %g cm-1 in steps of %g", bake.edges_cm.back() - bake.edges_cm.front(), bake.step_cm),
                "1e9 steps in all and 2e7 in a band at most");
  if (!(static_cast<double>(bake_spectra(gases.size(), bake)) * static_cast<double>(bake.points) < 2e9))
    throw Error(strf("a table of %zu spectra", bake_spectra(gases.size(), bake)),
                "2e9 values at most: fewer bands, pressures or temperatures");
  if (continuum) check_continuum(*continuum);
}

// The k of one gas in a band at one pressure and temperature.
void bake_spectrum(GasTable& table, const LineGas& lines, const WaterContinuum* continuum, double step_cm, float* out,
                   size_t band, double pressure, double temperature) {
  const bool water = lines.gas == Gas::h2o && continuum;
  const double low = table.edges_cm[band], width = table.edges_cm[band + 1] - low;
  const auto count = static_cast<size_t>(std::max(64.0, std::ceil(width / step_cm)));
  const double step = width / static_cast<double>(count), first = low + 0.5 * step;
  std::vector<double> k = line_spectrum(lines, first, step, count, pressure, temperature, water);
  if (water)
    for (size_t i = 0; i < count; ++i)
      k[i] +=
          pressure * (1 - lines.share) * continuum->foreign_section(first + static_cast<double>(i) * step, temperature);
  std::sort(k.begin(), k.end());
  mean_over_parts(k, table.weight, out);
}

// Water's self continuum in the middle of each band.
void bake_self(GasTable& table, const WaterContinuum& continuum) {
  for (size_t band = 0; band < table.bands(); ++band)
    for (const double temperature : table.temperature) {
      const double v = 0.5 * (table.edges_cm[band] + table.edges_cm[band + 1]);
      table.water_self.push_back(static_cast<float>(continuum.self_section(v, temperature)));
    }
}

}  // namespace

double partition_ratio(Gas gas, double kelvin) {
  const bool linear =
      gas == Gas::co2 || gas == Gas::n2o || gas == Gas::co || gas == Gas::o2 || gas == Gas::n2 || gas == Gas::no;
  return std::pow(kelvin / kReference, linear ? 1.0 : 1.5);
}

double voigt(double x, double y) {
  static const Weideman series;
  // Far out the first terms of the asymptotic series are enough.
  if (x * x + y * y > 400) {
    const double a = x * x - y * y - 0.5, b = 2 * x * y, d = a * a + b * b;
    // Re[(i z / sqrt(pi)) / (z^2 - 1/2)]
    return (x * b - y * a) / (d * std::sqrt(kPi));
  }
  const std::complex<double> z(x, y), i(0, 1), below = series.length - i * z, r = (series.length + i * z) / below;
  std::complex<double> sum = 0;
  for (int n = Weideman::kTerms; n-- > 0;) sum = sum * r + series.a[n];
  return (2.0 * sum / (below * below) + 1 / std::sqrt(kPi) / below).real();
}

std::vector<double> line_spectrum(const LineGas& gas, double low_cm, double step_cm, size_t count, double pressure,
                                  double temperature, bool base_left) {
  std::vector<double> fine(count, 0.0);
  const double high_cm = low_cm + step_cm * static_cast<double>(count - 1);
  // Wings change slowly: beyond kNear they are drawn on a coarse grid. There the line is held at its value at kNear,
  // and the fine grid adds what it is more.
  const bool coarse = step_cm < 0.5 * kCoarse;
  std::vector<double> wings(coarse ? static_cast<size_t>((high_cm - low_cm) / kCoarse) + 2 : 0, 0.0);
  const auto by_wavenumber = [](const SpectralLine& line, double v) { return line.wavenumber_cm < v; };
  auto line = std::lower_bound(gas.lines.begin(), gas.lines.end(), low_cm - kCut - 1, by_wavenumber);
  for (; line != gas.lines.end() && line->wavenumber_cm <= high_cm + kCut + 1; ++line) {
    const Shape shape = shape_of(gas, *line, pressure, temperature);
    const double base = base_left ? shape.at(kCut) : 0.0;
    if (!coarse) {
      add_near(fine, low_cm, step_cm, shape.middle, kCut, [&](double d) { return shape.at(d) - base; });
      continue;
    }
    const double held = shape.at(kNear);
    add_near(wings, low_cm, kCoarse, shape.middle, kCut,
             [&](double d) { return (std::abs(d) < kNear ? held : shape.at(d)) - base; });
    add_near(fine, low_cm, step_cm, shape.middle, kNear, [&](double d) { return shape.at(d) - held; });
  }
  if (coarse)
    for (size_t i = 0; i < count; ++i) {
      const double x = step_cm * static_cast<double>(i) / kCoarse;
      const auto j = static_cast<size_t>(x);
      fine[i] += wings[j] + (x - static_cast<double>(j)) * (wings[j + 1] - wings[j]);
    }
  for (double& k : fine) k = std::max(k, 0.0);
  return fine;
}

std::optional<double> narrowest_line(const LineGas& gas, double low_cm, double high_cm, double pressure,
                                     double temperature) {
  std::optional<double> narrowest;
  for (const SpectralLine& line : gas.lines) {
    if (line.wavenumber_cm < low_cm || line.wavenumber_cm > high_cm) continue;
    const Shape shape = shape_of(gas, line, pressure, temperature);
    const double doppler = std::sqrt(std::log(2.0)) * shape.doppler, lorentz = shape.ratio * shape.doppler;
    const double width = 0.5346 * lorentz + std::sqrt(0.2166 * lorentz * lorentz + doppler * doppler);
    if (!narrowest || width < *narrowest) narrowest = width;
  }
  return narrowest;
}

size_t bake_spectra(size_t gases, const LineBake& bake) {
  return gases * (bake.edges_cm.size() - 1) * bake.pressure.size() * bake.temperature.size();
}

GasTable bake_lines(std::span<const LineGas> gases, const WaterContinuum* continuum, const LineBake& bake) {
  check_bake(gases, continuum, bake);
  GasTable table;
  table.source = bake.source;
  table.edges_cm = bake.edges_cm, table.pressure = bake.pressure, table.temperature = bake.temperature;
  table.weight = weights_of(bake.points);
  for (const LineGas& gas : gases) table.gases.push_back(gas.gas);
  table.cross_section.assign(bake_spectra(gases.size(), bake) * bake.points, 0.0f);
  if (continuum) bake_self(table, *continuum);
  check_gas_table(table);
  const size_t t = table.temperature.size(), p = table.pressure.size(), bands = table.bands();
  parallel_for(0, bake_spectra(gases.size(), bake), 1, [&](size_t begin, size_t end) {
    // In the order of the table: temperatures fastest, gases slowest.
    for (size_t n = begin; n < end; ++n) {
      bake_spectrum(table, gases[n / t / p / bands], continuum, bake.step_cm,
                    table.cross_section.data() + n * bake.points, n / t / p % bands, table.pressure[n / t % p],
                    table.temperature[n % t]);
      if (bake.done) bake.done();
    }
  });
  return table;
}

}  // namespace suite
