// What the parts of the scene text reader share.
#pragma once
#include <functional>
#include <map>
#include <optional>

#include "base/params.h"
#include "base/tracked_inputs.h"
#include "formats/curve/curve.h"
#include "formats/motion/motion.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/scene_text.h"
#include "formats/voxel/voxel.h"
#include "motion/map_projection.h"

namespace suite {
struct Raster;
struct SourceMaterial;
struct SourceModel;
struct WaterSpec;
}  // namespace suite

namespace suite::scene_text {

// projection and drape of a map.
void read_projection(const Params& p, Projection& projection, Drape& drape);

// What is wrong with a file is no fault of the text that names it.
template <class Read>
auto of_file(const Read& read) {
  try {
    return read();
  } catch (const Error& e) {
    if (!e.code().empty()) throw;
    throw Error(e.where(), e.message(), e.hint(), "SP003");
  }
}

// How display colours of a model become spectra; texels: of its images so far.
struct UpliftRule {
  bool by_texel = true;
  size_t classes = 64, texels = 0;
};

// A raster, and what an ENVI image says of its bands.
struct MapRaster : Raster {
  std::vector<double> wavelength_um;  // empty or one a channel
  std::vector<bool> bad;              // empty or one a channel
};

class Reader {
 public:
  Reader(TrackedInputs& inputs, Report& report, Draft& draft) : inputs_(inputs), report_(report), draft_(draft) {}
  void run(const Params& root);

