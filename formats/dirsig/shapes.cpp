// Objects and groups of our text, and the shapes that DIRSIG's lists know.
#include <cmath>

#include "base/files.h"
#include "formats/dirsig/gdb.h"
#include "formats/dirsig/scene_writer.h"
#include "math/vec.h"

namespace suite::dirsig {

namespace {

// DIRSIG5 makes its ground planes, which its manual calls infinite, so wide.
constexpr double kGround = 2000;
constexpr size_t kMostChecks = 40000;

std::string vertex(double x, double y, double z) { return strf("v %.17g %.17g %.17g\n", x, y, z); }

}  // namespace

std::string SceneWriter::free_name(const std::string& wished) {
  std::string base;
  for (const char c : wished.empty() ? std::string("object") : wished)
    base += (static_cast<unsigned char>(c) < 0x21 || c == '"' || c == '\\' || c == '.') ? '_' : c;
  std::string name = base;
  for (int k = 2; name == "world" || !names_.insert(name).second; ++k) name = strf("%s_%d", base.c_str(), k);
  return name;
}

std::string SceneWriter::shape(const std::string& name, const char* kind, Tree parameters, const std::string& id,
                               const Where& where) {
  const std::string made = free_name(name);
  Tree object = Tree::map(where);
  object.set(kind, std::move(parameters));
  object.set("material", Tree::word(id, where));
  root_.map_at("objects", where_).set(made, std::move(object));
  return made;
}

std::string SceneWriter::mesh_text(const std::string& name, const std::string& obj, const Where& where) {
  const std::string made = free_name(name);
  Tree object = Tree::map(where);
  object.set("obj_text", Tree::word(obj, where));
  root_.map_at("objects", where_).set(made, std::move(object));
  return made;
}

std::string SceneWriter::several(const std::string& name, Tree placements, const Where& where) {
  const std::string made = free_name(name);
  placements.where = where;
  root_.map_at("groups", where_).set(made, std::move(placements));
  return made;
}

std::string SceneWriter::moved(const std::string& target, const std::array<double, 3>& by, const Where& where) {
  if (by[0] == 0 && by[1] == 0 && by[2] == 0) return target;
  Tree one = Tree::map(where), list = Tree::list(where);
  one.set("place", Tree::word(target, where));
  one.set("translate", Tree::numbers({by[0], by[1], by[2]}, where));
  list.push(std::move(one));
  return several(target + "_there", std::move(list), where);
}

// The materials that a file of geometry asks for, and whether faces ask for none; the file is read once.
const std::pair<std::set<std::string>, bool>& SceneWriter::asked_of(const std::string& path, bool gdb) {
  if (const auto there = asked_.find(path); there != asked_.end()) return there->second;
  const std::string text = read_text(path, size_t{1} << 30);
  auto& [materials, unnamed] = asked_[path];
  if (gdb) {
    Gdb made = parse_gdb(text, path);
    materials = std::move(made.materials), unnamed = false;
    if (!import_.known(path)) import_.keep(path, "geometric database", std::move(made.account));
  } else {
    ObjAccount made = account_of_obj(text, path);
    materials = std::move(made.materials), unnamed = made.unnamed;
    if (!import_.known(path)) import_.keep(path, "Wavefront OBJ", std::move(made.account));
  }
  return asked_.at(path);
}

std::string SceneWriter::mesh_file(const std::string& path, const char* kind, double unit, const Scope& scope,
                                   const Where& where) {
  const auto& [asked, unnamed] = asked_of(path, std::string_view(kind) == "gdb");
  std::string same = strf("%s %.17g", path.c_str(), unit);
  Tree materials = Tree::map(where);
  for (const std::string& id : asked) {
    const std::string mine = material(id, scope);
    same += "\n" + mine;
    if (mine != id) materials.set(id, Tree::word(mine, where));
  }
  if (const auto there = meshes_.find(same); there != meshes_.end()) return there->second;
  if (unnamed) throw Error(where, "'" + path + "' has faces without a material", "`usemtl ID` stands before faces");
  const std::string name = free_name(stem_of(path));
  Tree object = Tree::map(where);
  object.set(kind, Tree::word(import_.name_of(path), where));
  if (unit != 1) object.set("unit_m", Tree::number(unit, where));
  if (!materials.empty()) object.set("materials", std::move(materials));
  root_.map_at("objects", where_).set(name, std::move(object));
  return meshes_[same] = name;
}

std::string SceneWriter::sphere(const Item& from, double radius, const std::string& id) {
  Tree p = Tree::map(from.where);
  p.set("radius", Tree::number(radius, from.where));
  return shape("sphere", "sphere", std::move(p), id, from.where);
}

std::string SceneWriter::disk(const Item& from, double radius, const std::string& id) {
  Tree p = Tree::map(from.where);
  p.set("radius", Tree::number(radius, from.where));
  return shape("disk", "disk", std::move(p), id, from.where);
}

std::string SceneWriter::ground(const Item& from, const std::string& id, const Item* checked, const std::string& other,
                                double width) {
  from.mark(Fate::converted, "2 km wide about its anchor, as DIRSIG5 makes it");
  const double cells = checked ? std::ceil(kGround / width) : 1;
  if (checked && cells * cells > kMostChecks)
    checked->mark_all(Fate::unsupported, strf("more than %zu checks: the plane is plain", kMostChecks));
  if (!checked || cells * cells > kMostChecks) {
    Tree p = Tree::map(from.where);
    p.set("width", Tree::number(kGround, from.where));
    p.set("depth", Tree::number(kGround, from.where));
    return shape("ground", "plane", std::move(p), id, from.where);
  }
  checked->mark(Fate::approximated, "checks begin at the anchor with the plane's own material towards +x and +y");
  std::string obj, face[2];
  const int n = static_cast<int>(std::ceil(kGround / 2 / width));
  for (int j = -n; j <= n; ++j)
    for (int i = -n; i <= n; ++i) obj += vertex(i * width, j * width, 0);
  const int row = 2 * n + 1;
  for (int j = 0; j < 2 * n; ++j)
    for (int i = 0; i < 2 * n; ++i)
      face[(i + j) % 2 ? 1 : 0] +=
          strf("f %d %d %d %d\n", j * row + i + 1, j * row + i + 2, (j + 1) * row + i + 2, (j + 1) * row + i + 1);
  return mesh_text("ground", obj + "usemtl " + id + "\n" + face[0] + "usemtl " + other + "\n" + face[1], from.where);
}

std::string SceneWriter::secchi(const Item& from, double radius, const std::string& a, const std::string& b) {
  from.mark(Fate::approximated, "a polygon of 256 sides; the first material is that of +x +y");
  constexpr int kSides = 256;
  std::string obj = vertex(0, 0, 0);
  for (int i = 0; i < kSides; ++i)
    obj += vertex(radius * std::cos(2 * kPi * i / kSides), radius * std::sin(2 * kPi * i / kSides), 0);
  for (int i = 0; i < kSides; ++i) {
    if (i % (kSides / 4) == 0) obj += "usemtl " + (i / (kSides / 4) % 2 ? b : a) + "\n";
    obj += strf("f 1 %d %d\n", i + 2, (i + 1) % kSides + 2);
  }
  return mesh_text("secchi_disk", obj, from.where);
}

std::string SceneWriter::box(const Item& from, const std::array<double, 3>& low, const std::array<double, 3>& high,
                             const std::vector<std::string>& ids) {
  for (size_t k = 0; k < 3; ++k)
    if (!(low[k] < high[k])) throw from.error("the upper extent of a box is not above the lower");
  if (ids.size() == 1) {
    Tree p = Tree::map(from.where);
    constexpr const char* keys[] = {"x0", "y0", "z0", "x1", "y1", "z1"};
    for (size_t k = 0; k < 6; ++k) p.set(keys[k], Tree::number(k < 3 ? low[k] : high[k - 3], from.where));
    return shape("box", "box", std::move(p), ids[0], from.where);
  }
  if (ids.size() != 6) throw from.error(strf("a box of %zu materials", ids.size()), "one, or six");
  from.mark(Fate::approximated, "materials are taken as those of -x, +x, -y, +y, -z, +z");
  std::string obj;
  for (int c = 0; c < 8; ++c)
    obj += vertex(c & 1 ? high[0] : low[0], c & 2 ? high[1] : low[1], c & 4 ? high[2] : low[2]);
  constexpr const char* faces[] = {"1 5 7 3", "2 4 8 6", "1 2 6 5", "3 7 8 4", "1 3 4 2", "5 6 8 7"};
  for (size_t k = 0; k < 6; ++k) obj += "usemtl " + ids[k] + "\nf " + faces[k] + "\n";
  return mesh_text("box", obj, from.where);
}

}  // namespace suite::dirsig
