#include "base/files.h"
#include "formats/motion/fields.h"

namespace suite {

namespace {
constexpr const char* kHeaders[] = {"time_s,east_m,north_m,up_m", "time_s,ecef_x_m,ecef_y_m,ecef_z_m",
                                    "time_s,latitude_deg,longitude_deg,height_m",
                                    "time_s,utm_zone,easting_m,northing_m,height_m"};
}

std::string pose_keys_text(std::span<const PoseKey> keys, PoseColumns columns, const MotionContext& context) {
  if (columns != PoseColumns::enu && !context.frame)
    throw Error("poses can only be written in scene ENU when the scene has no origin on the Earth");
  std::string text = std::string(kHeaders[static_cast<int>(columns)]) + ",qw,qx,qy,qz\n";
  std::optional<UtmZone> grid;  // one zone for the whole table: that of the first pose
  for (const PoseKey& key : keys) {
    const Vec3 p = key.pose.translation;
    Quat q = key.pose.rotation;
    text += strf("%.17g,", key.time);
    switch (columns) {
      case PoseColumns::enu:
        text += strf("%.17g,%.17g,%.17g", p.x, p.y, p.z);
        break;
      case PoseColumns::ecef: {
        const Vec3 e = context.frame->ecef_from_enu(p);
        q = context.frame->to_ecef().rotation * q;
        text += strf("%.17g,%.17g,%.17g", e.x, e.y, e.z);
        break;
      }
      case PoseColumns::geodetic: {
        const Geodetic g = context.frame->geodetic_from_enu(p);
        q = geodetic_axes(*context.frame, g).conjugate() * q;
        text += strf("%.17g,%.17g,%.17g", g.latitude_deg, g.longitude_deg, g.height_m);
        break;
      }
      case PoseColumns::utm: {
        if (!grid) grid = standard_utm_zone(context.frame->geodetic_from_enu(p));
        const UtmPoint u = context.frame->utm_from_enu(p, *grid);
        q = utm_axes(*context.frame, u).conjugate() * q;
        text += strf("%d%c,%.17g,%.17g,%.17g", grid->zone, grid->north ? 'N' : 'S', u.easting, u.northing, u.height_m);
        break;
      }
    }
    text += strf(",%.17g,%.17g,%.17g,%.17g\n", q.w, q.x, q.y, q.z);
  }
  return text;
}

void write_pose_keys(const std::string& path, std::span<const PoseKey> keys, PoseColumns columns,
                     const MotionContext& context) {
  write_file(path, pose_keys_text(keys, columns, context));
}

}  // namespace suite
