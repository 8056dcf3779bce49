#include "air/air_spec.h"
#include "math/share.h"

#include <algorithm>
#include <cmath>

namespace suite {

std::vector<AirLevel> air_levels(const AirSpec& spec) {
  const std::vector<AirLevel>& given = spec.profile.levels;
  const double bottom = std::min(given.front().height, spec.height_of_ground()), top = given.back().height;
  std::vector<double> heights{bottom, top};
  const auto add = [&](double h) {
    if (h > bottom && h < top) heights.push_back(h);
  };
  const int closer = spec.closer * (spec.refraction ? 2 : 1);
  struct Steps {
    double to, step;
  };
  for (double h = 0;
       const Steps& s : {Steps{3e3, 250}, Steps{10e3, 500}, Steps{25e3, 1e3}, Steps{50e3, 2.5e3}, Steps{1e6, 10e3}})
    for (; h < s.to && h < top; h += s.step / closer) add(h);
  for (const AirSpec::Cloud& c : spec.clouds) add(c.base), add(c.top);
  add(spec.height_of_ground());
  if (spec.aerosol && !spec.aerosol->one_kind)
    for (const double region : {2e3, 10e3}) add(spec.height_of_ground() + region);
  std::sort(heights.begin(), heights.end());
  // What lies closer than a metre is one.
  std::vector<AirLevel> levels;
  for (const double h : heights)
    if (levels.empty() || h - levels.back().height > 1) levels.push_back(spec.profile.at(h));
  return levels;
}

void check_air(const AirSpec& spec) {
  check_profile(spec.profile, spec.where);
  const double ground = spec.height_of_ground(), top = spec.profile.levels.back().height;
  if (!(ground >= spec.profile.levels.front().height - 1000 && ground < top))
    throw Error(spec.where, strf("the ground at %g m lies outside of the profile (%g to %g m)", ground,
                                 spec.profile.levels.front().height, top));
  for (const AirSpec::Cloud& c : spec.clouds)
    if (!(c.top > c.base + 1 && c.top < top && c.content >= 0))
      throw Error(spec.where, strf("a cloud from %g to %g m with %g kg/m3", c.base, c.top, c.content),
                  "its top lies at least 1 m above its base and below the profile's top");
  if (!is_share(spec.ground_albedo.min()) || !is_share(spec.ground_albedo.max()))
    throw Error(spec.where, "the albedo of the ground is not between 0 and 1");
  if (spec.refraction && !spec.round)
    throw Error(spec.where, "refraction bends beams in the air about a round Earth, and this one is flat",
                "`shape: round`, or no `refraction`");
  if (spec.streams < 4 || spec.streams > 64 || spec.streams % 2)
    throw Error(spec.where, strf("%d streams", spec.streams), "an even number from 4 to 64");
}

}  // namespace suite
