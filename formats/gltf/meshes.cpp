// Triangles, strips and fans of a mesh, joined; primitives that share their vertices keep sharing them.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, section 3.7.2.
#include <map>

#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

constexpr size_t kMostTriangles = size_t{1} << 28, kMostVertices = size_t{1} << 28;

class Joiner {
 public:
  Joiner(const tinygltf::Model& model, const std::string& file, double unit_m, MeshUvs uvs)
      : model_(model), file_(file), unit_m_(unit_m), uvs_(uvs), materials_(material_names(model)) {
    made_.file = file;
  }
  void add(const tinygltf::Primitive& primitive, const std::string& at);
  size_t without_their_uvs() const { return without_their_uvs_; }  // primitives
  SourceMesh take();

 private:
  struct Vertices {
    size_t first = 0, count = 0;
  };
  Vertices vertices(const tinygltf::Primitive& primitive, const std::string& at);
  std::vector<uint32_t> corners(const tinygltf::Primitive& primitive, const Vertices& v, const std::string& at) const;
  void triangles(const std::vector<uint32_t>& corner, int mode, const std::string& at);

  const tinygltf::Model& model_;
  const std::string& file_;
  const double unit_m_;
  const MeshUvs uvs_;
  const std::vector<std::string> materials_;
  // By accessors of what is taken of an attribute, and what is made of texture coordinates.
  std::map<std::pair<std::map<std::string, int>, std::array<double, 6>>, Vertices> known_;
  size_t without_their_uvs_ = 0;
  bool any_normal_ = false, any_uv_ = false;
  SourceMesh made_;
};

Joiner::Vertices Joiner::vertices(const tinygltf::Primitive& primitive, const std::string& at) {
  UvRule rule = uvs_ == MeshUvs::of_base_colours ? uv_rule_of(model_, file_, primitive.material) : UvRule{};
  std::string uvs = strf("TEXCOORD_%d", rule.set);
  if (rule.set > 0 && !primitive.attributes.count(uvs)) ++without_their_uvs_, uvs = "TEXCOORD_0";
  std::map<std::string, int> taken;
  for (const std::string& name : {std::string("POSITION"), std::string("NORMAL"), uvs})
    if (const auto found = primitive.attributes.find(name); found != primitive.attributes.end()) taken.insert(*found);
  const auto key = std::pair(taken, rule.transform);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const auto read = [&](const std::string& name, size_t components) {
    return taken.count(name) ? values_of(model_, file_, taken.at(name), at + "/attributes/" + name, {components})
                             : Values{};
  };
  const Values position = read("POSITION", 3), normal = read("NORMAL", 3), uv = read(uvs, 2);
  for (const auto& [values, name] : {std::pair{&normal, std::string("NORMAL")}, std::pair{&uv, uvs}})
    if (taken.count(name) && values->count != position.count)
      throw fault(file_, at + "/attributes/" + name,
                  strf("%zu values for %zu positions", values->count, position.count));
  const Vertices made{made_.positions.size(), position.count};
  if (made.first + made.count > kMostVertices) throw fault(file_, at, "more than 2^28 vertices in one mesh");
  any_normal_ = any_normal_ || normal.count, any_uv_ = any_uv_ || uv.count;
  for (size_t k = 0; k < position.count; ++k) {
    const double* p = &position.numbers[3 * k];
    made_.positions.push_back(Vec3{p[0], p[1], p[2]} * unit_m_);
    const Vec3 n =
        normal.count ? Vec3{normal.numbers[3 * k], normal.numbers[3 * k + 1], normal.numbers[3 * k + 2]} : Vec3{};
    const double size = length(n);
    made_.normals.push_back(size > 0 && std::isfinite(size) ? oct_encode(n / size) : kNoNormal);
    // v counts downwards in the file, upwards here.
    const auto& t = rule.transform;
    const double u = uv.count ? uv.numbers[2 * k] : 0, v = uv.count ? uv.numbers[2 * k + 1] : 0;
    made_.uvs.push_back(uv.count ? static_cast<float>(t[0] * u + t[1] * v + t[2]) : 0);
    made_.uvs.push_back(uv.count ? static_cast<float>(1 - (t[3] * u + t[4] * v + t[5])) : 0);
  }
  return known_[key] = made;
}

