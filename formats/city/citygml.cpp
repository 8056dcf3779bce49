// Based on: OGC 12-019, "CityGML Encoding Standard" 2.0, 2012; OGC 21-006r2, "CityGML 3.0 GML Encoding", 2023; OGC
// 07-036 (GML 3.2.1), chapters 10 and 11. Names are taken without their namespaces, which differ between versions; a
// surface's meaning and level of detail are those of the elements that it stands in.
#include <algorithm>
#include <map>
#include <set>

#include "base/number_text.h"
#include "formats/city/internal.h"
#include "formats/xml/xml.h"

namespace suite::city {

namespace {

std::string_view local(std::string_view name) {
  const size_t colon = name.find(':');
  return colon == name.npos ? name : name.substr(colon + 1);
}

std::optional<std::string> attribute_of(const XmlElement& e, std::string_view name) {
  std::optional<std::string> found;
  e.each_attribute([&](std::string_view key, std::string_view value) {
    if (local(key) == name) found = std::string(value);
  });
  return found;
}

// Thematic surfaces and openings of buildings, bridges, tunnels, roads and waters.
bool is_kind(std::string_view name) {
  static const std::set<std::string_view> kinds{"Window",
                                                "Door",
                                                "WindowSurface",
                                                "DoorSurface",
                                                "TrafficArea",
                                                "AuxiliaryTrafficArea",
                                                "BuildingInstallation",
                                                "BuildingFurniture"};
  static const std::set<std::string_view> shapes{"Surface",           "MultiSurface",        "CompositeSurface",
                                                 "PolyhedralSurface", "TriangulatedSurface", "OrientableSurface"};
  return kinds.count(name) || (name.ends_with("Surface") && !shapes.count(name) && name[0] >= 'A' && name[0] <= 'Z');
}

// lod2Solid, lod3MultiSurface, lod0FootPrint, ...: 2, 3, 0.
std::optional<double> level_in(std::string_view name) {
  if (name.size() > 4 && name.substr(0, 3) == "lod" && name[3] >= '0' && name[3] <= '4') return name[3] - '0';
  return std::nullopt;
}

// Properties that hold surfaces, or refer to them.
bool holds_surfaces(std::string_view name) {
  return name == "surfaceMember" || name == "baseSurface" || name == "solidMember" || name == "exterior" ||
         name == "interior" || level_in(name);
}

// What an element refers to within the document; empty = nothing.
std::string reference_of(const XmlElement& e) {
  const auto to = attribute_of(e, "href");
  return to && to->size() > 1 && to->front() == '#' ? to->substr(1) : std::string();
}

class CitygmlReader {
 public:
  CitygmlReader(const std::string& file, const std::optional<std::string>& lod, Report& report)
      : lod_(lod), report_(report) {
    model_.file = file;
  }
  void look(const XmlElement& e);
  void member(const XmlElement& e);
  CityModel finish();

 private:
  // What holds for everything within an element.
  struct Around {
    std::string kind;
    double level = -1;
    bool turned = false;
  };
  struct Found {
    double level;
    CityModel::Surface surface;
  };
  // A surface that others refer to, and the object that it is part of.
  struct Shared {
    XmlElement surface;
    size_t object;
    std::string kind;  // of what it stands in there; may be empty
  };
  void references(const XmlElement& e, const std::string& kind);
  void find_shared(const XmlElement& e, size_t object, const std::string& kind);
  void refer(const XmlElement& e, const std::string& id, const Around& around, std::vector<Found>& to);
  void walk(const XmlElement& e, Around around, std::vector<Found>& to);
  void polygon(const XmlElement& e, const Around& around, std::vector<Found>& to);
  void implicit(const XmlElement& e, const Around& around, std::vector<Found>& to);
  void ring(const XmlElement& e, std::vector<std::vector<Vec3>>& to) const;
  std::vector<double> numbers(const XmlElement& e) const;

