#include "spectral/photopic.h"

#include <algorithm>

namespace suite {

namespace {

constexpr double kFirst = 0.38, kStep = 0.01;
constexpr double kV[] = {0.000039, 0.00012, 0.000396, 0.00121, 0.004,   0.0116,   0.023,    0.038,    0.06,
                         0.09098,  0.13902, 0.20802,  0.323,   0.503,   0.71,     0.862,    0.954,    0.99495,
                         0.995,    0.952,   0.87,     0.757,   0.631,   0.503,    0.381,    0.265,    0.175,
                         0.107,    0.061,   0.032,    0.017,   0.00821, 0.004102, 0.002091, 0.001047, 0.00052,
                         0.000249, 0.00012, 0.00006,  0.00003, 0.000015};
constexpr double kDark[] = {0.000589,    0.002209,    0.00929,    0.03484,     0.0966,       0.1998,     0.3281,
                            0.455,       0.567,       0.676,      0.793,       0.904,        0.982,      0.997,
                            0.935,       0.811,       0.65,       0.481,       0.3288,       0.2076,     0.1212,
                            0.0655,      0.03315,     0.01593,    0.00737,     0.003335,     0.001497,   0.000677,
                            0.0003129,   0.000148,    0.0000715,  0.00003533,  0.0000178,    0.00000914, 0.00000478,
                            0.000002546, 0.000001379, 0.00000076, 0.000000425, 0.0000002413, 0.000000139};
constexpr int kCount = static_cast<int>(std::size(kV));
static_assert(std::size(kDark) == std::size(kV));
constexpr double kLast = kFirst + kStep * (kCount - 1);

// Lumens a watt, linear between the rows of a table.
double weight(const double (&table)[kCount], double lumens_per_watt, double um) {
  const double place = std::clamp((um - kFirst) / kStep, 0.0, kCount - 1.0);
  const int i = std::min(kCount - 2, static_cast<int>(place));
  return lumens_per_watt * (table[i] + (place - i) * (table[i + 1] - table[i]));
}
double bright(double um) { return weight(kV, 683.002, um); }
double dark(double um) { return weight(kDark, 1700.06, um); }

double weighed(const Curve& spectrum, double (*eye)(double)) {
  if (!spectrum.covers(kFirst, kLast))
    throw Error("the spectrum reaches from " + spectrum.range_text() + ", the eye sees from 0.38 to 0.78 um",
                "give a longer curve, or declare 'outside: hold' or 'zero'");
  std::vector<double> knots;
  for (int i = 0; i < kCount; ++i) knots.push_back(kFirst + kStep * i);
  for (const double x : spectrum.wavelength_um())
    if (x > kFirst && x < kLast) knots.push_back(x);
  std::sort(knots.begin(), knots.end());
  // Between knots both are linear: Simpson's rule is exact. Inside the interval, where a curve may begin or end.
  double sum = 0;
  for (size_t i = 0; i + 1 < knots.size(); ++i) {
    const double a = knots[i], b = knots[i + 1], width = b - a;
    if (!(width > 0)) continue;
    const double middle = 0.5 * (a + b), half = 0.5 * width * (1 - 1e-9);
    auto f = [&](double x) { return eye(x) * spectrum.at(x); };
    sum += width / 6 * (f(middle - half) + 4 * f(middle) + f(middle + half));
  }
  return sum;
}

}  // namespace

double photopic(const Curve& spectrum) { return weighed(spectrum, bright); }
double scotopic(const Curve& spectrum) { return weighed(spectrum, dark); }
double photopic_weight(double um) { return um < kFirst || um > kLast ? 0 : bright(um); }
double scotopic_weight(double um) { return um < kFirst || um > kLast ? 0 : dark(um); }

}  // namespace suite
