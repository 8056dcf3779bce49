#include "formats/rgl/rgl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMinCosine = 0.03489949670250097;  // cos 88 deg
constexpr double kBilateralLimit = 0.02;

// The warped coordinates of the paper: theta = (pi/2) u^2, phi = (2 v - 1) pi.
double u_of_theta(double theta) { return std::sqrt(std::max(0.0, theta) * (2 / kPi)); }
double v_of_phi(double phi) {
  const double v = (phi + kPi) / (2 * kPi);
  return v - std::floor(v);
}

// Index below x in an ascending list and the weight of the next entry; clamped to the ends.
std::pair<size_t, double> bracket(const std::vector<double>& list, double x) {
  if (list.size() == 1) return {0, 0.0};
  const size_t above = static_cast<size_t>(std::upper_bound(list.begin(), list.end(), x) - list.begin());
  const size_t i = std::clamp<size_t>(above, 1, list.size() - 1) - 1;
  return {i, std::clamp((x - list[i]) / (list[i + 1] - list[i]), 0.0, 1.0)};
}

constexpr rgl::SliceMix kOnly{{0, 0, 0, 0}, {1, 0, 0, 0}, 1};

}  // namespace

RglBrdf::RglBrdf(std::string name, std::string description, Tables t)
    : description_(std::move(description)),
      phi_(std::move(t.phi)),
      theta_(std::move(t.theta)),
      jacobian_(t.jacobian),
      channels_(t.wavelength_um.size()) {
  size_t negative = 0;
  for (const float v : t.values) negative += v < 0;
  negative_share_ = static_cast<double>(negative) / static_cast<double>(t.values.size());
  vndf_ = rgl::Warp(t.vndf_rows, t.vndf_columns, t.vndf);
  ndf_ = rgl::Bilinear(t.ndf_rows, t.ndf_columns, std::move(t.ndf));
  sigma_ = rgl::Bilinear(t.sigma_rows, t.sigma_columns, std::move(t.sigma));
  values_ = rgl::Bilinear(t.rows, t.columns, std::move(t.values));
  info_.name = std::move(name);
  info_.isotropic = phi_.size() <= 2;
  if (!info_.isotropic) reduction_ = static_cast<int>(std::lround(2 * kPi / (phi_.back() - phi_.front())));
  info_.source = strf("RGL .bsdf, %s, %s, in = theta_i, divided by cos(out) (at least cos 88 deg)",
                      t.spectral ? "spectral" : "rgb", info_.isotropic ? "isotropic" : "anisotropic");
  info_.wavelength_um = std::move(t.wavelength_um);
  if (!t.spectral) info_.channel_names = {"R", "G", "B"};
  asymmetry_ = info_.isotropic ? measure_asymmetry() : 0;
  info_.bilateral = info_.isotropic && asymmetry_ < kBilateralLimit;
}

rgl::SliceMix RglBrdf::slices(double phi, double theta) const {
  const auto [t, tw] = bracket(theta_, theta);
  const auto [p, pw] = info_.isotropic ? std::pair<size_t, double>{0, 0.0} : bracket(phi_, phi);
  rgl::SliceMix mix;
  for (int b = 0; b < 4; ++b) {
    const double w = (b & 1 ? tw : 1 - tw) * (b & 2 ? pw : 1 - pw);
    if (w == 0) continue;
    mix.slice[mix.count] = (p + (b & 2 ? 1 : 0)) * theta_.size() + t + (b & 1);
    mix.weight[mix.count++] = w;
  }
  return mix;
}

void RglBrdf::stored(Dir out, Dir in, std::span<double> w) const {
  // Bring the direction into the stored range of azimuths by the symmetry that reduced it.
  if (reduction_ >= 2) {
    const double middle = 0.5 * (phi_.front() + phi_.back()), mx = std::cos(middle), my = std::sin(middle);
    const double sy = std::copysign(1.0, my) * std::copysign(1.0, in.y);
    const double sx = reduction_ == 4 ? std::copysign(1.0, mx) * std::copysign(1.0, in.x) : sy;
    out = {sx * out.x, sy * out.y, out.z};
    in = {sx * in.x, sy * in.y, in.z};
  }
  const Vec3 sum = out + in;
  const Dir m = sum / length(sum);
  const double theta_i = polar_angle(in), phi_i = azimuth(in), phi_m = azimuth(m);
  const Vec2 u_m{u_of_theta(polar_angle(m)), v_of_phi(info_.isotropic ? phi_m - phi_i : phi_m)};
  const rgl::SliceMix mix = slices(phi_i, theta_i);
  const Vec2 u = vndf_.invert(u_m, mix);
  // What is stored is the ratio to the analytic shape D(m) / (4 sigma(in)).
  double scale = 1;
  if (jacobian_) {
    const double sigma = sigma_.at({u_of_theta(theta_i), v_of_phi(phi_i)}, kOnly);
    scale = sigma > 0 ? ndf_.at(u_m, kOnly) / (4 * sigma) : 0;
  }
  for (size_t c = 0; c < channels_; ++c) w[c] = std::max(0.0, scale * values_.at(u, mix, channels_, c));
}

void RglBrdf::value(Dir out, Dir in, std::span<double> f) const {
  if (!(out.z > 0 && in.z > 0)) {
    std::fill(f.begin(), f.end(), kNan);
    return;
  }
  stored(out, in, f);
  const double inverse = 1 / std::max(out.z, kMinCosine);
  for (double& x : f) x *= inverse;
}

double RglBrdf::measure_asymmetry() const {
  double difference = 0, sum = 0;
  std::vector<double> a(channels_), b(channels_);
  for (int o = 1; o < 80; o += 6)
    for (int i = 1; i < 80; i += 3)
      for (int p = 3; p < 180; p += 6) {
        const Dir out = dir_from_angles(o * kDegree, 0), in = dir_from_angles(i * kDegree, p * kDegree);
        stored(out, in, a);
        stored(out, {in.x, -in.y, in.z}, b);
        const double solid = std::sin(i * kDegree) * std::sin(o * kDegree) * in.z;
        difference += solid * std::fabs(a[channels_ / 2] - b[channels_ / 2]);
        sum += solid * 0.5 * (a[channels_ / 2] + b[channels_ / 2]);
      }
  return sum > 0 ? difference / sum : 0;
}

}  // namespace suite
