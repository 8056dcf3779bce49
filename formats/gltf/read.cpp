#include "formats/gltf/gltf.h"

#include <algorithm>

#include "base/files.h"
#include "formats/gltf/load.h"

namespace suite {

namespace gltf {

namespace {

// The nodes of a scene become groups, but for those that only place a mesh.
class Builder {
 public:
  Builder(const tinygltf::Model& model, const std::string& file, const SourceModelOptions& options, Report& report)
      : model_(model), file_(file), options_(options), report_(report), names_(options.name) {}
  SourceModel run();

 private:
  void find_reachable();
  std::string mesh_name(int index, const std::string& at);
  std::vector<Affine3> copies_of(const tinygltf::Node& node, const std::string& at) const;
  DraftPlacement place(const std::string& target) const {
    DraftPlacement p;
    p.where = p.target.where = options_.where;
    p.target.name = target;
    return p;
  }
  void stand(size_t node, DraftPlacement& placement) const;
  void node(size_t n);
  void materials();

  const tinygltf::Model& model_;
  const std::string& file_;
  const SourceModelOptions& options_;
  Report& report_;
  PartNames names_;
  std::vector<Local> locals_;
  std::vector<size_t> order_;  // reachable nodes, parents first
  std::vector<size_t> roots_;
  std::vector<std::optional<std::string>> mesh_names_;  // empty string: has no triangles
  std::vector<std::optional<DraftPlacement>> made_;     // how each node stands in its parent; none: nothing to see
  size_t flat_ = 0;
  SourceModel result_;
};

// Every node has one parent at most, so what is reached from a root is a tree.
void Builder::find_reachable() {
  std::vector<bool> has_parent(model_.nodes.size(), false), root(model_.nodes.size(), false);
  for (size_t n = 0; n < model_.nodes.size(); ++n)
    for (const int child : model_.nodes[n].children) {
      const std::string at = strf("nodes[%zu]/children", n);
      item_of(model_.nodes, child, file_, at, "node");
      if (has_parent[static_cast<size_t>(child)]) throw fault(file_, at, strf("node %d has two parents", child));
      has_parent[static_cast<size_t>(child)] = true;
    }
  const Where where{file_, 0, 0, {}, -1};
  if (model_.scenes.empty()) {
    report_.add("SP707", file_, {where, "scenes: there is none; all nodes are taken"});
    for (size_t n = 0; n < model_.nodes.size(); ++n)
      if (!has_parent[n]) roots_.push_back(n);
  } else {
    const int number = model_.defaultScene < 0 ? 0 : model_.defaultScene;
    for (const int n : item_of(model_.scenes, number, file_, "scene", "scene").nodes) {
      const std::string at = strf("scenes[%d]/nodes", number);
      item_of(model_.nodes, n, file_, at, "node");
      if (has_parent[static_cast<size_t>(n)]) throw fault(file_, at, strf("node %d has a parent", n));
      if (root[static_cast<size_t>(n)]) throw fault(file_, at, strf("node %d stands there twice", n));
      root[static_cast<size_t>(n)] = true;
      roots_.push_back(static_cast<size_t>(n));
    }
    if (model_.scenes.size() > 1)
      report_.add("SP705", file_, {where, strf("scenes: number %d of %zu is taken", number, model_.scenes.size())});
  }
  order_ = roots_;
  for (size_t k = 0; k < order_.size(); ++k)
    for (const int child : model_.nodes[order_[k]].children) order_.push_back(static_cast<size_t>(child));
}

std::string Builder::mesh_name(int index, const std::string& at) {
  const tinygltf::Mesh& mesh = item_of(model_.meshes, index, file_, at + "/mesh", "mesh");
  std::optional<std::string>& name = mesh_names_[static_cast<size_t>(index)];
  if (name) return *name;
  name = "";
  if (auto triangles = mesh_of(model_, file_, index, options_.unit_m,
                               options_.textures ? MeshUvs::of_base_colours : MeshUvs::first, report_)) {
    name = names_.make(mesh.name, strf("mesh_%d", index));
    result_.meshes.push_back({*name, std::move(*triangles)});
  }
  return *name;
}

// EXT_mesh_gpu_instancing: where the node's mesh stands, many times.
std::vector<Affine3> Builder::copies_of(const tinygltf::Node& node, const std::string& at) const {
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end()) return {};
  const std::string pointer = at + "/extensions/EXT_mesh_gpu_instancing/attributes";
  if (!extension->second.IsObject()) throw fault(file_, pointer, "there is none");
  const auto read = [&](const char* name, size_t components) {
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    if (!attributes.IsObject() || !attributes.Has(name)) return Values{};
    const tinygltf::Value& accessor = attributes.Get(name);
    return values_of(model_, file_, accessor.IsInt() ? accessor.Get<int>() : -1, pointer + "/" + name, {components});
  };
  const Values t = read("TRANSLATION", 3), r = read("ROTATION", 4), s = read("SCALE", 3);
  const size_t count = std::max({t.count, r.count, s.count});
  std::vector<Affine3> copies;
  for (const Values* v : {&t, &r, &s})
    if (v->count && v->count != count) throw fault(file_, pointer, strf("%zu and %zu copies", v->count, count));
  if (count == 0) throw fault(file_, pointer, "says nothing of where the copies are");
  for (size_t k = 0; k < count; ++k) {
    Pose pose;
    if (t.count)
      pose.translation = Vec3{t.numbers[3 * k], t.numbers[3 * k + 1], t.numbers[3 * k + 2]} * options_.unit_m;
    if (r.count) {
      const double* q = &r.numbers[4 * k];
      const Quat turn{q[3], q[0], q[1], q[2]};
      if (!(dot(turn, turn) > 1e-12)) throw fault(file_, pointer + "/ROTATION", "a quaternion without length");
      pose.rotation = normalized(turn);
    }
    copies.push_back(pose.affine());
    if (s.count)
      copies.back() = copies.back() * scaling({s.numbers[3 * k], s.numbers[3 * k + 1], s.numbers[3 * k + 2]});
  }
  return copies;
}

void Builder::stand(size_t node, DraftPlacement& placement) const {
  const Local& local = locals_[node];
  placement.to_parent = local.motion ? local.scale : local.at_rest;
  placement.motion = local.motion;
  placement.motion_where = options_.where;
}

// Its children have been made before.
void Builder::node(size_t n) {
  const tinygltf::Node& node = model_.nodes[n];
  const std::string at = strf("nodes[%zu]", n);
  DraftGroup group;
  group.where = options_.where;
  if (node.mesh >= 0) {
    if (const std::string mesh = mesh_name(node.mesh, at); !mesh.empty()) {
      group.placements.push_back(place(mesh));
      group.placements.back().rows = copies_of(node, at);
      group.placements.back().table = !group.placements.back().rows.empty();
    }
  }
  for (const int child : node.children)
    if (auto& made = made_[static_cast<size_t>(child)]) group.placements.push_back(std::move(*made));
  if (group.placements.empty()) return;
  if (!((locals_[n].motion ? locals_[n].scale : locals_[n].at_rest).determinant() != 0)) {
    ++flat_;  // a common way to hide something
    return;
  }
  if (node.children.empty()) {
    made_[n] = std::move(group.placements.front());
  } else {
    group.name = names_.make(node.name, strf("node_%zu", n));
    made_[n] = place(group.name);
    result_.groups.push_back(std::move(group));
  }
  stand(n, *made_[n]);
}

void Builder::materials() {
  std::set<std::string> used;
  for (const SourceModel::Part& part : result_.meshes)
    for (const SourceMesh::Run& run : part.mesh.runs) used.insert(run.material);
  const std::vector<std::string> names = material_names(model_);
  for (size_t k = 0; k < names.size(); ++k) {
    if (!used.erase(names[k])) continue;  // not used, or two of one name
    SourceMaterial& made = result_.materials.emplace_back();
    made.name = names[k];
    const std::vector<double>& colour = model_.materials[k].pbrMetallicRoughness.baseColorFactor;
    for (size_t c = 0; c < 3 && c < colour.size(); ++c) made.rgb[c] = std::clamp(colour[c], 0.0, 1.0);
    if (options_.textures) made.texture = texture_of(model_, file_, k, options_.resolve, report_);
  }
}

SourceModel Builder::run() {
  check_extensions(model_, file_);
  result_.groups.push_back({options_.name, options_.where, {}});
  locals_ = locals_of(model_, file_, options_.unit_m);
  mesh_names_.resize(model_.meshes.size());
  made_.resize(model_.nodes.size());
  find_reachable();
  animate(model_, file_, options_, locals_, report_);
  // Meshes get their names in the order of the nodes, whatever the order in which groups are closed.
  for (const size_t n : order_)
    if (model_.nodes[n].mesh >= 0) mesh_name(model_.nodes[n].mesh, strf("nodes[%zu]", n));
  for (size_t k = order_.size(); k-- > 0;) node(order_[k]);
  const Affine3 up = options_.y_up ? kFromYUp : Affine3{};
  std::vector<DraftPlacement> tops;
  for (const size_t n : roots_)
    if (made_[n]) tops.push_back(std::move(*made_[n]));
  // A motion comes after its placement's transform, so what turns everything needs a group of its own.
  DraftGroup axes{names_.make("axes", ""), options_.where, std::move(tops)};
  if (axes.placements.empty())
    throw Error(Where{file_, 0, 0, {}, -1}, "places no triangle", "its default scene must hold a mesh", "SP204");
  result_.groups[0].placements.push_back(place(axes.name));
  result_.groups[0].placements[0].to_parent = up;
  result_.groups.push_back(std::move(axes));
  if (flat_)
    report_.add("SP706", file_, {Where{file_, 0, 0, {}, -1}, strf("%zu nodes are flattened to nothing", flat_)}, flat_);
  materials();
  report_left_out(model_, file_, options_.textures, report_);
  return std::move(result_);
}

}  // namespace
}  // namespace gltf

SourceModel parse_gltf(std::span<const std::byte> bytes, const std::string& file, const SourceModelOptions& options,
                       Report& report) {
  const tinygltf::Model model = gltf::load(bytes, file, options.resolve);
  return gltf::Builder(model, file, options, report).run();
}

SourceModel read_gltf(const std::string& path, const SourceModelOptions& options, Report& report) {
  return parse_gltf(read_bytes(path), path, options, report);
}

bool is_gltf(const std::string& path, std::string_view head) {
  const auto ends = [&](std::string_view end) {
    return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
  };
  return head.substr(0, 4) == "glTF" || ends(".glb") || ends(".gltf");
}

}  // namespace suite
