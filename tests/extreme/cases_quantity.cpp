// Planck's law, small angles, sums of many samples, statistics of the far tail.
#include <cfloat>
#include <cmath>

#include "extreme/case.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "spectral/planck.h"

namespace suite::extreme {

namespace {

long double exact_planck(long double wavelength_um, long double kelvin) {
  const long double h = 6.62607015e-34L, c = 299792458.0L, k = 1.380649e-23L, m = wavelength_um * 1e-6L;
  return 2 * h * c * c / (m * m * m * m * m) / std::expm1(h * c / (m * k * kelvin)) * 1e-6L;
}
double relative(double got, long double exact) {
  return static_cast<double>(std::fabs((got - exact) / (exact == 0 ? 1.0L : exact)));
}

// x: wavelength at a fixed temperature.
Case planck(const char* name, double kelvin, double um, double bound, double to, double factor) {
  return {"Planck",
          name,
          "long double",
          "1",
          bound,
          [kelvin](const Numerics& n, double x) { return relative(n.planck(x, kelvin), exact_planck(x, kelvin)); },
          {"wavelength", "um", um, to, factor},
          {}};
}
Case planck_temperature(const char* name, double um, double kelvin, double bound, double to) {
  return {"Planck",
          name,
          "long double",
          "1",
          bound,
          [um](const Numerics& n, double x) { return relative(n.planck(um, x), exact_planck(um, x)); },
          {"temperature", "K", kelvin, to, 10},
          {}};
}
Case whole_spectrum(const char* name, double kelvin, double to) {
  return {"Planck",
          name,
          "closed form sigma T^4 / pi",
          "1",
          1e-12,
          [](const Numerics&, double T) {
            return relative(planck_band_radiance(1e-3, 1e13, T), kStefanBoltzmann * std::pow(T, 4) / kPi);
          },
          {"temperature", "K", kelvin, to, 10},
          {}};
}

// Two directions `x` rad apart, and x rad short of opposite.
Case apart(const char* name, bool opposite, double from, double to) {
  return {"angles",
          name,
          "closed form",
          "1",
          1e-6,
          [opposite](const Numerics& n, double x) {
            double worst = 0;
            for (int i = 0; i < 50; ++i) {
              const Dir a = dir_from_angles(0.1 + 0.05 * i, 0.7 * i), side = Frame::around(a).x;
              const Dir b = normalized(a + side * std::tan(x));
              const double got = opposite ? kPi - n.angle(a, -b) : n.angle(a, b);
              // Unit vectors have rounded coordinates, which is worth up to 2 ulp of angle.
              worst = std::fmax(worst, std::fabs(got - x) <= 4 * DBL_EPSILON ? 0 : std::fabs(got / x - 1));
              if (std::isnan(got)) return got;
            }
            return worst;
          },
          {"angle", "rad", from, to, 10},
          {}};
}

}  // namespace

static void add_planck(std::vector<Case>& c) {
  c.push_back(planck("10 000 K at 0.2 um", 10000, 0.2, 1e-13, 1000, 10));
  c.push_back(planck("10 000 K at 1000 um (Rayleigh-Jeans)", 10000, 1000, 1e-14, 1e9, 10));
  c.push_back(planck("300 K at 10 um", 300, 10, 1e-14, 1e9, 10));
  c.push_back(planck("1 K at 1000 um (Wien)", 1, 1000, 1e-14, 25, 2));
  c.push_back(planck_temperature("0.2 um at 105 K (about to underflow)", 0.2, 105, 1e-12, 1e6));
  c.push_back(planck_temperature("1000 um at 2.725 K", 1000, 2.725, 1e-14, 1e9));
  c.push_back({"Planck",
               "0.2 um at 1 K underflows to nothing",
               "closed form",
               "W/(m2 sr um)",
               0,
               [](const Numerics& n, double) { return n.planck(0.2, 1); },
               {},
               {}});
  c.push_back(whole_spectrum("whole spectrum from 1 K", 1, 1e6));
  c.push_back(whole_spectrum("whole spectrum at 2.725 K", 2.725, 3e5));
  c.push_back(whole_spectrum("whole spectrum at 300 K", 300, 3e6));
  c.push_back({"Planck",
               "band 1e-6 of its wavelength wide",
               "long double, middle of the band",
               "1",
               1e-9,
               [](const Numerics&, double width) {
                 const double low = 10, high = 10 * (1 + width);
                 // The middle of the band is right to width^2 / 24.
                 return relative(planck_band_radiance(low, high, 300) / (high - low),
                                 exact_planck(0.5L * (low + high), 300));
               },
               {"relative width", "1", 1e-6, 1e-12, 10},
               {}});
  c.push_back({"Planck",
               "brightness temperature of 1 K at 1000 um",
               "identity",
               "1",
               1e-12,
               [](const Numerics& n, double T) { return relative(brightness_temperature(1000, n.planck(1000, T)), T); },
               {"temperature", "K", 1, 1e8, 10},
               {}});
  c.push_back({"Planck",
               "brightness temperature of 10 000 K at 0.2 um",
               "identity",
               "1",
               1e-12,
               [](const Numerics& n, double T) { return relative(brightness_temperature(0.2, n.planck(0.2, T)), T); },
               {"temperature", "K", 1e4, 120, 2},
               {}});
}

static void add_angles(std::vector<Case>& c) {
  c.push_back({"angles",
               "1 - cos of 1e-4 rad",
               "long double",
               "1",
               1e-15,
               [](const Numerics& n, double x) {
                 const long double s = std::sin(static_cast<long double>(x) / 2);
                 return relative(n.one_minus_cos(x), 2 * s * s);
               },
               {"angle", "rad", 1e-4, 1e-150, 10},
               {}});
  c.push_back({"angles",
               "cone of 1e-4 rad: mean of the squared angle",
               "closed form x^2 / 2",
               "1",
               1e-3,
               [](const Numerics& n, double x) {
                 const double drop = n.one_minus_cos(x);
                 double sum = 0;
                 for (int j = 0; j < 64; ++j)
                   for (int i = 0; i < 64; ++i) {
                     const Dir d = uniform_cone({(i + 0.5) / 64, (j + 0.5) / 64}, drop);
                     sum += d.x * d.x + d.y * d.y;
                   }
                 return relative(sum / 4096, x * x / 2);
               },
               {"half angle", "rad", 1e-4, 1e-150, 10},
               {}});
  c.push_back({"angles",
               "same direction",
               "closed form 0",
               "rad",
               0,
               [](const Numerics& n, double) {
                 double worst = 0;
                 for (int i = 0; i < 2000; ++i) {
                   const Dir d = dir_from_angles(0.001 * i, 0.37 * i);
                   const double a = n.angle(d, d);
                   if (std::isnan(a)) return a;
                   worst = std::fmax(worst, a);
                 }
                 return worst;
               },
               {},
               {}});
}

static void add_near_directions(std::vector<Case>& c) {
  c.push_back(apart("1e-6 rad apart", false, 1e-6, 1e-12));
  c.push_back(apart("1e-6 rad short of opposite", true, 1e-6, 1e-12));

  c.push_back(
      {"sums",
       "1e8 equal samples in one pixel",
       "closed form",
       "1",
       1e-8,
       [](const Numerics& n, double x) { return std::fabs(n.mean_of_equal(0.5, static_cast<uint64_t>(x)) / 0.5 - 1); },
       {"samples", "1", 1e8, 1e9, 10},
       {}});
  c.push_back(
      {"sums",
       "1e7 samples of 0.1",
       "closed form",
       "1",
       1e-9,
       [](const Numerics& n, double x) { return std::fabs(n.mean_of_equal(0.1, static_cast<uint64_t>(x)) / 0.1 - 1); },
       {"samples", "1", 1e7, 1e9, 10},
       {}});
}

static void add_sums(std::vector<Case>& c) {
  c.push_back({"sums",
               "variance 1/12 on an offset of 1e6",
               "closed form",
               "1",
               1e-2,
               [](const Numerics&, double offset) {
                 RunningStats s;
                 Pcg32 rng(5);
                 for (int i = 0; i < 200000; ++i) s.add(offset + rng.uniform());
                 return relative(s.variance(), 1.0L / 12);
               },
               {"offset", "1", 1e6, 1e16, 10},
               {}});
  c.push_back({"sums",
               "chi-square tail beyond 1000 for 2 degrees",
               "closed form exp(-x/2)",
               "1",
               1e-11,
               [](const Numerics&, double x) {
                 return relative(chi_square_tail(x, 2), std::exp(-static_cast<long double>(x) / 2));
               },
               {"chi-square", "1", 1000, 1e4, 1.2},
               {}});
  c.push_back({"sums",
               "normal tail beyond 20 sigma",
               "closed form erfc",
               "1",
               1e-11,
               [](const Numerics&, double z) {
                 return relative(normal_two_sided(z), std::erfc(static_cast<long double>(z) / std::sqrt(2.0L)));
               },
               {"z", "1", 20, 50, 1.1},
               {}});
}

std::vector<Case> quantity_cases() {
  std::vector<Case> c;
  add_planck(c);
  add_angles(c);
  add_near_directions(c);
  add_sums(c);
  return c;
}

}  // namespace suite::extreme
