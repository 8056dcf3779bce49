#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/late_part.h"
#include "formats/assimp/apart.h"
#include "formats/assimp/assimp.h"
#include "formats/assimp/long_numbers.h"
#include "formats/assimp/pack.h"
#include "scene/left_out_look.h"

namespace suite {

namespace {

std::string extension_of(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e.empty() ? e : e.substr(1);
}

// What came out of the library is checked: indices, numbers, parents.
void check(const AssimpModel& model, const Where& where) {
  const auto bad = [&](const char* what) {
    return Error(where, std::string("the library that reads it (assimp) made ") + what + " of it",
                 "the file is damaged");
  };
  for (const AssimpMesh& m : model.meshes) {
    if (m.positions.size() >= kNone) throw bad("too many vertices");
    for (const uint32_t v : m.indices)
      if (v >= m.positions.size()) throw bad("a vertex that is not there");
    if (m.indices.size() % 3 || (!m.normals.empty() && m.normals.size() != m.positions.size()) ||
        (!m.uvs.empty() && m.uvs.size() != 2 * m.positions.size()) || m.material >= model.materials.size())
      throw bad("a mesh without all its parts");
  }
  for (size_t n = 0; n < model.nodes.size(); ++n) {
    const AssimpNode& node = model.nodes[n];
    if (n ? !(node.parent >= 0 && static_cast<size_t>(node.parent) < n) : node.parent != -1)
      throw bad("a node without a parent");
    for (const double a : node.to_parent.a)
      if (!std::isfinite(a)) throw bad("a transform that is none");
    if (!finite(node.to_parent.b)) throw bad("a transform that is none");
    for (const uint32_t m : node.meshes)
      if (m >= model.meshes.size()) throw bad("a mesh that is not there");
  }
}

// The library gives pivots of FBX nodes of their own, which are folded into those that they belong to. (Where it folds
// them itself, transforms of a node's geometry move the node's children, and PostRotation is not undone as it is to be:
// FBX SDK, "Computing transformation matrices".)
void fold_pivots(AssimpModel& model) {
  constexpr std::string_view helper = "_$AssimpFbx$_";
  std::vector<AssimpNode> kept;
  std::vector<int32_t> number(model.nodes.size(), -1);  // of kept ones, or of the one that a folded one leads to
  std::vector<Affine3> before(model.nodes.size());      // from below a folded node to that one
  for (size_t n = 0; n < model.nodes.size(); ++n) {
    AssimpNode& node = model.nodes[n];
    if (n) {
      const auto parent = static_cast<size_t>(node.parent);
      node.to_parent = before[parent] * node.to_parent;
      node.parent = number[parent];
    }
    if (n && node.meshes.empty() && node.name.find(helper) != node.name.npos) {
      number[n] = node.parent, before[n] = node.to_parent;
    } else {
      number[n] = static_cast<int32_t>(kept.size());
      kept.push_back(std::move(node));
    }
  }
  model.nodes = std::move(kept);
}

// Nodes of FBX whose parent's scale is not to act as it does in a product of their matrices.
size_t scaled_otherwise(const AssimpModel& model) {
  size_t found = 0;
  for (const AssimpNode& node : model.nodes) {
    if (node.parent < 0 || node.inherits == 1) continue;
    const auto scales = [](const Affine3& m) {
      return std::array<double, 3>{length(m.vector({1, 0, 0})), length(m.vector({0, 1, 0})),
                                   length(m.vector({0, 0, 1}))};
    };
    const std::array<double, 3> parent = scales(model.nodes[static_cast<size_t>(node.parent)].to_parent),
                                mine = scales(node.to_parent);
    double off = 0;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        const double turn = mine[j] > 0 ? node.to_parent.a[3 * i + j] / mine[j] : 0;
        off = std::max(off, node.inherits == 2 ? std::abs(parent[i] - 1) : std::abs(turn * (parent[i] - parent[j])));
      }
    found += off > 1e-4;
  }
  return found;
}

class Builder {
 public:
  Builder(AssimpModel model, const std::string& file, const SourceModelOptions& options, Report& report)
      : model_(std::move(model)),
        whole_{file, 0, 0, {}, -1},
        options_(options),
        report_(report),
        names_(options.name) {}
  SourceModel run(const Affine3& turn);

