// Several scenes as one: each keeps its tables, moved behind those before it; nothing is copied but indices.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace suite {

struct ScenePart {
  std::string name;  // for messages, e.g. its file
  Scene scene;
  std::optional<Affine3> placement;     // its frame -> the moving body's axes, or the first scene's frame
  std::shared_ptr<const Track> motion;  // of the whole scene in the first scene's frame; null: at rest
  TimeSpan life = kAlways;              // s of the whole: all of it is there from `begin` until just before `end`
};

// The first scene's frame, origin and epoch are those of the result; its own placement, if any, holds too. A part with
// neither placement nor motion stands where its origin on the Earth says, turned as the horizon there is. Times of a
// part's motions count from the part's own epoch when both have one. Tags of the same name become one; materials and
// embedded files of the same name stay apart, a later one being called "name (part)".
// Error: a part that can be placed by origins only while it or the first scene has none; draped maps that the part's
// turn would shift by more than a tenth of a pixel; a part with media in space (volumes, an ambient medium) and a life,
// since these are always there.
Scene combine_scenes(std::vector<ScenePart> parts);

// Lets second 0 be at `epoch` (UTC, ISO 8601): the motions of a scene that has an epoch of its own keep their dates;
// those of a scene without count from there.
void set_epoch(Scene& scene, const std::string& epoch);

}  // namespace suite
