#include "model_import.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/files.h"
#include "base/inputs.h"
#include "base/kept_texts.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "base/yaml_text.h"
#include "formats/assimp/assimp.h"
#include "formats/city/city.h"
#include "formats/gltf/gltf.h"
#include "formats/ply/ply.h"
#include "formats/scene_text/scene_text.h"
#include "formats/stl/stl.h"
#include "motion/map_system.h"
#include "scene/issues.h"
#include "spectral/display_colour.h"

namespace suite {

namespace {

constexpr double kStandIn = 0.18;             // reflectance of what nothing is known of
constexpr const char* kNameless = "surface";  // the material of faces that name none

std::string extension_of(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e;
}

std::string kind_of(const std::string& path, std::string_view head) {
  const std::string e = extension_of(path);
  if (e == ".ply" || e == ".stl") return e.substr(1);
  if (is_assimp(path)) return "model";
  if (!city_format(path, head).empty()) return "city";
  return is_gltf(path, head) ? "gltf" : "";
}

bool sniff(const std::string& path, std::string_view head) { return !kind_of(path, head).empty(); }

// A curve from a display colour, as a text.
std::string uplifted_text(const LinearRgb& rgb) {
  const auto waves = uplifted_wavelengths_um();
  const auto values = uplifted_values(rgb);
  std::string points;
  for (size_t i = 0; i < waves.size(); ++i) points += strf("%s[%g, %.4f]", i ? ", " : "", waves[i], values[i]);
  return "{points: [" + points + "], outside: hold}";
}

struct Made {
  std::string yaml;
  std::string placed_by, origin;  // what is assumed; where on the Earth it is
  std::vector<SourceMaterial> materials;
  bool colours = false;  // the format has display colours at all
};

// What the materials of a model are called; its findings are those of the second reading.
std::vector<SourceMaterial> materials_of(const std::string& path, const std::string& kind, const ImportOptions& options,
                                         bool& nameless) {
  Report unheard(scene_issues());
  TrackedInputs inputs(path, options.search);
  SourceModelOptions how;
  how.name = "model", how.where = {path, 0, 0, {}, -1}, how.animation = "none";
  how.resolve = [&](const std::string& name) { return inputs.path_of(name); };
  how.textures = options.uplift;
  const SourceModel model = kind == "gltf" ? read_gltf(path, how, unheard) : read_assimp(path, how, nullptr, unheard);
  nameless = std::any_of(model.meshes.begin(), model.meshes.end(), [](const SourceModel::Part& part) {
    return std::any_of(part.mesh.runs.begin(), part.mesh.runs.end(), [](auto& run) { return run.material.empty(); });
  });
  return model.materials;
}

// The materials of a city, and its place: the middle of what it holds, at its lowest height, becomes the origin.
// Returns what its object has to say of that.
std::string place_city(const std::string& path, Made& made) {
  Report unheard(scene_issues());
  const CityModel city = read_city(path, std::nullopt, unheard);
  std::set<std::string> kinds;
  for (const CityModel::Object& object : city.objects)
    for (const CityModel::Surface& surface : object.surfaces) kinds.insert(surface.kind);
  for (const std::string& kind : kinds) made.materials.push_back({kind, {}, nullptr});
  const Box3 box = extent_of(city);
  if (box.empty() || !finite(box.center())) return "";
  const Vec3 at{box.center().x, box.center().y, box.low.z};
  const auto epsg = epsg_of_name(city.system);
  const auto system = epsg ? map_system_of_epsg(*epsg) : std::nullopt;
  if (!system) {
    made.placed_by = "its reference system '" + printable(city.system) +
                     "' is not known here: its map is taken as flat, with no place on the Earth";
    return strf(", local: [%.3f, %.3f, %.3f]", at.x, at.y, at.z);
  }
  Geodetic g{at.x, at.y, at.z};
  if (system->zone) g = geodetic_from_utm({*system->zone, at.x, at.y, at.z});
  check_geodetic(g);
  if (system->heights != MapSystem::Heights::ellipsoid)
    made.placed_by =
        "heights are taken as above the ellipsoid; above the geoid with --set origin.geoid=FILE.pgm --set "
        "origin.height=geoid --set objects.NAME.height=geoid";
  made.origin = strf("origin: {latitude_deg: %.9f, longitude_deg: %.9f, height_m: %.3f}\n", g.latitude_deg,
                     g.longitude_deg, g.height_m);
  return ", height: ellipsoid";
}

Made text_of(const std::string& path, const std::string& file, const std::string& kind, const ImportOptions& options) {
  Made made;
  bool nameless = true;
  if (kind == "gltf" || kind == "model")
    made.materials = materials_of(path, kind, options, nameless), made.colours = true;
  std::string keys;
  if (kind == "city") keys = place_city(path, made), nameless = false;
  const std::string name = yaml_quoted(std::filesystem::path(path).stem().string());
  std::string& y = made.yaml;
  y = "scene: 1\nname: " + name + "\n" + made.origin;
  if (nameless || std::ranges::any_of(made.materials, [](const SourceMaterial& m) { return !m.texture; }))
    y += "materials:\n";
  bool textures = false;
  for (const SourceMaterial& m : made.materials) {
    const bool uplift = options.uplift && made.colours;
    if (m.texture) {
      textures = true;  // its object makes the material
      continue;
    }
    y += strf("  %s: {model: lambert, reflectance: %s, description: \"%s %.3f %.3f %.3f\"}\n",
              yaml_quoted(m.name).c_str(), uplift ? uplifted_text(m.rgb).c_str() : strf("%g", kStandIn).c_str(),
              uplift ? kUplifted : "stand-in, display colour", m.rgb[0], m.rgb[1], m.rgb[2]);
  }
  if (textures) keys += ", textures: {uplift: texel}";
  if (nameless) {
    made.materials.push_back({kNameless, {}, nullptr});
    y += strf("  %s: {model: lambert, reflectance: %g, description: stand-in}\n", kNameless, kStandIn);
  }
  y += "objects:\n  " + name + ": {" + kind + ": " + yaml_quoted(file) + keys +
       (nameless ? std::string(", material: ") + kNameless : "") + "}\nworld: [{place: " + name + ", tag: " + name +
       "}]\n";
  return made;
}

Draft read_model(const std::string& path, const ImportOptions& options, Report& report) {
  const std::string file = std::filesystem::path(path).filename().string();
  std::string head(std::min<size_t>(file_size(path), 4096), '\0');
  RandomAccessFile(path).read_at(0, std::as_writable_bytes(std::span(head)));
  const Made made = text_of(path, file, kind_of(path, head), options);
  if (!made.placed_by.empty()) report.add("SP707", path, {Where{path, 0, 0, {}, -1}, made.placed_by});
  if (options.uplift && !made.colours) warn("--uplift: " + file + " has no materials with display colours");
  for (const SourceMaterial& m : made.materials) {
    const std::string setting = "materials." + m.name;
    if (std::any_of(options.settings.begin(), options.settings.end(), [&](const std::string& s) {
          return s.compare(0, setting.size(), setting) == 0 && s.size() > setting.size() &&
                 (s[setting.size()] == '=' || s[setting.size()] == '.');
        }))
      continue;
    const bool guessed = options.uplift && made.colours && m.name != kNameless;
    report.add("SP708", path,
               {Where{path, 0, 0, {}, -1},
                "material '" + m.name + "': " +
                    (m.texture ? "its texture is uplifted to spectra"
                     : guessed ? strf("a spectrum is guessed from the display colour (%.3f, %.3f, %.3f)", m.rgb[0],
                                      m.rgb[1], m.rgb[2])
                               : strf("a grey of reflectance %g stands in", kStandIn))});
  }
  TrackedInputs inputs(path, options.search);
  const Params root = Params::parse_made(made.yaml, path, {}, options.settings);
  return read_scene_tree(root, inputs, report);
}

bool convert_model(const std::string& path, const ImportOptions& options, const std::string& folder) {
  namespace fs = std::filesystem;
  std::string head(std::min<size_t>(file_size(path), 4096), '\0');
  RandomAccessFile(path).read_at(0, std::as_writable_bytes(std::span(head)));
  const std::string file = fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
  const std::string text = (fs::path(folder) / fs::path(path).stem()).string() + ".yaml";
  const Made made = text_of(path, file, kind_of(path, head), options);
  check_outputs({text});
  make_folder(folder);
  const NamedText made_text[] = {{text, made.yaml}};
  write_kept_texts(made_text);
  note("wrote " + text + ": give its materials spectra");
  return true;
}

}  // namespace

ImporterRow model_importer() {
  return {
      {"model",
       "a model: glTF or GLB, FBX, Collada, 3DS, PLY, STL, CityJSON, CityGML (formats/gltf, assimp, ply, stl and city)",
       "", read_model},
      sniff,
      convert_model};
}

}  // namespace suite
