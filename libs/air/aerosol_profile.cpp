#include "air/aerosol_profile.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

// LOWTRAN 7's block data PRFDTA: heights above the ground, km; extinction at 0.55 um, 1/km.
constexpr double kHeight[] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16,
                              17, 18, 19, 20, 21, 22, 23, 24, 25, 30, 35, 40, 45, 50, 70, 100};
constexpr int kCount = static_cast<int>(std::size(kHeight));
// 0, 1, 2 km, by visibility.
constexpr double kVisibility[] = {50, 23, 10, 5, 2};
constexpr double kBoundary[3][5] = {{6.62e-2, 1.58e-1, 3.79e-1, 7.70e-1, 1.94},
                                    {4.15e-2, 9.91e-2, 3.79e-1, 7.70e-1, 1.94},
                                    {2.60e-2, 6.21e-2, 6.21e-2, 6.21e-2, 6.21e-2}};
// 3 to 10 km: spring and summer, fall and winter; visibility 50 and 23 km.
constexpr double kFree[2][2][8] = {{{1.46e-2, 1.02e-2, 9.31e-3, 7.71e-3, 6.23e-3, 3.37e-3, 1.82e-3, 1.14e-3},
                                    {3.46e-2, 1.85e-2, 9.31e-3, 7.71e-3, 6.23e-3, 3.37e-3, 1.82e-3, 1.14e-3}},
                                   {{1.14e-2, 6.43e-3, 4.85e-3, 3.54e-3, 2.31e-3, 1.41e-3, 9.80e-4, 7.87e-4},
                                    {2.72e-2, 1.20e-2, 4.85e-3, 3.54e-3, 2.31e-3, 1.41e-3, 9.80e-4, 7.87e-4}}};
// 11 to 30 km, background, then the normal upper atmosphere.
constexpr double kStratosphere[2][16] = {{7.99e-4, 6.41e-4, 5.17e-4, 4.42e-4, 3.95e-4, 3.82e-4, 4.25e-4, 5.20e-4,
                                          5.81e-4, 5.89e-4, 5.02e-4, 4.20e-4, 3.00e-4, 1.98e-4, 1.31e-4, 3.32e-5},
                                         {7.14e-4, 6.64e-4, 6.23e-4, 6.45e-4, 6.43e-4, 6.41e-4, 6.00e-4, 5.62e-4,
                                          4.91e-4, 4.23e-4, 3.52e-4, 2.95e-4, 2.42e-4, 1.90e-4, 1.50e-4, 3.32e-5}};
constexpr double kUpper[] = {1.64e-5, 7.99e-6, 4.01e-6, 2.10e-6, 1.60e-7, 9.31e-10};

// Linear in one over the visibility, as extinction is.
double between_visibilities(double a, double at_a, double b, double at_b, double visibility) {
  return at_a + (at_b - at_a) * (1 / visibility - 1 / a) / (1 / b - 1 / a);
}

constexpr double kMolecules = 0.01159e-3;  // 1/m, at 0.55 um at the ground

}  // namespace

double visibility_extinction(double visibility) {
  // ln 50, the contrast of 0.02.
  const double extinction = 3.912 / visibility - kMolecules;
  if (!(visibility > 0 && extinction > 0))
    throw Error(strf("visibility: %g m is outside its range", visibility),
                "above 0, below 337000 m: air without aerosols");
  return extinction;
}

AerosolProfile::AerosolProfile(double visibility, Season season) {
  const double ground = visibility_extinction(visibility) * 1e3, vis = visibility / 1e3;
  const int s = season == Season::spring_summer ? 0 : 1;
  for (int i = 0; i < kCount; ++i) {
    double value;
    if (i < 3) {
      const int above = static_cast<int>(
          std::find_if(kVisibility + 1, kVisibility + 4, [&](double v) { return vis >= v; }) - kVisibility);
      value = between_visibilities(kVisibility[above - 1], kBoundary[i][above - 1], kVisibility[above],
                                   kBoundary[i][above], vis);
      // The table's ground is rounded; its shape stays, and clearer air than the table's ends at none.
      if (i == 0 || vis <= 10) value = i < 2 ? ground : value;
      value = std::max(value, 0.0);
    } else if (i < 11) {
      const double clear = kFree[s][0][i - 3], hazy = kFree[s][1][i - 3];
      value = vis <= 23 ? hazy : std::max(0.0, between_visibilities(50, clear, 23, hazy, vis));
    } else {
      value = i < 27 ? kStratosphere[s][i - 11] : kUpper[i - 27];
    }
    extinction_[i] = value * 1e-3;
  }
}

AerosolProfile AerosolProfile::exponential(double depth, double scale_height) {
  if (!(depth >= 0 && std::isfinite(depth))) throw Error(strf("aerosols: the depth %g is negative", depth));
  if (!(scale_height > 0 && std::isfinite(scale_height)))
    throw Error(strf("aerosols: the scale height %g m is not positive", scale_height));
  AerosolProfile profile;
  profile.scale_height_ = scale_height;
  profile.extinction_[0] = depth / scale_height;
  return profile;
}

AerosolProfile AerosolProfile::with_depth(double wanted) const {
  if (!(wanted >= 0 && std::isfinite(wanted))) throw Error(strf("aerosols: the depth %g is negative", wanted));
  const double factor = wanted / depth();
  AerosolProfile profile = *this;
  for (double& e : profile.extinction_) e *= factor;
  return profile;
}

double AerosolProfile::extinction(double height) const {
  const double h = std::max(height, 0.0);
  if (scale_height_ > 0) return extinction_[0] * std::exp(-h / scale_height_);
  const double km = h / 1e3;
  if (km >= kHeight[kCount - 1]) return 0;
  const int i = static_cast<int>(std::upper_bound(kHeight, kHeight + kCount, km) - kHeight) - 1;
  const double t = (km - kHeight[i]) / (kHeight[i + 1] - kHeight[i]), a = extinction_[i], b = extinction_[i + 1];
  return a > 0 && b > 0 ? a * std::pow(b / a, t) : a + (b - a) * t;
}

double AerosolProfile::depth(double low, double high) const {
  const double from = std::max(low, 0.0), to = std::max(high, 0.0);
  if (scale_height_ > 0)
    return extinction_[0] * scale_height_ * (std::exp(-from / scale_height_) - std::exp(-to / scale_height_));
  double sum = 0;
  for (int i = 0; i + 1 < kCount; ++i) {
    const double a = std::max(from, kHeight[i] * 1e3), b = std::min(to, kHeight[i + 1] * 1e3);
    if (a >= b) continue;
    // At the upper node of the table the next piece begins; approach it from below by the two values of this piece.
    const double ea = extinction(a), eb = b == kHeight[i + 1] * 1e3 ? extinction_[i + 1] : extinction(b);
    const double ratio = ea > 0 && eb > 0 ? std::log(eb / ea) : 0;
    sum += std::abs(ratio) > 1e-9 ? (b - a) * (eb - ea) / ratio : (b - a) * 0.5 * (ea + eb);
  }
  return sum;
}

AerosolProfile::Region AerosolProfile::region(double height) {
  return height < 2000 ? Region::boundary : height < 10000 ? Region::free_troposphere : Region::stratosphere;
}

}  // namespace suite