 private:
  void read_head(const Params& root);
  void read_curvature(const Params& p, const Params& root);
  // materials.cpp
  void read_curves(const Params& list);
  void read_material(const std::string& id, const Params& p);
  Curve read_curve_value(const Params& p);
  Curve read_curve_map(const Params& p);
  void read_model(const Params& p, ModelSpec& spec);
  std::string embed(const Params& p);
  // A fitted quad-tree: the name of a file, or {file, outside}; and the rule that a key of the model names.
  void read_stored(const Params& p, ModelSpec& spec);
  void read_phase(const Params& p, ModelSpec& spec);
  std::optional<Curve> relative_index(const Params& p);
  // media.cpp
  void read_medium(const std::string& id, const Params& p);
  void read_coefficients(const Params& p, Medium& m);
  void read_leaves(const Params& p, Medium& m);
  // water.cpp
  void read_water(const Params& p, Medium& m);
  void read_waves(const Params& p, DraftGeometry& g);
  void read_measured_water(const Params& p, WaterSpec& spec);
  // media.cpp
  void read_grid(const std::string& name, const Params& p);
  void read_volume(const Params& p);
  void read_voxel_geometry(const Params& p, DraftGeometry& g);
  VoxelData read_any_voxels(const Params& p, const Params& file);
  // The voxels that a value names, with their raw files among the inputs.
  VoxelData read_voxel_input(const Params& p);
  // temperatures.cpp
  void read_thermal(const Params& p, DraftMaterial& m);
  void read_temperature(const Params& p, DraftMaterial& m);
  // geometry.cpp
  void read_geometry(const std::string& name, const Params& p);
  void read_terrain(const Params& p, DraftGeometry& g);
  void report_marks(const Params& file, const Raster& raster);
  void read_heights(const Params& p, SourceTerrain& terrain);
  void read_primitive(const Params& p, DraftGeometry& g, const std::string& kind);
  // meshes.cpp
  void read_mesh_rules(const Params& p, DraftGeometry& g);
  void read_mesh(const Params& p, const std::string& kind, DraftGeometry& g);
  void read_model(const Params& p, const std::string& kind, DraftGeometry g, size_t slot);
  void read_city_mesh(const Params& p, DraftGeometry& g);
  void read_obj_mesh(const Params& p, DraftGeometry& g);
  std::function<std::string(const std::string&)> beside(const Params& file);
  void forget_temperatures(const Params& p, SourceMesh& mesh);
  // textures.cpp
  std::array<double, 3> read_texture(const Params& p, const SourceMaterial& from, const std::string& id,
                                     UpliftRule& rule);
  void read_textures(const Params& p, const SourceModel& model, DraftGeometry& g);
  // points.cpp
  void read_points(const Params& p, DraftGeometry& g);
  VoxelData read_point_voxels(const Params& p, const Params& file);
  // map_places.cpp
  void read_origin(const Params& p);
  // How far heights over a geoid are to be raised: nothing for such over the ellipsoid.
  struct GeoidRule {
    bool geoid = false;
    std::optional<double> separation_m;  // none: by the origin's grid
  };
  GeoidRule read_heights_rule(const Params& p);
  // A system of maps: one of map_system.h, else one that PROJ knows.
  struct EarthMap {
    std::optional<MapSystem> system;
    std::shared_ptr<const MapProjection> projection;  // where there is no system
    bool geographic() const { return system ? !system->zone : projection->geographic(); }
    MapSystem::Heights heights() const { return system ? system->heights : projection->heights(); }
    std::string heights_name() const { return projection ? projection->heights_name() : "the geoid"; }
  };
  EarthMap earth_map(int epsg, const Where& where) const;
  void report_projection(const EarthMap& map, int epsg, const Params& file);
  std::string known_systems() const;
  std::function<Vec3(Vec3)> map_place(const Params& p, const std::string& system, const Params& file,
                                      bool longitude_first);
  std::function<Vec3(Vec3)> on_earth(const EarthMap& map, const GeoidRule& rule) const;
  // placements.cpp
  void read_group(const std::string& name, const Params& p);
  DraftPlacement read_placement(const Params& p, bool world);
  // traffic.cpp
  DraftPlacement read_vehicle(const Params& p);
  void read_traffic(const Params& p, bool world, std::vector<DraftPlacement>& to);
  MotionContext motion_context(bool world);
  std::optional<DraftSchedule> read_schedule(const Params& p, const MotionContext& context);
  // maps.cpp
  void read_map(const std::string& name, const Params& p);
  void read_class_map(const std::string& name, const Params& p);
  // rasters.cpp
  // The raster of a map or terrain `p`: an ENVI image by its extension .img, else as formats/raster reads it.
  enum class Pixels { any, cube };  // cube: an ENVI image whatever its extension
  MapRaster pixels_of(const Params& p, const Params& file, Pixels kind = Pixels::any);
  // What its numbers stand for by the file, unless `p` has a scale or an offset (the names of those keys); NaN in gaps.
  std::vector<float> values_in(const Params& p, const Params& file, Raster&& raster, const char* scale,
                               const char* offset);
  void leave_bad_bands(const Params& file, MapRaster& raster);
  static void refuse_nan(const Params& p, const Params& file, const Raster& raster);
  // mark: of missing values, for messages.
  void close_gaps(const Params& p, const Params& file, double mark, PropertyMap& map);
  // property_maps.cpp
  void read_property_map(const std::string& name, const Params& p, const std::string& type);
  void check_cube(const Params& p, const MapRaster& cube, PropertyMap& map);
  std::vector<Curve> read_family(const Params& p);
  CurveOptions curve_options();  // those whose findings go into the report

  // Runs one item; what it throws is filed and the next item goes on. p: the item's text, not searched for unknown keys
  // any more when it failed. code: of faults that bring none.
  void item(const char* code, const Params& p, const std::function<void()>& read);
  // The file a value names, looked for beside the text and in the search folders; hashed into the inputs.
  std::string input(const Params& p);
  void header_input(const std::string& name);
  static Reference reference(const Params& p) { return {p.as_text(), p.where()}; }

  TrackedInputs& inputs_;
  Report& report_;
  Draft& draft_;
  std::map<std::string, Curve> curves_;
  std::map<std::string, std::shared_ptr<const sqt::Bundle>> stored_;  // name in the scene -> what it holds
  std::map<std::string, std::string> embedded_;                       // resolved path -> name in the scene
  std::optional<Geoid> geoid_;                                        // the origin's
  std::vector<DraftGroup> models_;                                    // of objects that are groups; after `world`
};

}  // namespace suite::scene_text
