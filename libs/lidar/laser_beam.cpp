#include "lidar/laser_beam.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/warps.h"

namespace suite {

namespace {

using Kind = BeamProfile::Kind;

Dir from_tangent(Vec2 q) { return normalized(Vec3{q.x, q.y, -1}); }

// Of a Gaussian that falls to 1/e^2 at `radius`.
Vec2 gaussian(Vec2 u, double radius) {
  const double r = radius * std::sqrt(-0.5 * std::log1p(-u.x)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace

LaserBeam::LaserBeam(const BeamProfile& profile) : profile_(profile) {
  const double half = profile.kind == Kind::top_hat ? profile.half_angle : profile.full_angle_1_e2 / 2;
  if (!(profile.waist >= 0 && std::isfinite(profile.waist)))
    throw Error(strf("a beam's waist of %g m", profile.waist), "0 or more");
  if (profile.kind != Kind::image) {
    if (!(half >= 0 && half <= 1.5)) throw Error(strf("a beam's half-angle of %g rad", half), "0 to 1.5 rad");
    edge_ = std::tan(profile.waist > 0 ? half : std::max(half, kNarrowest));
    width_ = std::max(edge_, kNarrowest);
    solid_angle_ = kPi * width_ * width_;
    return;
  }
  if (profile.waist > 0) throw Error("a beam that is an image has no waist");
  if (profile.image.empty() || profile.image.size() != size_t{profile.columns} * profile.rows)
    throw Error(strf("a beam's image of %u x %u with %zu cells", profile.columns, profile.rows, profile.image.size()));
  if (!(profile.cell > 0 && profile.cell * std::max(profile.columns, profile.rows) <= 20))
    throw Error(strf("cells of %g rad in a beam's image", profile.cell), "above 0, the image at most 20 wide");
  double sum = 0;
  for (const double e : profile.image) {
    if (!(e >= 0 && std::isfinite(e))) throw Error(strf("an energy of %g in a beam's image", e), "0 or more");
    cumulative_.push_back(sum += e);
  }
  if (!(sum > 0)) throw Error("a beam's image without energy");
  for (double& c : cumulative_) c /= sum;
  for (double& e : profile_.image) e /= sum;
  width_ = profile.cell / 2;
  solid_angle_ = profile.cell * profile.cell * static_cast<double>(profile.image.size());
}

double LaserBeam::cells_density(Vec2 q) const {
  const double c = q.x / profile_.cell + 0.5 * profile_.columns, r = 0.5 * profile_.rows - q.y / profile_.cell;
  if (!(c >= 0 && c < profile_.columns && r >= 0 && r < profile_.rows)) return 0;
  const size_t cell = static_cast<size_t>(r) * profile_.columns + static_cast<size_t>(c);
  return profile_.image[cell] / (profile_.cell * profile_.cell);
}

double LaserBeam::density(Dir local, double distance) const {
  const double cosine = -local.z;
  if (!(cosine > 0)) return 0;
  const Vec2 q{local.x / cosine, local.y / cosine};
  const double waist = profile_.waist / distance, r2 = q.x * q.x + q.y * q.y;
  double even = 0;
  if (profile_.kind == Kind::top_hat) {
    const double edge = edge_ + waist;
    even = r2 < edge * edge ? 1 / (kPi * edge * edge) : 0;
  } else if (profile_.kind == Kind::gaussian) {
    const double w2 = edge_ * edge_ + waist * waist;
    even = 2 / (kPi * w2) * std::exp(-2 * r2 / w2);
  } else {
    even = cells_density(q);
  }
  return even / (cosine * cosine * cosine);
}

Vec2 LaserBeam::sample_cells(Vec2 u) const {
  auto cell = static_cast<size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), u.x) - cumulative_.begin());
  cell = std::min(cell, cumulative_.size() - 1);
  const double before = cell > 0 ? cumulative_[cell - 1] : 0, share = cumulative_[cell] - before;
  const double x = share > 0 ? std::clamp((u.x - before) / share, 0.0, 1.0) : 0.5;
  const auto column = static_cast<double>(cell % profile_.columns), row = static_cast<double>(cell / profile_.columns);
  return {(column + x - 0.5 * profile_.columns) * profile_.cell, (0.5 * profile_.rows - row - u.y) * profile_.cell};
}

Dir LaserBeam::sample(Vec2 u, double distance) const {
  if (profile_.kind == Kind::image) return from_tangent(sample_cells(u));
  const double waist = profile_.waist / distance;
  if (profile_.kind == Kind::top_hat) {
    const Vec2 d = disk_from_square(u);
    return from_tangent({d.x * (edge_ + waist), d.y * (edge_ + waist)});
  }
  return from_tangent(gaussian(u, std::hypot(edge_, waist)));
}

auto LaserBeam::start(Vec2 u, Vec2 u_place) const -> Start {
  if (profile_.kind == Kind::image) return {{}, from_tangent(sample_cells(u))};
  if (profile_.kind == Kind::top_hat) {
    const Vec2 d = disk_from_square(u);
    return {{d.x * profile_.waist, d.y * profile_.waist, 0}, from_tangent({d.x * edge_, d.y * edge_})};
  }
  const Vec2 at = profile_.waist > 0 ? gaussian(u_place, profile_.waist) : Vec2{};
  return {{at.x, at.y, 0}, from_tangent(gaussian(u, edge_))};
}

}  // namespace suite
