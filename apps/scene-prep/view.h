// A page with a prepared scene in three dimensions, to turn and to click on.
#pragma once
#include <string>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"
#include "scene/scene.h"

namespace suite {

// A finding of the check, where it is in a mesh of the scene.
struct ViewedFinding {
  std::string text;      // "warning [SP303] panel.obj:12: ..."
  std::string geometry;  // name of the mesh; tiles have a number behind it
  Vec3 local;            // m, the mesh's frame
  bool error = false;
};
// Those of a report that have a place in a mesh of the draft.
std::vector<ViewedFinding> findings_to_view(const Draft& draft, const Report& report);

// Writes the HTML file `page`, which needs nothing else and takes at most some 20 MB: of larger scenes it has fewer
// triangles and instances, which the page and a note tell with their numbers. Things are where they are at the first
// time that all tracks cover. Error: page not writable.
void write_scene_view(const Scene& scene, const std::vector<ViewedFinding>& findings, const std::string& page);

}  // namespace suite
