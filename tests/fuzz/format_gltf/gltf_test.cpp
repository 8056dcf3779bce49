// Damaged glTF: text with a data URI, and GLB. What comes out must hold together.
#include "formats/gltf/gltf.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/gltf_kit.h"

namespace suite::format_gltf_gltf_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  SourceModelOptions how{.name = "m", .where = {"scene.yaml", 1, 1, {}, -1}, .y_up = true, .textures = true};
  how.resolve = [](const std::string& name) -> std::string { throw Error(Where{name, 0, 0, {}, -1}, "is not there"); };
  const SourceModel model = parse_gltf(bytes, "fuzz.gltf", how, report);
  for (const SourceModel::Part& part : model.meshes) {
    const SourceMesh& m = part.mesh;
    if (m.indices.empty() || m.runs.empty()) throw std::runtime_error("a mesh without triangles came out");
    for (const uint32_t v : m.indices)
      if (v >= m.positions.size()) throw std::runtime_error("an index that is not there came out");
    for (const Vec3& p : m.positions)
      if (!finite(p)) throw std::runtime_error("a place that is not finite came out");
    if (!m.normals.empty() && m.normals.size() != m.positions.size()) throw std::runtime_error("a normal is missing");
    if (!m.uvs.empty() && m.uvs.size() != 2 * m.positions.size()) throw std::runtime_error("a coordinate is missing");
  }
}

// Everything that the reader looks at, once.
std::string model(bool binary) {
  test::GltfFile f;
  const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  f.places(square);                                           // 0
  f.indices({0, 1, 2, 0, 2, 3});                              // 1
  f.places({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});             // 2
  f.floats({0, 0, 1, 0, 1, 1, 0, 1}, "VEC2", 2);              // 3
  f.floats({0, 1, 2}, "SCALAR", 1);                           // 4
  f.places({0, 0, 0, 1, 0, 0, 2, 0, 0});                      // 5
  f.floats({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}, "VEC4", 4);  // 6
  const int base = f.view(square), at = f.view(std::vector<uint16_t>{2}), value = f.view(std::vector<float>{9, 8, 7});
  f.raw_accessor(strf(
      R"({"bufferView":%d,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":%d,"componentType":5123},"values":{"bufferView":%d}}})",
      base, at, value));  // 7
  const std::string rest =
      R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"a","children":[1,2],"translation":[1,2,3]},{"mesh":0,"rotation":[0,0,0,1]},
      {"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":5,"ROTATION":6}}}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":2,"TEXCOORD_0":3},"indices":1,"material":0}]},
      {"primitives":[{"attributes":{"POSITION":7},"mode":5},{"attributes":{"POSITION":0},"mode":6}]}],
      "materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"baseColorTexture":{"index":0}}}],
      "textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071,"magFilter":9728}],"images":[{"bufferView":0,"mimeType":"image/png"}],
      "animations":[{"samplers":[{"input":4,"output":5},{"input":4,"output":6,"interpolation":"STEP"}],
      "channels":[{"sampler":0,"target":{"node":1,"path":"translation"}},{"sampler":1,"target":{"node":1,"path":"rotation"}}]}],
      "extensionsUsed":["EXT_mesh_gpu_instancing"])";
  return binary ? f.binary(rest) : f.text(rest);
}

const std::vector<std::string> kWords{
    "null", "-1", "1e308", "4294967295",      "5120",     "5126",      "[]",  "{}",   "\"\"",
    "true", "0",  "7",     "\"CUBICSPLINE\"", "\"VEC4\"", "\"scale\"", "2.5", "[[[[", "}}}}"};

TEST(FuzzGltf, Text) { test::fuzz(test::bytes_of(model(false)), read_and_check, 1, test::kMutations, kWords); }
TEST(FuzzGltf, Container) { test::fuzz(test::bytes_of(model(true)), read_and_check, 2, test::kMutations, kWords); }

}  // namespace
}  // namespace suite::format_gltf_gltf_test
