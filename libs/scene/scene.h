// The scene: plain tables, no behaviour. Written by scene-prep, loaded by the renderer, immutable afterwards.
// Everything is in the scene's ENU frame, metres; base geometry has its own local frame.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "base/shared_array.h"
#include "math/vec.h"
#include "motion/timetable.h"
#include "optics/medium.h"
#include "optics/model_spec.h"
#include "thermal/temperature.h"

namespace suite {

class Track;       // motion/track.h
struct FlatPlane;  // scene/curvature.h
struct Mesh;

inline constexpr uint32_t kNone = 0xffffffffu;

// Faces of one `usemtl`/`g` run: a range of triangles with one material.
struct Part {
  std::string name;
  uint32_t first_triangle = 0, triangle_count = 0;
  uint32_t material = kNone;  // index into Scene::materials
};

// The arrays of a mesh that are parts of a mapped file: they have their places and sizes, and what they hold comes when
// it is asked for.
struct StoredArrays {
  Box3 box;                                // local, mesh origin included
  std::function<void(const Mesh&)> fetch;  // brings what they hold and checks it; Error when the file is damaged
  std::mutex turn;
  std::atomic<bool> here{false};
};

// Base geometry, in local metres. Vertices are float relative to a double origin, so that georeferenced coordinates
// lose nothing. Arrays are laid out for the ray tracer to share: positions has 3 floats a vertex and one pad float,
// which holds anything.
struct Mesh {
  std::string name;
  Vec3 origin;                    // local frame position of (0, 0, 0) of the floats
  SharedArray<float> positions;   // 3 * vertex_count + 1
  SharedArray<uint32_t> indices;  // 3 * triangle_count
  SharedArray<uint32_t> normals;  // octahedral, 2 x 16 bit snorm per vertex; empty = facet normals (oct.h)
  SharedArray<float> uvs;         // 2 per vertex; empty = none
  std::vector<Part> parts;        // cover all triangles, ascending
  std::shared_ptr<StoredArrays> stored = nullptr;  // null: the arrays are here
  size_t vertex_count() const { return positions.size() / 3; }
  size_t triangle_count() const { return indices.size() / 3; }
  size_t bytes() const { return 4 * (positions.size() + indices.size() + normals.size() + uvs.size()); }
  // Brings what the arrays hold if it is not here yet; from any thread. Whoever touches them first calls it: the ray
  // tracer before it builds over them, and those who come before any ray. Error when the file is damaged.
  void require() const;
  // Gives the memory of arrays that are parts of a file back; it is taken again as they are touched.
  void let_go() const;
};

// What a placement puts somewhere.
enum class TargetKind : uint8_t { mesh, group, primitive };

// Exact surfaces, in the primitive's own local frame; see FORMAT.md of scene_text for each one's parameters.
enum class PrimitiveKind : uint8_t { plane, disk, box, sphere, cone, cylinder, sinusoid };
struct Primitive {
  std::string name;
  PrimitiveKind kind = PrimitiveKind::sphere;
  std::vector<double> parameters;
  uint32_t material = kNone;
};

// An instance. `to_parent` may mirror and scale. With a track the target moves: target -> to_parent -> the body's axes
// -> the track's pose at the time -> parent.
struct Placement {
  Affine3 to_parent;
  TargetKind kind = TargetKind::mesh;
  uint32_t target = 0;  // index into meshes, groups or primitives
  uint32_t material_override = kNone;
  uint32_t tag = kNone;       // index into Scene::tags, for truth
  uint32_t track = kNone;     // index into Scene::tracks; kNone = at rest
  uint32_t schedule = kNone;  // index into Scene::schedules; kNone = always there and of one material
};

// When a placement is there, and what it is made of. Times count from the scene's epoch.
struct Schedule {
  std::string name;                // for messages
  TimeSpan life = kAlways;         // s: there from `begin` until just before `end`
  Timetable when;                  // before its first row: there, of its own materials
  std::vector<uint8_t> there;      // per row: within its life
  std::vector<uint32_t> material;  // per row: replaces all of the target's materials; kNone = what the placement says
};

// How something moves, in the frame of the group that places it (the root: ENU). Time counts from the scene's epoch.
struct SceneTrack {
  std::string name;  // for messages
  std::shared_ptr<const Track> track;
};

// A named group of placements; group 0 is the root and is in the ENU frame.
struct Group {
  std::string name;
  std::vector<Placement> placements;
};

// Where a vertical drape puts the pixels of a map: pixel (0, 0) has its outer corner at `origin`, columns go along +x
// (east) and rows along -y (south) with the given ground sample distances (negative flips).
struct Drape {
  double origin_x = 0, origin_y = 0;  // m, scene ENU
  double gsd_x = 1, gsd_y = 1;        // m
  enum class Extend : uint8_t { clamp, repeat, none } extend = Extend::clamp;
  std::shared_ptr<const FlatPlane> plane = nullptr;  // the flat plane that the map lies on; null: scene ENU itself
};
enum class Projection : uint8_t { drape, uv };

// A class map: one material per pixel.
struct ClassMap {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<uint16_t> classes;    // row-major, top row first: indices into `materials`
  std::vector<uint32_t> materials;  // class -> Scene::materials
  Projection projection = Projection::drape;
  Drape drape;
};

// Materials that a map decides: a material whose surface is looked up per point. Its own model holds where the map says
// nothing (outside of it under Extend::none); scene-prep fills it from the map's first class when none was given.
struct MapBinding {
  uint32_t material = kNone;   // the material id that geometry carries
  uint32_t class_map = kNone;  // index into Scene::class_maps
};

// Rasters of numbers that vary a material from point to point. mixture: one channel a material of `materials`,
// fractions that sum to 1 in every pixel. curve_index: one channel, whole numbers into `family`, which replaces the
// curve `parameter` of the model (texture maps are baked to this). cube: the curve `parameter` is piecewise linear
// through the channels, which stand at `wavelength_um`, and by `outside` beyond them. temperature: one channel, K.
// bump: one channel, height in m along the normal. normal: three channels, the normal in the tangent frame (any
// length). opacity: one channel, 0 to 1.
enum class MapKind : uint8_t { mixture, curve_index, cube, temperature, bump, normal, opacity };
struct PropertyMap {
  std::string name;
  MapKind kind = MapKind::mixture;
  uint32_t width = 0, height = 0, channels = 1;
  std::vector<float> values;          // row-major, top row first, channels together
  std::vector<uint32_t> materials;    // mixture: index into Scene::materials of each channel
  std::string parameter;              // curve_index, cube: a curve parameter of the material's model
  std::vector<Curve> family;          // curve_index
  std::vector<double> wavelength_um;  // cube: ascending
  Outside outside = Outside::hold;  // cube: what holds beyond the channels; error: states that reach there are refused
  // Between the pixels: the value of the pixel one is in, or linear between the four nearest pixel centres. Curve
  // numbers are never mixed; bumps are always linear.
  enum class Filter : uint8_t { nearest, linear } filter = Filter::nearest;
  Projection projection = Projection::drape;
  Drape drape;
};
struct PropertyBinding {
  uint32_t material = kNone, property_map = kNone;
};

// Cells with constant contents; x runs fastest. Cell (i, j, k) is [i, i+1] x [j, j+1] x [k, k+1] in index space.
struct VoxelGrid {
  std::string name;
  std::array<uint32_t, 3> cells{0, 0, 0};
  Affine3 to_local;                // index space -> the grid's own frame, m (cell size and origin)
  std::vector<float> density;      // per cell: scales the medium's coefficients
  std::vector<uint8_t> kind;       // per cell: index into `media`; empty = all are media[0]
  std::vector<uint32_t> media;     // indices into Scene::media
  std::vector<float> temperature;  // per cell, K, 0 = the medium's own; empty = all have the medium's own
  size_t size() const { return size_t{cells[0]} * cells[1] * cells[2]; }
};
// A grid of media somewhere: it adds to whatever else is there, be it another grid, a body or the ambient medium.
struct Volume {
  uint32_t grid = kNone;
  Affine3 to_world;        // the grid's own frame -> ENU, or the axes of the moving body
  uint32_t track = kNone;  // index into Scene::tracks; kNone = at rest
};
// A temperature model of a material, in place of its constant temperature. An empty model: layers for others to
// simulate.
struct TemperatureBinding {
  uint32_t material = kNone;
  TemperatureSpec spec;
};

// A file that a material's `texts` name and that travels inside the scene, e.g. an SQT.
struct DataFile {
  std::string name;  // unique within the scene
  std::vector<std::byte> bytes;
};

// The ENU tangent frame on WGS84.
struct GeodeticOrigin {
  double latitude_deg = 0, longitude_deg = 0;
  double ellipsoid_height_m = 0;
  bool given = false;
};

// tables.h has to know every table and every index in it.
struct Scene {
  std::string name, description, author;
  GeodeticOrigin origin;
  bool curved = false;  // laid from a flat plane onto the ellipsoid (curvature.h); drapes are on the plane
  std::vector<Mesh> meshes;
  std::vector<Primitive> primitives;
  std::vector<Group> groups;  // [0] = root
  std::vector<Material> materials;
  std::vector<ClassMap> class_maps;
  std::vector<MapBinding> map_bindings;
  std::vector<PropertyMap> property_maps;
  std::vector<PropertyBinding> property_bindings;  // a material may have several, one of each kind
  std::vector<Medium> media;
  uint32_t ambient = kNone;  // medium that fills everything no body fills
  std::vector<VoxelGrid> grids;
  std::vector<Volume> volumes;
  std::vector<TemperatureBinding> temperatures;  // at most one a material
  std::vector<std::string> tags;
  std::vector<SceneTrack> tracks;
  std::vector<Schedule> schedules;
  std::string epoch;  // UTC (ISO 8601) of second 0 of tracks and schedules; empty when none was given
  std::vector<DataFile> files;
  Box3 bounds;  // ENU
};

// Does a ray anywhere in the scene have to ask what it travels through?
bool uses_media(const Scene& scene);

// Error, naming the mesh, unless its arrays fit each other and, where they were stored, what was said of them.
void check_arrays(const Mesh& mesh, const std::string& file);

// Checks every index and size of a scene that was read from a file; Error naming the table otherwise.
void check_scene(const Scene& scene, const std::string& file);

// Extent of everything placed, ENU, from the corners of each target's own box (so rotated targets give a box that may
// be somewhat large); infinite primitives count as nothing. What moves counts with all places it has in the span (s),
// found by sampling: its box may be up to 1 % of its size short. What is not there does not count. Error: a track that
// does not cover the span.
Box3 scene_bounds(const Scene& scene, double begin = 0, double end = 0);

// Extent of one mesh in its local frame, origin included; empty without vertices.
Box3 mesh_box(const Mesh& mesh);
// The same from the vertices themselves, which must be here.
Box3 box_of_positions(const Mesh& mesh);
// The box around a transformed box; empty stays empty.
Box3 transformed(const Box3& box, const Affine3& map);

// Error naming the track and the span unless every track that a placement uses covers [begin, end], s, as far as the
// placement is there.
void check_motion(const Scene& scene, double begin, double end, const Where& where);
// Whether there is anything that moves, or comes, goes or changes: time windows then differ.
bool changes_in_time(const Scene& scene);
// A time (s) to look at a scene whose motions need not cover second 0: 0 if all do, else where the last one begins.
double time_of_all(const Scene& scene);

// Octahedral encoding of unit vectors in 2 x 16 bits; error below 5e-5 rad.
// Based on: Cigolle et al., "A survey of efficient representations for independent unit vectors", JCGT 3(2), 2014.
uint32_t oct_encode(Dir direction);
Dir oct_decode(uint32_t code);

}  // namespace suite
