// What the part `assimp` and its only caller share: a model as plain arrays.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace suite {

struct AssimpMesh {
  std::string name;
  uint32_t material = 0;
  std::vector<Vec3> positions, normals;  // normals: one per position, or none
  std::vector<float> uvs;                // two per position, or none
  std::vector<uint32_t> indices;         // three per triangle
};

struct AssimpNode {
  std::string name;
  int32_t parent = -1;  // before it in the list; -1: the root
  Affine3 to_parent;
  std::vector<uint32_t> meshes;
  int32_t inherits =
      0;  // of FBX, InheritType: 0 the parent's scale comes after the rotation, 1 before it, 2 not at all
};

struct AssimpMaterial {
  std::string name;
  std::array<double, 3> rgb{1, 1, 1};  // as the file has it
};

struct AssimpModel {
  std::string fault;  // not empty: nothing else holds
  std::vector<AssimpMesh> meshes;
  std::vector<AssimpNode> nodes;
  std::vector<AssimpMaterial> materials;
  bool fbx = false;    // set by the reader
  double unit_cm = 0;  // of a file of FBX; 0: it does not say
  // Of FBX: which of x, y, z (0, 1, 2; -1: it does not say) is up, to the front and to the right, each with its sign.
  std::array<int32_t, 6> axes{-1, 1, -1, 1, -1, 1};
  // What a scene has no place for.
  uint64_t animations = 0, cameras = 0, lights = 0, textures = 0, bones = 0, morphs = 0, colours = 0, lines = 0;
  // Materials of which a scene has no place for something: left_out_look.h.
  uint64_t see_through = 0, shining = 0, bumps = 0, gloss = 0;
};

// extension: of the file's name, which says what it is. as_stored: axes of Collada are not turned to y up.
struct AssimpCalls {
  AssimpModel (*read)(const void* bytes, size_t size, const char* extension, bool as_stored);
};

}  // namespace suite
