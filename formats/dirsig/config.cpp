// Configurations of DIRSIG3 (.cfg): their scene. Their platform has no counterpart in public descriptions.
#include <filesystem>

#include "formats/dirsig/motion.h"
#include "formats/dirsig/scene_writer.h"

namespace suite::dirsig {

void SceneWriter::read_config(const Item& config) {
  const std::string base = folder_of(file_);
  const auto folders = [&](const Item* paths, const char* key) {
    Folders list;
    if (const Item* path = paths ? paths->find(key) : nullptr) {
      path->mark(Fate::exact);
      list.push_back((std::filesystem::path(base) / path->value).lexically_normal().string());
    }
    list.push_back(base);
    return list;
  };
  const Item* paths = config.find("PATHS");
  scope_.folders = folders(paths, "ODB_PATH");
  for (const std::string& more : folders(paths, "GDB_PATH")) scope_.folders.push_back(more);
  ems_ = folders(paths, "EMISSIVITY_PATH"), ext_ = folders(paths, "EXTINCTION_PATH");
  abs_ = folders(paths, "ABSORPTION_PATH"), map_ = folders(paths, "MAPS_PATH"),
  source_ = folders(paths, "SOURCES_PATH");
  const Item& scene = config.at("SCENE");
  read_database(scene.at("MATERIAL_FILENAME"), folders(paths, "MATERIAL_PATH"));
  Tree origin = Tree::map(scene.where);
  origin.set("latitude_deg", Tree::number(scene.at("LATITUDE").number_in(-90, 90), scene.where));
  // West of Greenwich is positive there.
  const Item& longitude = scene.at("LONGITUDE");
  origin.set(
      "longitude_deg",
      Tree::number(-longitude.number_in(-180, 180, Fate::converted, "west is positive in DIRSIG3"), longitude.where));
  if (const Item* height = scene.find("GROUND_ALTITUDE"))
    origin.set("height_m",
               Tree::number(1000 * height->number(Fate::converted, "km; above sea level, taken as above the ellipsoid"),
                            height->where));
  root_.set("origin", std::move(origin));
  Tree& world = root_.list_at("world", where_);
  if (const Item* gdb = scene.find("GDB_FILENAME")) {
    double unit = 1;
    if (const Item* units = scene.find("GDB_UNITS")) {
      constexpr double metres[] = {1, 0.01, 0.3048, 0.0254};
      unit = metres[units->choice({"METERS", "CENTIMETERS", "FEET", "INCHES"})];
    }
    Tree one = Tree::map(gdb->where);
    one.set("place",
            Tree::word(mesh_file(import_.file_of(*gdb, scope_.folders), "gdb", unit, scope_, gdb->where), gdb->where));
    world.push(std::move(one));
  }
  if (const Item* odb = scene.find("ODB_FILENAME"))
    read_list_file(import_.file_of(*odb, scope_.folders), scope_, root_.list_at("world", where_));
  for (const char* key : {"DATE", "GMT_TIME", "LOCAL_TIME", "GMT_OFFSET"})
    if (const Item* item = scene.find(key); item && !item->fate())
      item->mark(Fate::ignored, "the date is the simulation's");
}

}  // namespace suite::dirsig
