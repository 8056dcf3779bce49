// Property maps: of the scene's <maplist>, and of entries of material databases.
#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "formats/dirsig/scene_writer.h"

namespace suite::dirsig {

namespace {

// Rows and columns of an image, from its first bytes: PNG, PGM and PPM, or the header of an ENVI image.
std::optional<std::array<size_t, 2>> size_of_image(const std::string& path) {
  const RandomAccessFile file(path);
  std::string head(std::min<size_t>(file.size(), 4096), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(head)));
  const auto byte = [&](size_t i) { return static_cast<size_t>(static_cast<unsigned char>(head[i])); };
  if (head.size() > 24 && head.compare(1, 3, "PNG") == 0) {
    const auto big = [&](size_t i) { return (byte(i) << 24) + (byte(i + 1) << 16) + (byte(i + 2) << 8) + byte(i + 3); };
    return std::array<size_t, 2>{big(16), big(20)};
  }
  if (head.size() > 2 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6') {
    std::vector<double> sizes;
    for (const std::string_view line : words_of(std::string_view(head).substr(2), "\r\n"))
      for (const std::string_view word : words_of(line.substr(0, line.find('#')), " \t"))
        if (const auto v = number_in_text(word); v && sizes.size() < 2) sizes.push_back(*v);
    if (sizes.size() == 2) return std::array<size_t, 2>{static_cast<size_t>(sizes[0]), static_cast<size_t>(sizes[1])};
  }
  for (const std::string& header : {path + ".hdr", path.substr(0, path.rfind('.')) + ".hdr"}) {
    if (!file_exists(header)) continue;
    std::array<size_t, 2> size{};
    const std::string text = read_text(header, size_t{64} << 20);
    for (const std::string_view line : words_of(text, "\r\n")) {
      const size_t equals = std::min(line.find('='), line.size());
      const std::string key = lower_case(trimmed(line.substr(0, equals)));
      const auto value = equals < line.size() ? number_in_text(line.substr(equals + 1)) : std::nullopt;
      if (value && key == "samples") size[0] = static_cast<size_t>(*value);
      if (value && key == "lines") size[1] = static_cast<size_t>(*value);
    }
    if (size[0] && size[1]) return size;
  }
  return std::nullopt;
}

const char* extend_of(const Item* attribute) {
  if (!attribute) return "repeat";
  const std::string how = lower_case(attribute->value);
  const bool known = how == "repeat" || how == "clamp" || how == "none";
  attribute->mark(known             ? Fate::exact
                  : how == "mirror" ? Fate::approximated
                                    : Fate::unsupported,
                  known ? "" : "maps repeat here without being mirrored");
  return how == "clamp" ? "clamp" : how == "none" ? "none" : "repeat";
}

bool truth(const Item* flag) { return flag && flag->boolean(); }

}  // namespace

void SceneWriter::read_maps(const Item& list, const Folders& folders) {
  for (const Item& map : list.children) {
    if (map.name.starts_with('@')) continue;
    if (const Item* enabled = map.find("@enabled"); enabled && !enabled->boolean()) {
      map.mark_all(Fate::ignored, "disabled");
      continue;
    }
    read_map(map, folders);
  }
}

void SceneWriter::read_projector(const Item& map, const std::string& image, Tree& to) {
  const Item* projector = map.find("projector");
  const Item& from = projector ? *projector : map;
  const Item* uv = from.any({"uvprojector", "UV_PROJECTOR"});
  const Item *fx = from.any({"@flipx"}), *fy = from.any({"@flipy"});
  const bool flip_x = truth(fx) || (uv && truth(uv->find("FLIPX"))),
             flip_y = truth(fy) || (uv && truth(uv->find("FLIPY")));
  const char* extend = extend_of(from.find("@extendx"));
  extend_of(from.find("@extendy"));
  const Item* origin = from.find("@origin");
  const bool cartesian = origin && origin->choice({"cartesian", "image"}) == 0;
  const bool drapes = from.any({"drapeprojector", "drape", "DRAPE_PROJECTOR", "DRAPE", "gsd"}) != nullptr;
  if (uv || !drapes) {
    (uv ? *uv : from)
        .mark(uv ? Fate::exact : Fate::approximated, uv ? "" : "no projector is said: by texture coordinates");
    if (flip_x || flip_y)
      for (const Item* flag : {fx, fy, uv ? uv->find("FLIPX") : nullptr, uv ? uv->find("FLIPY") : nullptr})
        if (flag) flag->mark(Fate::unsupported, "maps by texture coordinates are not flipped");
    to.set("projection", Tree::word("uv", from.where));
    to.set("extend", Tree::word(extend, from.where));
    return;
  }
  const Item* drape = from.any({"drapeprojector", "drape", "DRAPE_PROJECTOR", "DRAPE"});
  const Item& place = drape ? *drape : from;
  const Item *insert = place.any({"insertpoint", "insert", "origin", "INSERT_POINT", "INSERT"}),
             *gsd = place.any({"gsd", "GSD"});
  if (!gsd) throw from.error("a map without <uvprojector> needs a <gsd>");
  const std::vector<double> g = gsd->numbers();
  std::vector<double> at{0, 0};
  if (insert) {
    const Item* inner = insert->any({"point", "cartesiantriple"});
    const Item& p = inner ? *inner : *insert;
    at = p.has("x") ? std::vector<double>{p.at("x").number(), p.at("y").number()} : p.numbers();
    if (p.has("x") && p.has("z")) p.at("z").mark(Fate::ignored, "maps fall along z");
  }
  if (at.size() < 2) throw insert->error("an insert point is x and y");
  const double gx = g[0], gy = g.size() > 1 ? g[1] : g[0];
  const auto size = size_of_image(image);
  if (!size) throw map.error("the size of the image '" + image + "' cannot be found", "PNG, PGM, PPM or ENVI");
  const double wide = gx * static_cast<double>((*size)[0]), high = gy * static_cast<double>((*size)[1]);
  // Ours begins at the outer corner of the first pixel, rows going south.
  const double left = at[0], top = cartesian || !origin ? at[1] + high : at[1];
  from.mark(Fate::approximated, cartesian || !origin
                                    ? "the insert point is taken as the lower left corner of the image"
                                    : "the insert point is taken as the upper left corner of the image");
  Tree& made = to.set("drape", Tree::map(place.where));
  made.set("origin", Tree::numbers({flip_x ? left + wide : left, flip_y ? top - high : top}, place.where));
  made.set("gsd", Tree::numbers({flip_x ? -gx : gx, flip_y ? -gy : gy}, place.where));
  made.set("extend", Tree::word(extend, place.where));
}

