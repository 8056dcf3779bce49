#include "light/air_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "air/air_media.h"
#include "math/falling.h"

namespace suite {

namespace {
constexpr double kBoundless = std::numeric_limits<double>::infinity();

// The share of light that is scattered on a way of scattering depth x, within 1e-6.
double scattered(double x) {
  return x < 0.1 ? x * (1 - x * (0.5 - x * (1 / 6.0 - x * (1 / 24.0 - x * (1 / 120.0)))))
                 : 1 - double{exp_falling(static_cast<float>(x))};
}
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

// Where a way that leaves the scene ends, m: what lies past its edge is the even ground.
double AirVertices::end_of(Vec3 from, Dir d, double length) const {
  return length == kBoundless ? to_ground(from, d) : length;
}

AirVertices::PerKnot AirVertices::chances(Vec3 from, Dir d, double length) const {
  PerKnot sums{};
  column_->shells.walk(from, d, end_of(from, d, length), [&](const Shells::Piece& p) {
    for (size_t k = 0; k < knots_; ++k) sums[k] += scattering_[p.layer][k] * p.length;
  });
  for (size_t k = 0; k < knots_; ++k) sums[k] = scattered(sums[k]);
  return sums;
}

void AirVertices::depth_over(double height, double sign, PerKnot& sums) const {
  const size_t l = column_->shells.layer_of(height);
  if (l == media_.size()) return;
  const double left = column_->shells.heights()[l + 1] - height;
  for (size_t k = 0; k < knots_; ++k) sums[k] += sign * (over_[l + 1][k] + scattering_[l][k] * left);
}

std::optional<AirVertices::Steep> AirVertices::steep(Vec3 from, Dir d, double length) const {
  constexpr double kSteep = 0.12, kShort = 3e4;  // m
  const Shells& shells = column_->shells;
  const double height = shells.height(from), cosine = shells.cosine(from, height, d);
  const bool out = length == kBoundless;
  if (std::fabs(cosine) < kSteep || (out ? cosine < 0 : length > kShort)) return std::nullopt;
  Steep way{std::fabs(cosine), height, out ? shells.heights().back() : shells.height(from + d * length), {}, {}};
  depth_over(way.near_height, 1, way.near);
  depth_over(way.far_height, 1, way.far);
  return way;
}

// Height along a straight line has no maximum between its ends, and in a round world lies less than the sagitta below
// the line between them.
std::optional<size_t> AirVertices::one_layer(Vec3 from, Dir d, double length) const {
  constexpr double kShort = 3e4;  // m: beyond, few ways stay in a layer
  if (!(length < kShort)) return std::nullopt;
  const Shells& shells = column_->shells;
  const double near = shells.height(from), far = shells.height(from + d * length), high = std::max(near, far),
               low = std::min(near, far) - 0.125 * shells.curvature() * length * length;
  const size_t l = shells.layer_of(high);
  if (l == media_.size() || (l > 0 && low < shells.heights()[l])) return std::nullopt;
  return l;
}

AirVertices::PerKnot AirVertices::chances_in(size_t layer, double length) const {
  PerKnot all{};
  for (size_t k = 0; k < knots_; ++k) all[k] = scattered(scattering_[layer][k] * length);
  return all;
}

std::optional<AirVertices::Place> AirVertices::draw_in(size_t layer, double length, double u, size_t knot) const {
  const PerKnot &rates = scattering_[layer], all = chances_in(layer, length);
  if (!(all[knot] > 0)) return std::nullopt;
  Place place{std::min(-std::log1p(-u * all[knot]) / rates[knot], length), layer, {}};
  for (size_t k = 0; k < knots_; ++k)
    if (all[k] > 0)
      place.density[k] = rates[k] * double{exp_falling(static_cast<float>(rates[k] * place.distance))} / all[k];
  return place;
}

AirVertices::PerKnot AirVertices::about_chances(Vec3 from, Dir d, double length) const {
  length = end_of(from, d, length);
  if (const auto layer = one_layer(from, d, length)) return chances_in(*layer, length);
  const auto way = steep(from, d, length);
  if (!way) return chances(from, d, length);
  PerKnot all{};
  for (size_t k = 0; k < knots_; ++k) all[k] = scattered(std::fabs(way->near[k] - way->far[k]) / way->cosine);
  return all;
}

// By height, as if layers were flat: the density is the one with which that draws, whatever they are.
std::optional<AirVertices::Place> AirVertices::draw_steep(const Steep& way, Vec3 from, Dir d, double length, double u,
                                                          size_t knot) const {
  PerKnot all;
  for (size_t k = 0; k < knots_; ++k) all[k] = scattered(std::fabs(way.near[k] - way.far[k]) / way.cosine);
  if (!(all[knot] > 0)) return std::nullopt;
  const Shells& shells = column_->shells;
  const bool up = way.far_height > way.near_height;
  const double passed = -std::log1p(-u * all[knot]) * way.cosine, over = way.near[knot] + (up ? -passed : passed);
  // The layer at whose foot the depth over it is still `over`, of those between both ends.
  const size_t first = shells.layer_of(std::min(way.near_height, way.far_height));
  size_t l = static_cast<size_t>(std::upper_bound(over_.begin() + static_cast<ptrdiff_t>(first), over_.end(), over,
                                                  [&](double v, const PerKnot& o) { return v > o[knot]; }) -
                                 over_.begin());
  l = std::clamp<size_t>(l, first + 1, media_.size()) - 1;
  while (l > first && !(scattering_[l][knot] > 0)) --l;
  const PerKnot& rates = scattering_[l];
  if (!(rates[knot] > 0)) return std::nullopt;
  const double height =
      std::clamp(shells.heights()[l] + (over_[l][knot] - over) / rates[knot], std::min(way.near_height, way.far_height),
                 std::max(way.near_height, way.far_height));
  const double distance = up ? shells.way_up_to(from, d, height) : shells.way_down_to(from, d, height);
  if (!(distance < kBoundless)) return std::nullopt;
  Place place{std::clamp(distance, 0.0, length), l, {}};
  const double rise = std::fabs(shells.cosine(from + d * place.distance, height, d)) / way.cosine;
  for (size_t k = 0; k < knots_; ++k) {
    if (!(all[k] > 0)) continue;
    const double here = over_[l][k] + (shells.heights()[l] - height) * rates[k],
                 gone = std::fabs(here - way.near[k]) / way.cosine;
    place.density[k] = rates[k] * rise * double{exp_falling(static_cast<float>(gone))} / all[k];
  }
  return place;
}

std::optional<AirVertices::Place> AirVertices::draw(Vec3 from, Dir d, double length, double u, size_t knot) const {
  length = end_of(from, d, length);
  if (const auto layer = one_layer(from, d, length)) return draw_in(*layer, length, u, knot);
  if (const auto way = steep(from, d, length)) return draw_steep(*way, from, d, length, u, knot);
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
      if (all[k] > 0)
        place->density[k] = rates[k] * double{exp_falling(static_cast<float>(passed[k] + rates[k] * way))} / all[k];
      passed[k] += rates[k] * p.length;
    }
    done = passed[knot] > wanted;
  });
  return place;
}

double AirVertices::to_ground(Vec3 from, Dir d) const {
  const Shells& shells = column_->shells;
  if (shells.height(from) > ground_height_) return shells.way_down_to(from, d, ground_height_);
  return dot(d, shells.up(from)) < 0 ? 0 : kBoundless;
}

void AirVertices::even(Vec3 from, Dir d, std::span<float> scratch, std::span<float> radiance) const {
  const double ground = to_ground(from, d);
  if (ground == kBoundless) return air_.skylight(from, d, scratch, radiance);
  air_.path(from, d, ground, scratch, radiance);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += scratch[i] * ground_[i];
}

void AirVertices::beyond(Vec3 from, Dir d, double length, std::span<float> T, std::span<float> more,
                         std::span<float> scratch) const {
  const double ground = to_ground(from, d);
  air_.transmittance(from, d, std::min(length, ground), T);
  const Vec3 end = from + d * std::min(length, ground);
  if (length <= ground) {  // the even ground, or the sky, would have been seen further on
    const bool sky = ground == kBoundless;
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
