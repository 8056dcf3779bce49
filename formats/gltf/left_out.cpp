// What a file says and a scene has no place for.
#include <algorithm>
#include <functional>

#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

struct Extension {
  const char* name;
  const char* fate;  // null: read; else why it may be left out
};
// Whatever is not here is refused where the file requires it and told where it does not.
constexpr const char* kNoSpectra = "appearances are no spectra";
constexpr Extension kKnown[] = {
    {"KHR_mesh_quantization", nullptr},
    {"EXT_mesh_gpu_instancing", nullptr},
    {"KHR_lights_punctual", "lights belong to the simulation"},
    {"KHR_materials_anisotropy", kNoSpectra},
    {"KHR_materials_clearcoat", kNoSpectra},
    {"KHR_materials_dispersion", kNoSpectra},
    {"KHR_materials_emissive_strength", kNoSpectra},
    {"KHR_materials_ior", kNoSpectra},
    {"KHR_materials_iridescence", kNoSpectra},
    {"KHR_materials_pbrSpecularGlossiness", kNoSpectra},
    {"KHR_materials_sheen", kNoSpectra},
    {"KHR_materials_specular", kNoSpectra},
    {"KHR_materials_transmission", kNoSpectra},
    {"KHR_materials_unlit", kNoSpectra},
    {"KHR_materials_variants", "the materials that stand at the primitives hold"},
    {"KHR_materials_volume", kNoSpectra},
    {"KHR_texture_basisu", "textures are no spectra"},
    {"KHR_texture_transform", "texture coordinates are taken as they are"},
    {"KHR_xmp_json_ld", "metadata"},
    {"EXT_texture_webp", "textures are no spectra"},
    {"MSFT_texture_dds", "textures are no spectra"},
};

const Extension* known(const std::string& name) {
  const auto* found = std::find_if(std::begin(kKnown), std::end(kKnown), [&](const auto& e) { return name == e.name; });
  return found == std::end(kKnown) ? nullptr : found;
}

// What is left out of materials whose base colours are taken.
void report_surfaces(const tinygltf::Model& model,
                     const std::function<void(const char*, const std::string&, size_t)>& add_finding) {
  size_t metals = 0, others = 0;
  for (const tinygltf::Material& m : model.materials) {
    const tinygltf::PbrMetallicRoughness& pbr = m.pbrMetallicRoughness;
    metals += pbr.metallicFactor > 0.5 && pbr.metallicRoughnessTexture.index < 0;
    others += (pbr.metallicRoughnessTexture.index >= 0) + (m.normalTexture.index >= 0) +
              (m.occlusionTexture.index >= 0) + (m.emissiveTexture.index >= 0);
  }
  add_finding("SP707", strf("%zu materials of metal: they are matte here ('materials:' names better ones)", metals),
              metals);
  add_finding("SP705", strf("%zu textures of roughness, normals, occlusion or light: base colours are taken", others),
              others);
}

}  // namespace

void check_extensions(const tinygltf::Model& model, const std::string& file) {
  for (const std::string& name : model.extensionsRequired)
    if (!known(name))
      throw fault(file, "extensionsRequired", "'" + printable(name).substr(0, 80) + "' is not read here",
                  name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression"
                      ? "write the file again without compression"
                      : "write the file again without it");
  for (size_t m = 0; m < model.meshes.size(); ++m)
    for (size_t k = 0; k < model.meshes[m].primitives.size(); ++k)
      if (model.meshes[m].primitives[k].extensions.count("KHR_draco_mesh_compression"))
        throw fault(file, strf("meshes[%zu]/primitives[%zu]", m, k), "is compressed by Draco, which is not read here",
                    "write the file again without compression");
}

void report_left_out(const tinygltf::Model& model, const std::string& file, bool textures, Report& report) {
  const auto add_finding = [&](const char* code, const std::string& what, size_t count) {
    if (count) report.add(code, file, {Where{file, 0, 0, {}, -1}, what}, count);
  };
  for (const std::string& name : model.extensionsUsed) {
    const Extension* e = known(name);
    if (e && !e->fate) continue;
    const std::string short_name = printable(name).substr(0, 80);
    add_finding("SP705", "extension " + short_name + ": " + (e ? e->fate : "unknown here"), 1);
  }
  add_finding("SP706", strf("%zu cameras: cameras belong to the simulation", model.cameras.size()),
              model.cameras.size());
  add_finding("SP705", strf("%zu lights: lights belong to the simulation", model.lights.size()), model.lights.size());
  add_finding("SP705",
              strf("%zu skins: bodies stand as their meshes are stored, not bent by joints", model.skins.size()),
              model.skins.size());
  if (!textures)
    add_finding(
        "SP705",
        strf("%zu textures: display colours are no spectra, maps are ('textures: {uplift: texel}' guesses spectra)",
             model.textures.size()),
        model.textures.size());
  if (textures) report_surfaces(model, add_finding);
  size_t morphs = 0, colours = 0, see_through = 0, shining = 0, coordinates = 0;
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& p : mesh.primitives) {
      morphs += !p.targets.empty();
      colours += p.attributes.count("COLOR_0"), coordinates += p.attributes.count("TEXCOORD_1");
    }
  for (const tinygltf::Material& m : model.materials) {
    see_through += m.alphaMode != "OPAQUE" && !m.alphaMode.empty();
    shining += std::any_of(m.emissiveFactor.begin(), m.emissiveFactor.end(), [](double v) { return v > 0; });
  }
  add_finding("SP705", strf("%zu primitives with morph targets: they keep their basic shape", morphs), morphs);
  add_finding("SP706", strf("%zu primitives with colours of vertices: display colours are no spectra", colours),
              colours);
  add_finding("SP706", strf("%zu primitives with a second set of texture coordinates: the first is taken", coordinates),
              coordinates);
  add_finding(
      "SP705",
      strf("%zu materials that are seen through: surfaces are whole, an 'opacity' map makes holes", see_through),
      see_through);
  add_finding("SP705", strf("%zu materials that shine: radiance comes from temperatures and lamps", shining), shining);
}

}  // namespace suite::gltf
