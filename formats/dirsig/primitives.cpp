// Cylinders, frusta, and the elements of lists in XML that are shapes.
#include <cmath>

#include "formats/dirsig/scene_writer.h"
#include "math/dualquat.h"

namespace suite::dirsig {

namespace {

Tree place_of(const std::string& target, const Where& where) {
  Tree one = Tree::map(where);
  one.set("place", Tree::word(target, where));
  return one;
}

}  // namespace

std::string SceneWriter::cylinder(const Item& from, const std::array<double, 3>& a, const std::array<double, 3>& b,
                                  double radius, const std::string& id, bool cap_a, bool cap_b) {
  const Vec3 low{a[0], a[1], a[2]}, along = Vec3{b[0], b[1], b[2]} - low;
  const double height = length(along);
  if (!(height > 0)) throw from.error("both ends of a cylinder are in one place");
  Tree p = Tree::map(from.where);
  p.set("radius", Tree::number(radius, from.where));
  p.set("height", Tree::number(height, from.where));
  p.set("capped", Tree::number(cap_a && cap_b ? 1 : 0, from.where));
  Tree list = Tree::list(from.where);
  list.push(place_of(shape("cylinder", "cylinder", std::move(p), id, from.where), from.where));
  if (cap_a != cap_b) {
    Tree cap = place_of(disk(from, radius, id), from.where);
    if (cap_b) cap.set("translate", Tree::numbers({0, 0, height}, from.where));
    list.push(std::move(cap));
  }
  // The turn that leads z to the axis.
  const Vec3 axis = along * (1 / height), k = cross({0, 0, 1}, axis);
  const double sine = length(k);
  Tree turned_list = Tree::list(from.where),
       one = place_of(several("cylinder_parts", std::move(list), from.where), from.where);
  if (sine > 1e-15 || axis.z < 0) {
    Tree turn = Tree::map(from.where);
    const Vec3 about = sine > 1e-15 ? k * (1 / sine) : Vec3{1, 0, 0};
    turn.set("axis", Tree::numbers({about.x, about.y, about.z}, from.where));
    turn.set("angle_deg", Tree::number(std::atan2(sine, axis.z) / kDegree, from.where));
    one.set("rotate", std::move(turn));
  }
  one.set("translate", Tree::numbers({a[0], a[1], a[2]}, from.where));
  turned_list.push(std::move(one));
  return several("cylinder_there", std::move(turned_list), from.where);
}

// sizes: height, bottom width x and y, radius of the bottom's corners, radius of the top.
std::string SceneWriter::frustum(const Item& from, const std::array<double, 5>& sizes, const std::string& id) {
  from.mark(Fate::approximated, "straight sides between 128 points of the bottom's outline and of the top's circle");
  constexpr int kSides = 128;
  const auto [height, wide, deep, corner, top] = sizes;
  const double r = std::min({corner, wide / 2, deep / 2});
  std::string obj = "usemtl " + id + "\n", rim;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kSides, c = std::cos(angle), s = std::sin(angle);
    obj += strf("v %.17g %.17g 0\n", std::copysign(wide / 2 - r, c) + r * c, std::copysign(deep / 2 - r, s) + r * s);
    rim += strf("v %.17g %.17g %.17g\n", top * c, top * s, height);
  }
  obj += rim;
  std::string bottom = "f", lid = "f";
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    obj += strf("f %d %d %d %d\n", i + 1, next + 1, kSides + next + 1, kSides + i + 1);
    bottom += strf(" %d", kSides - i);
    lid += strf(" %d", kSides + i + 1);
  }
  return mesh_text("frustum", obj + bottom + "\n" + lid + "\n", from.where);
}

std::optional<std::string> SceneWriter::glist_primitive(const Item& base, const Scope& scope) {
  const auto id_of = [&](const Item& from, const char* key) { return material(from.at(key).text(), scope); };
  const auto at = [&](const Item& from, const char* key, const std::string& made) {
    const Item* anchor = from.find(key);
    return anchor ? moved(made, triple_of(*anchor), from.where) : made;
  };
  const auto size = [](const Item& from, const char* key) { return from.at(key).number_in(1e-9, 1e9); };
  if (const Item* p = base.find("sphere")) return at(*p, "center", sphere(*p, size(*p, "radius"), id_of(*p, "matid")));
  if (const Item* p = base.find("disk")) return at(*p, "center", disk(*p, size(*p, "radius"), id_of(*p, "matid")));
  if (const Item* p = base.find("secchidisk"))
    return at(*p, "center", secchi(*p, size(*p, "radius"), id_of(*p, "matid_a"), id_of(*p, "matid_b")));
  if (const Item* p = base.find("groundplane")) {
    const Item* checks = p->find("checkers");
    const std::string other = checks ? id_of(*checks, "matid") : "";
    const double width = checks ? checks->at("width").number_in(1e-6, 1e9) : 0;
    return at(*p, "anchor", ground(*p, id_of(*p, "matid"), checks, other, width));
  }
  if (const Item* p = base.find("box")) {
    std::vector<std::string> ids;
    for (const Item* id : p->all("matid"))
      for (const std::string_view word : words_of(id->text(), " \t,"))
        ids.push_back(material(std::string(word), scope));
    if (ids.empty()) throw p->error("a box without a material", "<matid>");
    return box(*p, triple_of(p->at("lowerextent")), triple_of(p->at("upperextent")), ids);
  }
  if (const Item* p = base.find("cylinder")) {
    const auto cap = [&](std::initializer_list<std::string_view> names) {
      const Item* flag = p->any(names);
      return flag && flag->boolean();
    };
    return cylinder(*p, triple_of(p->at("point_a")), triple_of(p->at("point_b")), size(*p, "radius"),
                    id_of(*p, "matid"), cap({"cap_a", "@cap_a"}), cap({"cap_b", "@cap_b"}));
  }
  if (const Item* p = base.find("curvedfrustum")) {
    const Item &bottom = p->at("bottom"), &top = p->at("top");
    if (const Item* ramp = p->find("ramp")) ramp->mark_all(Fate::unsupported, "the sides are straight");
    return at(*p, "center",
              frustum(*p,
                      {size(*p, "height"), size(bottom, "xwidth"), size(bottom, "ywidth"),
                       bottom.at("radius").number_in(0, 1e9), size(top, "radius")},
                      id_of(*p, "matid")));
  }
  return std::nullopt;
}

}  // namespace suite::dirsig