 private:
  DraftPlacement place(const std::string& target, const Affine3& to_parent) const {
    DraftPlacement p;
    p.where = p.target.where = options_.where;
    p.target.name = target;
    p.to_parent = to_parent;
    return p;
  }
  void mesh(size_t k);
  void materials();
  void report_left_out() const;
  double unit() const { return options_.unit_m * (model_.unit_cm > 0 ? model_.unit_cm / 100 : 1); }

  AssimpModel model_;
  Where whole_;
  const SourceModelOptions& options_;
  Report& report_;
  PartNames names_;
  std::vector<std::string> mesh_names_;  // empty: has no triangles
  SourceModel result_;
};

void Builder::mesh(size_t k) {
  const AssimpMesh& from = model_.meshes[k];
  mesh_names_.emplace_back();
  if (from.indices.empty()) return;
  SourceMesh made;
  made.file = whole_.file;
  for (const Vec3& p : from.positions) {
    const Vec3 place = p * unit();
    if (!finite(place) || length(place) > 1e15)
      report_.add("SP203", whole_.file, {whole_, "mesh '" + printable(from.name) + "': a place that is none"});
    made.positions.push_back(place);
  }
  for (const Vec3& n : from.normals) {
    const double size = length(n);
    made.normals.push_back(size > 0 && std::isfinite(size) ? oct_encode(n / size) : kNoNormal);
  }
  for (const float c : from.uvs) made.uvs.push_back(std::isfinite(c) ? c : 0);
  made.indices = from.indices;
  made.runs.push_back({printable(from.name), model_.materials[from.material].name, 0, 0});
  mesh_names_.back() = names_.make(printable(from.name), strf("mesh_%zu", k));
  result_.meshes.push_back({mesh_names_.back(), std::move(made)});
}

void Builder::materials() {
  std::set<std::string> used;
  for (const SourceModel::Part& part : result_.meshes)
    for (const SourceMesh::Run& run : part.mesh.runs) used.insert(run.material);
  for (const AssimpMaterial& m : model_.materials)
    if (!m.name.empty() && used.erase(m.name)) {
      SourceMaterial& made = result_.materials.emplace_back(SourceMaterial{m.name, m.rgb, nullptr});
      for (double& c : made.rgb) c = std::isfinite(c) ? std::clamp(c, 0.0, 1.0) : 1;
    }
}

void Builder::report_left_out() const {
  const auto say = [&](const char* code, uint64_t count, const char* what) {
    if (count) report_.add(code, whole_.file, {whole_, strf("%zu %s", static_cast<size_t>(count), what)}, count);
  };
  say("SP705", model_.animations, "animations: everything stands as it is stored");
  say("SP705", model_.bones, "meshes with bones: they keep their basic shape");
  say("SP705", model_.morphs, "meshes with morph targets: they keep their basic shape");
  say("SP705", model_.textures,
      "textures: display colours are no spectra, maps are; written as glTF or OBJ they can be uplifted ('textures')");
  say("SP705", model_.lights, "lights: lights belong to the simulation");
  if (model_.fbx)
    say("SP705", scaled_otherwise(model_),
        "nodes inherit their parents' scale in another way than matrices do (InheritType): they are bent or too large");
  say("SP706", model_.cameras, "cameras: cameras belong to the simulation");
  LeftOutLook look;
  look.see_through = model_.see_through, look.shining = model_.shining, look.bumps = model_.bumps;
  look.gloss = model_.gloss, look.coloured = model_.colours;
  look.report(whole_.file, report_);
  say("SP205", model_.lines, "points or lines");
}

// Nodes become groups, children before their parents.
SourceModel Builder::run(const Affine3& turn) {
  result_.groups.push_back({options_.name, options_.where, {}});
  for (size_t k = 0; k < model_.meshes.size(); ++k) mesh(k);
  std::vector<DraftGroup> groups(model_.nodes.size());
  size_t flat = 0;
  for (size_t n = model_.nodes.size(); n-- > 0;) {
    const AssimpNode& node = model_.nodes[n];
    DraftGroup& group = groups[n];
    for (const uint32_t m : node.meshes)
      if (!mesh_names_[m].empty()) group.placements.push_back(place(mesh_names_[m], {}));
    Affine3 to_parent = node.to_parent;
    to_parent.b *= unit();
    if (group.placements.empty()) continue;
    if (!(to_parent.determinant() != 0)) {
      ++flat;
      continue;
    }
    group.name = names_.make(printable(node.name), strf("node_%zu", n));
    group.where = options_.where;
    DraftGroup& parent = n ? groups[static_cast<size_t>(node.parent)] : result_.groups[0];
    parent.placements.push_back(place(group.name, n ? to_parent : turn * to_parent));
  }
  if (result_.groups[0].placements.empty()) throw Error(whole_, "places no triangle", "it must hold a mesh", "SP204");
  for (DraftGroup& group : groups)
    if (!group.name.empty()) result_.groups.push_back(std::move(group));
  if (flat) report_.add("SP706", whole_.file, {whole_, strf("%zu nodes are flattened to nothing", flat)}, flat);
  materials();
  report_left_out();
  return std::move(result_);
}

// What brings the axes that a file of FBX names to ours: right is east, front south, up up.
Affine3 turn_of_axes(const AssimpModel& model, const Where& where, Report& report) {
  const auto& a = model.axes;
  Affine3 turn;
  turn.a = {};
  bool named = true;
  for (const size_t k : {0, 2, 4}) named = named && a[k] >= 0 && a[k] <= 2 && (a[k + 1] == 1 || a[k + 1] == -1);
  if (named) {
    turn.a[static_cast<size_t>(a[4])] = a[5];
    turn.a[static_cast<size_t>(3 + a[2])] = -a[3];
    turn.a[static_cast<size_t>(6 + a[0])] = a[1];
  }
  const double handed = turn.determinant();
  if (handed < 0) report.add("SP707", where.file, {where, "its axes are left-handed: it is mirrored, as they say"});
  if (handed != 0) return turn;
  if (a[0] == 0)
    report.add("SP705", where.file, {where, "x is up, and which axes point right and to the front is not said"});
  if (a[0] == 0) return {{0, -1, 0, 0, 0, -1, 1, 0, 0}, {}};  // as Collada has it
  return a[0] == 2 ? Affine3{} : kFromYUp;
}

}  // namespace

