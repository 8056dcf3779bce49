#include "formats/motion/fields.h"

namespace suite {

namespace {
constexpr double kFarthest = 1e13;  // m; beyond, a millimetre is lost in double
constexpr const char* kFirst[] = {"east_m", "ecef_x_m", "latitude_deg", "easting_m"};
constexpr const char* kNames[][4] = {{"east_m", "north_m", "up_m", nullptr},
                                     {"ecef_x_m", "ecef_y_m", "ecef_z_m", nullptr},
                                     {"latitude_deg", "longitude_deg", "height_m", nullptr},
                                     {"easting_m", "northing_m", "height_m", "utm_zone"}};
constexpr const char* kWays =
    "give east_m, north_m, up_m; or ecef_x_m, ecef_y_m, ecef_z_m; or latitude_deg, longitude_deg, height_m; or "
    "utm_zone, "
    "easting_m, northing_m, height_m";
}  // namespace

// Which frame the names are of.
PoseColumns PoseFields::columns(const MotionContext& context) const {
  int found = -1;
  for (int i = 0; i < 4; ++i)
    if (has(kFirst[i])) {
      if (found >= 0)
        throw error(std::string("a position has both ") + kFirst[found] + " and " + kFirst[i], "use one frame");
      found = i;
    }
  if (found < 0) throw error("a position is missing", kWays);
  for (const char* name : kNames[found])
    if (name && !has(name)) throw error(std::string("a position has ") + kFirst[found] + " but no " + name, kWays);
  // Leftovers of other frames would be silently ignored otherwise.
  for (int i = 0; i < 4; ++i)
    for (const char* name : kNames[i]) {
      bool mine = !name;
      for (const char* own : kNames[found]) mine = mine || (own && std::string_view(own) == name);
      if (!mine && has(name))
        throw error(std::string("a position has both ") + kFirst[found] + " and " + name, "use one frame");
    }
  const PoseColumns columns = static_cast<PoseColumns>(found);
  if (columns != PoseColumns::enu && !context.frame)
    throw error("this position needs a scene with an origin on the Earth",
                "use east_m, north_m, up_m, or give the scene its origin");
  return columns;
}

UtmPoint PoseFields::utm() const {
  const std::string zone = text("utm_zone");
  const auto grid = utm_zone_of_text(zone);
  if (!grid) throw error("'" + zone + "' is no UTM zone", "write 33N or 56S");
  return {*grid, number("easting_m"), number("northing_m"), number("height_m")};
}

Geodetic PoseFields::geodetic() const { return {number("latitude_deg"), number("longitude_deg"), number("height_m")}; }

Quat PoseFields::orientation() const {
  const bool angles = has("heading_deg") || has("pitch_deg") || has("roll_deg");
  if (has("qw") || has("qx") || has("qy") || has("qz")) {
    if (angles) throw error("an orientation both as angles and as a quaternion", "use one of them");
    for (const char* name : {"qw", "qx", "qy", "qz"})
      if (!has(name)) throw error(std::string("a quaternion without ") + name, "qw, qx, qy, qz");
    const Quat q{number("qw"), number("qx"), number("qy"), number("qz")};
    const double n2 = dot(q, q);
    if (!(std::fabs(n2 - 1) < 1e-3))
      throw error(strf("a quaternion of length %g", std::sqrt(n2)), "a rotation has length 1");
    return normalized(q);
  }
  if (!angles) return {};
  auto or_zero = [&](const char* name) { return has(name) ? number(name) : 0.0; };
  const double pitch = or_zero("pitch_deg");
  if (!(std::fabs(pitch) <= 90)) throw error(strf("a pitch of %g degrees", pitch), "-90 to 90");
  return platform_rotation(azimuth_from_compass_deg(or_zero("heading_deg")), pitch * kDegree,
                           or_zero("roll_deg") * kDegree);
}

Vec3 PoseFields::position(const MotionContext& context) const {
  const Vec3 p = position_in(columns(context), context);
  if (!(length(p) <= kFarthest))
    throw error(strf("a position %g m away", length(p)), strf("at most %g m from the origin", kFarthest));
  return p;
}

Vec3 PoseFields::position_in(PoseColumns kind, const MotionContext& context) const {
  try {
    switch (kind) {
      case PoseColumns::enu:
        return {number("east_m"), number("north_m"), number("up_m")};
      case PoseColumns::ecef:
        return context.frame->enu_from_ecef({number("ecef_x_m"), number("ecef_y_m"), number("ecef_z_m")});
      case PoseColumns::geodetic:
        return context.frame->enu_from_geodetic(geodetic());
      case PoseColumns::utm:
        return context.frame->enu_from_utm(utm());
    }
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw error(e.message(), e.hint());
  }
  throw_bug(__FILE__, __LINE__, "a frame that does not exist", "");
}

Pose PoseFields::pose(const MotionContext& context) const {
  const PoseColumns kind = columns(context);
  const Vec3 p = position(context);
  const Quat q = orientation();
  switch (kind) {
    case PoseColumns::enu:
      return {q, p};
    case PoseColumns::ecef:
      // Angles count from the horizon of the place, a quaternion from the Earth-centred axes.
      if (!has("qw")) return {normalized(geodetic_axes(*context.frame, context.frame->geodetic_from_enu(p)) * q), p};
      return {normalized(context.frame->to_ecef().rotation.conjugate() * q), p};
    case PoseColumns::geodetic:
      return {normalized(geodetic_axes(*context.frame, geodetic()) * q), p};
    case PoseColumns::utm:
      return {normalized(utm_axes(*context.frame, utm()) * q), p};
  }
  throw_bug(__FILE__, __LINE__, "a frame that does not exist", "");
}

}  // namespace suite
