// The parts of the translation of scenes. Not for users of the format.
#pragma once
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>

#include "formats/dirsig/dirsig.h"
#include "formats/dirsig/ems.h"

namespace suite::dirsig {

// What holds for the geometry of one list.
struct Scope {
  Folders folders;                              // of geometry
  std::vector<const Item*> databases;           // the nearest first
  std::vector<std::string> prefixes;            // of ids, one a database
  std::vector<Folders> material_folders;        // of what a database's entries name
  std::map<std::string, std::string> assigned;  // ids that are replaced
};

// A material as geometry asks for it: the entry of the database that holds there, under an id of its own.
struct MaterialUse {
  const Item* entry;
  Folders folders;
  Scope scope;                        // in which its own maps name materials
  std::optional<double> kelvin = {};  // of facets, in place of the entry's solver
};

// Whether a reflectance of this name (in lower case) has parameters of facets: Shell, NEF, Priest & Germer.
bool is_facets(std::string_view kind);
struct FacetFit;

class SceneWriter {
 public:
  SceneWriter(Import& import, std::string file);
  SceneMade run();

 private:
  // scene.cpp
  void read_head(const Item& scene);
  void read_origin(const Item& location);
  void read_folders(const Item& scene);
  void read_database(const Item& named, const Folders& folders);
  void read_lists(const Item& list, const Scope& scope);
  void finish_materials();
  // config.cpp: scenes of DIRSIG3
  void read_config(const Item& config);
  // lists.cpp
  void read_list_file(const std::string& path, const Scope& scope, Tree& to);
  void read_glist(const Item& list, const Scope& scope, Tree& to);
  void read_object(const Item& object, const Scope& scope, Tree& to);
  std::string base_of(const Item& base, const Scope& scope);
  void read_instances(const Item& object, const Scope& scope, const std::vector<const Item*>& bases, Tree& to);
  void read_source(const Item& object, const Scope& scope);
  Tree placement_of(const Item& instance, const std::string& target);
  void read_assigned(const Item& from, Scope& scope) const;
  // odb.cpp
  void read_odb(const Item& odb, const Scope& scope, Tree& to);
  void read_odb_object(const Item& object, const Scope& scope, Tree& to);
  void read_odb_instance(const Item& info, const std::string& target, const Scope& scope, Tree& to);
  bool read_odb_primitive(const Item& item, const Scope& scope, Tree& to);
  void read_grid(const Item& grid, const Scope& scope, Tree& to);
  // shapes.cpp: objects of ours; each gives its name
  const std::pair<std::set<std::string>, bool>& asked_of(const std::string& path, bool gdb);
  std::string mesh_file(const std::string& path, const char* kind, double unit, const Scope& scope, const Where& where);
  std::string shape(const std::string& name, const char* kind, Tree parameters, const std::string& material,
                    const Where& where);
  std::string mesh_text(const std::string& name, const std::string& obj, const Where& where);
  std::string moved(const std::string& target, const std::array<double, 3>& by, const Where& where);
  std::string several(const std::string& name, Tree placements, const Where& where);
  std::string free_name(const std::string& wished);
  // primitives.cpp: of both kinds of list
  std::string sphere(const Item& from, double radius, const std::string& id);
  std::string ground(const Item& from, const std::string& id, const Item* checked, const std::string& other,
                     double width);
  std::string disk(const Item& from, double radius, const std::string& id);
  std::string secchi(const Item& from, double radius, const std::string& a, const std::string& b);
  std::string box(const Item& from, const std::array<double, 3>& low, const std::array<double, 3>& high,
                  const std::vector<std::string>& ids);
  std::string cylinder(const Item& from, const std::array<double, 3>& a, const std::array<double, 3>& b, double radius,
                       const std::string& id, bool cap_a, bool cap_b);
  std::string frustum(const Item& from, const std::array<double, 5>& sizes, const std::string& id);
  std::optional<std::string> glist_primitive(const Item& base, const Scope& scope);
  // materials.cpp
  std::string material(const std::string& id, const Scope& scope);
  Tree material_tree(const MaterialUse& use);
  void read_bulk(const std::string& id, const MaterialUse& use, Tree& to);
  bool read_source_material(const Item& entry) const;
  void write_lamps();
  // thermal.cpp
  void read_solvers(const Item& entry, Tree& to);
  void read_layer(const Item& solver, Tree& heat);
  void read_therm(const Item& solver, Tree& to);
  // surfaces.cpp
  void read_surface(const MaterialUse& use, Tree& to);
  bool read_emissivity(const Item& properties, const Folders& folders, Tree& to);
  bool read_reflectance(const Item& properties, const Folders& folders, Tree& to);
  bool read_ward(const Item& name, const Item& section, Tree& to);
  bool read_kernels(const Item& name, const Item& section, const Folders& folders, Tree& to);
  bool read_fit(const Item& name, const Item& section, const Folders& folders, Tree& to);
  void read_transmittance(const Item& properties, const Folders& folders, Tree& to);
  void flat_emissivity(const Item& entry, const Item& named, double specular, const Folders& folders, Tree& to);
  Tree curve_file(const Item& named, const Folders& folders, const char* what, double scale);
  const CurveFile& curves_of(const std::string& path, const char* kind);
  void reaches(const CurveFile& file);
  static CurveFile mean_reflectance(const CurveFile& file, const Item& named);
  // facets.cpp
  bool read_facets(const Item& name, const Item& section, const Folders& folders, Tree& to);
  const Item* facet_file(const Item& section, const Folders& folders);
  Tree body_of(const Item& section, const Folders& folders, const FacetFit& fit, const Where& where);
  // maps.cpp
  void read_maps(const Item& list, const Folders& folders);
  void read_map(const Item& map, const Folders& folders);
  void read_classes(const Item& map, bool channels, const Scope& scope, Tree& made);
  bool read_family(const Item& map, const MaterialUse* use, Tree& made);
  void read_bands(const Item& map, Tree& made);
  std::string write_map(const Item& map, const std::string& what, const std::string& path, const MaterialUse* use,
                        const Scope& scope);
  void use_map(const std::string& id, const std::string& what, const std::string& map);
  void read_projector(const Item& map, const std::string& image, Tree& to);
  void read_entry_maps(const MaterialUse& use, const std::string& id, Tree& to);

