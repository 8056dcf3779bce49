// What the parts of the glTF reader share: the parsed file, and faults at a place in its JSON.
#pragma once
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include <span>

#include "base/report.h"
#include "motion/track.h"
#include "scene/source_model.h"

namespace suite::gltf {

using Resolve = std::function<std::string(const std::string&)>;

// Checks the container and the nesting, then lets tinygltf parse. Error: as read_gltf.
tinygltf::Model load(std::span<const std::byte> bytes, const std::string& file, const Resolve& resolve);

// A fault at a JSON pointer such as "accessors[3]/count".
Error fault(const std::string& file, const std::string& pointer, const std::string& what, const std::string& hint = {});

// A list's item by an index that came from the file. Error: there is none.
template <class T>
const T& item_of(const std::vector<T>& list, int index, const std::string& file, const std::string& pointer,
                 const char* what) {
  if (index < 0 || static_cast<size_t>(index) >= list.size())
    throw fault(file, pointer, strf("%s %d of %zu", what, index, list.size()), "indices count from 0");
  return list[static_cast<size_t>(index)];
}

// The numbers of an accessor, one after the other, checked to lie within its buffers and to be finite; normalised
// integers as the specification turns them into numbers, sparse values put in. components: how many a value must have
// (any of these). Error: fault().
struct Values {
  std::vector<double> numbers;
  size_t count = 0, components = 0;
};
Values values_of(const tinygltf::Model& model, const std::string& file, int accessor, const std::string& pointer,
                 std::initializer_list<size_t> components);

// The materials' names, of all of the file; unnamed ones are material_N.
std::vector<std::string> material_names(const tinygltf::Model& model);

// The image of base colours of a material; null: there is none. Error: fault(); the image is not there.
std::shared_ptr<const SourceTexture> texture_of(const tinygltf::Model& model, const std::string& file, size_t material,
                                                const Resolve& resolve, Report& report);

// Which texture coordinates a material's image of base colours is laid out by, and what is made of them first
// (KHR_texture_transform), in the file's own u and v, which counts downwards: (a u + b v + c, d u + e v + f).
struct UvRule {
  int set = 0;  // TEXCOORD_set
  std::array<double, 6> transform{1, 0, 0, 0, 1, 0};
  bool operator==(const UvRule&) const = default;
};
// material: -1 for none. Error: fault().
UvRule uv_rule_of(const tinygltf::Model& model, const std::string& file, int material);

// What texture coordinates a mesh gets: the first of the file, or those by which images of base colours are laid out.
enum class MeshUvs { first, of_base_colours };
// The triangles of a mesh; nothing when it has none (points and lines are told).
std::optional<SourceMesh> mesh_of(const tinygltf::Model& model, const std::string& file, int mesh, double unit_m,
                                  MeshUvs uvs, Report& report);

// Where a node stands in its parent, m.
struct Local {
  Affine3 at_rest;
  Affine3 scale;    // what is left beside a motion
  TrackPtr motion;  // null: at rest
};
// Of every node. Error: fault().
std::vector<Local> locals_of(const tinygltf::Model& model, const std::string& file, double unit_m);
// Gives nodes that move their tracks. name: of the animation, see SourceModelOptions.
void animate(const tinygltf::Model& model, const std::string& file, const SourceModelOptions& options,
             std::vector<Local>& locals, Report& report);

// Everything else that the file says and that has no place in a scene. Error: it needs an extension that is not read.
void check_extensions(const tinygltf::Model& model, const std::string& file);
// textures: base colours are not left out.
void report_left_out(const tinygltf::Model& model, const std::string& file, bool textures, Report& report);

}  // namespace suite::gltf
