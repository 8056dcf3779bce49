// What moves, as programs of traffic write it: files of many tracks, one row a format. A new one is a file here and a
// row in track_files.cpp.
#pragma once
#include "base/registry.h"
#include "formats/motion/motion.h"

namespace suite {

// One thing from its first record to its last, without a gap.
struct MovingThing {
  std::string id, type;  // type: empty where the format knows none
  Where where;           // of its first record
  TrackPtr track;        // covers the times when it is there
};

struct TrackFileOptions {
  const MotionContext& motion;
  double begins = 0;  // s of the scene at which the file's second 0 is
  // The plane in which a traffic network counts: metres of the scene, longitudes and latitudes, or metres of UTM.
  enum class Network { scene, geographic, utm } network = Network::scene;
  UtmZone zone = {};  // utm
  double east = 0;    // where the network's (0, 0) lies: m in the scene, or easting and northing
  double north = 0;
  double height = 0;                // added to the file's, m: above the scene's z = 0, or above the ellipsoid
  std::optional<Error> given = {};  // what to tell if one of these was given and a file has dates and places of its own
};

// make takes the text, its name for messages and the options. Error, located: anything that is not of the format, times
// that do not ascend, a file that holds nothing that moves.
struct TrackFileRow
    : RegistryRow<std::vector<MovingThing>(const std::string& text, const std::string& name, const TrackFileOptions&)> {
  // Whether a file is of this format, by its first bytes (4 KiB, or all of a shorter one).
  bool (*sniff)(std::string_view head);
};
const Registry<TrackFileRow>& track_files();

// Null when no row knows the text; it may be a table of timed poses.
const TrackFileRow* track_file_of(std::string_view text);

// Keys `begins`, `network` and `height_m` of a node.
TrackFileOptions track_file_options(const Params& node, const MotionContext& context);

// What moves in the file that a node names. Error: no row knows it.
std::vector<MovingThing> read_track_file(const Params& file, const TrackFileOptions& options);

namespace track_file {
TrackFileRow fcd_row();
TrackFileRow czml_row();
TrackFileRow stk_row();
// Of formats with dates and places on the Earth. Error: the scene has no origin or no date, or options were given.
void require_earth(const TrackFileOptions& options, const std::string& name);
// A thing at an ECEF place that points north.
Pose northward(const SceneFrame& frame, Vec3 ecef);
}  // namespace track_file

}  // namespace suite