  Import& import_;
  std::string file_;
  Tree root_, lamps_;
  Where where_;  // of the scene as a whole
  Scope scope_;
  Folders ems_, ext_, abs_, map_, source_;
  std::set<const Item*> databases_;                                      // all that were named
  std::set<std::string> names_;                                          // of objects and groups
  std::map<std::string, std::pair<std::set<std::string>, bool>> asked_;  // of a mesh file; see asked_of
  std::map<std::string, std::string> meshes_;                            // what makes a mesh -> its object
  std::map<std::string, MaterialUse> uses_;                              // id in our text -> what it is
  std::deque<std::string> open_;                                         // ids that are still to be written
  std::map<std::string, std::vector<std::string>> maps_of_;              // id -> maps of ours that vary it
  std::map<std::string, std::string> map_names_;                         // of a material: the map that chooses instead
  std::map<std::string, CurveFile> curves_;
  std::vector<std::pair<const Item*, Scope>> sources_;  // objects of lamps
  std::optional<double> reach_um_;                      // where the first of a surface's curves ends
  bool heat_ = false;                                   // a material's temperature follows from weather
  std::string epoch_;
  int depth_ = 0;
};

// Three numbers below an element: x, y, z of it, or of the <point> or <cartesiantriple> in it.
std::array<double, 3> triple_of(const Item& item);
std::array<double, 3> triple_of_value(const Item& item);

}  // namespace suite::dirsig
