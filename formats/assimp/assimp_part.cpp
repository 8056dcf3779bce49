// The part `assimp`: all calls of the Open Asset Import Library.
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/Importer.hpp>

#include "base/late_part.h"
#include "formats/assimp/part.h"

namespace suite {

namespace {

Vec3 vec(const aiVector3D& v) { return {v.x, v.y, v.z}; }

AssimpMesh mesh_of(const aiMesh& from, AssimpModel& model) {
  AssimpMesh made;
  made.name = from.mName.C_Str();
  made.material = from.mMaterialIndex;
  for (unsigned k = 0; k < from.mNumVertices; ++k) {
    made.positions.push_back(vec(from.mVertices[k]));
    if (from.HasNormals()) made.normals.push_back(vec(from.mNormals[k]));
    if (from.HasTextureCoords(0))
      made.uvs.insert(made.uvs.end(), {from.mTextureCoords[0][k].x, from.mTextureCoords[0][k].y});
  }
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices == 3)
      made.indices.insert(made.indices.end(), face.mIndices, face.mIndices + 3);
    else
      ++model.lines;
  }
  model.bones += from.HasBones();
  model.morphs += from.mNumAnimMeshes > 0;
  model.colours += from.HasVertexColors(0);
  return made;
}

void add_node(const aiNode& from, int32_t parent, AssimpModel& model) {
  AssimpNode made;
  made.name = from.mName.C_Str();
  made.parent = parent;
  const aiMatrix4x4& m = from.mTransformation;
  made.to_parent = {{m.a1, m.a2, m.a3, m.b1, m.b2, m.b3, m.c1, m.c2, m.c3}, {m.a4, m.b4, m.c4}};
  made.meshes.assign(from.mMeshes, from.mMeshes + from.mNumMeshes);
  if (from.mMetaData) from.mMetaData->Get("InheritType", made.inherits);
  const auto mine = static_cast<int32_t>(model.nodes.size());
  model.nodes.push_back(std::move(made));
  for (unsigned k = 0; k < from.mNumChildren; ++k) add_node(*from.mChildren[k], mine, model);
}

void materials_of(const aiScene& scene, AssimpModel& model) {
  for (unsigned k = 0; k < scene.mNumMaterials; ++k) {
    const aiMaterial& from = *scene.mMaterials[k];
    AssimpMaterial made;
    made.name = from.GetName().C_Str();
    aiColor3D colour(1, 1, 1);
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS) made.rgb = {colour.r, colour.g, colour.b};
    const auto any_of = [&](std::initializer_list<aiTextureType> kinds) {
      return std::any_of(kinds.begin(), kinds.end(),
                         [&](aiTextureType kind) { return from.GetTextureCount(kind) > 0; });
    };
    float opacity = 1;
    aiColor3D glow(0, 0, 0);
    const bool translucent = from.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 1;
    const bool glows =
        from.Get(AI_MATKEY_COLOR_EMISSIVE, glow) == AI_SUCCESS && (glow.r > 0 || glow.g > 0 || glow.b > 0);
    model.see_through += translucent || any_of({aiTextureType_OPACITY});
    model.shining += glows || any_of({aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR});
    model.bumps +=
        any_of({aiTextureType_HEIGHT, aiTextureType_NORMALS, aiTextureType_DISPLACEMENT, aiTextureType_NORMAL_CAMERA});
    model.gloss += any_of({aiTextureType_SPECULAR, aiTextureType_SHININESS, aiTextureType_REFLECTION,
                           aiTextureType_METALNESS, aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_AMBIENT_OCCLUSION});
    for (int kind = aiTextureType_DIFFUSE; kind <= aiTextureType_UNKNOWN; ++kind)
      model.textures += from.GetTextureCount(static_cast<aiTextureType>(kind));
    model.materials.push_back(std::move(made));
  }
}

AssimpModel read(const void* bytes, size_t size, const char* extension, bool as_stored) {
  AssimpModel model;
  Assimp::Importer importer;
  // The reader folds FBX's pivots, for the library does it wrongly.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, as_stored);
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes, size, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, extension);
  if (!scene || !scene->mRootNode) {
    model.fault = importer.GetErrorString();
    if (model.fault.empty()) model.fault = "there is no scene in it";
    return model;
  }
  for (unsigned k = 0; k < scene->mNumMeshes; ++k) model.meshes.push_back(mesh_of(*scene->mMeshes[k], model));
  add_node(*scene->mRootNode, -1, model);
  materials_of(*scene, model);
  model.animations = scene->mNumAnimations, model.cameras = scene->mNumCameras, model.lights = scene->mNumLights;
  if (scene->mMetaData) {
    const char* const names[] = {"UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign", "CoordAxis", "CoordAxisSign"};
    for (size_t k = 0; k < 6; ++k) scene->mMetaData->Get(names[k], model.axes[k]);
    float single = 0;
    if (!scene->mMetaData->Get("UnitScaleFactor", model.unit_cm) && scene->mMetaData->Get("UnitScaleFactor", single))
      model.unit_cm = single;
  }
  return model;
}

}  // namespace

SUITE_PART_VERSION;
extern "C" {
extern const AssimpCalls suite_assimp_calls;
const AssimpCalls suite_assimp_calls{read};
}

}  // namespace suite
