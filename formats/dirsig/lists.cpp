// Lists of geometry in XML (.glist): objects, their geometry, where they are placed.
#include <algorithm>
#include <cstdint>

#include "base/files.h"
#include "formats/dirsig/motion.h"
#include "formats/dirsig/scene_writer.h"
#include "formats/dirsig/texts.h"

namespace suite::dirsig {

namespace {

// Lists that name each other in a circle end here.
constexpr int kListsDeepest = 40;

bool disabled(const Item& item) {
  const Item* enabled = item.find("@enabled");
  if (!enabled || enabled->boolean()) return false;
  item.mark_all(Fate::ignored, "disabled");
  return true;
}

// Where an object has several geometries, each instance draws one of them. Their cumulative shares; 1 each unless said.
std::vector<double> shares_of(const std::vector<const Item*>& bases) {
  std::vector<double> sums;
  for (const Item* base : bases) {
    const Item* weight = base->any({"@weight", "weight"});
    const double mine = weight ? weight->number_in(0, 1e9) : 1;
    sums.push_back((sums.empty() ? 0 : sums.back()) + mine);
    if (bases.size() > 1)
      base->mark(Fate::approximated,
                 strf("one of %zu, drawn for each instance by the weights; DIRSIG's draws are others", bases.size()));
  }
  if (!(sums.back() > 0)) throw bases[0]->error("no geometry has a weight above 0");
  return sums;
}

// The number that the n-th instance draws: the same whenever the list is read.
// Based on: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014 (SplitMix64's
// finisher).
size_t drawn(const std::vector<double>& sums, size_t n) {
  if (sums.size() == 1) return 0;
  uint64_t z = 0x9e3779b97f4a7c15u * (n + 1);
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  const double at = static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53 * sums.back();
  return static_cast<size_t>(std::upper_bound(sums.begin(), sums.end() - 1, at) - sums.begin());
}

}  // namespace

std::array<double, 3> triple_of_value(const Item& item) {
  const std::vector<double> list = item.numbers();
  if (list.size() != 3) throw item.error("'" + item.name + "' is three numbers");
  return {list[0], list[1], list[2]};
}

std::array<double, 3> triple_of(const Item& item) {
  for (const char* name : {"point", "cartesiantriple", "vector"})
    if (const Item* inner = item.find(name)) return triple_of(*inner);
  if (!item.value.empty()) return triple_of_value(item);
  return {item.at("x").number(), item.at("y").number(), item.at("z").number()};
}

void SceneWriter::read_list_file(const std::string& path, const Scope& scope, Tree& to) {
  if (++depth_ > kListsDeepest)
    throw Error(Where{path, 0, 0, {}, -1}, strf("lists name each other more than %d deep", kListsDeepest),
                "a list must not lead back to itself");
  Scope mine = scope;
  mine.folders.insert(mine.folders.begin(), folder_of(path));
  std::string how;
  if (trimmed(plain_text_of(path, size_t{64} << 20, how)).starts_with('<')) {
    const Item& list = import_.xml(path, "geometry list");
    if (list.name != "geometrylist") throw list.error("the root is <" + list.name + ">", "<geometrylist> is expected");
    read_glist(list, mine, to);
  } else {
    const Item& odb = import_.sections(path, "object database", "odb");
    if (odb.children.empty()) odb.mark(Fate::unsupported, "there is nothing in it: it places nothing");
    read_odb(odb, mine, to);
  }
  --depth_;
}

void SceneWriter::read_glist(const Item& list, const Scope& scope, Tree& to) {
  if (disabled(list)) return;
  for (const Item* include : list.all("geometrylistinclude")) {
    if (disabled(*include)) continue;
    if (const Item* name = include->find("@name")) name->mark(Fate::ignored, "a name for people");
    read_list_file(import_.file_of(*include, scope.folders), scope, to);
  }
  for (const Item* object : list.all("object")) {
    if (disabled(*object)) continue;
    object->mark(Fate::exact);
    read_object(*object, scope, to);
  }
}

void SceneWriter::read_assigned(const Item& from, Scope& scope) const {
  for (const Item* assign : from.all("assign")) {
    const Item& id = assign->at("@id");
    scope.assigned[assign->text(Fate::converted, "the text is the old id, the attribute the new one")] = id.text();
  }
}

void SceneWriter::read_object(const Item& object, const Scope& scope, Tree& to) {
  Scope mine = scope;
  if (const Item* paths = object.find("@search_paths"))
    paths->mark(Fate::exact, "names are looked for beside the list first in any case");
  if (const Item* name = object.find("@name")) name->mark(Fate::ignored, "a name for people");
  for (const Item* local : object.all("localmaterials")) {
    const std::string path = import_.file_of(*local, mine.folders);
    const Item& base = import_.sections(path, "material database", "mat");
    databases_.insert(&base);
    mine.databases.insert(mine.databases.begin(), &base);
    mine.prefixes.insert(mine.prefixes.begin(), stem_of(path) + "/");
    mine.material_folders.insert(mine.material_folders.begin(), {folder_of(path)});
  }
  read_assigned(object, mine);
  if (object.has("basesource")) {
    sources_.emplace_back(&object, mine);
    return;
  }
  if (const std::vector<const Item*> bases = object.all("basegeometry"); !bases.empty())
    return read_instances(object, mine, bases, to);
  object.mark(Fate::unsupported, "an object without geometry that is known here");
}

void SceneWriter::read_instances(const Item& object, const Scope& scope, const std::vector<const Item*>& bases,
                                 Tree& to) {
  size_t placed = 0;
  const std::vector<double> shares = shares_of(bases);
  std::set<const Item*> used;
  std::map<const Item*, std::string> plain;  // what instances without materials of their own place
  for (const char* kind : {"staticinstance", "dynamicinstance"})
    for (const Item* instance : object.all(kind)) {
      ++placed;
      if (disabled(*instance)) continue;
      instance->mark(Fate::exact);
      const Item& base = *bases[drawn(shares, placed)];
      used.insert(&base);
      if (instance->has("assign")) {
        Scope mine = scope;
        read_assigned(*instance, mine);
        to.push(placement_of(*instance, base_of(base, mine)));
        continue;
      }
      if (!plain.count(&base)) plain[&base] = base_of(base, scope);
      to.push(placement_of(*instance, plain.at(&base)));
    }
  for (const Item* base : bases)
    if (placed && !used.count(base)) base->mark_all(Fate::ignored, "no instance drew it");
  if (placed) return;
  // DIRSIG places nothing without an instance; a list of populations may.
  object.mark(Fate::unsupported, "no instance that is known here: it is not placed");
  for (const Item* base : bases) base->mark_all(Fate::unsupported, "not placed");
}

std::string SceneWriter::base_of(const Item& base, const Scope& scope) {
  const double unit = 1;
  for (const char* kind : {"gdb", "obj"})
    if (const Item* mesh = base.find(kind)) {
      if (const Item* tangents = mesh->find("@generatetangents"))
        tangents->mark(Fate::ignored, "tangents come from the texture coordinates here");
      return mesh_file(import_.file_of(mesh->at("filename"), scope.folders), kind, unit, scope, mesh->where);
    }
  for (const char* kind : {"odb", "glist"})
    if (const Item* list = base.find(kind)) {
      const std::string path = import_.file_of(list->at("filename"), scope.folders);
      Tree placements = Tree::list(list->where);
      read_list_file(path, scope, placements);
      return several(stem_of(path), std::move(placements), list->where);
    }
  if (const auto shape_name = glist_primitive(base, scope)) return *shape_name;
  for (const Item& child : base.children)
    throw child.error("<" + child.name + "> is no geometry that is known here",
                      "gdb, obj, odb, glist, sphere, groundplane, disk, secchidisk, box, cylinder, curvedfrustum");
  throw base.error("there is no geometry in it");
}

Tree SceneWriter::placement_of(const Item& instance, const std::string& target) {
  Tree made = Tree::map(instance.where);
  made.set("place", Tree::word(target, instance.where));
  const Item *tags = instance.find("@tags"), *name = instance.find("@name");
  if (tags && !tags->value.empty()) {
    const bool several_tags = tags->value.find(',') != tags->value.npos;
    tags->mark(several_tags ? Fate::approximated : Fate::exact,
               several_tags ? "one tag is kept, which names them all" : "");
    made.set("tag", Tree::word(tags->value, tags->where));
    if (name) name->mark(Fate::ignored, "the tags name it");
  } else if (name && !name->value.empty()) {
    const bool important = name->value.find("::IMPORTANT::") != name->value.npos;
    name->mark(Fate::converted, important
                                    ? "the instance's tag; that it is important changes nothing: pixels are sampled "
                                      "to an error"
                                    : "the instance's tag");
    made.set("tag", Tree::word(name->value, name->where));
  }
  if (const Item* scale = instance.find("scale")) {
    const auto s = triple_of(*scale);
    made.set("scale", Tree::numbers({s[0], s[1], s[2]}, scale->where));
  }
  if (const Item* rotation = instance.find("rotation")) {
    const double unit = radians_of(rotation->any({"@units", "@angularunits"}), true);
    const std::string order = order_of(rotation->find("@rotationorder"));
    const auto r = triple_of(*rotation);
    constexpr double degree = 57.295779513082320877;
    Tree turn = Tree::map(rotation->where);
    turn.set("euler_deg",
             Tree::numbers({r[0] * unit * degree, r[1] * unit * degree, r[2] * unit * degree}, rotation->where));
    turn.set("order", Tree::word(order, rotation->where));
    made.set("rotate", std::move(turn));
  }
  if (const Item* translation = instance.find("translation")) {
    const auto t = triple_of(*translation);
    made.set("translate", Tree::numbers({t[0], t[1], t[2]}, translation->where));
  }
  if (const Item* matrix = instance.find("matrix")) made.set("matrix", Tree::numbers(matrix->numbers(), matrix->where));
  const MotionPlace place{import_, {folder_of(instance.where.file)}, &epoch_};
  if (const Item* frames = instance.find("keyframemovement")) {
    const std::string path =
        import_.file_of(frames->at("filename"), {folder_of(instance.where.file), folder_of(file_)});
    made.set("motion", track_of_mov(import_.sections(path, "delta motion", "mov"), place));
  }
  if (const Item* motion = instance.find("motion")) made.set("motion", track_of(*motion, place, nullptr));
  if (const Item* location = instance.find("location")) {
    Tree at = Tree::map(location->where);
    at.set("kind", Tree::word("static", location->where));
    set_location(*location, at);
    made.set("motion", std::move(at));
  }
  return made;
}

}  // namespace suite::dirsig
