#include "formats/motion/track_files.h"

#include "base/files.h"
#include "formats/motion/fields.h"

namespace suite {

const Registry<TrackFileRow>& track_files() {
  static const Registry<TrackFileRow> table("file of tracks", "",
                                            {track_file::fcd_row(), track_file::czml_row(), track_file::stk_row()});
  return table;
}

const TrackFileRow* track_file_of(std::string_view text) {
  for (const TrackFileRow& row : track_files())
    if (row.sniff(text.substr(0, 4096))) return &row;
  return nullptr;
}

TrackFileOptions track_file_options(const Params& node, const MotionContext& context) {
  TrackFileOptions o{context};
  for (const char* key : {"begins", "network", "height_m"})
    if (node.has(key))
      o.given = node.at(key).error(std::string("'") + key + "' of a file that has dates and places on the Earth",
                                   "leave it out");
  if (const auto begins = node.find("begins")) o.begins = time_value(*begins, context);
  o.height = node.number_in("height_m", -1e5, 1e7, "m", 0);
  const auto network = node.find("network");
  if (!network) return o;
  const bool map = network->kind() == Params::Kind::map;
  if (!map && network->as_choice({"scene", "geographic"}) == 1) o.network = TrackFileOptions::Network::geographic;
  if (map) {
    if (const auto zone = network->find("utm_zone")) {
      const auto grid = utm_zone_of_text(zone->as_text());
      if (!grid) throw zone->error("'" + zone->as_text() + "' is no UTM zone", "write 33N or 56S");
      o.network = TrackFileOptions::Network::utm, o.zone = *grid;
    }
    const std::vector<double> origin = network->at("origin_m").as_numbers();
    if (origin.size() != 2) throw network->at("origin_m").error("the place of the network's (0, 0) is [east, north]");
    o.east = origin[0], o.north = origin[1];
  }
  if (o.network != TrackFileOptions::Network::scene && !context.frame)
    throw network->error("this network needs a scene with an origin on the Earth", "give the scene an origin");
  return o;
}

void track_file::require_earth(const TrackFileOptions& options, const std::string& name) {
  if (options.given) throw *options.given;
  const Where where{name, 0, 0, {}, -1};
  if (!options.motion.frame)
    throw Error(where, "places on the Earth need a scene with an origin on it", "give the scene an origin");
  if (!options.motion.clock)
    throw Error(where, "its dates need the date of the scene's second 0", "give the scene an epoch");
}

Pose track_file::northward(const SceneFrame& frame, Vec3 ecef) {
  return pose_from_geodetic(frame, geodetic_from_ecef(ecef), {1, 0, 0, 0});
}

std::vector<MovingThing> read_track_file(const Params& file, const TrackFileOptions& options) {
  const std::string path = motion_file(file, options.motion), text = read_text(path);
  const TrackFileRow* row = track_file_of(text);
  if (!row) {
    std::string known;
    for (const TrackFileRow& r : track_files()) known += (known.empty() ? "" : ", ") + r.summary;
    throw file.error("'" + path + "' is no file of tracks", "known are: " + known);
  }
  return row->make(text, path, options);
}

}  // namespace suite
