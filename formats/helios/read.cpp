// Based on: L. Winiwarter et al., "Virtual laser scanning with HELIOS++", Remote Sens. Environ. 269, 2022, and its
// public scenes and documentation (https://github.com/3dgeo-heidelberg/helios): a part is loaded by its first filter,
// then turned, scaled and moved.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "base/number_text.h"
#include "base/yaml_text.h"
#include "formats/helios/helios.h"
#include "formats/helios/on_ground.h"
#include "formats/helios/part.h"
#include "formats/helios/xyz.h"
#include "formats/xml/xml.h"

namespace suite {

namespace helios {
namespace {

// Lines of YAML, each with the place that it comes from.
struct Lines {
  std::string yaml;
  std::vector<Where> origins;
  void add(const std::string& line, const Where& where) {
    yaml += line + "\n";
    origins.push_back(where);
  }
  void add(const Lines& more) {
    yaml += more.yaml;
    origins.insert(origins.end(), more.origins.begin(), more.origins.end());
  }
};

constexpr const char *kSurface = "surface", *kFoliage = "foliage";
constexpr double kGrey = 0.18, kLeaf = 0.4;  // of what nothing is known of

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

double number(const XmlElement& e, const std::string& text) {
  const auto value = number_of(text);
  if (!value || !(std::abs(*value) <= kLargestNumber))
    throw e.fault("'" + printable(text).substr(0, 40) + "' is no number");
  return *value;
}

class Reader {
 public:
  Reader(const HeliosFiles& files, const std::string& file, Report& report)
      : files_(files), file_(file), report_(report) {}
  HeliosText run(const XmlElement& document);

 private:
  void part(const XmlElement& e);
  void filter(const XmlElement& e, Part& part);
  void load(const XmlElement& e, const std::string& kind, Part& part);
  void load_terrain(const XmlElement& e, const std::string& path, Part& part);
  void load_voxels(const XmlElement& e, const std::string& path, Part& part);
  void load_points(const XmlElement& e, const std::string& path, Part& part);
  void rotate(const XmlElement& e, Part& part);
  void translate(const XmlElement& e, Part& part);
  void place_parts();
  // Whether it is new.
  bool name_for(const std::string& path, const std::string& how, std::map<std::string, std::string>& names,
                std::string& name);
  static std::optional<std::string> value_of(const XmlElement& e, std::string_view key);
  void add_finding(const char* code, const XmlElement& e, const std::string& what) {
    report_.add(code, file_, {e.where(), what});
  }

