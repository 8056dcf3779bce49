// Entries of material databases (.mat): what they are, bulk properties, sources of light.
#include <algorithm>

#include "base/files.h"
#include "formats/dirsig/gdb.h"
#include "formats/dirsig/scene_writer.h"

namespace suite::dirsig {

namespace {

const Item* entry_of(const Item& database, const std::string& id) {
  for (const Item& entry : database.children) {
    if (entry.name != "MATERIAL_ENTRY") continue;
    for (const Item& key : entry.children)
      if ((key.name == "ID" || key.name == "MATERIAL_ID") && key.value == id) return &entry;
  }
  return nullptr;
}

// A section or the name beside it, which are called NAME_PROP and NAME_PROP_NAME and the like.
std::string named(const Item& in, const char* key) {
  const Item* item = in.find(key);
  return item ? item->value : "";
}

}  // namespace

std::string SceneWriter::material(const std::string& asked, const Scope& scope) {
  const std::optional<WarmName> warm = warm_name_of(asked);
  const std::string& plain = warm ? warm->id : asked;
  const auto replaced = scope.assigned.find(plain);
  const std::string& id = replaced == scope.assigned.end() ? plain : replaced->second;
  for (size_t i = 0; i < scope.databases.size(); ++i) {
    const Item* entry = entry_of(*scope.databases[i], id);
    if (!entry) continue;
    std::string mine = scope.prefixes[i] + id;
    std::optional<double> kelvin;
    if (warm) {
      kelvin = warm->celsius + 273.15;
      mine += strf("_at_%.9gK", *kelvin);
      std::replace(mine.begin() + static_cast<std::ptrdiff_t>(scope.prefixes[i].size() + id.size()), mine.end(), '.',
                   '_');
    }
    if (uses_.count(mine)) return mine;
    entry->mark(Fate::exact);
    Folders folders = scope.material_folders[i];
    uses_[mine] = {entry, folders, scope, kelvin};
    open_.push_back(mine);
    return mine;
  }
  return id;
}

Tree SceneWriter::material_tree(const MaterialUse& use) {
  const Item& entry = *use.entry;
  Tree made = Tree::map(entry.where);
  entry.any({"ID", "MATERIAL_ID"})->mark(Fate::exact);
  if (const Item* name = entry.any({"NAME", "MATERIAL_NAME"})) {
    name->mark(Fate::exact);
    if (!name->value.empty()) made.set("description", Tree::word(name->value, name->where));
  }
  if (const Item* color = entry.find("EDITOR_COLOR")) color->mark(Fate::ignored, "of DIRSIG's own windows");
  if (const Item* sides = entry.find("DOUBLE_SIDED")) {
    const bool both = sides->boolean();
    sides->mark(both ? Fate::exact : Fate::approximated, both ? "" : "both sides scatter here");
  }
  if (const Item* bundle = entry.find("BUNDLE_FILENAME")) {
    bundle->mark(Fate::unsupported, "the layout of bundles is not public; a grey of 0.18 stands for the material");
    made.set("model", Tree::word("lambert", bundle->where));
    made.set("reflectance", Tree::number(0.18, bundle->where));
    return made;
  }
  reach_um_.reset();
  read_surface(use, made);
  if (!use.kelvin) {
    read_solvers(entry, made);
    return made;
  }
  // What the solver would say is looked at, so that nothing of the entry is left over, and put aside.
  const bool heat = heat_;
  Tree aside = Tree::map(entry.where);
  read_solvers(entry, aside);
  heat_ = heat;
  made.set("temperature_k", Tree::number(*use.kelvin, entry.where));
  return made;
}

// What fills the body that the material bounds.
void SceneWriter::read_bulk(const std::string& id, const MaterialUse& use, Tree& to) {
  const Item *bulk = use.entry->find("BULK_PROPERTIES"), *flat = use.entry->find("EXTINCTION_FILE");
  if (!bulk && !flat) return;
  Tree medium = Tree::map(use.entry->where);
  const auto curve = [&](const Item& file, const Folders& folders, double scale, const char* unit, const char* ours) {
    Folders all = use.folders;
    all.insert(all.end(), folders.begin(), folders.end());
    const std::string path = import_.file_of(file, all);
    if (!curves_.count(path)) {
      curves_[path] = parse_ext(read_text(path, size_t{64} << 20), path, unit);
      import_.keep(path, unit, curves_[path].account);
    }
    const CurveFile& read = curves_.at(path);
    Tree made = Tree::map(file.where);
    made.set("wavelength_um", Tree::numbers(read.wavelength_um[0], file.where));
    std::vector<double> values = read.value[0];
    for (double& v : values) v *= scale;
    made.set("value", Tree::numbers(values, file.where));
    medium.set(ours, std::move(made));
  };
  if (flat) curve(*flat, ext_, 1e-3, "1/km", "absorption");
  if (bulk) {
    if (const std::string kind = named(*bulk, "EXTINCTION_PROP_NAME"); kind == "ClassicExtinction") {
      bulk->at("EXTINCTION_PROP_NAME")
          .mark(Fate::approximated, "extinction is all absorption unless scattering is given");
      curve(bulk->at("EXTINCTION_PROP").at("FILENAME"), ext_, 1e-3, "1/km", "absorption");
    }
    if (const std::string kind = named(*bulk, "SCATTERING_PROP_NAME"); kind == "SimpleScattering") {
      bulk->at("SCATTERING_PROP_NAME").mark(Fate::exact);
      medium.set("scattering",
                 curve_file(bulk->at("SCATTERING_PROP").at("TXT_FILENAME"), use.folders, "coefficient, 1/m", 1));
    }
    if (const Item* kind = bulk->find("ABSORPTION_PROP_NAME"); kind && !kind->fate()) {
      const std::string why = "absorption per ppm and metre needs a concentration, which is not given here";
      kind->mark(Fate::unsupported, why);
      if (const Item* rest = bulk->find("ABSORPTION_PROP")) rest->mark_all(Fate::unsupported, why);
    }
  }
  if (medium.empty()) return;
  for (const char* other : {"absorption", "scattering"})
    if (!medium.find(other)) medium.set(other, Tree::number(0, use.entry->where));
  root_.map_at("media", where_).set(id, std::move(medium));
  to.set("inside", Tree::word(id, use.entry->where));
}

bool SceneWriter::read_source_material(const Item& entry) const {
  const Item* kind = entry.find("OPTICAL_DESCRIPTION");
  return kind && lower_case(kind->value) == "source";
}

// Point sources of the geometry, one lamp a place.
void SceneWriter::write_lamps() {
  for (const auto& [object, scope] : sources_) {
    const Item& base = object->at("basesource");
    const Item* point = base.find("pointsource");
    if (!point) {
      object->mark_all(Fate::unsupported, "only point sources are known here");
      continue;
    }
    const Item& id = point->any({"@matid", "matid"}) ? *point->any({"@matid", "matid"}) : point->at("@matid");
    const Item* entry = nullptr;
    for (size_t i = 0; i < scope.databases.size() && !entry; ++i) entry = entry_of(*scope.databases[i], id.value);
    if (!entry) throw id.error("there is no material '" + id.value + "' in the database");
    id.mark(Fate::exact);
    entry->mark(Fate::exact);
    for (const char* key : {"ID", "MATERIAL_ID", "NAME", "EDITOR_COLOR", "OPTICAL_DESCRIPTION"})
      if (const Item* item = entry->find(key)) item->mark(Fate::exact);
    if (const Item* shape_of = entry->any({"SOURCE_SHAPE"}))
      shape_of->mark(Fate::approximated, "the source shines alike in every direction");
    if (const Item* norm = entry->find("NORMALIZE_SHAPE")) norm->mark(Fate::ignored, "of the shape");
    Folders folders = scope.material_folders.empty() ? Folders{} : scope.material_folders[0];
    folders.insert(folders.end(), source_.begin(), source_.end());
    Tree intensity = curve_file(entry->at("INTENSITY_FILENAME"), folders, "radiant intensity, W/(sr um)", 1);
    intensity.set("outside", Tree::word("zero", entry->where));
    std::vector<const Item*> places = object->all("staticinstance");
    for (const Item* moving : object->all("dynamicinstance"))
      moving->mark_all(Fate::unsupported, "lamps that move ride on a placement; this one has none");
    for (const Item* instance : places) {
      Tree lamp = Tree::map(instance->where);
      lamp.set("kind", Tree::word("point", instance->where));
      const Item* shift = instance->find("translation");
      const auto at = shift ? triple_of(*shift) : std::array<double, 3>{};
      lamp.set("position_m", Tree::numbers({at[0], at[1], at[2]}, instance->where));
      lamp.set("intensity", intensity);
      for (const char* key : {"@name", "@tags"})
        if (const Item* name = instance->find(key)) name->mark(Fate::ignored, "a name for people");
      lamps_.push(std::move(lamp));
    }
  }
}

}  // namespace suite::dirsig