// Materials of digital counts, or of the channels of a mixture.
void SceneWriter::read_classes(const Item& map, bool channels, const Scope& scope, Tree& made) {
  Tree& materials = made.set("materials", channels ? Tree::list(map.where) : Tree::map(map.where));
  const Item* table = map.any({"dcmatlut", "materiallist", "matlut", "LUT"});
  if (!table) throw map.error("a map without a table of materials", "<dcmatlut>");
  const auto add = [&](const std::string& count, const std::string& id, const Where& where) {
    Tree mine = Tree::word(material(id, scope), where);
    if (channels)
      materials.push(std::move(mine));
    else
      materials.set(count, std::move(mine));
  };
  std::vector<const Item*> entries = table->all("entry");
  // Of a mixture the counts are the channels' numbers.
  if (channels) {
    for (const Item* entry : entries)
      entry->at("dc").number(Fate::converted, "channels follow each other in the order of their numbers");
    std::stable_sort(entries.begin(), entries.end(), [](const Item* a, const Item* b) {
      return a->at("dc").number(Fate::converted) < b->at("dc").number(Fate::converted);
    });
    for (size_t i = 1; i < entries.size(); ++i)
      if (entries[i]->at("dc").number(Fate::converted) != entries[i - 1]->at("dc").number(Fate::converted) + 1)
        entries[i]->at("dc").mark(Fate::approximated,
                                  "not the number after the last one: the next channel all the same");
  }
  for (const Item* entry : entries) add(entry->at("dc").text(), entry->at("matid").text(), entry->where);
  // Of a database: lines "0:grass".
  for (const Item& line : table->children)
    if (line.name != "entry" && !line.name.starts_with('@')) add(line.name, line.text(), line.where);
}

// The curves that a map chooses among are those of the material that has it. False where it has none.
bool SceneWriter::read_family(const Item& map, const MaterialUse* use, Tree& made) {
  const Item* surface = use ? use->entry->find("SURFACE_PROPERTIES") : nullptr;
  const Item* section = surface ? surface->find("EMISSIVITY_PROP") : nullptr;
  const Item* file = section ? section->find("FILENAME") : nullptr;
  if (!file) return map.mark_all(Fate::unsupported, "its material has no file of emissivities to choose from"), false;
  Folders where = use->folders;
  where.insert(where.end(), ems_.begin(), ems_.end());
  made.set("family", Tree::word(import_.name_of(import_.file_of(*file, where)), file->where));
  return true;
}

void SceneWriter::read_bands(const Item& map, Tree& made) {
  const Item* bands = map.find("bandlist");
  const Item* band = bands ? bands->find("band") : nullptr;
  const Item& pass = band ? band->at("bandpass") : map.at("bandpass");
  const Item *low = pass.any({"min", "minimum"}), *high = pass.any({"max", "maximum"});
  if (!low || !high) throw pass.error("a band has <min> and <max>");
  made.set("bands_um", Tree::list(map.where)).push(Tree::numbers({low->number(), high->number()}, pass.where));
  if (bands && bands->all("band").size() > 1)
    bands->all("band")[1]->mark_all(Fate::unsupported, "the first band of a texture map is used");
  map.mark(Fate::approximated, "pixels and curves are matched rank by rank of their standardised values");
}

