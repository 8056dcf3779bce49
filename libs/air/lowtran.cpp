// Gas absorption on the spectra of LOWTRAN 7, by laws fitted line by line (band_fits) where there are, else by its own.
//
// LOWTRAN's band functions: T = exp(-(C U)^a) in 20 cm-1, each 5 cm-1, with the amount U scaled by powers of p/p0 and
// T0/T of each band; continua of water, nitrogen (4.3 um) and oxygen (6.4 um), ozone in
// the ultraviolet and visible, nitric acid, the Herzberg continuum.
//
// Assumes: of an exp(-(C U)^a) the k-distribution is the one-sided stable law of index a, scaled by C; so several
// levels together give what LOWTRAN gives for the summed amount. Where two neighbouring bands of a gas overlap in no
// value, there is nothing of it between. Other than LOWTRAN's: the collision complex of oxygen (O4) in the visible,
// added, and the heads of oxygen's A and B bands, sharper (scripts/bake_air). Based on: F. X. Kneizys et al., "Users
// guide to LOWTRAN 7", AFGL-TR-88-0177, 1988; the numbers in lowtran_table.inc. O4: G. D. Greenblatt et al., J.
// Geophys. Res. 95, 1990 (peaks and widths of its bands).
#include "air/lowtran.h"

#include <algorithm>
#include <cmath>

#include "air/band_fits.h"
#include "air/lowtran_limits.h"

