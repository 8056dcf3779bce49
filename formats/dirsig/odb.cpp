// Object databases (.odb): blocks of text, each an object with its instances, or a shape.
#include <cmath>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/dirsig/motion.h"
#include "formats/dirsig/scene_writer.h"

namespace suite::dirsig {

namespace {

double unit_of(const Item* units) {
  if (!units) return 1;
  const size_t kind = units->choice({"METERS", "CENTIMETERS", "FEET", "INCHES", "MILLIMETERS", "KILOMETERS"});
  constexpr double metres[] = {1, 0.01, 0.3048, 0.0254, 0.001, 1000};
  if (kind) units->mark(Fate::converted, strf("%g m", metres[kind]));
  return metres[kind];
}

bool is_mov(const Item& info) { return lower_case(info.value).ends_with(".mov"); }

// Boxes of a grid of materials are kept apart up to here.
constexpr size_t kMostBoxes = 100000;

// The faces of boxes that have no box behind them, with outward normals.
std::string skin_of(const std::map<std::array<long long, 3>, std::string>& cells, const double (&d)[3]) {
  // Corners by bits: x, y, z; of the faces -x, +x, -y, +y, -z, +z.
  constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  std::string obj;
  for (const auto& [cell, id] : cells) {
    obj += "usemtl " + id + "\n";
    for (size_t f = 0; f < 6; ++f) {
      std::array<long long, 3> behind = cell;
      behind[f / 2] += f % 2 ? 1 : -1;
      if (cells.count(behind)) continue;
      for (const int c : faces[f])
        obj += strf("v %.17g %.17g %.17g\n", static_cast<double>(cell[0] + (c & 1)) * d[0],
                    static_cast<double>(cell[1] + (c >> 1 & 1)) * d[1],
                    static_cast<double>(cell[2] + (c >> 2 & 1)) * d[2]);
      obj += "f -4 -3 -2 -1\n";
    }
  }
  return obj;
}

}  // namespace

void SceneWriter::read_odb(const Item& odb, const Scope& scope, Tree& to) {
  if (const Item* version = odb.find("DIRSIG_ODB"))
    version->mark(version->value == "1.0" ? Fate::exact : Fate::approximated,
                  version->value == "1.0" ? "" : "1.0 is known");
  for (const Item& item : odb.children) {
    if (item.name == "DIRSIG_ODB") continue;
    if (item.name == "OBJECT") {
      item.mark(Fate::exact);
      read_odb_object(item, scope, to);
    } else if (item.name == "REGULAR_GRID") {
      item.mark(Fate::exact);
      read_grid(item, scope, to);
    } else if (read_odb_primitive(item, scope, to)) {
      item.mark(Fate::exact);
    }
  }
}

void SceneWriter::read_odb_object(const Item& object, const Scope& scope, Tree& to) {
  const double unit = unit_of(object.find("UNITS"));
  std::string target;
  if (const Item* list = object.any({"ODB_FILENAME", "GLIST_FILENAME"})) {
    const std::string path = import_.file_of(*list, scope.folders);
    Tree placements = Tree::list(list->where);
    read_list_file(path, scope, placements);
    target = several(stem_of(path), std::move(placements), list->where);
  } else if (const Item* gdb = object.find("GDB_FILENAME")) {
    target = mesh_file(import_.file_of(*gdb, scope.folders), "gdb", unit, scope, gdb->where);
  } else if (const Item* obj = object.find("OBJ_FILENAME")) {
    target = mesh_file(import_.file_of(*obj, scope.folders), "obj", unit, scope, obj->where);
  } else {
    throw object.error("an OBJECT without geometry", "GDB_FILENAME, OBJ_FILENAME or ODB_FILENAME");
  }
  const Item& instances = object.at("INSTANCES");
  const auto infos = instances.all("INFO");
  if (infos.empty()) instances.mark(Fate::ignored, "no instance, so that nothing is placed");
  for (const Item* info : infos) read_odb_instance(*info, target, scope, to);
}

void SceneWriter::read_odb_instance(const Item& info, const std::string& target, const Scope& scope, Tree& to) {
  Tree made = Tree::map(info.where);
  made.set("place", Tree::word(target, info.where));
  if (is_mov(info)) {
    const std::string path = import_.file_of(info, scope.folders);
    made.set("motion", track_of_mov(import_.sections(path, "delta motion", "mov"), {import_, scope.folders, &epoch_}));
    to.push(std::move(made));
    return;
  }
  const std::vector<double> n = info.numbers();
  if (n.size() == 16) {
    made.set("matrix", Tree::numbers(n, info.where));
  } else if (n.size() == 9) {
    made.set("scale", Tree::numbers({n[3], n[4], n[5]}, info.where));
    Tree turn = Tree::map(info.where);
    turn.set("euler_deg", Tree::numbers({n[6], n[7], n[8]}, info.where));
    turn.set("order", Tree::word("xyz", info.where));
    made.set("rotate", std::move(turn));
    made.set("translate", Tree::numbers({n[0], n[1], n[2]}, info.where));
  } else {
    throw info.error(strf("an INFO of %zu numbers", n.size()),
                     "9 (translation, scale, rotation in degrees), 16 (a matrix by rows) or the name of a .mov file");
  }
  to.push(std::move(made));
}

bool SceneWriter::read_odb_primitive(const Item& item, const Scope& scope, Tree& to) {
  const auto id_of = [&](const char* key) { return material(item.at(key).text(), scope); };
  const auto ids_of = [&](const char* key) {
    std::vector<std::string> ids;
    for (const std::string_view word : words_of(item.at(key).text(), " \t,"))
      ids.push_back(material(std::string(word), scope));
    return ids;
  };
  const auto place = [&](const std::string& target, const char* at) {
    Tree made = Tree::map(item.where);
    made.set("place", Tree::word(target, item.where));
    if (const Item* anchor = at ? item.find(at) : nullptr) {
      const auto t = triple_of_value(*anchor);
      made.set("translate", Tree::numbers({t[0], t[1], t[2]}, anchor->where));
    }
    to.push(std::move(made));
    return true;
  };
  const auto length = [&](const char* key) { return item.at(key).number_in(1e-9, 1e9); };
  if (item.name == "SPHERE") return place(sphere(item, length("RADIUS"), ids_of("MATERIAL_IDS")[0]), "CENTER");
  if (item.name == "DISK") return place(disk(item, length("RADIUS"), id_of("MATERIAL_ID")), "CENTER");
  if (item.name == "SECCHI_DISK") {
    const auto ids = ids_of("MATERIAL_IDS");
    return place(secchi(item, length("RADIUS"), ids[0], ids.back()), "CENTER");
  }
  if (item.name == "GROUND_PLANE") {
    const Item* checks = item.find("ADD_CHECKS");
    const std::string other = checks ? material(checks->at("MATERIAL_ID").text(), scope) : "";
    const double width = checks ? checks->at("WIDTH").number_in(1e-6, 1e9) : 0;
    return place(ground(item, id_of("MATERIAL_ID"), checks, other, width), "ANCHOR");
  }
  if (item.name == "BOX")
    return place(box(item, triple_of_value(item.at("LOWER_EXTENT")), triple_of_value(item.at("UPPER_EXTENT")),
                     ids_of("MATERIAL_IDS")),
                 nullptr);
  if (item.name == "CYLINDER") {
    const Item *a = item.find("CAP_A"), *b = item.find("CAP_B");
    return place(cylinder(item, triple_of_value(item.at("POINT_A")), triple_of_value(item.at("POINT_B")),
                          length("RADIUS"), id_of("MATERIAL_ID"), a && a->boolean(), b && b->boolean()),
                 nullptr);
  }
  if (item.name == "CURVED_FRUSTUM") {
    const std::string made = frustum(item,
                                     {length("HEIGHT"), length("BOTTOM_WIDTH_X"), length("BOTTOM_WIDTH_Y"),
                                      item.at("BOTTOM_RADIUS").number_in(0, 1e9), length("TOP_RADIUS")},
                                     id_of("MATERIAL_ID"));
    if (const Item* ramp = item.find("RAMP")) ramp->mark(Fate::unsupported, "the sides are straight");
    return place(made, "CENTER");
  }
  return false;
}

// Boxes of a material each. What stands behind i, j, k in a row is not public: the first number is taken as the id.
void SceneWriter::read_grid(const Item& grid, const Scope& scope, Tree& to) {
  const auto at = triple_of_value(grid.at("INSERT_POINT"));
  const double d[3] = {grid.at("DELTA_X").number_in(1e-6, 1e9), grid.at("DELTA_Y").number_in(1e-6, 1e9),
                       grid.at("DELTA_Z").number_in(1e-6, 1e9)};
  const std::string path = import_.file_of(grid.at("GRID_FILENAME"), scope.folders);
  const std::string text = read_text(path, size_t{256} << 20);
  TextLines lines(text, path);
  if (!lines.next()) throw lines.error_at_end("a grid without a line");
  const long long most[3] = {lines.integer(0, "boxes along x", 1, 1000000),
                             lines.integer(1, "boxes along y", 1, 1000000),
                             lines.integer(2, "boxes along z", 1, 1000000)};
  std::map<std::array<long long, 3>, std::string> cells;
  size_t more = 0;
  while (lines.next()) {
    std::array<long long, 3> cell{};
    for (size_t k = 0; k < 3; ++k) cell[k] = lines.integer(k, "a box", 0, most[k] - 1);
    if (lines.words() < 4) throw lines.error(0, "a box without a material", "i j k material");
    cells[cell] = material(std::string(lines.word(3)), scope);
    more = std::max(more, lines.words());
    if (cells.size() > kMostBoxes) throw lines.error(0, strf("more than %zu boxes", kMostBoxes));
  }
  const std::string obj = skin_of(cells, d);
  Item account;
  account.name = "grid";
  account.where = {path, 1, 1, {}, -1};
  Item& rows = account.children.emplace_back();
  rows.name = "boxes", rows.value = strf("%zu", cells.size()), rows.where = account.where;
  rows.mark(more > 4 ? Fate::unsupported : Fate::approximated,
            more > 4 ? "the first number behind i, j, k is taken as the material; the rest is lost"
                     : "the number behind i, j, k is taken as the material");
  import_.keep(path, "regular grid", std::move(account));
  if (cells.empty()) throw Error(Where{path, 1, 1, {}, -1}, "a grid without a box");
  Tree made = Tree::map(grid.where);
  made.set("place", Tree::word(mesh_text(stem_of(path), obj, grid.where), grid.where));
  made.set("translate", Tree::numbers({at[0], at[1], at[2]}, grid.where));
  to.push(std::move(made));
}

}  // namespace suite::dirsig
