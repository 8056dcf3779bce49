#include "model_import.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "formats/gltf/gltf.h"
#include "formats/ply/ply.h"
#include "formats/scene_text/scene_text.h"
#include "formats/stl/stl.h"
#include "scene/issues.h"

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
  return is_gltf(path, head) ? "gltf" : "";
}

bool sniff(const std::string& path, std::string_view head) { return !kind_of(path, head).empty(); }

// As a text between double quotes, for YAML.
std::string quoted(const std::string& text) {
  std::string q = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') q += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      q += strf("\\x%02x", c);
    else
      q += c;
  }
  return q + "\"";
}

// A curve from a display colour: three flat parts with ramps between them, which sum to 1, so that grey stays grey.
// What lies outside of the visible is held; that is a guess and no measurement.
std::string uplifted(const std::array<double, 3>& rgb) {
  return strf(
      "{points: [[0.38, %.4f], [0.485, %.4f], [0.505, %.4f], [0.575, %.4f], [0.6, %.4f], [0.78, %.4f]], "
      "outside: hold}",
      rgb[2], rgb[2], rgb[1], rgb[1], rgb[0], rgb[0]);
}

struct Made {
  std::string yaml;
  std::vector<SourceMaterial> materials;
  bool colours = false;  // the format has display colours at all
};

// What the materials of a model are called; its findings are those of the second reading.
std::vector<SourceMaterial> materials_of(const std::string& path, const ImportOptions& options, bool& nameless) {
  Report unheard(scene_issues());
  TrackedInputs inputs(path, options.search);
  SourceModelOptions how;
  how.name = "model", how.where = {path, 0, 0, {}, -1}, how.animation = "none";
  how.resolve = [&](const std::string& name) { return inputs.path_of(name); };
  const SourceModel model = read_gltf(path, how, unheard);
  nameless = std::any_of(model.meshes.begin(), model.meshes.end(), [](const SourceModel::Part& part) {
    return std::any_of(part.mesh.runs.begin(), part.mesh.runs.end(), [](auto& run) { return run.material.empty(); });
  });
  return model.materials;
}

Made text_of(const std::string& path, const std::string& file, const std::string& kind, const ImportOptions& options) {
  Made made;
  bool nameless = true;
  if (kind == "gltf") made.materials = materials_of(path, options, nameless), made.colours = true;
  const std::string name = quoted(std::filesystem::path(path).stem().string());
  std::string& y = made.yaml;
  y = "scene: 1\nname: " + name + "\nmaterials:\n";
  for (const SourceMaterial& m : made.materials) {
    const bool uplift = options.uplift;
    y += strf("  %s: {model: lambert, reflectance: %s, description: \"%s, display colour %.3f %.3f %.3f\"}\n",
              quoted(m.name).c_str(), uplift ? uplifted(m.rgb).c_str() : strf("%g", kStandIn).c_str(),
              uplift ? "guessed" : "stand-in", m.rgb[0], m.rgb[1], m.rgb[2]);
  }
  if (nameless) {
    made.materials.push_back({kNameless, {}});
    y += strf("  %s: {model: lambert, reflectance: %g, description: stand-in}\n", kNameless, kStandIn);
  }
  y += "objects:\n  " + name + ": {" + kind + ": " + quoted(file) +
       (nameless ? std::string(", material: ") + kNameless : "") + "}\nworld: [{place: " + name + ", tag: " + name +
       "}]\n";
  return made;
}

Draft read(const std::string& path, const ImportOptions& options, Report& report) {
  const std::string file = std::filesystem::path(path).filename().string();
  std::string head(std::min<size_t>(file_size(path), 4), '\0');
  RandomAccessFile(path).read_at(0, std::as_writable_bytes(std::span(head)));
  const Made made = text_of(path, file, kind_of(path, head), options);
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
                    (guessed ? strf("a spectrum is guessed from the display colour (%.3f, %.3f, %.3f)", m.rgb[0],
                                    m.rgb[1], m.rgb[2])
                             : strf("a grey of reflectance %g stands in", kStandIn))});
  }
  TrackedInputs inputs(path, options.search);
  const Params root = Params::parse_made(made.yaml, path, {}, options.settings);
  return read_scene_tree(root, inputs, report);
}

bool convert(const std::string& path, const ImportOptions& options, const std::string& folder) {
  namespace fs = std::filesystem;
  std::string head(std::min<size_t>(file_size(path), 4), '\0');
  RandomAccessFile(path).read_at(0, std::as_writable_bytes(std::span(head)));
  const std::string file = fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
  const std::string text = (fs::path(folder) / fs::path(path).stem()).string() + ".yaml";
  const Made made = text_of(path, file, kind_of(path, head), options);
  check_outputs({text});
  make_folder(folder);
  write_file(text, made.yaml);
  note("wrote " + text + ": give its materials spectra");
  return true;
}

}  // namespace

ImporterRow model_importer() {
  return {{"model", "a model: glTF or GLB, PLY, STL (formats/gltf, ply and stl)", "", read}, sniff, convert};
}

}  // namespace suite