namespace suite {

namespace {

// Values of C each 5 cm-1 from low to high, cm-1, the first at `first`; the law of its k; powers of p/p0 and T0/T.
struct LowtranBand {
  Gas gas;
  int low, high;
  size_t law;
  double pressure, temperature;
  int first;
};

#include "air/lowtran_table.inc"

constexpr double kLoschmidt = 2.6868e25;  // 1/m3 at 0 C, 1 atm, as LOWTRAN has it
constexpr double kOneAtmosphere = 101325, kFreezing = 273.15, kLowtranAvogadro = 6.02214076e23;
constexpr int kStep = 5, kLowest = 10, kHighest = 50000;  // cm-1
constexpr double kHugginsLow = 27370, kFarLow = 40800;    // cm-1, where ozone's tables begin
constexpr size_t kLawPoints = kBandLawPoints, kLawSize = 1 + 2 * kLawPoints;

double ten_to(int tenth_thousandths) {
  return tenth_thousandths == -999999 ? 0.0 : std::pow(10.0, 1e-4 * tenth_thousandths);
}

// A table's value at v, linear between its own; 0 outside.
template <class Table, class Read>
double interpolated(const Table& table, double first, double step, double v, const Read& read) {
  const double x = (v - first) / step;
  const auto n = static_cast<double>(std::size(table) - 1);
  if (x < 0 || x > n) return 0;
  const auto i = static_cast<size_t>(std::min(x, n - 1));
  const double s = x - static_cast<double>(i);
  return (1 - s) * read(table[i]) + s * read(table[i + 1]);
}
template <class Table>
double interpolated(const Table& table, double first, double step, double v) {
  return interpolated(table, first, step, v, [](double x) { return x; });
}

// Amount of a gas in 1 m of path: atm cm, of water g/cm2.
double amount(const AirLevel& level, Gas gas) {
  const double molecules = level.density() * level.share(gas);
  if (gas == Gas::h2o) return molecules / kLowtranAvogadro * molar_mass(gas) * 0.1;
  return molecules / kLoschmidt * 100;
}

enum class Laws { fitted, lowtran };

// Of a band at a wavenumber: s = strength times the amount times powers of p/p0 and T0/T, and the law of the k of s.
struct LawAt {
  double strength, pressure, temperature;
  const double *k, *weight;
};
LawAt law_at(const LowtranBand& band, int v, Laws laws) {
  const double* law = kLowtranLaws + band.law * kLawSize;
  const double strength = ten_to(kLowtranStrength[band.first + (v - band.low) / kStep]);
  const BandFit* fit = laws == Laws::fitted ? band_fit(band.gas, v) : nullptr;
  if (!fit) return {strength, band.pressure, band.temperature, law + 1, law + 1 + kLawPoints};
  const double halving = strength / std::pow(std::log(2.0), 1 / law[0]);
  const double* fitted = band_law(fit->law).data();
  return {fit->strength * std::pow(halving, fit->contrast), fit->pressure, fit->temperature, fitted,
          fitted + kLawPoints};
}

GasPoints points_of(const LowtranBand& band, int v, Laws laws, std::span<const AirLevel> levels) {
  const LawAt law = law_at(band, v, laws);
  GasPoints out;
  std::vector<double> k;
  double total = 0;
  for (size_t g = 0; g < kLawPoints; ++g) {
    if (!(law.weight[g] > 0)) continue;
    k.push_back(law.k[g]);
    out.weight.push_back(law.weight[g]);
    total += out.weight.back();
  }
  for (double& w : out.weight) w /= total;
  out.absorption.reserve(levels.size() * k.size());
  for (const AirLevel& level : levels) {
    const double air = level.pressure > 0 ? std::pow(level.pressure / kOneAtmosphere, law.pressure) : 0.0,
                 scaled = law.strength * amount(level, band.gas) * air *
                          std::pow(kFreezing / level.temperature, law.temperature);
    for (const double x : k) out.absorption.push_back(static_cast<float>(scaled * x));
  }
  return out;
}

// Water's continuum at a wavenumber, 1e-20 cm2/(molecule cm-1), without the radiation field.
struct WaterAt {
  double self_296, self_260, foreign;
};
WaterAt water_at(double v, Laws laws) {
  const ContinuumFactors f = laws == Laws::fitted ? continuum_factors(v) : ContinuumFactors{};
  const auto table = [&](const auto& t) { return interpolated(t, 0, 10, v, ten_to); };
  // LOWTRAN's correction around 1050 cm-1, and its far wings added to the foreign part.
  const double dip = 1 - 0.2333 * 40000 / ((v - 1050) * (v - 1050) + 40000);
  const double wings = 1 / (std::exp(2.75e-4 * v) / (1.025 * 3.159e-8) + std::exp(1.3e-3 * v) / 8.97e-6);
  return {table(kWaterSelf296) * dip * f.self_296, table(kWaterSelf260) * dip * f.self_260,
          (table(kWaterForeign296) + wings) * f.foreign};
}

// What a wavenumber needs of the smooth absorbers, so that levels only multiply.
// continuum: of water, instead of the builtin one; may be null and must outlive this.
class Smooth {
 public:
  Smooth(double v, Laws laws, const WaterContinuum* continuum)
      : herzberg_(herzberg(v)),
        nitrogen_(interpolated(kNitrogen, 2080, 5, v)),
        oxygen_s_(interpolated(kOxygenS, 1395, 5, v) / 0.20946),
        oxygen_a_(interpolated(kOxygenA, 1395, 5, v)),
        oxygen_b_(interpolated(kOxygenB, 1395, 5, v)),
        ozone_(interpolated(kOzoneChappuis, 13000, 200, v) + interpolated(kOzoneFar, kFarLow, 100, v)),
        nitric_(nitric_acid(v)),
        complex_(oxygen_complex(v)),
        v_(v),
        laws_(laws),
        continuum_(continuum) {
    if (!continuum_) water(v);
    if (v >= kHugginsLow && v < kFarLow) {
      const double inside = std::clamp(v, kHugginsLow + 7.5, kFarLow - 22.5);  // the middles of its ends
      huggins_ = interpolated(kOzoneHuggins, kHugginsLow + 7.5, 20, inside) * 1e-24;
      huggins_1_ = interpolated(kOzoneHugginsC1, kHugginsLow + 7.5, 20, inside);
      huggins_2_ = interpolated(kOzoneHugginsC2, kHugginsLow + 7.5, 20, inside);
    }
  }

