#include "spectral/photopic.h"

#include <algorithm>

namespace suite {

namespace {

constexpr double kLumensPerWatt = 683.002, kFirst = 0.38, kStep = 0.01;
constexpr double kV[] = {0.000039, 0.00012, 0.000396, 0.00121, 0.004,   0.0116,   0.023,    0.038,    0.06,
                         0.09098,  0.13902, 0.20802,  0.323,   0.503,   0.71,     0.862,    0.954,    0.99495,
                         0.995,    0.952,   0.87,     0.757,   0.631,   0.503,    0.381,    0.265,    0.175,
                         0.107,    0.061,   0.032,    0.017,   0.00821, 0.004102, 0.002091, 0.001047, 0.00052,
                         0.000249, 0.00012, 0.00006,  0.00003, 0.000015};
constexpr int kCount = static_cast<int>(std::size(kV));

double eye(double um) {
  const double place = std::clamp((um - kFirst) / kStep, 0.0, kCount - 1.0);
  const int i = std::min(kCount - 2, static_cast<int>(place));
  return kV[i] + (place - i) * (kV[i + 1] - kV[i]);
}

}  // namespace

double photopic(const Curve& spectrum) {
  const double last = kFirst + kStep * (kCount - 1);
  if (!spectrum.covers(kFirst, last))
    throw Error("the spectrum reaches from " + spectrum.range_text() + ", the eye sees from 0.38 to 0.78 um",
                "give a longer curve, or declare 'outside: hold' or 'zero'");
  std::vector<double> knots;
  for (int i = 0; i < kCount; ++i) knots.push_back(kFirst + kStep * i);
  for (const double x : spectrum.wavelength_um())
    if (x > kFirst && x < last) knots.push_back(x);
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
  return kLumensPerWatt * sum;
}

}  // namespace suite
