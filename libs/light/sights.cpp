#include "light/sights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Shown {
  SightAxis axis;
  const char *name, *unit, *key;
  double factor;
  bool angle;
};
constexpr Shown kShown[kSightAxes] = {
    {SightAxis::view_zenith, "view zenith angle", "degrees", "angle_tolerance_deg", 1 / kDegree, true},
    {SightAxis::range, "range", "m", nullptr, 1, false},
    {SightAxis::observer_height, "observer's height", "m", "height_tolerance_m", 1, false},
    {SightAxis::end_height, "height of the end", "m", "height_tolerance_m", 1, false},
    {SightAxis::solar_zenith, "solar zenith angle", "degrees", "angle_tolerance_deg", 1 / kDegree, true},
    {SightAxis::relative_azimuth, "azimuth from the Sun's", "degrees", "angle_tolerance_deg", 1 / kDegree, true}};

using Span = std::pair<double, double>;

// How far along a falling ray it comes to a height; behind its start where that lies above. Nothing where it never
// does. As in air/shells.h: differences of heights stand in place of those of squared radii.
std::optional<double> falls_to(const Shells& sea, Vec3 from, Dir d, double target) {
  const double k = sea.curvature(), height = sea.height(from), slope = dot(sea.up(from), d) * (1 + k * height),
               above = (height - target) * (1 + 0.5 * k * (height + target)), root = slope * slope - 2 * k * above;
  if (!(slope < 0) || !(root >= 0)) return std::nullopt;
  return 2 * above / (std::sqrt(root) - slope);
}

double nearest(const Span& span, double v) { return std::clamp(v, span.first, span.second); }
double off(const Span& span, double v) { return std::fabs(v - nearest(span, v)); }

// Azimuths from the Sun run to pi; tables may have the other side.
double on_side_of(const Span& span, double azimuth) {
  const double other = 2 * kPi - azimuth;
  return off(span, other) < off(span, azimuth) ? other : azimuth;
}

// The angle between the vertical planes of two directions, 0 to pi; 0 along the vertical.
double azimuth_between(Dir up, Dir a, Dir b) {
  const Vec3 p = a - up * dot(a, up), q = b - up * dot(b, up);
  return std::atan2(length(cross(p, q)), dot(p, q));
}

std::string text(const Shown& axis, const Span& span) {
  const double low = span.first * axis.factor, high = span.second * axis.factor;
  return low == high ? strf("%.6g %s", low, axis.unit) : strf("%.6g to %.6g %s", low, high, axis.unit);
}

std::optional<SightFault> fault_of(const Shown& axis, const SightTable& runs, const SightWorld& world,
                                   const Sight& sight) {
  const auto span = runs.covered(axis.axis);
  if (!span) return std::nullopt;
  const std::string have = std::string(axis.name) + " of " + text(axis, *span);
  if (!sight[axis.axis])
    return SightFault{"the runs have a " + have + ", and there is no sun in the simulation",
                      "give `sun`: its direction counts"};
  double value = *sight[axis.axis], slant = 1;
  if (axis.axis == SightAxis::relative_azimuth) {
    value = on_side_of(*span, value);
    slant = std::sin(sight[SightAxis::view_zenith].value_or(kPi / 2));  // near the vertical azimuths lie close together
  }
  if (value == kInfinity)
    return SightFault{"it meets nothing, and the runs have a " + have,
                      "a ground under all that is seen, or an `earth`"};
  const double away = off(*span, value), allowed = axis.angle ? world.within_angle : axis.key ? world.within_height : 0;
  if (away * slant <= allowed + 1e-6 * std::fabs(value)) return std::nullopt;
  return SightFault{
      strf("its %s is %s, and the runs have ", axis.name, text(axis, {value, value}).c_str()) + text(axis, *span),
      axis.key ? strf("runs that cover it, or `%s: %.3g` where theirs may stand for it", axis.key,
                      1.01 * away * slant * axis.factor)
               : "runs that go so far"};
}

}  // namespace

bool SightTable::has(SightAxis axis) const { return std::find(axes.begin(), axes.end(), axis) != axes.end(); }

std::optional<Span> SightTable::covered(SightAxis axis) const {
  for (size_t a = 0; a < axes.size(); ++a)
    if (axes[a] == axis) return table.covered(a);
  if (alike[axis]) return Span(*alike[axis], *alike[axis]);
  return std::nullopt;
}

Sight sight_of(const SightTable& runs, const SightWorld& world, Vec3 from, Dir d, double distance) {
  const Shells& sea = world.sea;
  double height = sea.height(from);
  const auto begin = runs.covered(SightAxis::observer_height);
  if (height > kTopOfAir && begin && begin->second >= kTopOfAir) {
    const double start = std::max(kTopOfAir, nearest(*begin, height));
    if (const auto way = falls_to(sea, from, d, start); way && *way < distance) {
      from += d * *way;
      distance -= *way;
      height = start;
    }
  }
  if (const auto end = runs.covered(SightAxis::end_height); end && distance == kInfinity)
    if (const auto way = falls_to(sea, from, d, end->first); way && *way > 0) distance = *way;
  const Dir up = sea.up(from);
  Sight s;
  s[SightAxis::view_zenith] = angle_between(up, d);
  s[SightAxis::observer_height] = height;
  s[SightAxis::range] = distance;
  s[SightAxis::end_height] = distance == kInfinity ? kInfinity : sea.height(from + d * distance);
  if (!world.sun) return s;
  s[SightAxis::solar_zenith] = angle_between(up, *world.sun);
  s[SightAxis::relative_azimuth] = azimuth_between(up, d, *world.sun);
  return s;
}

std::optional<SightFault> uncovered(const SightTable& runs, const SightWorld& world, const Sight& sight, bool ends) {
  for (const Shown& axis : kShown) {
    const bool own = runs.has(axis.axis), end = axis.axis == SightAxis::range || axis.axis == SightAxis::end_height;
    if (runs.everywhere && !own) continue;
    if (end && !ends) continue;
    // Of range and height of the end one follows from the other: what is no axis need not be alike.
    if (axis.axis == SightAxis::range && !own && runs.covered(SightAxis::end_height)) continue;
    if (axis.axis == SightAxis::end_height && !own && runs.has(SightAxis::range)) continue;
    // Without a Sun in the runs its azimuth means nothing.
    if (axis.axis == SightAxis::relative_azimuth && !runs.covered(SightAxis::solar_zenith)) continue;
    if (auto fault = fault_of(axis, runs, world, sight)) return fault;
  }
  return std::nullopt;
}

std::vector<double> place_of(const SightTable& runs, const Sight& sight) {
  std::vector<double> place;
  for (size_t a = 0; a < runs.axes.size(); ++a) {
    const Span span = runs.table.covered(a);
    double value = sight[runs.axes[a]].value_or(span.first);
    if (runs.axes[a] == SightAxis::relative_azimuth) value = on_side_of(span, value);
    place.push_back(nearest(span, value));
  }
  return place;
}

}  // namespace suite
