// Based on: H. Ledoux et al., "CityJSON Specifications" 1.0.3, 1.1.3 and 2.0.1, 2019 to 2024.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/params.h"
#include "formats/city/internal.h"

namespace suite::city {

namespace {

// How deep the boundaries of a geometry are nested around their surfaces; nothing for what has none.
std::optional<int> shells_of(const std::string& type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 0;
  if (type == "Solid") return 1;
  if (type == "MultiSolid" || type == "CompositeSolid") return 2;
  return std::nullopt;
}

using Vertices = std::vector<Vec3>;

class Reader {
 public:
  Reader(const std::string& file, const std::optional<std::string>& lod, Report& report) : lod_(lod), report_(report) {
    model_.file = file;
  }
  // One document, or one line of a sequence. line: of the file, or 0.
  void document(const Params& root, int line);
  CityModel finish();

 private:
  Error fault(const std::string& at, const std::string& what, const std::string& hint = {}) const {
    return Error(Where{model_.file, line_, 0, {}, -1}, at + ": " + what, hint);
  }
  void head(const Params& root);
  Vertices vertices_of(const Params& list, const std::string& at, bool transformed) const;
  void object(const std::string& id, const Params& p, const Vertices& vertices);
  void geometry(const Params& g, const std::string& at, const Vertices& vertices, const std::string& type,
                std::vector<CityModel::Surface>& to);
  void surfaces(const Params& boundaries, const std::optional<Params>& values, int shells, const std::string& at,
                const Vertices& vertices, const std::vector<std::string>& kinds, const std::string& type,
                std::vector<CityModel::Surface>& to) const;
  void instance(const Params& g, const std::string& at, const Vertices& vertices, const std::string& type,
                std::vector<CityModel::Surface>& to);

