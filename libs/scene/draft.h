// A scene on its way in: what the text said and what the files it names contain, every value with its place, nothing
// resolved yet. Filled by formats/scene_text, turned into a Scene by bake.h.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/tracked_inputs.h"
#include "scene/scatter.h"
#include "scene/scene.h"

namespace suite {

// A name that refers to something, and where it was written.
struct Reference {
  std::string name;
  Where where;
  bool given() const { return !name.empty(); }
};

// In place of a normal that is missing; oct_encode never gives it.
inline constexpr uint32_t kNoNormal = 0x80008000u;

// Triangles as read from a file, in double, before they get an origin.
struct SourceMesh {
  struct Run {                    // consecutive triangles of one group and one material name
    std::string group, material;  // material: the `usemtl` name; empty = none
    uint32_t first_triangle = 0;
    int line = 0;  // where the run starts in the file
  };
  std::string file;
  std::vector<Vec3> positions;      // m
  std::vector<uint32_t> normals;    // octahedral, one per position (kNoNormal: has none), or empty
  std::vector<float> uvs;           // two per position, or empty
  std::vector<uint32_t> indices;    // three per triangle
  std::vector<int> lines;           // source line of each triangle, or empty
  std::vector<uint32_t> smoothing;  // group of each triangle, 0 = flat where there is no normal; or empty: all flat
  std::vector<Run> runs;            // ascending
  struct Holed {                    // a polygon with holes
    std::string group, material;    // as of a run
    std::vector<uint32_t> corners;  // its outer ring, then its holes
    std::vector<size_t> ring_ends;  // where they end among the corners
    Where where;
  };
  std::vector<Holed> holed;  // not among the triangles yet: cut_holed of libs/mesh puts them there
};

// Heights on a grid, as a raster gives them. Samples are at pixel centres.
struct SourceTerrain {
  uint32_t width = 0, height = 0;
  std::vector<float> heights;  // m, row-major, first row first; NaN = no data
  // Scene ENU position of the sample in column i, row j (both may be fractional) with the height given.
  std::function<Vec3(double column, double row, double height)> place;
  bool georeferenced = false;  // place() knows the Earth's curvature already
};

// file: the file's own, those that are missing by its smoothing groups; facet: none; smooth: all made anew.
enum class NormalRule { file, facet, smooth };

// A lighter version of a mesh: down to this share of its triangles (0 to 1), moved by no more than error_m.
struct DecimationRule {
  double to = 0, error_m = 0;  // error_m 0: by any distance
};

// A surface over scattered ground points: at most so far from any of them in height, m (0: through all of them);
// triangles with an edge longer than longest_m in plan (0: none are) are left out, as gaps.
struct TinRule {
  double error_m = 0, longest_m = 0;
};

struct DraftGeometry {
  std::string name;
  Where where;
  enum class Kind { mesh, terrain, primitive, voxels } kind = Kind::mesh;
  SourceMesh mesh;
  SourceTerrain terrain;
  Primitive primitive;
  Affine3 to_local;                            // applied once to a mesh when it is read (units, up axis)
  Reference material;                          // of everything without a better one
  std::map<std::string, Reference> materials;  // `usemtl` name -> material id
  NormalRule normals = NormalRule::file;
  double crease_rad = kPi;  // facets that bend by more keep an edge where normals are made
  size_t fill_holes = 0;    // holes of at most so many edges are closed
  std::optional<DecimationRule> decimate;
  std::optional<TinRule> tin;  // the mesh has positions only, which libs/mesh puts triangles through
  double tile_m = 0;           // largest extent of one terrain tile
  bool failed = false;         // could not be read, which has been filed: only the name is sure
};

// When a placement is there and what it is made of.
struct DraftSchedule {
  struct Row {
    bool there = true;
    Reference material;  // none: what the placement says
  };
  TimeSpan life = kAlways;
  Timetable when;
  std::vector<Row> rows;
};

struct DraftPlacement {
  Where where;
  Reference target, material, tag, on;  // on: the terrain whose surface z counts from
  Affine3 to_parent;
  std::vector<Affine3> rows;  // of an instance table or a scatter; each before to_parent
  bool table = false;
  std::optional<ScatterRule> scatter;   // over the surface `on`
  std::shared_ptr<const Track> motion;  // null: at rest
  Where motion_where;
  std::optional<DraftSchedule> schedule;  // none: always there
};

struct DraftGroup {
  std::string name;
  Where where;
  std::vector<DraftPlacement> placements;
};

struct DraftMaterial {
  Where where;
  Material material;
  Reference inside, outside;  // media
  Reference map;              // a class map that decides instead
  bool has_model = false;
  std::optional<TemperatureSpec> temperature;
  std::vector<Reference> property_maps;
};

struct DraftClassMap {
  Where where;
  ClassMap map;                             // `materials` still empty; `classes` hold the values of the raster
  std::map<uint16_t, Reference> materials;  // value -> material id
};

struct DraftPropertyMap {
  Where where;
  PropertyMap map;                   // `materials` still empty
  std::vector<Reference> materials;  // mixture: of each channel
};

struct DraftMedium {
  Where where;
  Medium medium;
};

struct DraftGrid {
  Where where;
  VoxelGrid grid;  // `media` still empty
  std::vector<Reference> media;
  std::vector<std::vector<float>> shares;  // of each medium, per cell; empty = each cell has one medium
};

struct DraftVolume {
  Where where;
  Reference grid;
  Affine3 to_world;
  std::shared_ptr<const Track> motion;  // null: at rest
  Where motion_where;
};

struct SpectralWindow {
  double low_um = 0, high_um = 0;
  Where where;
};

// The span of time (s) that every motion must cover.
struct TimeWindowSpec {
  double begin = 0, end = 0;
  Where where;
};

struct Draft {
  std::string file, name, description, author;
  std::string epoch;  // UTC of second 0, or empty
  std::optional<TimeWindowSpec> times;
  GeodeticOrigin origin;
  std::optional<double> curvature_m;  // the scene is flat and to be laid onto the ellipsoid this exactly, m
  Where curvature_where;
  std::vector<SpectralWindow> windows;
  std::vector<DraftMaterial> materials;
  std::vector<DraftClassMap> class_maps;
  std::vector<DraftPropertyMap> property_maps;
  std::vector<DraftMedium> media;
  Reference ambient;
  std::vector<DraftGrid> grids;
  std::vector<DraftVolume> volumes;
  std::vector<DraftGeometry> geometry;
  std::vector<DraftGroup> groups;  // [0] = world
  std::vector<DataFile> files;
  std::set<std::string> failed_maps;  // could not be read, which has been filed: naming one is no second fault
  bool failed_placements = false;     // the same; what seems not to be placed may be
  std::vector<InputFile> inputs;
};

}  // namespace suite
