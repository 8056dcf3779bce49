// Models of cities: CityJSON 1.0 to 2.0 (also as a sequence of features, a line each) and CityGML 2.0 and 3.0. See
// FORMAT.md.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// What both formats say, in coordinates of the map that the file names.
struct CityModel {
  struct Surface {
    std::string kind;                      // RoofSurface, WallSurface, ...; or the type of the object
    std::vector<std::vector<Vec3>> rings;  // the outer one, anticlockwise from outside; holes
    int line = 0;                          // of the file, where known
  };
  struct Object {
    std::string id, type, parent;
    double lod = -1;  // of its surfaces; -1: has none or does not say
    std::vector<Surface> surfaces;
    int line = 0;
  };
  std::string file;
  std::string system;  // the reference system as it is named there; empty: it is not
  std::vector<Object> objects;
};

// lod: a level of detail such as 2 or 2.2: of each object the geometry of just that level, or (2: also 2.2) of the
// highest that begins with it; none: the highest there is. Points and lines are told (SP205), as is what is left out
// (SP705, SP706). Objects whose parts have a higher level than they themselves are left to their parts. Error when the
// file cannot be read or says something that cannot be; indices are checked, and depths are those of the geometry
// types.
CityModel read_city(const std::string& path, const std::optional<std::string>& lod, Report& report);
CityModel parse_city(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                     Report& report);

// The triangles, in the frame to which `place` leads from the map's: a group each object (its id), a material each kind
// of surface. Corners are shared within an object. Polygons with holes stay in SourceMesh::holed.
SourceMesh mesh_of(const CityModel& city, const std::function<Vec3(Vec3)>& place, Report& report);

// Smallest box around all surfaces, in coordinates of the map. Empty box: there are none.
Box3 extent_of(const CityModel& city);

// "cityjson", "citygml" or nothing, by a file's name and its first bytes.
std::string city_format(const std::string& path, std::string_view head);

}  // namespace suite