  const std::optional<std::string>& lod_;
  Report& report_;
  CityModel model_;
  std::map<std::string, std::string> kinds_;  // of polygons that are elsewhere than what says their kind
  std::map<std::string, XmlElement> prototypes_;
  std::set<std::string, std::less<>> wanted_;  // ids that properties of surfaces refer to
  std::map<std::string, Shared, std::less<>> shared_;
  size_t references_ = 0, nested_ = 0, lost_ = 0;
  size_t implicit_ = 0, depth_ = 0, placed_ = 0, lines_ = 0, none_ = 0, other_systems_ = 0;
};

// The reference system, and members of the model.
void CitygmlReader::look(const XmlElement& e) {
  if (local(e.name()) != "CityModel") throw e.fault("'" + printable(e.name()) + "' is no CityModel");
  references(e, "");
  const auto each_object = [&](const auto& visit) {
    e.each_child([&](const XmlElement& child) {
      const std::string_view name = local(child.name());
      if (name == "cityObjectMember" || name == "featureMember") child.each_child(visit);
    });
  };
  size_t object = 0;
  if (!wanted_.empty()) each_object([&](const XmlElement& o) { find_shared(o, object++, ""); });
  each_object([&](const XmlElement& o) { member(o); });
}

void CitygmlReader::find_shared(const XmlElement& e, size_t object, const std::string& kind) {
  const std::string_view name = local(e.name());
  const std::string within = is_kind(name) ? std::string(name) : kind;
  if (const auto id = attribute_of(e, "id"); id && wanted_.count(*id)) shared_.emplace(*id, Shared{e, object, within});
  e.each_child([&](const XmlElement& child) { find_shared(child, object, within); });
}

// A surface of another object is a surface of this one, too; what the object has itself it has already.
void CitygmlReader::refer(const XmlElement& e, const std::string& id, const Around& around, std::vector<Found>& to) {
  const auto found = shared_.find(id);
  if (found == shared_.end()) {
    ++lost_;
    return;
  }
  if (found->second.object == model_.objects.size()) return;
  constexpr size_t kMost = 10'000'000, kNested = 20;
  if (nested_ >= kNested) throw e.fault("references to references without end", "at most 20 may follow each other");
  if (++references_ > kMost) throw e.fault(strf("more than %zu references to surfaces", kMost));
  ++nested_;
  Around here = around;
  if (!is_kind(here.kind) && !found->second.kind.empty()) here.kind = found->second.kind;
  walk(found->second.surface, here, to);
  --nested_;
}

void CitygmlReader::references(const XmlElement& e, const std::string& kind) {
  const std::string_view name = local(e.name());
  const std::string within = is_kind(name) ? std::string(name) : kind;
  if (const auto system = attribute_of(e, "srsName"); system && !system->empty()) {
    if (model_.system.empty())
      model_.system = *system;
    else
      other_systems_ += *system != model_.system;
  }
  if (const std::string to = reference_of(e); !to.empty()) {
    if (!within.empty()) kinds_[to] = within;
    if (holds_surfaces(name)) wanted_.insert(to);
  }
  if (name == "relativeGMLGeometry")
    e.each_child([&](const XmlElement& child) {
      if (const auto id = attribute_of(child, "id")) prototypes_.emplace(*id, child);
    });
  e.each_child([&](const XmlElement& child) { references(child, within); });
}

std::vector<double> CitygmlReader::numbers(const XmlElement& e) const {
  std::vector<double> all;
  const std::string text = e.text();
  for (size_t at = text.find_first_not_of(" \t\r\n"); at != text.npos;) {
    const size_t stop = std::min(text.find_first_of(" \t\r\n", at), text.size());
    const auto value = number_of(std::string_view(text).substr(at, stop - at));
    if (!value) throw e.fault("'" + printable(text.substr(at, std::min<size_t>(stop - at, 40))) + "' is no number");
    all.push_back(*value);
    at = text.find_first_not_of(" \t\r\n", stop);
  }
  return all;
}

void CitygmlReader::ring(const XmlElement& e, std::vector<std::vector<Vec3>>& to) const {
  std::vector<double> all;
  e.each_child([&](const XmlElement& child) {
    const std::string_view name = local(child.name());
    if (name == "LinearRing") return ring(child, to);
    if (name != "posList" && name != "pos") return;
    if (const auto size = attribute_of(child, "srsDimension"); size && *size != "3")
      throw child.fault("places of '" + printable(*size).substr(0, 20) + "' numbers", "three are expected");
    const std::vector<double> more = numbers(child);
    all.insert(all.end(), more.begin(), more.end());
  });
  if (all.empty()) return;
  if (all.size() % 3) throw e.fault(strf("%zu numbers are no places of three", all.size()));
  std::vector<Vec3> corners;
  for (size_t k = 0; k < all.size(); k += 3) corners.push_back({all[k], all[k + 1], all[k + 2]});
  // The last place of a ring repeats the first.
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  to.push_back(std::move(corners));
}

void CitygmlReader::polygon(const XmlElement& e, const Around& around, std::vector<Found>& to) {
  CityModel::Surface made{around.kind, {}, e.where().line};
  if (const auto id = attribute_of(e, "id"); id && !is_kind(made.kind))
    if (const auto kind = kinds_.find(*id); kind != kinds_.end()) made.kind = kind->second;
  e.each_child([&](const XmlElement& child) {
    if (local(child.name()) == "exterior") ring(child, made.rings);
  });
  if (made.rings.empty()) return;
  if (made.rings.size() > 1) throw e.fault("a polygon with several outer rings");
  e.each_child([&](const XmlElement& child) {
    if (local(child.name()) == "interior") ring(child, made.rings);
  });
  if (around.turned)
    for (auto& r : made.rings) std::reverse(r.begin(), r.end());
  to.push_back({around.level, std::move(made)});
}

// A prototype that is placed: turned, scaled and moved by a matrix, then put at a point. Its geometry stands here or
// where it is placed first; files (libraryObject) are left out.
void CitygmlReader::implicit(const XmlElement& e, const Around& around, std::vector<Found>& to) {
  std::vector<double> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, at{0, 0, 0};
  std::vector<Found> made;
  bool here = false;
  const auto shape = [&](const XmlElement& geometry) {
    here = true;
    if (depth_ > 0) throw geometry.fault("a prototype of prototypes");
    ++depth_;
    walk(geometry, around, made);
    --depth_;
  };
  e.each_child([&](const XmlElement& child) {
    const std::string_view name = local(child.name());
    if (name == "transformationMatrix") m = numbers(child);
    if (name == "referencePoint")
      child.each_child(
          [&](const XmlElement& point) { point.each_child([&](const XmlElement& pos) { at = numbers(pos); }); });
    if (name != "relativeGMLGeometry") return;
    child.each_child(shape);
    const auto href = attribute_of(child, "href");
    if (!href || href->size() < 2) return;
    if (const auto found = prototypes_.find(href->substr(1)); found != prototypes_.end()) shape(found->second);
  });
  if (m.size() != 16) throw e.fault(strf("a transformation of %zu numbers", m.size()), "16, row by row");
  if (at.size() != 3) throw e.fault(strf("a reference point of %zu numbers", at.size()), "three");
  implicit_ += !here;
  const Affine3 turn{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[3], m[7], m[11]}};
  for (Found& f : made) {
    if (!place_copy(f.surface, turn, {at[0], at[1], at[2]}, placed_))
      throw e.fault("copies of prototypes have more than 2e7 corners", "place them as objects of a scene text");
    to.push_back(std::move(f));
  }
}

void CitygmlReader::walk(const XmlElement& e, Around around, std::vector<Found>& to) {
  const std::string_view name = local(e.name());
  if (is_kind(name)) around.kind = std::string(name);
  if (const auto level = level_in(name)) around.level = *level;
  if (name == "OrientableSurface" && attribute_of(e, "orientation") == "-") around.turned = !around.turned;
  if (name == "ImplicitGeometry") return implicit(e, around, to);
  if (name == "LineString" || name == "MultiCurve" || name == "Point" || name == "MultiPoint") {
    ++lines_;
    return;
  }
  if (name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle")
    return polygon(e, around, to);
  if (holds_surfaces(name))
    if (const std::string id = reference_of(e); !id.empty()) return refer(e, id, around, to);
  e.each_child([&](const XmlElement& child) { walk(child, around, to); });
}

void CitygmlReader::member(const XmlElement& e) {
  CityModel::Object made;
  made.type = std::string(local(e.name()));
  made.line = e.where().line;
  made.id = attribute_of(e, "id").value_or(strf("object_%zu", model_.objects.size()));
  std::vector<Found> all;
  walk(e, {made.type, -1, false}, all);
  std::vector<double> levels;
  for (const Found& f : all) levels.push_back(f.level);
  const auto taken = chosen(levels, lod_);
  none_ += !taken && !all.empty();
  for (Found& f : all)
    if (taken && f.level == *taken) made.surfaces.push_back(std::move(f.surface));
  if (taken) made.lod = *taken;
  model_.objects.push_back(std::move(made));
}

CityModel CitygmlReader::finish() {
  const auto add_finding = [&](const char* code, size_t count, const char* what) {
    if (count) report_.add(code, model_.file, {Where{model_.file, 0, 0, {}, -1}, strf("%zu %s", count, what)}, count);
  };
  add_finding("SP205", lines_, "geometries of points or lines");
  add_finding("SP705", none_, "objects have no geometry of the level of detail that is asked for");
  add_finding("SP705", implicit_, "implicit geometries are in files of their own, or nowhere, and left out");
  add_finding("SP705", lost_, "references to surfaces that are not in the file");
  add_finding("SP705", other_systems_, "elements name another reference system than the first, which is taken for all");
  return std::move(model_);
}

}  // namespace

CityModel parse_gml(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                    Report& report) {
  CitygmlReader reader(file, lod, report);
  reader.look(XmlElement::parse(text, file));
  return reader.finish();
}

}  // namespace suite::city