  const std::optional<std::string>& lod_;
  Report& report_;
  CityModel model_;
  Vec3 scale_{1, 1, 1}, shift_;
  bool begun_ = false;
  int line_ = 0;
  std::optional<Params> templates_;
  Vertices template_vertices_;
  size_t placed_ = 0, lines_ = 0, none_ = 0, unshaped_ = 0, textured_ = 0;
};

void Reader::head(const Params& root) {
  const std::string version = root.text("version", "");
  if (version.substr(0, 2) != "1." && version.substr(0, 2) != "2.")
    throw fault("version", version.empty() ? "it is missing" : "'" + version + "' is not read here",
                "1.0, 1.1 and 2.0 are");
  if (const auto transform = root.find("transform")) {
    const auto s = transform->at("scale").as_vec3(), t = transform->at("translate").as_vec3();
    scale_ = {s[0], s[1], s[2]}, shift_ = {t[0], t[1], t[2]};
  } else if (version.substr(0, 3) != "1.0") {
    throw fault("transform", "it is missing", "from version 1.1 on it is required");
  }
  if (const auto metadata = root.find("metadata"); metadata && metadata->kind() == Params::Kind::map)
    model_.system = metadata->text("referenceSystem", "");
  if (const auto templates = root.find("geometry-templates")) {
    templates_ = templates->at("templates");
    template_vertices_ =
        vertices_of(templates->at("vertices-templates"), "geometry-templates/vertices-templates", false);
  }
}

Vertices Reader::vertices_of(const Params& list, const std::string& at, bool transformed) const {
  Vertices made;
  made.reserve(list.size());
  for (size_t k = 0; k < list.size(); ++k) {
    const Params v = list[k];
    if (v.kind() != Params::Kind::list || v.size() != 3)
      throw fault(strf("%s[%zu]", at.c_str(), k), "three numbers are expected");
    const Vec3 p{v[0].as_number(), v[1].as_number(), v[2].as_number()};
    made.push_back(transformed ? Vec3{p.x * scale_.x + shift_.x, p.y * scale_.y + shift_.y, p.z * scale_.z + shift_.z}
                               : p);
  }
  return made;
}

// boundaries: lists of lists, `shells` deep around surfaces; values: the same, one number or null in place of a
// surface.
void Reader::surfaces(const Params& boundaries, const std::optional<Params>& values, int shells, const std::string& at,
                      const Vertices& vertices, const std::vector<std::string>& kinds, const std::string& type,
                      std::vector<CityModel::Surface>& to) const {
  if (boundaries.kind() != Params::Kind::list) throw fault(at, "a list is expected");
  const bool listed = values && values->kind() == Params::Kind::list;
  if (listed && values->size() != boundaries.size())
    throw fault(at, strf("%zu boundaries and %zu semantic values", boundaries.size(), values->size()));
  for (size_t k = 0; k < boundaries.size(); ++k) {
    const std::string here = strf("%s[%zu]", at.c_str(), k);
    const auto value = listed ? std::optional((*values)[k]) : std::nullopt;
    if (shells > 0) {
      surfaces(boundaries[k], value, shells - 1, here, vertices, kinds, type, to);
      continue;
    }
    CityModel::Surface made{type, {}, line_};
    if (value && value->kind() == Params::Kind::scalar) {
      const long long number = value->as_integer(0, static_cast<long long>(kinds.size()) - 1);
      made.kind = kinds[static_cast<size_t>(number)];
    }
    const Params rings = boundaries[k];
    if (rings.kind() != Params::Kind::list) throw fault(here, "a list of rings is expected");
    for (const Params& ring : rings.items()) {
      std::vector<Vec3>& corners = made.rings.emplace_back();
      if (ring.kind() != Params::Kind::list) throw fault(here, "a ring is a list of indices");
      for (const Params& index : ring.items()) {
        const double v = index.as_number();
        if (!(v >= 0 && v < static_cast<double>(vertices.size()) && v == std::floor(v)))
          throw fault(here, strf("vertex %g of %zu", v, vertices.size()), "indices count from 0");
        corners.push_back(vertices[static_cast<size_t>(v)]);
      }
    }
    if (!made.rings.empty()) to.push_back(std::move(made));
  }
}

void Reader::geometry(const Params& g, const std::string& at, const Vertices& vertices, const std::string& type,
                      std::vector<CityModel::Surface>& to) {
  const std::string shape = g.text("type");
  if (shape == "GeometryInstance") return instance(g, at, vertices, type, to);
  const auto shells = shells_of(shape);
  if (!shells) {
    if (shape != "MultiPoint" && shape != "MultiLineString")
      throw fault(at + "/type", "'" + shape + "' is no type of geometry");
    ++lines_;
    return;
  }
  std::vector<std::string> kinds;
  std::optional<Params> values;
  if (const auto semantics = g.find("semantics"); semantics && semantics->kind() == Params::Kind::map) {
    for (const Params& surface : semantics->at("surfaces").items()) kinds.push_back(surface.text("type"));
    values = semantics->find("values");
  }
  textured_ += g.has("texture") || g.has("material");
  surfaces(g.at("boundaries"), values, *shells, at + "/boundaries", vertices, kinds, type, to);
}

// A template that is placed: turned, scaled and moved by a matrix, then put at a vertex.
void Reader::instance(const Params& g, const std::string& at, const Vertices& vertices, const std::string& type,
                      std::vector<CityModel::Surface>& to) {
  if (!templates_) throw fault(at + "/template", "the file has no geometry-templates");
  const auto number =
      static_cast<size_t>(g.at("template").as_integer(0, static_cast<long long>(templates_->size()) - 1));
  const std::vector<double> m = g.at("transformationMatrix").as_numbers();
  if (m.size() != 16) throw fault(at + "/transformationMatrix", strf("%zu numbers", m.size()), "16, row by row");
  const Params boundaries = g.at("boundaries");
  const double v = boundaries[0].as_number();
  if (boundaries.size() != 1 || !(v >= 0 && v < static_cast<double>(vertices.size()) && v == std::floor(v)))
    throw fault(at + "/boundaries", "one vertex is expected");
  const Params shape = (*templates_)[number];
  if (shape.text("type") == "GeometryInstance") throw fault(at, "a template of templates");
  std::vector<CityModel::Surface> made;
  geometry(shape, strf("geometry-templates/templates[%zu]", number), template_vertices_, type, made);
  const Affine3 turn{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[3], m[7], m[11]}};
  for (CityModel::Surface& surface : made) {
    if (!place_copy(surface, turn, vertices[static_cast<size_t>(v)], placed_))
      throw fault(at, "copies of templates have more than 2e7 corners", "place them as objects of a scene text");
    to.push_back(std::move(surface));
  }
}

void Reader::object(const std::string& id, const Params& p, const Vertices& vertices) {
  CityModel::Object made;
  made.id = id, made.type = p.text("type"), made.line = line_;
  if (const auto parents = p.find("parents"); parents && parents->size()) made.parent = parents->items()[0].as_text();
  const auto list = p.find("geometry");
  std::vector<double> levels;
  std::vector<Params> shapes;
  if (list && list->kind() == Params::Kind::list)
    for (const Params& g : list->items()) {
      const std::string at = strf("CityObjects/%s/geometry[%zu]", printable(id).substr(0, 80).c_str(), shapes.size());
      // A template's level is that of what it places.
      Params says = g;
      if (g.text("type") == "GeometryInstance" && templates_)
        says = (*templates_)[static_cast<size_t>(
            g.at("template").as_integer(0, static_cast<long long>(templates_->size()) - 1))];
      const auto level = level_of(says.text("lod", "0"));
      if (!level) throw fault(at + "/lod", "'" + says.text("lod") + "' is no level of detail");
      levels.push_back(*level);
      shapes.push_back(g);
    }
  const auto taken = chosen(levels, lod_);
  if (!taken && !levels.empty()) ++none_;
  unshaped_ += levels.empty();
  for (size_t k = 0; k < shapes.size() && taken; ++k)
    if (levels[k] == *taken)
      geometry(shapes[k], strf("CityObjects/%s/geometry[%zu]", printable(id).substr(0, 80).c_str(), k), vertices,
               made.type, made.surfaces);
  if (taken) made.lod = *taken;
  model_.objects.push_back(std::move(made));
}

void Reader::document(const Params& root, int line) {
  line_ = line;
  const std::string type = root.text("type");
  if (!begun_) {
    if (type != "CityJSON") throw fault("type", "'" + type + "' is no CityJSON", "a sequence begins with its header");
    head(root);
    begun_ = true;
  } else if (type != "CityJSONFeature") {
    throw fault("type", "'" + type + "' in a sequence", "CityJSONFeature");
  }
  const Vertices vertices = vertices_of(root.at("vertices"), "vertices", true);
  const Params objects = root.at("CityObjects");
  if (objects.kind() != Params::Kind::map) throw fault("CityObjects", "a map is expected");
  for (const std::string& id : objects.keys()) object(id, objects.at(id), vertices);
}

CityModel Reader::finish() {
  const auto add_finding = [&](const char* code, size_t count, const char* what) {
    if (count) report_.add(code, model_.file, {Where{model_.file, 0, 0, {}, -1}, strf("%zu %s", count, what)}, count);
  };
  add_finding("SP205", lines_, "geometries of points or lines");
  add_finding("SP705", none_, "objects have no geometry of the level of detail that is asked for");
  add_finding("SP706", unshaped_, "objects have no geometry of their own");
  add_finding("SP706", textured_, "geometries with appearances: display colours and textures are no spectra");
  return std::move(model_);
}

// Are all brackets that a line opens closed on it?
bool closes(std::string_view line) {
  int depth = 0;
  bool opened = false, quoted = false;
  for (size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '\\') ++k;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '{' || c == '[') ++depth, opened = true;
    if (c == '}' || c == ']') --depth;
  }
  return opened && depth == 0;
}

}  // namespace

CityModel parse_json(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                     Report& report) {
  Reader reader(file, lod, report);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  // A sequence has its first document on its first line; anything else is one document.
  const bool whole_line = closes(text.substr(0, text.find('\n')));
  if (!whole_line) {
    reader.document(Params::parse_json(text, file), 0);
    return reader.finish();
  }
  int line = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t stop = std::min(text.find('\n', begin), text.size());
    const std::string_view one = text.substr(begin, stop - begin);
    ++line, begin = stop + 1;
    if (one.find_first_not_of(" \t\r") == one.npos) continue;
    try {
      reader.document(Params::parse_json(one, file), line);
    } catch (const Error& e) {
      if (e.where().line) throw;
      throw Error(Where{file, line, 0, {}, -1}, e.message(), e.hint());
    }
  }
  return reader.finish();
}

}  // namespace suite::city
