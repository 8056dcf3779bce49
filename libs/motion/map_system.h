// Reference systems of maps by their EPSG codes, and where their coordinates are in a scene.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "motion/geoid.h"
#include "motion/scene_frame.h"

namespace suite {

// What is known here: WGS84, ETRS89 and JGD2011 (taken as one frame, scene_frame.h), geographic or UTM, with or without
// heights.
struct MapSystem {
  std::optional<UtmZone> zone;  // none: latitude first, then longitude, degrees
  enum class Heights { unknown, ellipsoid, geoid } heights = Heights::unknown;
};
std::optional<MapSystem> map_system_of_epsg(int epsg);
// Easting and northing, or longitude and latitude. Errors of utm_from_geodetic.
Vec2 map_of_geodetic(const MapSystem& system, const Geodetic& place);
// The last number of a name such as EPSG:25832, urn:ogc:def:crs:EPSG::7415, or
// https://www.opengis.net/def/crs/EPSG/0/7415; of compound names such as urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783
// (also with + or &) the horizontal one; and that of urn:adv:crs:ETRS89_UTM32*... . Nothing where it is none of these.
std::optional<int> epsg_of_name(const std::string& name);

// From (x or latitude, y or longitude, height) to scene ENU, m. separation_m: the geoid above the ellipsoid, added to
// heights; in its place the grid, where there is one. The function's Errors are those of scene_frame.h.
std::function<Vec3(Vec3)> enu_of_map(const MapSystem& system, const SceneFrame& frame, double separation_m,
                                     std::optional<Geoid> geoid = std::nullopt);

}  // namespace suite
