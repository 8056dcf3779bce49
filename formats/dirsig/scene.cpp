// The scene itself (.scene): its head, its folders, its lists of geometry.
#include <algorithm>
#include <filesystem>
#include <map>

#include "base/files.h"
#include "formats/dirsig/gdb.h"
#include "formats/dirsig/motion.h"
#include "formats/dirsig/scene_writer.h"

namespace suite::dirsig {

namespace {

bool ends_with(const std::string& path, std::string_view end) { return lower_case(path).ends_with(end); }

// A configuration of DIRSIG3 has these sections, and no other format here.
bool is_config(const std::string& path, std::string_view head) {
  return ends_with(path, ".cfg") && (head.find("SCENE") != head.npos || head.find("PATHS") != head.npos);
}

std::string inside(const std::string& folder, const std::string& name) {
  if (folder.empty() || std::filesystem::path(name).is_absolute()) return name;
  return (std::filesystem::path(folder) / name).lexically_normal().string();
}

}  // namespace

bool is_scene(const std::string& path, std::string_view head) {
  return ends_with(path, ".scene") || is_config(path, head);
}
bool is_simulation(const std::string& path, std::string_view head) {
  return ends_with(path, ".sim") || ends_with(path, ".jsim") || is_config(path, head);
}

std::string obj_of_gdb(std::string_view text, const std::string& file) { return parse_gdb(text, file).obj; }

SceneMade scene_of(Import& import, const std::string& file) { return SceneWriter(import, file).run(); }

SceneWriter::SceneWriter(Import& import, std::string file) : import_(import), file_(std::move(file)) {
  where_ = {file_, 1, 1, {}, -1};
  root_ = Tree::map(where_);
  lamps_ = Tree::list(where_);
  import_.set_variable("SCENE_DIR", folder_of(file_).empty() ? "." : folder_of(file_));
}

SceneMade SceneWriter::run() {
  root_.set("scene", Tree::number(1, where_));
  if (ends_with(file_, ".cfg")) {
    read_config(import_.sections(file_, "configuration", "cfg"));
  } else {
    const Item& scene = import_.xml(file_, "scene");
    if (scene.name != "classicscene")
      throw scene.error("the root is <" + scene.name + ">", "a scene of DIRSIG begins with <classicscene>");
    read_head(scene);
    read_folders(scene);
    root_.list_at("world", where_);
    const Item& lists = scene.at("geometrylist");
    read_lists(lists, scope_);
    if (const Item* maps = scene.find("maplist")) read_maps(*maps, map_);
  }
  finish_materials();
  write_lamps();
  if (!epoch_.empty()) root_.set("epoch", Tree::word(epoch_, where_));
  SceneMade made;
  made.text = print(root_, {"made from " + file_ + " by the import of DIRSIG's files"});
  made.lamps = lamps_;
  made.epoch = epoch_;
  made.heat = heat_;
  if (Tree* origin = root_.find("origin")) {
    const auto number = [&](const char* key) { return number_in_text(origin->find(key)->text).value_or(0); };
    made.origin = {number("latitude_deg"), number("longitude_deg"), origin->find("height_m") ? number("height_m") : 0};
  }
  return made;
}

void SceneWriter::read_head(const Item& scene) {
  if (const Item* name = scene.find("@name"))
    root_.set("name", Tree::word(name->value, name->where)), name->mark(Fate::exact);
  if (const Item* metadata = scene.find("metadata"))
    for (const Item* entry : metadata->all("entry")) {
      const Item &name = entry->at("name"), *value = entry->find("value");
      const std::string low = lower_case(name.value);
      const char* key = low == "name"                           ? "name"
                        : low == "description"                  ? "description"
                        : low == "author(s)" || low == "author" ? "author"
                                                                : nullptr;
      if (!key) {
        entry->mark_all(Fate::ignored, "scene texts have no place for it");
        continue;
      }
      name.mark(Fate::exact);
      if (!value) continue;
      value->mark(Fate::exact);
      if (!value->value.empty()) root_.set(key, Tree::word(value->value, value->where));
    }
  if (const Item* origin = scene.find("sceneorigin")) read_origin(origin->at("location"));
  if (const Item* properties = scene.find("properties"))
    properties->mark_all(Fate::ignored, "spectra are kept on their own grids, and nothing is left out by size");
  for (const char* name : {"thumbnaillist", "landmarks", "landmarklist"})
    if (const Item* list = scene.find(name)) list->mark_all(Fate::ignored, "of DIRSIG's own windows");
}

void SceneWriter::read_origin(const Item& location) {
  Tree place = Tree::map(location.where);
  set_location(location, place);
  Tree origin = Tree::map(location.where);
  for (const char* key : {"latitude_deg", "longitude_deg", "height_m"})
    if (Tree* value = place.find(key)) origin.set(key, *value);
  if (!origin.find("latitude_deg")) throw location.error("the origin is no place on the Earth", "frame=\"geodetic\"");
  root_.set("origin", std::move(origin));
}

void SceneWriter::read_folders(const Item& scene) {
  std::string base = folder_of(file_);
  if (const Item* named = scene.find("scenebasedirectory"); named && !named->value.empty()) {
    named->mark(Fate::exact);
    if (named->value != "$SCENE_DIR") base = inside(base, named->value);
  }
  import_.set_variable("SCENE_DIR", base.empty() ? "." : base);
  const auto folders = [&](const char* name) {
    Folders list;
    for (const Item* one : scene.all(name)) {
      std::string path = one->value;
      for (char& c : path) c = c == '\\' ? '/' : c;
      if (path.starts_with("$SCENE_DIR")) path = path.size() > 11 ? path.substr(11) : ".";
      const bool usable = !path.empty() && !path.starts_with('$');
      std::error_code unknown;
      const bool there = usable && std::filesystem::is_directory(inside(base, path), unknown);
      one->mark(there ? Fate::exact : Fate::ignored, there ? "" : "there is no such folder");
      if (usable) list.push_back(inside(base, path));
    }
    list.push_back(base);
    return list;
  };
  scope_.folders = folders("odbdirectory");
  for (const std::string& more : folders("gdbdirectory")) scope_.folders.push_back(more);
  ems_ = folders("emsdirectory"), ext_ = folders("extdirectory"), abs_ = folders("absdirectory");
  source_ = folders("srcdirectory"), map_ = folders("mapdirectory");
  if (const Item* database = scene.find("matfilename")) {
    Folders all = {base};
    for (const std::string& more : folders("matdirectory")) all.push_back(more);
    read_database(*database, all);
  }
}

void SceneWriter::read_database(const Item& named, const Folders& folders) {
  const std::string path = import_.file_of(named, folders);
  const Item& base = import_.sections(path, "material database", "mat");
  databases_.insert(&base);
  scope_.databases.push_back(&base);
  scope_.prefixes.push_back("");
  scope_.material_folders.push_back({folder_of(path)});
}

void SceneWriter::read_lists(const Item& list, const Scope& scope) {
  if (const Item* enabled = list.find("@enabled"); enabled && !enabled->boolean()) {
    list.mark_all(Fate::ignored, "disabled");
    return;
  }
  for (const Item* include : list.all("geometrylistinclude")) {
    if (const Item* enabled = include->find("@enabled"); enabled && !enabled->boolean()) {
      include->mark_all(Fate::ignored, "disabled");
      continue;
    }
    if (const Item* name = include->find("@name")) name->mark(Fate::ignored, "a name for people");
    read_list_file(import_.file_of(*include, scope.folders), scope, root_.list_at("world", where_));
  }
}

namespace {

// Entries that nobody asked for: of materials that nothing has, or of an ID that an entry above them has, too.
void mark_unused_materials(const Item& base) {
  std::map<std::string, int, std::less<>> lines;
  for (const Item& entry : base.children) {
    if (entry.name != "MATERIAL_ENTRY") continue;
    const auto id = std::find_if(entry.children.begin(), entry.children.end(),
                                 [](const Item& key) { return key.name == "ID" || key.name == "MATERIAL_ID"; });
    const auto before = id == entry.children.end() ? lines.end() : lines.find(id->value);
    if (before != lines.end())
      entry.mark_all(Fate::unsupported,
                     strf("'%s' is given in line %d, too, which holds", before->first.c_str(), before->second));
    else if (!entry.seen())
      entry.mark_all(Fate::ignored, "no geometry and no map has this material");
    if (id != entry.children.end() && entry.seen()) lines.emplace(id->value, entry.where.line);
  }
}

}  // namespace

void SceneWriter::finish_materials() {
  // Writing one may ask for others.
  while (!open_.empty()) {
    const std::string id = open_.front();
    open_.pop_front();
    Tree tree = material_tree(uses_.at(id));
    read_bulk(id, uses_.at(id), tree);
    read_entry_maps(uses_.at(id), id, tree);
    root_.map_at("materials", where_).set(id, std::move(tree));
  }
  for (const Item* base : databases_) mark_unused_materials(*base);
}

}  // namespace suite::dirsig