// The map as one of ours, under a name; empty where it is lost. use: the first material that has it.
std::string SceneWriter::write_map(const Item& map, const std::string& what, const std::string& path,
                                   const MaterialUse* use, const Scope& scope) {
  Tree made = Tree::map(map.where);
  made.set("type", Tree::word(what, map.where));
  made.set("file", Tree::word(import_.name_of(path), map.where));
  read_projector(map, path, made);
  if (what == "class" || what == "mixture") read_classes(map, what == "mixture", scope, made);
  if (what == "texture") read_bands(map, made);
  if ((what == "texture" || what == "curve_index") && !read_family(map, use, made)) return {};
  if (what == "normal") {
    made.set("scale", Tree::number(2.0 / 255, map.where));
    made.set("offset", Tree::number(-1, map.where));
    map.mark(Fate::approximated, "8 bit values are taken as -1 to 1");
  }
  if (what == "cube") made.set("outside", Tree::word("error", map.where));
  const Item* name = map.any({"@name", "NAME"});
  if (name) name->mark(Fate::exact);
  const std::string mine = free_name(name && !name->value.empty() ? name->value : map.name);
  root_.map_at("maps", map.where).set(mine, std::move(made));
  return mine;
}

void SceneWriter::read_map(const Item& map, const Folders& folders) {
  static const std::map<std::string, const char*> kinds = {
      {"materialmap", "class"},  {"mixturemap", "mixture"},         {"fractionmap", "mixture"},
      {"texturemap", "texture"}, {"curvemap", "curve_index"},       {"bumpmap", "bump"},
      {"normalmap", "normal"},   {"temperaturemap", "temperature"}, {"reflectancemap", "cube"},
      {"densitymap", "opacity"}};
  const auto kind = kinds.find(map.name);
  if (kind == kinds.end())
    return map.mark_all(Fate::unsupported, "a map that is not known here: what it changes stays even");
  map.mark(Fate::exact);
  std::vector<std::string> ids;
  for (const Item* list : map.all("matidlist"))
    for (const Item* id : list->all("matid")) ids.push_back(material(id->text(), scope_));
  for (const Item* id : map.all("matid")) ids.push_back(material(id->text(), scope_));
  const Item* mixing = map.find("@mixing");
  if (mixing && mixing->boolean())
    mixing->mark(Fate::unsupported, "materials of a map of digital counts are not blended");
  const Item *bands = map.find("bandlist"), *image = map.find("image");
  if (const Item* band = bands && !image ? bands->find("band") : nullptr) image = band->find("image");
  if (!image) throw map.error("a map without an image", "<image><filename>");
  const auto use = ids.empty() ? uses_.end() : uses_.find(ids[0]);
  const std::string mine = write_map(map, kind->second, import_.file_of(image->at("filename"), folders),
                                     use == uses_.end() ? nullptr : &use->second, scope_);
  if (mine.empty()) return;
  for (const std::string& id : ids) use_map(id, kind->second, mine);
}

void SceneWriter::use_map(const std::string& id, const std::string& what, const std::string& map) {
  if (what == "class")
    map_names_[id] = map;
  else
    maps_of_[id].push_back(map);
}

// Maps that stand in the entry of a material.
void SceneWriter::read_entry_maps(const MaterialUse& use, const std::string& id, Tree& to) {
  static const std::map<std::string, const char*> kinds = {
      {"MATERIAL_MAP", "class"},   {"NORMAL_MAP", "normal"},     {"BUMP_MAP", "bump"},
      {"TEXTURE_MAP", "texture"},  {"CURVE_MAP", "curve_index"}, {"TEMPERATURE_MAP", "temperature"},
      {"REFLECTANCE_MAP", "cube"}, {"DENSITY_MAP", "opacity"}};
  for (const Item& block : use.entry->children) {
    if (!block.name.ends_with("_MAP") || block.fate()) continue;
    const auto kind = kinds.find(block.name);
    const Item* image = block.any({"IMAGE_FILENAME", "FILENAME"});
    const Item* enabled = block.find("ENABLED");
    if (enabled && !enabled->boolean()) {
      block.mark_all(Fate::ignored, "disabled");
    } else if (kind == kinds.end() || !image || kind->second == std::string("texture")) {
      block.mark_all(Fate::unsupported, "a map that is not known here: what it changes stays even");
    } else {
      block.mark(Fate::exact);
      Folders folders = use.folders;
      folders.insert(folders.end(), map_.begin(), map_.end());
      if (const std::string mine = write_map(block, kind->second, import_.file_of(*image, folders), &use, use.scope);
          !mine.empty())
        use_map(id, kind->second, mine);
    }
  }
  if (const auto map = map_names_.find(id); map != map_names_.end())
    to.set("map", Tree::word(map->second, use.entry->where));
  if (const auto maps = maps_of_.find(id); maps != maps_of_.end())
    for (const std::string& map : maps->second)
      to.list_at("maps", use.entry->where).push(Tree::word(map, use.entry->where));
}

}  // namespace suite::dirsig
