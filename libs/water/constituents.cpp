#include "water/constituents.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace suite {

namespace {
struct Bricaud {
  double a, e;
};
constexpr double kFirstUm = 0.4, kStepUm = 0.01, kGoneUm = 0.72;
constexpr std::array<Bricaud, 31> kBricaud{
    {{0.0241, 0.6877}, {0.0287, 0.6834}, {0.0328, 0.6664}, {0.0359, 0.6478}, {0.0378, 0.6266}, {0.0350, 0.5993},
     {0.0328, 0.5961}, {0.0309, 0.5970}, {0.0281, 0.5890}, {0.0254, 0.6074}, {0.0210, 0.6529}, {0.0162, 0.7212},
     {0.0126, 0.7939}, {0.0103, 0.8500}, {0.0085, 0.9036}, {0.0070, 0.9312}, {0.0057, 0.9345}, {0.0050, 0.9298},
     {0.0051, 0.8933}, {0.0054, 0.8589}, {0.0052, 0.8410}, {0.0055, 0.8548}, {0.0061, 0.8704}, {0.0066, 0.8638},
     {0.0071, 0.8524}, {0.0078, 0.8155}, {0.0108, 0.8233}, {0.0174, 0.8138}, {0.0161, 0.8284}, {0.0069, 0.9255},
     {0.0025, 1.0286}}};
}  // namespace

double phytoplankton_absorption(double um, double chlorophyll) {
  if (!(chlorophyll > 0) || um >= kGoneUm) return 0;
  const auto row = [&](size_t i) { return kBricaud[i].a * std::pow(chlorophyll, kBricaud[i].e); };
  const double place = std::max(0.0, (um - kFirstUm) / kStepUm), last = kBricaud.size() - 1.0;
  if (place >= last) return row(kBricaud.size() - 1) * (kGoneUm - um) / (kGoneUm - (kFirstUm + last * kStepUm));
  const auto i = static_cast<size_t>(place);
  return row(i) + (row(i + 1) - row(i)) * (place - static_cast<double>(i));
}

double phytoplankton_scattering(double um, double chlorophyll) {
  if (!(chlorophyll > 0)) return 0;
  const double v = chlorophyll < 2 ? 0.5 * (std::log10(std::max(chlorophyll, 0.02)) - 0.3) : 0;
  return 0.416 * std::pow(chlorophyll, 0.766) * std::pow(um / 0.55, v);
}

double phytoplankton_backscatter(double chlorophyll) {
  return 0.002 + 0.01 * (0.5 - 0.25 * std::log10(std::clamp(chlorophyll, 0.02, 100.0)));
}

double dissolved_absorption(double um, double absorption_440, double slope_per_nm) {
  return absorption_440 * std::exp(-slope_per_nm * (1000 * um - 440));
}

double case_1_dissolved(double chlorophyll) { return 0.2 * (0.00635 + 0.06 * std::pow(chlorophyll, 0.65)); }

double mineral_absorption(double um, double grams_per_m3) {
  return 0.031 * grams_per_m3 * std::exp(-0.0123 * (1000 * um - 443));
}
double mineral_scattering(double grams_per_m3) { return 0.51 * grams_per_m3; }

double raman_scattering(double from_um) { return 2.7e-4 * std::pow(0.488 / from_um, 5.5); }

}  // namespace suite
