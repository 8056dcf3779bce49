// What turns a Draft into a Scene, step by step; internal to bake.cpp and bake_materials.cpp.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "motion/time_span.h"
#include "scene/bake.h"

namespace suite {

template <class Table, class Name>
std::vector<std::string> names_of(const Table& table, Name name) {
  std::vector<std::string> names;
  for (const auto& row : table) names.push_back(name(row));
  return names;
}

class Baker {
 public:
  Baker(const Draft& draft, Report& report) : draft_(draft), report_(report) {}

  Scene run();

 private:
  // What a geometry became: the targets a placement of it places.
  struct Built {
    TargetKind kind;
    uint32_t first, count;
    const TerrainGrid* terrain = nullptr;
    bool failed = false;  // has been filed; placements of it say nothing more
  };

  void add(const char* code, const Where& where, const std::string& message) {
    report_.add(code, draft_.file, {where, message});
  }

  uint32_t material_id(const Reference& ref);
  void materials();
  void check_coverage(const DraftMaterial& m);
  void check_map_coverage(const DraftMaterial& m, const PropertyMap& map,
                          const std::function<void(const std::string&, const Curve&)>& check);
  void check_map_energy(const DraftMaterial& m, const PropertyMap& map, const Where& where);
  void check_times(const DraftMaterial& m);
  void class_maps();
  void take_surface(size_t m, const DraftMaterial& first);
  void property_maps();
  void check_parts(const PropertyMap& map, const Where& where);
  void geometry();
  Built build_mesh(const DraftGeometry& g);
  SourceTerrain on_plane(const SourceTerrain& terrain) const;
  void curve();
  Built build_terrain(const DraftGeometry& g);
  Built build_primitive(const DraftGeometry& g);
  void groups();
  void count_unfolded(const std::vector<size_t>& order);
  std::vector<size_t> group_order();
  std::optional<Built> target(const Reference& ref);
  std::vector<Affine3> transforms(const DraftPlacement& p);
  std::string terrains() const;
  bool put_on(const DraftPlacement& p, bool world, std::vector<Affine3>& all);
  void place(const DraftPlacement& p, Group& group, bool world);
  uint32_t schedule(const DraftSchedule& draft, const std::string& target, const Where& where);
  TimeSpan time_window();
  void unused();
  void report_endless_media();
  void report_shared_faces(double time);

  const Draft& draft_;
  Report& report_;
  Scene scene_;
  std::map<std::string, uint32_t> material_ids_, map_ids_, tag_ids_, group_ids_;
  std::map<std::string, Built> built_;
  std::vector<std::unique_ptr<TerrainGrid>> terrains_;
  std::vector<Where> motion_where_;  // of scene_.tracks
  std::set<std::string> used_materials_, used_maps_, used_targets_;
};

}  // namespace suite
