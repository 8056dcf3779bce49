#include "air/size_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "air/mie.h"
#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

void require(bool good, const char* what, double value, const char* range) {
  if (!good || !std::isfinite(value))
    throw Error(strf("size distribution: %s %g is outside its range", what, value), range);
}

// Nodes of moments: even in the logarithm of the radius.
constexpr int kNodes = 2000;

}  // namespace

SizeDistribution::SizeDistribution(std::function<double(double)> log_shape, double mode_um, double low_um,
                                   double high_um)
    : log_shape_(std::move(log_shape)), low_(low_um), high_(high_um) {
  if (!(high_ > low_)) cut(mode_um);
  log_scale_ = std::log(integral([](double) { return 1.0; }));
}

// The radii where the cross-section, r^3 density over the logarithm of r, falls to 1e-7 of its peak: its tails then
// hold less than 1e-5.
void SizeDistribution::cut(double peak) {
  auto weight = [&](double log_r) { return log_shape_(std::exp(log_r)) + 3 * log_r; };
  const double middle = std::log(peak), floor = weight(middle) - std::log(1e9);
  double a = middle, b = middle;
  while (weight(a) > floor) a -= 0.01;
  while (weight(b) > floor) b += 0.01;
  low_ = std::exp(a);
  high_ = std::exp(b);
}

SizeDistribution SizeDistribution::log_normal(double median, double sigma) {
  require(median > 0, "the median radius", median, "above 0");
  require(sigma > 1 && sigma <= 10, "the geometric standard deviation", sigma, "above 1, at most 10");
  const double s = std::log(sigma), middle = std::log(median);
  return {[=](double r) {
            const double d = (std::log(r) - middle) / s;
            return -0.5 * d * d - std::log(r);
          },
          median * std::exp(2 * s * s), 0, 0};
}

SizeDistribution SizeDistribution::gamma(double radius, double variance) {
  require(radius > 0, "the effective radius", radius, "above 0");
  require(variance >= 0.001 && variance <= 0.49, "the effective variance", variance, "0.001 .. 0.49");
  return modified_gamma((1 - 3 * variance) / variance, 1 / (radius * variance), 1);
}

SizeDistribution SizeDistribution::modified_gamma(double shape, double slope, double power) {
  require(shape > -2, "the exponent", shape, "above -2");
  require(slope > 0, "the slope", slope, "above 0");
  require(power > 0, "the power", power, "above 0");
  return {[=](double r) { return shape * std::log(r) - slope * std::pow(r, power); },
          std::pow((shape + 3) / (slope * power), 1 / power), 0, 0};
}

SizeDistribution SizeDistribution::junge(double exponent, double low, double high) {
  require(exponent > 0, "Junge's exponent", exponent, "above 0");
  require(low > 0, "the least radius", low, "above 0");
  require(high > low, "the largest radius", high, "above the least");
  return {[=](double r) { return -(exponent + 1) * std::log(r); }, low, low, high};
}

double SizeDistribution::integral(const std::function<double(double)>& f) const {
  const double a = std::log(low_), step = (std::log(high_) - a) / kNodes;
  double sum = 0;
  for (int i = 0; i <= kNodes; ++i) {
    const double r = std::exp(a + i * step);
    sum += (i == 0 || i == kNodes ? 0.5 : 1) * f(r) * std::exp(log_shape_(r) - log_scale_) * r * step;
  }
  return sum;
}

double SizeDistribution::density(double r) const { return std::exp(log_shape_(r) - log_scale_); }

double SizeDistribution::moment(double power) const {
  return integral([&](double r) { return std::pow(r, power); });
}

double SizeDistribution::effective_variance() const {
  const double m2 = moment(2), m3 = moment(3);
  return moment(4) * m2 / (m3 * m3) - 1;
}