SourceModel parse_assimp(std::span<const std::byte> bytes, const std::string& file, const SourceModelOptions& options,
                         const bool* y_up, Report& report) {
  static const auto* const calls = static_cast<const AssimpCalls*>(late_symbol("assimp", "suite_assimp_calls"));
  const Where whole{file, 0, 0, {}, -1};
  const std::string extension = extension_of(file);
  check_long_numbers(bytes, file, extension);
  const std::string made = apart(file, bytes.size(), [&] {
    return packed(calls->read(bytes.data(), bytes.size(), extension.c_str(), y_up != nullptr));
  });
  AssimpModel model;
  if (!unpack(made, model)) throw Error(whole, "the library that reads it (assimp) broke down", "the file is damaged");
  if (!model.fault.empty()) throw Error(whole, "cannot be read: " + printable(model.fault).substr(0, 300));
  check(model, whole);
  if ((model.fbx = extension == "fbx")) fold_pivots(model);
  // Files of FBX say how their axes lie; the library turns those of Collada y up unless the caller knows better.
  const Affine3 turn = y_up                 ? (*y_up ? kFromYUp : Affine3{})
                       : extension == "3ds" ? Affine3{}
                                            : turn_of_axes(model, whole, report);
  return Builder(std::move(model), file, options, report).run(turn);
}

SourceModel read_assimp(const std::string& path, const SourceModelOptions& options, const bool* y_up, Report& report) {
  return parse_assimp(read_bytes(path), path, options, y_up, report);
}

bool is_assimp(const std::string& path) {
  const std::string e = extension_of(path);
  return e == "fbx" || e == "dae" || e == "3ds";
}

}  // namespace suite