  double at(const AirLevel& level) const {  // 1/m
    const double density = level.density(), relative = density / kLoschmidt, celsius = level.temperature - kFreezing;
    const double water = relative * level.share(Gas::h2o), p = level.pressure / kOneAtmosphere,
                 t = std::sqrt(kFreezing / level.temperature), oxygen = amount(level, Gas::o2);
    double k = continuum_at(level, water, relative);
    k += nitrogen_ * 1e-3 * level.share(Gas::n2) * relative * p * t;
    const double dt = level.temperature - 220;
    k += oxygen_s_ * oxygen * p * std::max(0.0, 1 + oxygen_a_ * dt + (oxygen_a_ * oxygen_a_ / 2 + oxygen_b_) * dt * dt);
    k += herzberg_ * oxygen * (1 + 0.83 * relative);
    k += ozone_ * amount(level, Gas::o3) + nitric_ * amount(level, Gas::hno3);
    k += huggins_ * density * level.share(Gas::o3) *
         std::max(0.0, 1 + huggins_1_ * celsius + huggins_2_ * celsius * celsius);
    const double o2 = density * level.share(Gas::o2);
    return k + complex_ * o2 * o2;
  }

 private:
  double continuum_at(const AirLevel& level, double water, double relative) const {
    if (continuum_) {
      const double share = level.share(Gas::h2o);
      return level.density() * share * level.pressure *
             (share * continuum_->self_section(v_, level.temperature) +
              (1 - share) * continuum_->foreign_section(v_, level.temperature));
    }
    const double self = self_at(level.temperature);
    return (self * water * water + foreign_ * water * (relative - water)) * kLoschmidt * 1e-4 * 1e-20 /
           (kFreezing / 296);
  }
  // A power of the temperature; LOWTRAN's is linear in it between 296 and 260 K and held outside.
  double self_at(double temperature) const {
    if (laws_ == Laws::fitted && self_296_ > 0 && self_260_ > 0)
      return self_296_ * std::pow(self_260_ / self_296_, std::log(296 / temperature) / std::log(296.0 / 260));
    const double cold = std::clamp((296 - temperature) / 36, 0.0, 1.0);
    return self_296_ + cold * (self_260_ - self_296_);
  }
  void water(double v) {
    const WaterAt water = water_at(v, laws_);
    self_296_ = water.self_296 * radiation_field(v, 296);
    self_260_ = water.self_260 * radiation_field(v, 260);
    foreign_ = water.foreign * radiation_field(v, 296);
  }
  static double herzberg(double v) {
    if (v <= 36000) return 0;
    const double ratio = v / 48811, log = std::log(ratio);
    const double cut = v <= 40000 ? (40000 - v) / 4000 * 7.917e-27 : 0;
    return std::max(0.0, 6.884e-24 * ratio * std::exp(-69.738 * log * log) - cut) * 2.6868e19;
  }
  static double nitric_acid(double v) {
    constexpr struct {
      double low, high;
      size_t first;
    } runs[] = {{850, 920, 0}, {1275, 1350, 15}, {1675, 1735, 31}};
    for (const auto& run : runs)
      if (v >= run.low && v <= run.high) {
        const double x = (v - run.low) / 5;
        const auto i = std::min(static_cast<size_t>(x), static_cast<size_t>((run.high - run.low) / 5) - 1);
        const double s = x - static_cast<double>(i);
        return (1 - s) * kNitricAcid[run.first + i] + s * kNitricAcid[run.first + i + 1];
      }
    return 0;
  }
  // m5/molecule2: each band a Gaussian of its peak (1e-46 cm5) and full width at half maximum (nm).
  static double oxygen_complex(double v) {
    constexpr double bands[][3] = {{343.4, 1.2, 4.2}, {360.5, 4.1, 4.8},  {380.2, 2.4, 4.4},   {446.7, 0.57, 5.6},
                                   {477.3, 6.3, 6.2}, {532.2, 1.0, 10.2}, {577.2, 11.0, 11.6}, {630.0, 7.2, 13.8}};
    double sum = 0;
    for (const auto& b : bands) {
      const double x = (1e7 / v - b[0]) / b[2];
      sum += b[1] * std::exp(-4 * std::log(2.0) * x * x);
    }
    return sum * 1e-56;
  }

