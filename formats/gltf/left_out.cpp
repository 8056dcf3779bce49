// What a file says and a scene has no place for.
#include <algorithm>

#include "formats/gltf/load.h"
#include "scene/left_out_look.h"

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
    {"KHR_texture_transform", nullptr},
    {"KHR_xmp_json_ld", "metadata"},
    {"EXT_texture_webp", "textures are no spectra"},
    {"MSFT_texture_dds", "textures are no spectra"},
};

const Extension* known(const std::string& name) {
  const auto* found = std::find_if(std::begin(kKnown), std::end(kKnown), [&](const auto& e) { return name == e.name; });
  return found == std::end(kKnown) ? nullptr : found;
}

// What is left out of materials and meshes.
LeftOutLook look_of(const tinygltf::Model& model) {
  LeftOutLook look;
  for (const tinygltf::Material& m : model.materials) {
    const auto& glow = m.emissiveFactor;
    look.see_through += m.alphaMode != "OPAQUE" && !m.alphaMode.empty();
    look.shining += std::any_of(glow.begin(), glow.end(), [](double v) { return v > 0; });
    look.bumps += m.normalTexture.index >= 0;
    look.gloss += m.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0 || m.occlusionTexture.index >= 0;
    look.one_sided += !m.doubleSided;
  }
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& p : mesh.primitives) look.coloured += p.attributes.count("COLOR_0");
  return look;
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
  size_t metals = 0, morphs = 0, coordinates = 0;
  for (const tinygltf::Material& m : model.materials)
    metals += m.pbrMetallicRoughness.metallicFactor > 0.5 && m.pbrMetallicRoughness.metallicRoughnessTexture.index < 0;
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& p : mesh.primitives)
      morphs += !p.targets.empty(), coordinates += p.attributes.count("TEXCOORD_1");
  if (!textures)
    add_finding("SP706",
                strf("%zu primitives with a second set of texture coordinates: the first is taken", coordinates),
                coordinates);
  if (textures)
    add_finding("SP707", strf("%zu materials of metal: they are matte here ('materials:' names better ones)", metals),
                metals);
  add_finding("SP705", strf("%zu primitives with morph targets: they keep their basic shape", morphs), morphs);
  look_of(model).report(file, report);
}

}  // namespace suite::gltf
