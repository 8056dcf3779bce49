#include "sensor/psf.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// A radially symmetric pattern as rings of constant density: ring k reaches from radius k to k + 1 in units of `step`.
struct Rings {
  double step = 0;
  std::vector<double> upto;     // light inside radius (k + 1) step, last = 1
  std::vector<double> density;  // per area, in units of 1 / length^2 of step's length
  // light: of each ring, >= 0.
  void set(double s, std::vector<double> light) {
    step = s;
    double sum = 0;
    for (const double x : light) sum += x;
    upto.clear(), density.clear();
    double run = 0;
    for (size_t k = 0; k < light.size(); ++k) {
      run += light[k];
      upto.push_back(run / sum);
      density.push_back(light[k] / sum / (kPi * step * step * (2.0 * static_cast<double>(k) + 1)));
    }
    upto.back() = 1;
  }
  double radius(double u) const {
    const size_t k =
        std::min(static_cast<size_t>(std::upper_bound(upto.begin(), upto.end(), u) - upto.begin()), upto.size() - 1);
    const double low = k ? upto[k - 1] : 0, at = upto[k] > low ? (u - low) / (upto[k] - low) : 0.5,
                 inner = static_cast<double>(k);
    return step * std::sqrt(inner * inner + at * (2 * inner + 1));  // uniform in area within the ring
  }
  double at(double radius_value) const {
    const double k = radius_value / step;
    return k < static_cast<double>(density.size()) ? density[static_cast<size_t>(k)] : 0;
  }
};

Vec2 polar(double radius, double v) { return {radius * std::cos(2 * kPi * v), radius * std::sin(2 * kPi * v)}; }

struct Gaussian final : PointSpread {
  explicit Gaussian(double s) : sigma(s) {}
  Vec2 sample(double u, double v, double) const override { return polar(sigma * std::sqrt(-2 * std::log1p(-u)), v); }
  double sigma;
};

struct Radial final : PointSpread {
  Vec2 sample(double u, double v, double) const override { return polar(rings.radius(u), v); }
  Rings rings;
};

// 2 J1(v) / v, 1 at 0.
double jinc2(double v) { return v < 1e-4 ? 1 - v * v / 8 : 2 * std::cyl_bessel_j(1.0, v) / v; }

// Radii in units of wavelength x f-number / pi, where the pattern is the same for all wavelengths.
struct Airy final : PointSpread {
  Airy(double f_number, double obscuration, double tail, const SpectralState& state) {
    const double e2 = obscuration * obscuration, step_v = 0.02, whole = 2 / (1 - e2);
    std::vector<double> light;
    double sum = 0;
    for (size_t k = 0; k < 4000000 && sum < (1 - tail) * whole; ++k) {
      // The ring's light by Simpson's rule.
      double ring = 0;
      for (int i = 0; i <= 2; ++i) {
        const double v = step_v * (static_cast<double>(k) + 0.5 * i);
        const double amplitude = (jinc2(v) - e2 * jinc2(obscuration * v)) / (1 - e2);
        ring += (i == 1 ? 4 : 1) * amplitude * amplitude * v;
      }
      light.push_back(ring * step_v / 6);
      sum += light.back();
    }
    beyond = 1 - sum / whole;
    rings.set(step_v, std::move(light));
    set_units(f_number * 1e-6 / kPi, state);
  }
  std::unique_ptr<PointSpread> with_bins(const SpectralState& state) const override {
    auto other = std::make_unique<Airy>(*this);
    other->set_units(per_um, state);
    return other;
  }
  void set_units(double m_per_um, const SpectralState& state) {
    per_um = m_per_um;
    unit.clear();
    for (const Bin& b : state.bins) unit.push_back(b.center_um() * per_um);
  }
  Vec2 sample(double u, double v, double which) const override {
    const size_t bin = std::min(static_cast<size_t>(which * static_cast<double>(unit.size())), unit.size() - 1);
    return polar(rings.radius(u) * unit[bin], v);
  }
  bool spectral() const override { return unit.size() > 1; }
  void weights(Vec2 offset, std::span<float> w) const override {
    const double r = std::hypot(offset.x, offset.y);
    double mixture = 0;
    for (size_t b = 0; b < unit.size(); ++b) {
      const double density = rings.at(r / unit[b]) / (unit[b] * unit[b]);
      mixture += density;
      w[b] = static_cast<float>(density * kScale);
    }
    mixture *= kScale / static_cast<double>(unit.size());
    for (float& x : w) x = mixture > 0 ? static_cast<float>(x / mixture) : 0.0f;
  }
  double cut() const override { return beyond; }
  static constexpr double kScale = 1e-12;  // densities per um2 fit a float
  Rings rings;
  double per_um = 0;         // m of a unit per um of wavelength
  std::vector<double> unit;  // m
  double beyond = 0;
};