  double herzberg_, nitrogen_, oxygen_s_, oxygen_a_, oxygen_b_, ozone_, nitric_, complex_;
  double v_;
  Laws laws_;
  const WaterContinuum* continuum_;
  double huggins_ = 0, huggins_1_ = 0, huggins_2_ = 0;  // m2, 1/K, 1/K2
  double self_296_ = 0, self_260_ = 0, foreign_ = 0;    // 1e-20 cm2
};

class Lowtran final : public GasProvider {
 public:
  explicit Lowtran(Laws laws) : laws_(laws) {}
  explicit Lowtran(WaterContinuum continuum) : laws_(Laws::fitted), continuum_(std::move(continuum)) {
    check_continuum(*continuum_);
  }
  double low_um() const override { return 1e4 / kHighest; }
  double high_um() const override { return 1e4 / kLowest; }
  std::string note() const override {
    return std::string(laws_ == Laws::fitted ? "spectra of LOWTRAN 7, laws fitted line by line"
                                             : "LOWTRAN 7 band functions") +
           ", 20 cm-1; vertical transmittance against line-by-line: rms 0.03, at most 0.1 in 10 nm and 0.14 in 20 cm-1";
  }

  std::vector<GasLimit> limits() const override {
    if (laws_ == Laws::lowtran) return limits_of_lowtran();
    return limits_of_builtin(continuum_ ? WaterOf::mt_ckd : WaterOf::builtin);
  }

  std::vector<Band> bands(double low_cm, double high_cm) const override {
    std::vector<Band> out;
    const int last = std::min(static_cast<int>(std::floor(high_cm / kStep + 0.5)) * kStep, kHighest);
    for (int v = static_cast<int>(std::floor(low_cm / kStep + 0.5)) * kStep; v <= last; v += kStep) {
      const double low = std::max(low_cm, v - 0.5 * kStep), high = std::min(high_cm, v + 0.5 * kStep);
      if (high > low) out.push_back({low, high, static_cast<size_t>(v)});
    }
    return out;
  }

  std::vector<GasPoints> absorbers(const Band& band, std::span<const AirLevel> levels) const override {
    const int v = static_cast<int>(band.index);
    std::vector<GasPoints> out(1);
    const Smooth smooth(v, laws_, continuum_ ? &*continuum_ : nullptr);
    out[0].weight = {1.0};
    for (const AirLevel& level : levels) out[0].absorption.push_back(static_cast<float>(smooth.at(level)));
    for (const LowtranBand& b : kLowtranBands)
      if (v >= b.low && v <= b.high) out.push_back(points_of(b, v, laws_, levels));
    return out;
  }

 private:
  Laws laws_;
  std::optional<WaterContinuum> continuum_;
};

}  // namespace

const GasProvider& builtin_gases() {
  static const Lowtran fitted(Laws::fitted);
  return fitted;
}
const GasProvider& lowtran_gases() {
  static const Lowtran lowtran(Laws::lowtran);
  return lowtran;
}
std::unique_ptr<GasProvider> builtin_gases(WaterContinuum continuum) {
  return std::make_unique<Lowtran>(std::move(continuum));
}

WaterContinuum builtin_continuum() {
  WaterContinuum c{0, 10, {}, {}, {}};
  for (size_t i = 0; i < std::size(kWaterSelf296); ++i) {
    const WaterAt water = water_at(c.step_cm * static_cast<double>(i), Laws::fitted);
    c.self.push_back(1e-20 * water.self_296);
    c.foreign.push_back(1e-20 * water.foreign);
    // So that it meets both temperatures of the tables.
    const bool both = water.self_296 > 0 && water.self_260 > 0;
    c.exponent.push_back(both ? std::log(water.self_260 / water.self_296) / std::log(296.0 / 260) : 0);
  }
  return c;
}

}  // namespace suite
