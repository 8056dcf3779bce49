// What models say of how their surfaces look and scenes have no place for, counted and told in one line.
#pragma once
#include <cstddef>
#include <string>

#include "base/report.h"

namespace suite {

struct LeftOutLook {
  // Materials with each.
  size_t see_through = 0;  // alpha, opacity, dissolve
  size_t shining = 0;      // emission, as a factor or a texture
  size_t bumps = 0;        // maps of normals, bumps or displacement
  size_t gloss = 0;        // specular, metallic, roughness or occlusion, as a texture or a factor that matters
  size_t one_sided = 0;    // not seen from behind in the file
  size_t coloured = 0;     // meshes or primitives with colours of vertices

  // "left out: transparency of 2 materials (an 'opacity' map makes holes), ..."; empty where nothing is.
  std::string text() const;
  size_t count() const { return see_through + shining + bumps + gloss + one_sided + coloured; }
  // SP705, which is a warning, where that changes the look of a material or a mesh; SP706 where it is one-sidedness
  // alone.
  void report(const std::string& file, Report& to) const;
};

}  // namespace suite
