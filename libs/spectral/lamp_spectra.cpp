#include "spectral/lamp_spectra.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

struct Part {
  double middle, width, height;  // um, full width at half maximum; relative
};
struct Lamp {
  const char* name;
  std::vector<Part> parts;
};

const std::vector<Lamp>& lamps() {
  constexpr double kBlue = 0.452, kBlueWidth = 0.022;  // of LEDs, beside their phosphor
  static const std::vector<Lamp> all{
      // Sodium's D lines broadened and reversed, its lines at 498, 515, 568, 616 and 819 nm.
      {"sodium",
       {{0.498, 0.006, 0.12},
        {0.515, 0.006, 0.05},
        {0.5683, 0.010, 0.30},
        {0.582, 0.010, 0.75},
        {0.5975, 0.018, 1},
        {0.616, 0.010, 0.25},
        {0.590, 0.10, 0.08},
        {0.819, 0.006, 0.35}}},
      // Mercury's lines, sodium, thallium at 535 nm, bands of scandium.
      {"metal_halide",
       {{0.405, 0.008, 0.25},
        {0.4358, 0.006, 0.6},
        {0.474, 0.05, 0.35},
        {0.5461, 0.006, 1},
        {0.535, 0.012, 0.9},
        {0.578, 0.008, 0.6},
        {0.5893, 0.020, 1},
        {0.62, 0.06, 0.45},
        {0.55, 0.20, 0.15}}},
      // Mercury's lines, and a red phosphor on the bulb.
      {"mercury",
       {{0.4047, 0.004, 0.55},
        {0.4358, 0.004, 1},
        {0.5461, 0.004, 1},
        {0.578, 0.005, 0.9},
        {0.615, 0.012, 0.35},
        {0.50, 0.30, 0.012}}},
      {"led_2700", {{kBlue, kBlueWidth, 0.45}, {0.599, 0.125, 1}}},
      {"led_3000", {{kBlue, kBlueWidth, 0.59}, {0.594, 0.128, 1}}},
      {"led_4000", {{kBlue, kBlueWidth, 1.05}, {0.581, 0.135, 1}}},
      {"led_5000", {{kBlue, kBlueWidth, 1.45}, {0.572, 0.140, 1}}}};
  return all;
}

}  // namespace

std::vector<std::string> lamp_names() {
  std::vector<std::string> names;
  for (const Lamp& lamp : lamps()) names.emplace_back(lamp.name);
  return names;
}

Curve lamp_spectrum(const std::string& name) {
  const auto found = std::find_if(lamps().begin(), lamps().end(), [&](const Lamp& l) { return l.name == name; });
  if (found == lamps().end()) throw Bug("there is no lamp '" + name + "'");
  std::vector<double> x, y;
  for (int nm = 350; nm <= 850; ++nm) {
    x.push_back(1e-3 * nm);
    double sum = 0;
    for (const Part& p : found->parts) {
      const double away = (x.back() - p.middle) / p.width;
      sum += p.height * std::exp(-4 * std::log(2) * away * away);
    }
    y.push_back(sum);
  }
  const Curve shape(x, std::move(y), Outside::zero);
  return shape.scaled(1 / shape.integral(0.35, 0.85));
}

}  // namespace suite
