#include "light/air_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "air/air_media.h"
#include "math/falling.h"

namespace suite {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}  // namespace

AirVertices::AirVertices(std::shared_ptr<const AirColumn> column, const SpectralState& state, const Atmosphere& air,
                         std::vector<float> ground)
    : column_(std::move(column)),
      air_(air),
      ground_(std::move(ground)),
      ground_height_(column_->shells.heights()[column_->ground]),
      media_(air_media(column_, state)),
      knots_(state.knots.size()) {
  const std::span<const double> heights = column_->shells.heights();
  PerKnot depths{};
  for (size_t l = 0; l < media_.size(); ++l) {
    PerKnot& rates = scattering_.emplace_back();
    for (size_t k = 0; k < knots_; ++k) {
      rates[k] = media_[l].scattering[state.knots[k]];
      if (l >= column_->ground) depths[k] += rates[k] * (heights[l + 1] - heights[l]);
    }
  }
  depth_ = *std::max_element(depths.begin(), depths.end());
  over_.assign(heights.size(), PerKnot{});
  for (size_t l = media_.size(); l-- > 0;)
    for (size_t k = 0; k < knots_; ++k)
      over_[l][k] = over_[l + 1][k] + scattering_[l][k] * (heights[l + 1] - heights[l]);
}

AirVertices::PerKnot AirVertices::chances(Vec3 from, Dir d, double length) const {
  PerKnot sums{};
  column_->shells.walk(from, d, length, [&](const Shells::Piece& p) {
    for (size_t k = 0; k < knots_; ++k) sums[k] += scattering_[p.layer][k] * p.length;
  });
  for (size_t k = 0; k < knots_; ++k) sums[k] = -std::expm1(-sums[k]);
  return sums;
}

void AirVertices::depth_over(double height, double sign, PerKnot& sums) const {
  const size_t l = column_->shells.layer_of(height);
  if (l == media_.size()) return;
  const double left = column_->shells.heights()[l + 1] - height;
  for (size_t k = 0; k < knots_; ++k) sums[k] += sign * (over_[l + 1][k] + scattering_[l][k] * left);
}

// As in flat layers, where the way is steep enough for that.
AirVertices::PerKnot AirVertices::about_chances(Vec3 from, Dir d, double length) const {
  constexpr double kSteep = 0.2, kShort = 3e4;  // m
  const Shells& shells = column_->shells;
  const double cosine = dot(d, shells.up(from));
  const bool out = length == kInfinity;
  if (std::fabs(cosine) < kSteep || (out ? cosine < 0 : length > kShort)) return chances(from, d, length);
  PerKnot sums{};
  depth_over(shells.height(from), cosine > 0 ? 1 : -1, sums);
  if (!out) depth_over(shells.height(from + d * length), cosine > 0 ? -1 : 1, sums);
  for (size_t k = 0; k < knots_; ++k) {
    const double x = std::max(0.0, sums[k] / std::fabs(cosine));
    sums[k] = x < 0.1 ? x * (1 - x * (0.5 - x * (1 / 6.0))) : 1 - double{exp_falling(static_cast<float>(x))};
  }
  return sums;
}

std::optional<AirVertices::Place> AirVertices::draw(Vec3 from, Dir d, double length, double u, size_t knot) const {
  const PerKnot all = chances(from, d, length);
  if (!(all[knot] > 0)) return std::nullopt;
  const double wanted = -std::log1p(-u * all[knot]);
  PerKnot passed{};
  std::optional<Place> place;
  bool done = false;
  column_->shells.walk(from, d, length, [&](const Shells::Piece& p) {
    const PerKnot& rates = scattering_[p.layer];
    if (done || !(rates[knot] > 0)) {
      for (size_t k = 0; k < knots_; ++k) passed[k] += rates[k] * p.length;
      return;
    }
    // The last one that begins before it: where rounding would lead past the end, too.
    const double way = std::min((wanted - passed[knot]) / rates[knot], p.length);
    place = {p.near + way, p.layer, {}};
    for (size_t k = 0; k < knots_; ++k) {
      if (all[k] > 0) place->density[k] = rates[k] * std::exp(-passed[k] - rates[k] * way) / all[k];
      passed[k] += rates[k] * p.length;
    }
    done = passed[knot] > wanted;
  });
  return place;
}

// How far it is to the even ground, m; infinite where the sky lies beyond.
double AirVertices::to_ground(Vec3 from, Dir d) const {
  const Shells& shells = column_->shells;
  if (shells.height(from) > ground_height_) return shells.way_down_to(from, d, ground_height_);
  return dot(d, shells.up(from)) < 0 ? 0 : kInfinity;
}

void AirVertices::beyond(Vec3 from, Dir d, double length, std::span<float> T, std::span<float> more,
                         std::span<float> scratch) const {
  const double ground = to_ground(from, d);
  air_.transmittance(from, d, std::min(length, ground), T);
  const Vec3 end = from + d * std::min(length, ground);
  if (length <= ground) {  // the even ground, or the sky, would have been seen further on
    const bool sky = ground == kInfinity;
    sky ? air_.skylight(end, d, scratch, more) : air_.path(end, d, ground - length, scratch, more);
    for (size_t i = 0; i < T.size(); ++i) more[i] = -T[i] * (more[i] + (sky ? 0 : scratch[i] * ground_[i]));
  } else {
    air_.path(end, d, length - ground, scratch, more);
    for (size_t i = 0; i < T.size(); ++i) {
      more[i] = T[i] * (more[i] - ground_[i]);
      T[i] *= scratch[i];
    }
  }
}

}  // namespace suite