// The vertices in the order in which triangles are made of them, as they are numbered in the joined mesh.
std::vector<uint32_t> Joiner::corners(const tinygltf::Primitive& primitive, const Vertices& v,
                                      const std::string& at) const {
  std::vector<uint32_t> corner;
  if (primitive.indices < 0) {
    for (size_t k = 0; k < v.count; ++k) corner.push_back(static_cast<uint32_t>(v.first + k));
    return corner;
  }
  const tinygltf::Accessor& accessor = item_of(model_.accessors, primitive.indices, file_, at + "/indices", "accessor");
  if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      accessor.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    throw fault(file_, strf("accessors[%d]/componentType", primitive.indices),
                strf("%d is no type of indices", accessor.componentType), "5121, 5123 or 5125");
  if (accessor.normalized)
    throw fault(file_, strf("accessors[%d]/normalized", primitive.indices), "indices are not normalized");
  const Values values = values_of(model_, file_, primitive.indices, at + "/indices", {1});
  for (size_t k = 0; k < values.count; ++k) {
    const auto index = static_cast<size_t>(values.numbers[k]);
    if (index >= v.count)
      throw fault(file_, strf("accessors[%d]", primitive.indices), strf("index %zu of %zu vertices", index, v.count));
    corner.push_back(static_cast<uint32_t>(v.first + index));
  }
  return corner;
}

void Joiner::triangles(const std::vector<uint32_t>& corner, int mode, const std::string& at) {
  const size_t n = corner.size();
  const bool list = mode == TINYGLTF_MODE_TRIANGLES, strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
  if (list && n % 3) throw fault(file_, at, strf("%zu corners of triangles", n), "a multiple of 3");
  const size_t count = list ? n / 3 : n < 3 ? 0 : n - 2;
  if (made_.indices.size() / 3 + count > kMostTriangles) throw fault(file_, at, "more than 2^28 triangles in one mesh");
  for (size_t k = 0; k < count; ++k) {
    std::array<uint32_t, 3> t;
    if (list)
      t = {corner[3 * k], corner[3 * k + 1], corner[3 * k + 2]};
    else if (strip)
      t = {corner[k], corner[k + 1 + k % 2], corner[k + 2 - k % 2]};
    else
      t = {corner[k + 1], corner[k + 2], corner[0]};
    // In a strip these only lead to where it goes on.
    if (strip && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])) continue;
    made_.indices.insert(made_.indices.end(), t.begin(), t.end());
  }
}

void Joiner::add(const tinygltf::Primitive& primitive, const std::string& at) {
  if (!primitive.attributes.count("POSITION")) return;  // nothing to draw, says the specification
  std::string material;
  if (primitive.material >= 0) material = item_of(materials_, primitive.material, file_, at + "/material", "material");
  const Vertices v = vertices(primitive, at);
  const auto first = static_cast<uint32_t>(made_.indices.size() / 3);
  triangles(corners(primitive, v, at), primitive.mode, at);
  if (made_.indices.size() / 3 == first) return;
  if (made_.runs.empty() || made_.runs.back().material != material) made_.runs.push_back({"", material, first, 0});
}

SourceMesh Joiner::take() {
  if (!any_normal_) made_.normals.clear();
  if (!any_uv_) made_.uvs.clear();
  return std::move(made_);
}

}  // namespace

std::vector<std::string> material_names(const tinygltf::Model& model) {
  std::vector<std::string> names;
  for (size_t k = 0; k < model.materials.size(); ++k)
    names.push_back(model.materials[k].name.empty() ? strf("material_%zu", k) : model.materials[k].name);
  return names;
}

std::optional<SourceMesh> mesh_of(const tinygltf::Model& model, const std::string& file, int index, double unit_m,
                                  MeshUvs uvs, Report& report) {
  const tinygltf::Mesh& mesh = model.meshes[static_cast<size_t>(index)];
  const Where where{file, 0, 0, {}, -1};
  Joiner joiner(model, file, unit_m, uvs);
  size_t left_out = 0;
  for (size_t k = 0; k < mesh.primitives.size(); ++k) {
    const tinygltf::Primitive& primitive = mesh.primitives[k];
    const std::string at = strf("meshes[%d]/primitives[%zu]", index, k);
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      throw fault(file, at + "/mode", strf("%d is no kind of primitive", primitive.mode), "0 to 6");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES)
      ++left_out;
    else
      joiner.add(primitive, at);
  }
  if (left_out)
    report.add("SP205", file, {where, strf("meshes[%d]: %zu primitives of points or lines", index, left_out)},
               left_out);
  if (joiner.without_their_uvs())
    report.add(
        "SP705", file,
        {where, strf("meshes[%d]: %zu primitives have not the texture coordinates that their material's image is "
                     "laid out by: TEXCOORD_0 is taken",
                     index, joiner.without_their_uvs())},
        joiner.without_their_uvs());
  SourceMesh made = joiner.take();
  if (made.indices.empty()) return std::nullopt;
  return made;
}

}  // namespace suite::gltf
