// Traffic: each thing of a file of tracks as a placement that is there from its first record to its last.
#include "formats/motion/track_files.h"
#include "formats/scene_text/reader.h"
#include "motion/track.h"

namespace suite::scene_text {

// What stands for the things of a type: an object or a group, or a placement of one.
DraftPlacement Reader::read_vehicle(const Params& p) {
  if (p.kind() == Params::Kind::scalar) {
    DraftPlacement made;
    made.where = p.where();
    made.target = reference(p);
    return made;
  }
  for (const char* key : {"motion", "table", "scatter", "on"})
    if (p.has(key))
      throw p.at(key).error(std::string("'") + key + "' of what moves along a track of a file", "leave it out");
  return read_placement(p, true);
}

void Reader::read_traffic(const Params& p, bool world, std::vector<DraftPlacement>& to) {
  if (!world) throw p.at("traffic").error("traffic counts in 'world' only", "place it there");
  const MotionContext context = motion_context(true);
  const TrackFileOptions options = track_file_options(p, context);
  std::map<std::string, DraftPlacement> types;
  if (const auto list = p.find("types"))
    for (const std::string& type : list->keys()) types[type] = read_vehicle(list->at(type));
  std::optional<DraftPlacement> otherwise;
  if (const auto other = p.find("default")) otherwise = read_vehicle(*other);
  const std::vector<MovingThing> things = read_track_file(p.at("traffic"), options);
  std::map<std::string, size_t> unknown;
  for (const MovingThing& thing : things)
    if (!types.count(thing.type) && !otherwise) ++unknown[thing.type];
  if (!unknown.empty()) {
    std::string names;
    for (const auto& [type, count] : unknown) names += (names.empty() ? "'" : ", '") + type + strf("' (%zu)", count);
    throw p.error("traffic of types that 'types' does not know: " + names, "name them in 'types', or give a 'default'",
                  "SP413");
  }
  for (const MovingThing& thing : things) {
    const auto type = types.find(thing.type);
    DraftPlacement made = type == types.end() ? *otherwise : type->second;
    if (!made.tag.given()) made.tag = {thing.id, thing.where};
    made.motion = ending_track(thing.track);
    made.motion_where = p.where();
    to.push_back(std::move(made));
  }
}

}  // namespace suite::scene_text