namespace {

// Where spheres of one size differ most: aside, in the rainbows, in the glory.
constexpr std::array<double, 8> kCheckCosines = {0.9, 0.5, 0.0, -0.5, -0.77, -0.9, -0.97, -1.0};

// Sums of trapezia whose step is halved again and again.
struct Sums {
  double scattering = 0, absorption = 0, cosine = 0;
  double extinction() const { return scattering + absorption; }
  std::array<double, 8> check{};
  std::vector<double> phase;
  std::vector<PlaneBlocks> matrices;
};

class Crowd {
 public:
  Crowd(const SizeDistribution& sizes, std::complex<double> index, double wavelength, std::span<const double> cosines,
        BulkMatrices matrices)
      : sizes_(sizes), index_(index), wavenumber_(2 * kPi / wavelength), cosines_(cosines) {
    sums_.phase.resize(cosines.size());
    if (matrices == BulkMatrices::all) sums_.matrices.assign(cosines.size(), PlaneBlocks{0, 0, 0, 0, 0, 0});
  }
  void add(double r, double weight) {
    // Below the series' range nothing is scattered that counts.
    const double x = std::max(wavenumber_ * r, 1e-6), area = weight * sizes_.density(r) * r * kPi * r * r;
    ++nodes_;
    // Large particles that are too few for the sum are the dearest: none cuts out more than four times its area.
    if (x > 2 && 4 * area * nodes_ < 1e-5 * sums_.scattering) return;
    const MieSphere sphere(x, index_);
    const double scattering = area * sphere.scattering();
    sums_.absorption += area * sphere.absorption();
    sums_.scattering += scattering;
    sums_.cosine += scattering * sphere.asymmetry();
    if (cosines_.empty()) return;
    if (sums_.matrices.empty())
      sphere.add_phase(cosines_, scattering, sums_.phase);
    else
      sphere.add_matrices(cosines_, scattering, sums_.matrices);
    sphere.add_phase(kCheckCosines, scattering, sums_.check);
  }
  const Sums& sums() const { return sums_; }

 private:
  const SizeDistribution& sizes_;
  std::complex<double> index_;
  double wavenumber_;
  std::span<const double> cosines_;
  double nodes_ = 0;
  Sums sums_;
};

bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance * std::abs(b); }

// Both sums as means over their steps: twice as many nodes, half the step.
bool converged(const Sums& before, const Sums& now, double tolerance) {
  const bool bulk = near(2 * before.extinction(), now.extinction(), tolerance) &&
                    near(2 * before.scattering, now.scattering, tolerance) &&
                    std::abs(before.cosine / before.scattering - now.cosine / now.scattering) <= tolerance;
  // Narrow resonances absorb: a weak absorption is slow to settle, and of no account to the phase function.
  bool slow = !now.phase.empty() || near(2 * before.absorption, now.absorption, 20 * tolerance) ||
              std::abs(2 * before.absorption - now.absorption) <= 1e-4 * tolerance * now.extinction();
  for (size_t i = 0; i < now.check.size(); ++i) slow = slow && near(2 * before.check[i], now.check[i], 20 * tolerance);
  return bulk && slow;
}

}  // namespace

BulkOptics bulk_optics(const SizeDistribution& sizes, std::complex<double> index, double wavelength,
                       std::span<const double> cosines, double tolerance, BulkMatrices matrices) {
  require(wavelength > 0, "the wavelength", wavelength, "above 0");
  Crowd crowd(sizes, index, wavelength, cosines, matrices);
  const double a = std::log(sizes.low_um()), range = std::log(sizes.high_um()) - a;
  crowd.add(sizes.low_um(), 0.5);
  crowd.add(sizes.high_um(), 0.5);
  int steps = 32;
  for (int i = 1; i < steps; ++i) crowd.add(std::exp(a + range * i / steps), 1);
  for (Sums before;;) {
    before = crowd.sums();
    steps *= 2;
    if (steps > 1 << 18)
      throw Error("size distribution: the sum over radii does not converge", "ask for a coarser tolerance");
    for (int i = 1; i < steps; i += 2) crowd.add(std::exp(a + range * i / steps), 1);
    if (converged(before, crowd.sums(), tolerance)) break;
  }
  const Sums& sums = crowd.sums();
  const double step = range / steps;
  BulkOptics bulk;
  bulk.scattering_um2 = sums.scattering * step;
  bulk.absorption_um2 = sums.absorption * step;
  bulk.extinction_um2 = bulk.scattering_um2 + bulk.absorption_um2;
  bulk.asymmetry = sums.cosine / sums.scattering;
  bulk.volume_um3 = 4 * kPi / 3 * sizes.moment(3);
  bulk.phase = sums.phase;
  for (size_t i = 0; i < sums.matrices.size(); ++i) bulk.phase[i] = sums.matrices[i].a;
  for (double& p : bulk.phase) p /= sums.scattering;
  for (const PlaneBlocks& m : sums.matrices) bulk.matrices.push_back(m * (1 / m.a));
  return bulk;
}

}  // namespace suite
