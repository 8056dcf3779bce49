// The tables of a scene, one descriptor each: what a new table has to say of itself so that check_scene,
// combine_scenes, the prepared scene (formats/scene_hdf) and the summary know it. A new table is a member of Scene, a
// descriptor here and its name in for_each_table.
//
// A descriptor has
//   name, one         what the table and a row of it are called; `name` is also its place in a prepared scene
//   rows              the member of Scene
//   title(row, k)     a row as messages call it
// and, where there is something to say,
//   indices(row, v)   v.must<Table>(index) or v.may<Table>(index), which may be kNone, for every index of a row
//   check(...)        what else must hold of a row; fault(text) throws
//   columns(io)       how rows are stored, in the words of formats/scene_hdf/columns.h; a table without it has a
//                     write_table and a read_table there
//   summary(scene)    its lines in the summary; without it: how many rows there are, if any
//   feature           what a scene is said to use when there are rows
#pragma once
#include <functional>
#include <string>

#include "scene/scene.h"

namespace suite {

// Throws the Error of a scene that was read from a file; see check_scene.
using SceneFault = std::function<void(const std::string& what)>;

struct MeshTable {
  static constexpr const char *name = "meshes", *one = "mesh";
  static constexpr auto rows = &Scene::meshes;
  static std::string title(const Mesh& m, size_t) { return "mesh '" + m.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& m, const Visit& v);
  static constexpr bool heavy = true;  // rows are checked by several threads
  static void check(const Scene& scene, const Mesh& m, size_t k, const SceneFault& fault);
  static std::string summary(const Scene& scene);
};

struct PrimitiveTable {
  static constexpr const char *name = "primitives", *one = "primitive", *feature = "exact primitives";
  static constexpr auto rows = &Scene::primitives;
  static std::string title(const Primitive& p, size_t) { return "primitive '" + p.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& p, const Visit& v);
  template <class Io>
  static void columns(Io& io) {
    io.names("name", &Primitive::name);
    io.value("kind", "1", &Primitive::kind, PrimitiveKind::sinusoid);
    io.value("material", "1", &Primitive::material);
    io.template list<uint32_t>("parameters", "SI", "parameter_count", &Primitive::parameters);
  }
};

struct GroupTable {
  static constexpr const char *name = "groups", *one = "group";
  static constexpr auto rows = &Scene::groups;
  static std::string title(const Group& g, size_t) { return "group '" + g.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& g, const Visit& v);
  static void check(const Scene& scene, const Group& g, size_t k, const SceneFault& fault);
  static std::string summary(const Scene& scene);
};

struct TagTable {
  static constexpr const char *name = "tags", *one = "tag";
  static constexpr auto rows = &Scene::tags;
  static std::string title(const std::string& tag, size_t) { return "tag '" + tag + "'"; }
};

struct TrackTable {
  static constexpr const char *name = "tracks", *one = "motion", *feature = "motion";
  static constexpr auto rows = &Scene::tracks;
  static std::string title(const SceneTrack& t, size_t) { return "motion of " + t.name; }
  static void check(const Scene& scene, const SceneTrack& t, size_t k, const SceneFault& fault);
};

struct ScheduleTable {
  static constexpr const char *name = "schedules", *one = "schedule", *feature = "schedules";
  static constexpr auto rows = &Scene::schedules;
  static std::string title(const Schedule& s, size_t) { return "schedule of " + s.name; }
  template <class Row, class Visit>
  static void indices(Row& s, const Visit& v);
  static void check(const Scene& scene, const Schedule& s, size_t k, const SceneFault& fault);
};

struct MaterialTable {
  static constexpr const char *name = "materials", *one = "material";
  static constexpr auto rows = &Scene::materials;
  static std::string title(const Material& m, size_t) { return "material '" + m.id + "'"; }
  template <class Row, class Visit>
  static void indices(Row& m, const Visit& v);
  static std::string summary(const Scene& scene);
};

struct ClassMapTable {
  static constexpr const char *name = "class_maps", *one = "class map", *feature = "class maps";
  static constexpr auto rows = &Scene::class_maps;
  static std::string title(const ClassMap& m, size_t) { return "class map '" + m.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& m, const Visit& v);
  static void check(const Scene& scene, const ClassMap& m, size_t k, const SceneFault& fault);
  static std::string summary(const Scene& scene);
  template <class Io>
  static void columns(Io& io) {
    io.names("name", &ClassMap::name);
    io.template numbers<uint32_t, 2>(
        "size", "1",
        [](const ClassMap& m) {
          return std::array{m.width, m.height};
        },
        [](ClassMap& m, const uint32_t* size) {
          m.width = size[0], m.height = size[1];
          return true;
        });
    io.template numbers<uint8_t, 2>(
        "rule", "1",
        [](const ClassMap& m) {
          return std::array{static_cast<uint8_t>(m.projection), static_cast<uint8_t>(m.drape.extend)};
        },
        [](ClassMap& m, const uint8_t* rule) {
          m.projection = static_cast<Projection>(rule[0]), m.drape.extend = static_cast<Drape::Extend>(rule[1]);
          return m.projection <= Projection::uv && m.drape.extend <= Drape::Extend::none;
        });
    io.template numbers<double, 4>(
        "drape", "m",
        [](const ClassMap& m) {
          return std::array{m.drape.origin_x, m.drape.origin_y, m.drape.gsd_x, m.drape.gsd_y};
        },
        [](ClassMap& m, const double* d) {
          m.drape.origin_x = d[0], m.drape.origin_y = d[1], m.drape.gsd_x = d[2], m.drape.gsd_y = d[3];
          return true;
        });
    io.template list<uint32_t>("materials", "1", "material_count", &ClassMap::materials);
    io.values("classes", "1", &ClassMap::classes, [](const ClassMap& m) { return uint64_t{m.width} * m.height; });
  }
};

struct MapBindingTable {
  static constexpr const char *name = "map_bindings", *one = "map binding";
  static constexpr auto rows = &Scene::map_bindings;
  static std::string title(const MapBinding&, size_t) { return "a map binding"; }
  template <class Row, class Visit>
  static void indices(Row& b, const Visit& v);
  template <class Io>
  static void columns(Io& io) {
    io.value("material", "1", &MapBinding::material);
    io.value("class_map", "1", &MapBinding::class_map);
  }
  static std::string summary(const Scene&) { return {}; }
};

struct FileTable {
  static constexpr const char *name = "files", *one = "file", *feature = "embedded files";
  static constexpr auto rows = &Scene::files;
  static std::string title(const DataFile& f, size_t) { return "file '" + f.name + "'"; }
  template <class Io>
  static void columns(Io& io) {
    io.names("name", &DataFile::name);
    io.template list<uint64_t>("bytes", "1", "size", &DataFile::bytes);
  }
};

struct PropertyMapTable {
  static constexpr const char *name = "property_maps", *one = "property map";
  static constexpr auto rows = &Scene::property_maps;
  static std::string title(const PropertyMap& m, size_t) { return "map '" + m.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& m, const Visit& v);
  static void check(const Scene& scene, const PropertyMap& m, size_t k, const SceneFault& fault);
};

struct PropertyBindingTable {
  static constexpr const char *name = "property_bindings", *one = "map binding";
  static constexpr auto rows = &Scene::property_bindings;
  static std::string title(const PropertyBinding&, size_t) { return "a map binding"; }
  template <class Row, class Visit>
  static void indices(Row& b, const Visit& v);
  template <class Io>
  static void columns(Io& io) {
    io.value("material", "1", &PropertyBinding::material);
    io.value("property_map", "1", &PropertyBinding::property_map);
  }
  static std::string summary(const Scene&) { return {}; }
};

struct MediumTable {
  static constexpr const char *name = "volume_media", *one = "medium";
  static constexpr auto rows = &Scene::media;
  static std::string title(const Medium& m, size_t) { return "medium '" + m.id + "'"; }
  static std::string summary(const Scene& scene);
};

struct GridTable {
  static constexpr const char *name = "grids", *one = "grid";
  static constexpr auto rows = &Scene::grids;
  static std::string title(const VoxelGrid& g, size_t) { return "voxel grid '" + g.name + "'"; }
  template <class Row, class Visit>
  static void indices(Row& g, const Visit& v);
  static void check(const Scene& scene, const VoxelGrid& g, size_t k, const SceneFault& fault);
  static std::string summary(const Scene& scene);
};

struct VolumeTable {
  static constexpr const char *name = "volumes", *one = "volume", *feature = "voxel grids";
  static constexpr auto rows = &Scene::volumes;
  static std::string title(const Volume&, size_t) { return "a volume"; }
  template <class Row, class Visit>
  static void indices(Row& v, const Visit& visit);
  static void check(const Scene& scene, const Volume& v, size_t k, const SceneFault& fault);
  template <class Io>
  static void columns(Io& io) {
    io.value("grid", "1", &Volume::grid);
    io.transform("to_world", "m", &Volume::to_world);
    io.value("track", "1", &Volume::track);
  }
};

struct TemperatureTable {
  static constexpr const char *name = "temperatures", *one = "temperature";
  static constexpr auto rows = &Scene::temperatures;
  static std::string title(const TemperatureBinding&, size_t) { return "a temperature"; }
  template <class Row, class Visit>
  static void indices(Row& t, const Visit& v);
};

// Calls f(Table{}) for every table, in the order in which a prepared scene has them.
template <class F>
void for_each_table(const F& f) {
  f(MeshTable{}), f(PrimitiveTable{}), f(GroupTable{}), f(TagTable{}), f(TrackTable{}), f(MaterialTable{});
  f(ClassMapTable{}), f(MapBindingTable{}), f(FileTable{}), f(PropertyMapTable{}), f(PropertyBindingTable{});
  f(MediumTable{}), f(GridTable{}), f(VolumeTable{}), f(TemperatureTable{}), f(ScheduleTable{});
}

template <class Row, class Visit>
void MeshTable::indices(Row& m, const Visit& v) {
  for (auto& part : m.parts) v.template may<MaterialTable>(part.material);
}
template <class Row, class Visit>
void PrimitiveTable::indices(Row& p, const Visit& v) {
  v.template may<MaterialTable>(p.material);
}
template <class Row, class Visit>
void GroupTable::indices(Row& g, const Visit& v) {
  for (auto& p : g.placements) {
    if (p.kind == TargetKind::mesh) v.template must<MeshTable>(p.target);
    if (p.kind == TargetKind::group) v.template must<GroupTable>(p.target);
    if (p.kind == TargetKind::primitive) v.template must<PrimitiveTable>(p.target);
    v.template may<MaterialTable>(p.material_override);
    v.template may<TagTable>(p.tag);
    v.template may<TrackTable>(p.track);
    v.template may<ScheduleTable>(p.schedule);
  }
}
template <class Row, class Visit>
void ScheduleTable::indices(Row& s, const Visit& v) {
  for (auto& id : s.material) v.template may<MaterialTable>(id);
}
template <class Row, class Visit>
void MaterialTable::indices(Row& m, const Visit& v) {
  v.template may<MediumTable>(m.inside);
  v.template may<MediumTable>(m.outside);
}
template <class Row, class Visit>
void ClassMapTable::indices(Row& m, const Visit& v) {
  for (auto& id : m.materials) v.template must<MaterialTable>(id);
}
template <class Row, class Visit>
void MapBindingTable::indices(Row& b, const Visit& v) {
  v.template must<MaterialTable>(b.material);
  v.template must<ClassMapTable>(b.class_map);
}
template <class Row, class Visit>
void PropertyMapTable::indices(Row& m, const Visit& v) {
  for (auto& id : m.materials) v.template must<MaterialTable>(id);
}
template <class Row, class Visit>
void PropertyBindingTable::indices(Row& b, const Visit& v) {
  v.template must<MaterialTable>(b.material);
  v.template must<PropertyMapTable>(b.property_map);
}
template <class Row, class Visit>
void GridTable::indices(Row& g, const Visit& v) {
  for (auto& m : g.media) v.template must<MediumTable>(m);
}
template <class Row, class Visit>
void VolumeTable::indices(Row& volume, const Visit& v) {
  v.template must<GridTable>(volume.grid);
  v.template may<TrackTable>(volume.track);
}
template <class Row, class Visit>
void TemperatureTable::indices(Row& t, const Visit& v) {
  v.template must<MaterialTable>(t.material);
}

}  // namespace suite