  const HeliosFiles& files_;
  const std::string& file_;
  Report& report_;
  Lines objects_, grids_, volumes_, world_;
  std::vector<Part> parts_;
  std::map<std::string, std::string> object_of_, grid_of_;
  std::set<std::string> used_;
};

// As there the first of a name counts.
std::optional<std::string> Reader::value_of(const XmlElement& e, std::string_view key) {
  std::optional<std::string> found;
  e.each_child("param", [&](const XmlElement& p) {
    if (!found && p.attribute("key").value_or("") == key) found = p.attribute("value").value_or("");
  });
  return found;
}

// One name for each file and way of reading it: its stem.
bool Reader::name_for(const std::string& path, const std::string& how, std::map<std::string, std::string>& names,
                      std::string& name) {
  const auto [at, fresh] = names.try_emplace(path + "\n" + how);
  if (fresh) {
    const std::string stem = std::filesystem::path(path).stem().string();
    at->second = stem;
    for (int k = 2; !used_.insert(at->second).second; ++k) at->second = stem + strf("-%d", k);
  }
  name = at->second;
  return fresh;
}

void Reader::load_terrain(const XmlElement& e, const std::string& path, Part& part) {
  if (!name_for(path, "", object_of_, part.object)) return;
  const HeliosGrid grid = files_.grid_of(path);
  objects_.add("  " + yaml_quoted(part.object) + ": {terrain: " + yaml_quoted(path) +
                   (grid.no_data ? strf(", no_data: %.17g", *grid.no_data) : "") +
                   strf(", local: {origin: [%.17g, %.17g], gsd: [%.17g, %.17g]}, material: %s}", grid.corner[0],
                        grid.corner[1], grid.pixel[0], grid.pixel[1], kSurface),
               e.where());
}

void Reader::load_voxels(const XmlElement& e, const std::string& path, Part& part) {
  if (const std::string mode = lower(value_of(e, "intersectionMode").value_or("transmittive")); mode != "transmittive")
    add_finding(
        "SP707", e,
        "voxels of mode '" + printable(mode) + "' are solid cubes there; here their leaves fill their cells evenly");
  if (name_for(path, "", grid_of_, part.object))
    grids_.add("  " + yaml_quoted(part.object) + ": {voxels: " + yaml_quoted(path) + ", medium: " + kFoliage + "}",
               e.where());
}

// Cubes where points are, as there.
void Reader::load_points(const XmlElement& e, const std::string& path, Part& part) {
  const double said = number(e, value_of(e, "voxelSize").value_or("0")), edge = part.edge_m = said == 0 ? 1 : said;
  if (!(edge > 0)) throw e.fault(strf("a voxelSize of %g", edge), "metres, above 0");
  part.separators = value_of(e, "separator").value_or("");
  if (!name_for(path, strf("%.17g %s", edge, part.separators.c_str()), object_of_, part.object)) return;
  const Cubes cubes = cubes_of_xyz(files_.text_of(path), path, part.separators, edge);
  add_finding("SP707", e,
              strf("%zu points are %zu solid cubes of %g m, as there; their colours and normals are left out",
                   cubes.points, cubes.centres.size(), edge));
  objects_.add(
      "  " + yaml_quoted(part.object) + ": {obj_text: " + yaml_quoted(cubes.obj) + ", material: " + kSurface + "}",
      e.where());
}

void Reader::load(const XmlElement& e, const std::string& kind, Part& part) {
  std::string path = value_of(e, "filepath").value_or("");
  if (path.empty()) throw e.fault("there is no param 'filepath'");
  std::replace(path.begin(), path.end(), '\\', '/');
  if (path.find('*') != path.npos) return add_finding("SP705", e, "several files at once, '" + printable(path) + "'");
  part.path = path;
  part.matfile = value_of(e, "matfile").value_or(""), part.material = value_of(e, "matname").value_or("");
  std::replace(part.matfile.begin(), part.matfile.end(), '\\', '/');
  if (kind == "xyzloader") return part.kind = Part::Kind::points, load_points(e, path, part);
  if (kind == "geotiffloader") return part.kind = Part::Kind::terrain, load_terrain(e, path, part);
  if (kind == "detailedvoxels") return part.kind = Part::Kind::voxels, load_voxels(e, path, part);
  part.kind = Part::Kind::mesh;
  part.y_up = lower(value_of(e, "up").value_or("z")) == "y";
  if (name_for(path, part.y_up ? "y" : "", object_of_, part.object))
    objects_.add("  " + yaml_quoted(part.object) + ": {obj: " + yaml_quoted(path) + (part.y_up ? ", up: y" : "") +
                     ", material: " + kSurface + "}",
                 e.where());
}

// Turns one after the other about the axes of the scene; local ones, about axes that turn along, are the same in
// reverse.
void Reader::rotate(const XmlElement& e, Part& part) {
  e.each_child("param", [&](const XmlElement& p) {
    std::vector<Turn> turns;
    p.each_child("rot", [&](const XmlElement& rot) {
      const std::string axis = lower(rot.attribute("axis").value_or(""));
      const double angle = number(rot, rot.attribute("angle_deg").value_or(""));
      if (axis == "x" || axis == "pitch")
        turns.push_back({{1, 0, 0}, angle});
      else if (axis == "y" || axis == "roll")
        turns.push_back({{0, 1, 0}, angle});
      else if (axis == "z" || axis == "yaw")
        turns.push_back({{0, 0, 1}, angle});
      else
        throw rot.fault("'" + printable(axis) + "' is no axis", "x, y, z; pitch, roll, yaw");
    });
    if (p.attribute("rotations").value_or("") == "local") std::reverse(turns.begin(), turns.end());
    part.turns.insert(part.turns.end(), turns.begin(), turns.end());
  });
}

// As there the last offset of a part counts.
void Reader::translate(const XmlElement& e, Part& part) {
  std::string offset = value_of(e, "offset").value_or("");
  std::vector<double> values;
  for (size_t at = 0; at <= offset.size();) {
    const size_t stop = std::min(offset.find(';', at), offset.size());
    std::string word = offset.substr(at, stop - at);
    word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
    values.push_back(number(e, word));
    at = stop + 1;
  }
  if (values.size() != 3) throw e.fault(strf("an offset of %zu numbers", values.size()), "x;y;z");
  part.shift = {values[0], values[1], values[2]};
  if (const auto ground = value_of(e, "onGround")) {
    const double depth = lower(*ground) == "true" ? 1 : lower(*ground) == "false" ? 0 : number(e, *ground);
    if (!(depth >= -1 && depth <= 2147483647 && depth == std::floor(depth)))
      throw e.fault(strf("an onGround of %g", depth), "-1, 0 or how many vertices are tried");
    part.on_ground = static_cast<long long>(depth);
  }
}

void Reader::filter(const XmlElement& e, Part& part) {
  const std::string kind = lower(e.attribute("type").value_or(""));
  if (kind == "objloader" || kind == "geotiffloader" || kind == "xyzloader" || kind == "detailedvoxels") {
    if (part.kind != Part::Kind::none) throw e.fault("a part that is loaded twice");
    load(e, kind, part);
  } else if (kind == "scale") {
    const double factor = number(e, value_of(e, "scale").value_or(""));
    if (!(factor > 0)) throw e.fault(strf("a scale of %g", factor), "above 0");
    part.scale = factor;  // as there the last one counts
  } else if (kind == "rotate") {
    rotate(e, part);
  } else if (kind == "translate") {
    translate(e, part);
  } else {
    add_finding("SP705", e, "filter '" + printable(kind) + "'");
  }
}

void Reader::part(const XmlElement& e) {
  Part part;
  e.each_child([&](const XmlElement& child) {
    if (child.name() == "filter")
      filter(child, part);
    else
      add_finding("SP705", child, "'" + printable(child.name()) + "': parts stay as and where they are loaded");
  });
  if (part.object.empty()) return;
  part.id = e.attribute("id").value_or("");
  part.where = e.where();
  parts_.push_back(std::move(part));
}

void Reader::place_parts() {
  const auto stands = [](const Part& part) { return part.on_ground != 0; };
  if (std::any_of(parts_.begin(), parts_.end(), stands))
    put_on_ground(parts_, files_, [&](const char* code, const Part& part, const std::string& what) {
      report_.add(code, file_, {part.where, what});
    });
  for (const Part& part : parts_) {
    const bool volume = part.kind == Part::Kind::voxels;
    std::string line = "  - {place: " + yaml_quoted(part.object), turns;
    if (part.scale != 1) line += strf(", scale: %.17g", part.scale);
    for (const Turn& t : part.turns)
      turns += strf("%s{axis: [%g, %g, %g], angle_deg: %.17g}", turns.empty() ? "" : ", ", t.axis.x, t.axis.y, t.axis.z,
                    t.angle_deg);
    if (!turns.empty()) line += ", rotate: [" + turns + "]";
    line += strf(", translate: [%.17g, %.17g, %.17g]", part.shift.x, part.shift.y, part.shift.z);
    if (!part.id.empty() && !volume) line += ", tag: " + yaml_quoted(part.id);
    (volume ? volumes_ : world_).add(line + "}", part.where);
  }
}

HeliosText Reader::run(const XmlElement& document) {
  std::optional<XmlElement> scene;
  size_t scenes = 0;
  document.each_child("scene", [&](const XmlElement& e) {
    if (!scenes++) scene = e;
  });
  if (!scene) throw document.fault("there is no scene in it");
  if (scenes > 1) add_finding("SP705", *scene, strf("the first of %zu scenes is taken", scenes));
  scene->each_child([&](const XmlElement& e) {
    if (e.name() == "part")
      part(e);
    else
      add_finding("SP706", e, "'" + printable(e.name()) + "' belongs to the simulation");
  });
  place_parts();
  const Where where = scene->where();
  Lines all;
  const std::string name = scene->attribute("name").value_or(scene->attribute("id").value_or("helios"));
  all.add("scene: 1", where);
  all.add("name: " + yaml_quoted(name), where);
  all.add(strf("materials: {%s: {model: lambert, reflectance: %g}}", kSurface, kGrey), where);
  add_finding("SP708", *scene,
              strf("all surfaces: a grey of reflectance %g stands in (material '%s')", kGrey, kSurface));
  if (!grids_.yaml.empty()) {
    all.add(strf("media: {%s: {leaves: {reflectance: %g, transmittance: %g}}}", kFoliage, kLeaf, kLeaf), where);
    add_finding("SP708", *scene,
                strf("all voxels: leaves that reflect and transmit %g stand in (--set media.%s.leaves.reflectance=...)",
                     kLeaf, kFoliage));
  }
  const auto section = [&](const char* key, const Lines& lines) {
    if (lines.yaml.empty()) return;
    all.add(key, where);
    all.add(lines);
  };
  section("grids:", grids_), section("volumes:", volumes_), section("objects:", objects_);
  if (world_.yaml.empty()) all.add("world: []", where);
  section("world:", world_);
  return {std::move(all.yaml), std::move(all.origins)};
}

}  // namespace
}  // namespace helios

HeliosText parse_helios(std::string_view text, const std::string& file, const HeliosFiles& files, Report& report) {
  return helios::Reader(files, file, report).run(XmlElement::parse(text, file));
}

bool is_helios(const std::string& path, std::string_view head) {
  return path.ends_with(".xml") && head.find("<document") != head.npos && head.find("<scene") != head.npos;
}

}  // namespace suite
