// Where the first things met are and how they are turned: means over the samples that met something.
#include <cmath>

#include "transport/truth/terrain.h"
#include "transport/truth/truth.h"

namespace suite {

namespace {

using Names = std::vector<std::string>;

std::unique_ptr<const TruthCollector> simple(const TruthContext& c, size_t slots, Names names, SimpleCollector::Add add,
                                             SimpleCollector::Finish finish) {
  return std::make_unique<SimpleCollector>(c, slots, std::move(names), add, finish);
}

void add_position(const TruthContext&, const TruthSample& s, double* sum) {
  if (!s.first) return;
  const Vec3& p = s.first->at->position;
  sum[0] += p.x, sum[1] += p.y, sum[2] += p.z;
}

SceneFrame frame_of(const TruthContext& c, const char* what) {
  const GeodeticOrigin& o = c.tracer.scene().origin;
  if (!o.given)
    throw Error(std::string("the truth '") + what + "' needs a scene with an origin on the Earth",
                "give the scene an origin");
  return SceneFrame({o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m});
}

// The mean place, expressed in a frame of the Earth.
struct EarthPlace final : TruthCollector {
  EarthPlace(const SceneFrame& f, bool angles) : frame(f), geodetic(angles) {}
  size_t slots() const override { return 3; }
  Names columns() const override {
    return geodetic ? Names{"latitude [deg]", "longitude [deg]", "height [m]"}
                    : Names{"ecef x [m]", "ecef y [m]", "ecef z [m]"};
  }
  void add(const TruthSample& s, double* sum) const override {
    if (s.first)
      sum[0] += s.first->at->position.x, sum[1] += s.first->at->position.y, sum[2] += s.first->at->position.z;
  }
  void finish(const double* sum, const TruthCounts& n, double* v) const override {
    if (!(n.hits > 0)) return;
    const Vec3 enu = Vec3{sum[0], sum[1], sum[2]} / n.hits;
    if (geodetic) {
      const Geodetic g = frame.geodetic_from_enu(enu);
      v[0] = g.latitude_deg, v[1] = g.longitude_deg, v[2] = g.height_m;
    } else {
      const Vec3 e = frame.ecef_from_enu(enu);
      v[0] = e.x, v[1] = e.y, v[2] = e.z;
    }
  }
  SceneFrame frame;
  bool geodetic;
};

void mean_of_one(const TruthContext&, const double* sum, const TruthCounts& n, double* v) {
  if (n.hits > 0) v[0] = sum[0] / n.hits;
}

// Angle between a direction and the surface's normal on the side that is looked at, degrees.
double angle_deg(const FirstMeeting& node, Dir d) {
  const Dir n = dot(node.out, node.at->geometric_normal) >= 0 ? node.at->geometric_normal : -node.at->geometric_normal;
  return angle_between(d, n) / kDegree;
}

}  // namespace

void add_place_rows(std::vector<TruthRow>& table) {
  table.push_back({"location", "mean place of the first hits, scene ENU", "m", [](const TruthContext& c) {
                     return simple(c, 3, {"east [m]", "north [m]", "up [m]"}, add_position,
                                   [](const TruthContext&, const double* sum, const TruthCounts& n, double* v) {
                                     if (n.hits > 0)
                                       for (int i = 0; i < 3; ++i) v[i] = sum[i] / n.hits;
                                   });
                   }});
  table.push_back({"ecef", "the same, Earth-centred Earth-fixed", "m",
                   [](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                     return std::make_unique<EarthPlace>(frame_of(c, "ecef"), false);
                   }});
  table.push_back({"geodetic", "the same, WGS84 latitude, longitude and ellipsoidal height", "deg, m",
                   [](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                     return std::make_unique<EarthPlace>(frame_of(c, "geodetic"), true);
                   }});
  table.push_back(
      {"time", "mean time of the sample rays", "s", [](const TruthContext& c) {
         return simple(
             c, 1, {"time [s]"}, [](const TruthContext&, const TruthSample& s, double* sum) { sum[0] += s.path.time; },
             [](const TruthContext&, const double* sum, const TruthCounts& n, double* v) { v[0] = sum[0] / n.paths; });
       }});
  table.push_back({"range", "mean distance from the sensor to the first hits", "m", [](const TruthContext& c) {
                     return simple(
                         c, 1, {"range [m]"},
                         [](const TruthContext&, const TruthSample& s, double* sum) {
                           if (s.first) sum[0] += s.first->distance;
                         },
                         mean_of_one);
                   }});
}

void add_angle_rows(std::vector<TruthRow>& table) {
  table.push_back({"normal", "mean normal of the first hits on the side looked at, unit length, ENU", "",
                   [](const TruthContext& c) {
                     return simple(
                         c, 3, {"normal east", "normal north", "normal up"},
                         [](const TruthContext&, const TruthSample& s, double* sum) {
                           if (!s.first) return;
                           const Dir n = s.first->at->geometric_normal;
                           const double side = dot(s.first->out, n) >= 0 ? 1 : -1;
                           sum[0] += side * n.x, sum[1] += side * n.y, sum[2] += side * n.z;
                         },
                         [](const TruthContext&, const double* sum, const TruthCounts&, double* v) {
                           const double len = length({sum[0], sum[1], sum[2]});
                           if (len > 0)
                             for (int i = 0; i < 3; ++i) v[i] = sum[i] / len;
                         });
                   }});
  table.push_back(
      {"view_angle", "mean angle between normal and direction to the sensor", "deg", [](const TruthContext& c) {
         return simple(
             c, 1, {"view angle [deg]"},
             [](const TruthContext&, const TruthSample& s, double* sum) {
               if (s.first) sum[0] += angle_deg(*s.first, s.first->out);
             },
             mean_of_one);
       }});
  table.push_back({"incidence", "mean angle between normal and direction to the sun", "deg", [](const TruthContext& c) {
                     return simple(
                         c, 1, {"incidence angle [deg]"},
                         [](const TruthContext& x, const TruthSample& s, double* sum) {
                           if (const auto to_sun = x.environment.towards_sun(); s.first && to_sun)
                             sum[0] += angle_deg(*s.first, *to_sun);
                         },
                         [](const TruthContext& x, const double* sum, const TruthCounts& n, double* v) {
                           if (n.hits > 0 && x.environment.towards_sun()) v[0] = sum[0] / n.hits;
                         });
                   }});
  add_terrain_rows(table);
}

}  // namespace suite
