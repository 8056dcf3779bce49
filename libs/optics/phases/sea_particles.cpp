#include "optics/phases/sea_particles.h"

#include <array>

#include "optics/phases/henyey_greenstein.h"

namespace suite {

namespace {

constexpr double kFirstAngle = 1e-6;  // rad; the average particle scatters some 0.1 % of the light by less

// Sine squared of half the scattering angle; the function of it that both closed forms use.
struct Delta {
  double value, power;  // delta, delta^nu
  Delta(double index, double nu, double half_sine2)
      : value(4 * half_sine2 / (3 * (index - 1) * (index - 1))), power(std::pow(value, nu)) {}
};

double forand_at(double index, double slope, double half_sine2) {
  const double nu = (3 - slope) / 2;
  const Delta d(index, nu, half_sine2), back(index, nu, 1);
  const double rest = 1 - d.value, missing = 1 - d.power;
  const double lobe = (nu * rest - missing + (d.value * missing - nu * rest) / half_sine2) / (rest * rest * d.power);
  const double c = 1 - 2 * half_sine2;
  const double floor = (1 - back.power) / (4 * (back.value - 1) * back.power) * (3 * c * c - 1);
  return (lobe + floor) / (4 * kPi);
}

// Cosines from -1 to 1 for functions that fall as powers of the angle: even in angle from 0.2 rad on, in its logarithm
// below.
std::vector<double> peaked_cosines() {
  constexpr int fine = 700, coarse = 600;
  constexpr double border = 0.2;
  std::vector<double> cosine;
  for (int i = 0; i < coarse; ++i) cosine.push_back(std::cos(kPi + (border - kPi) * i / coarse));
  cosine.front() = -1;
  for (int i = 0; i <= fine; ++i) cosine.push_back(std::cos(border * std::pow(kFirstAngle / border, i / double(fine))));
  cosine.push_back(1);
  return cosine;
}

// power: the values near 0 go as the angle to -power, below 2. What lies within the first angle is a cap of the same
// integral.
template <class F>
CosineTable peaked_table(double power, const F& value_of_cosine) {
  std::vector<double> cosine = peaked_cosines(), value;
  for (size_t i = 0; i + 1 < cosine.size(); ++i) value.push_back(std::max(0.0, value_of_cosine(cosine[i])));
  value.push_back(value.back() * (2 / (1 - power / 2) - 1));
  return CosineTable(std::move(cosine), std::move(value));
}

struct Measured {
  double angle_deg, value;
};
constexpr std::array<Measured, 55> kPetzold{
    {{0.1, 1.76661e3},     {0.12589, 1.29564e3}, {0.15849, 9.50172e2}, {0.19953, 6.99092e2}, {0.25119, 5.13687e2},
     {0.31623, 3.76373e2}, {0.39811, 2.76318e2}, {0.50119, 2.18839e2}, {0.63096, 1.44369e2}, {0.79433, 1.02241e2},
     {1.0, 7.16082e1},     {1.2589, 4.95803e1},  {1.5849, 3.39511e1},  {1.9953, 2.28129e1},  {2.5119, 1.51622e1},
     {3.1623, 1.00154e1},  {3.9811, 6.57957},    {5.0119, 4.29530},    {6.3096, 2.80690},    {7.9433, 1.81927},
     {10, 1.15257},        {15, 4.89344e-1},     {20, 2.44424e-1},     {25, 1.47151e-1},     {30, 8.60848e-2},
     {35, 5.93075e-2},     {40, 4.20985e-2},     {45, 3.06722e-2},     {50, 2.27533e-2},     {55, 1.69904e-2},
     {60, 1.31254e-2},     {65, 1.04625e-2},     {70, 8.48826e-3},     {75, 6.97601e-3},     {80, 5.84232e-3},
     {85, 4.95306e-3},     {90, 4.29232e-3},     {95, 3.78161e-3},     {100, 3.40405e-3},    {105, 3.11591e-3},
     {110, 2.91222e-3},    {115, 2.79696e-3},    {120, 2.68568e-3},    {125, 2.57142e-3},    {130, 2.47603e-3},
     {135, 2.37667e-3},    {140, 2.32898e-3},    {145, 2.31308e-3},    {150, 2.36475e-3},    {155, 2.50584e-3},
     {160, 2.66183e-3},    {165, 2.83472e-3},    {170, 3.03046e-3},    {175, 3.09206e-3},    {180, 3.15366e-3}}};
constexpr double kPetzoldPower = 1.346;  // of the angle, below the first entry (Mobley 1994, section 3.8)

// Straight lines in the logarithms of angle and value.
double petzold(double c) {
  // The angle without loss near 0.
  const double angle = 2 * std::asin(std::sqrt(std::max(0.0, 0.5 * (1 - c)))) / kDegree;
  if (angle <= kPetzold[0].angle_deg)
    return kPetzold[0].value * std::pow(angle / kPetzold[0].angle_deg, -kPetzoldPower);
  size_t i = 1;
  while (i + 1 < kPetzold.size() && kPetzold[i].angle_deg < angle) ++i;
  const Measured &a = kPetzold[i - 1], &b = kPetzold[i];
  return a.value * std::pow(b.value / a.value, std::log(angle / a.angle_deg) / std::log(b.angle_deg / a.angle_deg));
}

}  // namespace

double fournier_forand(double index, double slope, double cos_scatter) {
  const double half_sine2 = 0.5 * (1 - cos_scatter);
  // Where delta is 1 numerator and denominator vanish together: the mean of two neighbours.
  const double one = 0.75 * (index - 1) * (index - 1);
  if (std::fabs(half_sine2 / one - 1) < 1e-4)
    return 0.5 * (forand_at(index, slope, one * (1 - 1e-4)) + forand_at(index, slope, one * (1 + 1e-4)));
  return forand_at(index, slope, half_sine2);
}

CosineTable fournier_forand_table(double index, double slope) {
  return peaked_table(5 - slope, [&](double c) { return fournier_forand(index, slope, c); });
}

double fournier_forand_backscatter(double index, double slope) {
  const double nu = (3 - slope) / 2;
  const Delta d(index, nu, 0.5);
  return 1 - (1 - d.value * d.power - 0.5 * (1 - d.power)) / ((1 - d.value) * d.power);
}

SeaParticles sea_particles(double backscatter) {
  const auto on_line = [](double slope) { return SeaParticles{1.01 + 0.1542 * (slope - 3), slope}; };
  double low = 3.0001, high = 4.9;
  for (int step = 0; step < 60; ++step) {
    const SeaParticles middle = on_line(0.5 * (low + high));
    (fournier_forand_backscatter(middle.index, middle.slope) < backscatter ? low : high) = middle.slope;
  }
  return on_line(0.5 * (low + high));
}

CosineTable petzold_table() { return peaked_table(kPetzoldPower, petzold); }

CosineTable hg_table(double g) {
  return peaked_table(0, [&](double c) { return hg_value(g, c); });
}

}  // namespace suite
