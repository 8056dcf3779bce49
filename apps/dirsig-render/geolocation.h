// Where the pixels of an image are on the ground, for programs that put raw images onto maps: IGM, GLT and a VRT.
#pragma once
#include <string>
#include <vector>

#include "formats/envi/envi.h"
#include "ground_places.h"
#include "headers.h"

namespace suite {

// The image that is located.
struct LocatedImage {
  std::string base;          // file name without ".img"
  const EnviHeader& header;  // of the radiance
  const std::string& about;  // for descriptions: whose and from what
  double scale = 1;          // what one of its numbers stands for
};

// Writes BASE_igm.img (longitude, latitude, height on WGS84; east, north, up of a scene without an origin),
// BASE_glt.img (for every cell of a north-up map the sample and the line that show it; not without a map) and, of a
// scene with an origin, BASE_geo.vrt (the image with the IGM as its geolocation arrays). Returns the names of the
// files.
std::vector<std::string> write_geolocation(const LocatedImage& image, const GroundPlaces& places, const GroundMap* map);

}  // namespace suite
