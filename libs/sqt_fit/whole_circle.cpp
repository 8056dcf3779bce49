#include "sqt_fit/whole_circle.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite::sqt {

namespace {

constexpr double kSameAzimuth = 1e-4;  // rad: single precision, and degrees with two digits
constexpr double kWidestAzimuthGap = kPi / 2 + kSameAzimuth;

double within_circle(double phi) {
  const double x = std::remainder(phi, 2 * kPi);
  return x >= kPi - kSameAzimuth ? -kPi : x;
}

bool half_circle(const std::vector<double>& phi) {
  const auto [low, high] = std::minmax_element(phi.begin(), phi.end());
  return std::fabs(*low) < kSameAzimuth && std::fabs(*high - kPi) < kSameAzimuth;
}

}  // namespace

std::vector<CirclePlace> whole_circle(const std::vector<double>& phi) {
  std::vector<CirclePlace> places;
  const bool half = phi.size() > 1 && half_circle(phi);
  for (size_t i = 0; i < phi.size(); ++i) {
    if (!(std::fabs(phi[i]) <= 2 * kPi + kSameAzimuth))
      throw Error(strf("phi_d of %g rad", phi[i]), "one turn at most");
    places.push_back({within_circle(phi[i]), i, false});
    if (half && phi[i] > kSameAzimuth && phi[i] < kPi - kSameAzimuth) places.push_back({-phi[i], i, true});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const CirclePlace& a, const CirclePlace& b) { return a.phi < b.phi; });
  const double span =
      phi.empty() ? 0 : *std::max_element(phi.begin(), phi.end()) - *std::min_element(phi.begin(), phi.end());
  for (size_t i = 1; i < places.size();) {
    if (places[i].phi - places[i - 1].phi > kSameAzimuth) {
      ++i;
      continue;
    }
    // The end of a turn is its start again.
    if (std::fabs(span - 2 * kPi) > kSameAzimuth || std::fabs(phi[places[i].from] - phi[places[i - 1].from]) < kPi)
      throw Error(strf("phi_d of %g rad is given twice", phi[places[i].from]));
    places.erase(places.begin() + static_cast<ptrdiff_t>(i));
  }
  for (size_t i = 0; i < places.size() && places.size() > 1; ++i) {
    const double next = i + 1 < places.size() ? places[i + 1].phi : places[0].phi + 2 * kPi;
    if (half ? next - places[i].phi > kPi + kSameAzimuth : next - places[i].phi > kWidestAzimuthGap)
      throw Error(strf("phi_d leaves out %.4g to %.4g rad", places[i].phi, next), "the whole circle, or 0 to pi");
  }
  return places;
}

}  // namespace suite::sqt
