// A model of several meshes on its way in, as files of modelling tools give them: meshes in the file's own axes, and
// the groups that place them, once or many times, at rest or moving. What a scene text or an importer makes of it is
// theirs; here nothing is resolved.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/draft.h"

namespace suite {

// An image of display colours that a model lays onto its surfaces by their texture coordinates.
struct SourceTexture {
  std::string name;              // for messages
  std::vector<std::byte> bytes;  // of a picture's file
  enum class Extend { repeat, clamp } extend = Extend::repeat;
  bool smooth = true;  // linear between texels
};

// What a file says of a material's colour: a display colour, which is no spectrum.
struct SourceMaterial {
  std::string name;
  std::array<double, 3> rgb{1, 1, 1};            // of sRGB's primaries, linear, 0 to 1
  std::shared_ptr<const SourceTexture> texture;  // times rgb; null: none, or not asked for
};

struct SourceModel {
  struct Part {
    std::string name;
    SourceMesh mesh;
  };
  std::vector<Part> meshes;               // m, in axes whose way up `groups` turn
  std::vector<DraftGroup> groups;         // [0] is the whole model; the others lie in it
  std::vector<SourceMaterial> materials;  // those that the meshes' runs name, each once
};

// How a model is read.
struct SourceModelOptions {
  std::string name;            // of the model; its parts are NAME/PART
  Where where;                 // where it is named: the place of all its placements
  double unit_m = 1;           // metres of one unit of the file
  bool y_up = false;           // y is up and z towards the viewer in the file; else z is up
  bool textures = false;       // what the materials' colours are, with their images; else these are never opened
  std::string animation = {};  // name or number (from 0) of the one that is taken; "none"; empty: the first
  // Where a file that the model names is to be found. Error: it is not there.
  std::function<std::string(const std::string&)> resolve = {};
};

// A name that no other part of the model has: NAME/given, or NAME/otherwise, with #2, #3 ... behind it.
class PartNames {
 public:
  explicit PartNames(std::string model) : model_(std::move(model)) {}
  std::string make(const std::string& given, const std::string& otherwise) {
    const std::string base = model_ + "/" + (given.empty() ? otherwise : given);
    std::string name = base;
    for (size_t k = 2; !used_.insert(name).second; ++k) name = base + "#" + std::to_string(k);
    return name;
  }

 private:
  std::string model_;
  std::set<std::string> used_;
};

// y up, z towards the viewer (the usual modelling tools) becomes z up, -y towards the viewer.
inline constexpr Affine3 kFromYUp{{1, 0, 0, 0, 0, -1, 0, 1, 0}, {}};

}  // namespace suite