struct Picture final : PointSpread {
  Picture(const GreyImage& p, double c) : width(p.width), height(p.height), cell(c) {
    double sum = 0;
    for (const float v : p.values) {
      if (!(v >= 0)) throw Error("a point-spread picture holds a negative value");
      sum += v;
      upto.push_back(sum);
    }
    if (!(sum > 0)) throw Error("a point-spread picture holds no light");
    for (double& v : upto) v /= sum;
  }
  Vec2 sample(double u, double v, double) const override {
    const size_t i =
        std::min(static_cast<size_t>(std::upper_bound(upto.begin(), upto.end(), u) - upto.begin()), upto.size() - 1);
    const double low = i ? upto[i - 1] : 0, within = upto[i] > low ? (u - low) / (upto[i] - low) : 0.5;
    return {(static_cast<double>(i % width) + within - 0.5 * width) * cell,
            (static_cast<double>(i / width) + v - 0.5 * height) * cell};
  }
  uint32_t width, height;
  double cell;
  std::vector<double> upto;
};

}  // namespace

void PointSpread::weights(Vec2, std::span<float> per_bin) const { std::fill(per_bin.begin(), per_bin.end(), 1.0f); }

std::unique_ptr<PointSpread> gaussian_spread(double sigma) {
  if (!(sigma > 0)) throw Error("a gaussian point spread needs a positive width");
  return std::make_unique<Gaussian>(sigma);
}

std::unique_ptr<PointSpread> airy_spread(double f_number, double obscuration, double tail, const SpectralState& state) {
  if (!(f_number > 0)) throw Error("an Airy pattern needs an f-number");
  return std::make_unique<Airy>(f_number, obscuration, tail, state);
}

std::unique_ptr<PointSpread> image_spread(const GreyImage& picture, double cell) {
  return std::make_unique<Picture>(picture, cell);
}

std::unique_ptr<PointSpread> mtf_spread(const std::vector<double>& frequency, const std::vector<double>& mtf,
                                        double most_negative) {
  if (frequency.size() < 2 || frequency.size() != mtf.size())
    throw Error("an MTF needs two frequencies at least and as many values");
  if (frequency[0] != 0 || std::fabs(mtf[0] - 1) > 1e-9) throw Error("an MTF starts with the value 1 at frequency 0");
  for (size_t i = 0; i < mtf.size(); ++i)
    if (!(mtf[i] >= 0 && mtf[i] <= 1) || (i && !(frequency[i] > frequency[i - 1])))
      throw Error("an MTF has ascending frequencies and values from 0 to 1");
  const double highest = frequency.back(), step = 1 / (16 * highest), reach = 24 / highest;
  auto at = [&](double f) {
    const size_t i =
        std::clamp(static_cast<size_t>(std::upper_bound(frequency.begin(), frequency.end(), f) - frequency.begin()),
                   size_t{1}, mtf.size() - 1);
    return mtf[i - 1] + (mtf[i] - mtf[i - 1]) * (f - frequency[i - 1]) / (frequency[i] - frequency[i - 1]);
  };
  // Light inside radius r is r times the integral of M(f) J1(2 pi f r) 2 pi df (Hankel transform, integrated over r).
  constexpr int samples = 2000;
  std::vector<double> light;
  double before = 0, negative = 0, positive = 0;
  for (int k = 1; step * k <= reach; ++k) {
    const double r = step * k, df = highest / samples;
    double inside = 0;
    for (int i = 0; i < samples; ++i) {
      const double f = (i + 0.5) * df;
      inside += at(f) * std::cyl_bessel_j(1.0, 2 * kPi * f * r);
    }
    inside *= 2 * kPi * r * df;
    const double ring = inside - before;
    before = inside;
    (ring < 0 ? negative : positive) += std::fabs(ring);
    light.push_back(std::max(0.0, ring));
  }
  if (negative > most_negative * (positive - negative))
    throw Error(
        strf("this MTF belongs to a pattern with %.1f %% of negative light", 100 * negative / (positive - negative)),
        "a table of a real lens is expected; add points or let it fall to 0 smoothly");
  auto pattern = std::make_unique<Radial>();
  pattern->rings.set(step, std::move(light));
  return pattern;
}

std::unique_ptr<PointSpread> read_psf(const Params& params, const SensorContext& context, double f_number,
                                      double obscuration, const SpectralState& state) {
  const auto p = params.find("psf");
  if (!p) return nullptr;
  try {
    switch (p->at("kind").as_choice({"gaussian", "airy", "image", "mtf"})) {
      case 0: {
        if (const auto sigma = p->find("sigma_um")) return gaussian_spread(sigma->as_number_in(1e-6, 1e6, "um") * 1e-6);
        return gaussian_spread(p->number_in("fwhm_um", 1e-6, 1e6, "um") * 1e-6 / (2 * std::sqrt(2 * std::log(2.0))));
      }
      case 1: {
        const double tail = p->number_in("tail", 1e-4, 0.1, "(share of the light)", 0.005);
        if (!(f_number > 0))
          throw p->error("an Airy pattern needs the aperture", "give the instrument aperture_mm or f_number");
        return airy_spread(f_number, obscuration, tail, state);
      }
      case 2: {
        const double cell = p->number_in("pixel_um", 1e-6, 1e6, "um") * 1e-6;
        if (!context.image) throw p->error("pictures cannot be read here");
        return image_spread(context.image(p->at("file").as_path()), cell);
      }
      default: {
        std::vector<double> f = p->at("cycles_per_mm").as_numbers();
        for (double& x : f) x *= 1000;
        return mtf_spread(f, p->at("value").as_numbers());
      }
    }
  } catch (const Error& e) {
    if (e.where().line) throw;
    throw p->error(e.message(), e.hint());
  }
}

}  // namespace suite
